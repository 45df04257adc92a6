# --clip and --slice show a part of the voxels, with sections in red.
svdag-scene city -n 1.2K -q -o city.ply
svdag build city.ply -r 64 -o city.svdag -q
reds() {
  python3 -c '
import sys, zlib, struct
data, at, raw = open(sys.argv[1], "rb").read(), 8, b""
while at < len(data):
    size, = struct.unpack(">I", data[at:at + 4])
    if data[at + 4:at + 8] == b"IHDR": width, height = struct.unpack(">II", data[at + 8:at + 16])
    if data[at + 4:at + 8] == b"IDAT": raw += data[at + 8:at + 8 + size]
    at += 12 + size
raw = zlib.decompress(raw)
row, rows, last = 3 * width, [], bytes(3 * width)
for y in range(height):
    kind, line = raw[y * (row + 1)], bytearray(raw[y * (row + 1) + 1:(y + 1) * (row + 1)])
    for i in range(row):
        a, b, c = line[i - 3] if i > 2 else 0, last[i], last[i - 3] if i > 2 else 0
        p = a + b - c
        line[i] = (line[i] + [0, a, b, (a + b) // 2, min((a, b, c), key=lambda v: abs(p - v))][kind]) & 255
    rows.append(line); last = line
print(sys.argv[1], any(r[i] > 2 * r[i + 1] and r[i] > 100 for r in rows for i in range(0, row, 3)))' $1
}
svdag-verify render city.svdag -o whole.png --size 80x60 -q
svdag-verify render city.svdag -o slice.png --size 80x60 --slice x=0 -q
svdag-verify render city.svdag -o clip.png --size 80x60 --clip=-30,-1,-30,20,50,20 --mode soft --samples 2 -q
for picture in whole slice clip; do reds $picture.png; done
svdag-verify render city.svdag -o one.png --size 80x60 --clip=-30,-1,-30,20,50,20 --mode ao --samples 2 -q -j 1
svdag-verify render city.svdag -o two.png --size 80x60 --clip=-30,-1,-30,20,50,20 --mode ao --samples 2 -q -j 2
cmp one.png two.png
for option in --slice=x=9e9 --slice=x --slice=w=1 --slice=x=nan --clip=1e6,1e6,1e6,2e6,2e6,2e6 --clip=1,2,3; do
  svdag-verify render city.svdag -o bad.png $option || echo "exit $?"
done
ls *.png
