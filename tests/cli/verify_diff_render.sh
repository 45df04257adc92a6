# --render draws voxels of both files grey, of only A red, of only B blue.
svdag-scene city -n 1.2K -q -o city.ply
svdag build city.ply -r 64 --cube=-60,-60,-60,120 -o a.svdag -q
svdag edit a.svdag -o half.svdag --bounds=-60,-60,-60,0,60,60 -q
colours() {
  python3 -c '
import sys, zlib, struct
data, at, raw = open(sys.argv[1], "rb").read(), 8, b""
while at < len(data):
    size, = struct.unpack(">I", data[at:at + 4])
    if data[at + 4:at + 8] == b"IHDR": width, height = struct.unpack(">II", data[at + 8:at + 16])
    if data[at + 4:at + 8] == b"IDAT": raw += data[at + 8:at + 8 + size]
    at += 12 + size
raw = zlib.decompress(raw)
row, red, blue, last = 3 * width, 0, 0, bytes(3 * width)
for y in range(height):
    kind, line = raw[y * (row + 1)], bytearray(raw[y * (row + 1) + 1:(y + 1) * (row + 1)])
    for i in range(row):
        a, b, c = line[i - 3] if i > 2 else 0, last[i], last[i - 3] if i > 2 else 0
        p = a + b - c
        line[i] = (line[i] + [0, a, b, (a + b) // 2, min((a, b, c), key=lambda v: abs(p - v))][kind]) & 255
    red += sum(line[i] > 1.6 * line[i + 2] for i in range(0, row, 3))
    blue += sum(line[i + 2] > 1.6 * line[i] for i in range(0, row, 3))
    last = line
print(sys.argv[1], "red" if red else "", "blue" if blue else "")' $1
}
svdag-verify diff a.svdag a.svdag --render same.png --size 80x60 -q
svdag-verify diff a.svdag half.svdag --render less.png --size 80x60 -q || echo "exit $?"
svdag-verify diff half.svdag a.svdag --render more.png --size 80x60 -q || echo "exit $?"
for picture in same less more; do colours $picture.png; done
svdag edit a.svdag -o coarse.svdag --level 5 -q
svdag-verify diff a.svdag coarse.svdag --render bad.png || echo "exit $?"
svdag-verify diff a.svdag half.svdag --render bad.jpg || echo "exit $?"
svdag-verify diff a.svdag half.svdag --render a.svdag || echo "exit $?"
svdag-verify diff a.svdag half.svdag --render bad.png --size 0x0 || echo "exit $?"
ls
