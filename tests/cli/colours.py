"""Prints which of red and blue a PNG contains: a channel that is 1.6 times the other."""
import struct
import sys
import zlib


def rows_of(data):
    """The rows of an 8-bit RGB picture."""
    at, raw = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        chunk = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height = struct.unpack(">II", chunk[:8])
        if kind == b"IDAT":
            raw += chunk
        at += 12 + size
    raw, row, last = zlib.decompress(raw), 3 * width, bytes(3 * width)
    for y in range(height):
        kind, line = raw[y * (row + 1)], bytearray(raw[y * (row + 1) + 1:(y + 1) * (row + 1)])
        for i in range(row):
            a, b, c = line[i - 3] if i > 2 else 0, last[i], last[i - 3] if i > 2 else 0
            paeth = min((a, b, c), key=lambda v: abs(a + b - c - v))
            line[i] = line[i] + [0, a, b, (a + b) // 2, paeth][kind] & 255
        yield line
        last = line


def main():
    for name in sys.argv[1:]:
        with open(name, "rb") as file:
            pixels = [line[i:i + 3] for line in rows_of(file.read()) for i in range(0, len(line), 3)]
        found = [colour for colour, one, other in (("red", 0, 2), ("blue", 2, 0)) if any(p[one] > 1.6 * p[other] for p in pixels)]
        print(name, *found)


if __name__ == "__main__":
    main()
