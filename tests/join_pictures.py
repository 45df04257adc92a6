#!/usr/bin/env python3
"""Joins pictures of equal height side by side into a PNG with a palette, a third of the bytes.

Usage: join_pictures.py OUT.png IN.png...; the inputs are 8-bit RGB, as svdag-verify render writes them. The palette is
by median cut (Heckbert 1982).
"""
import pathlib
import struct
import sys
import zlib

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "cli"))
from colours import rows_of  # noqa: E402

COLOURS = 256


def median_cut(colours, counts):
    """The box of each colour: the box with the largest error is halved at the median of its longest axis."""
    boxes = [numpy.arange(len(colours))]

    def error(box):
        weight = counts[box, None]
        mean = (colours[box] * weight).sum(0) / weight.sum()
        return (((colours[box] - mean) ** 2) * weight).sum(0)

    errors = [error(boxes[0])]
    while len(boxes) < min(COLOURS, len(colours)):
        worst = max(range(len(boxes)), key=lambda i: errors[i].max())
        box, axis = boxes[worst], errors[worst].argmax()
        box = box[numpy.argsort(colours[box, axis], kind="stable")]
        total = counts[box].cumsum()
        half = min(max(1, int(numpy.searchsorted(total, total[-1] / 2))), len(box) - 1)
        boxes[worst], errors[worst] = box[:half], error(box[:half])
        boxes.append(box[half:])
        errors.append(error(box[half:]))
    return boxes


def main():
    out, *names = sys.argv[1:]
    pictures = [numpy.array([list(row) for row in rows_of(pathlib.Path(name).read_bytes())], numpy.uint8) for name in names]
    joined = numpy.concatenate(pictures, 1)
    height, width = len(joined), joined.shape[1] // 3
    colours, inverse, counts = numpy.unique(joined.reshape(-1, 3), axis=0, return_inverse=True, return_counts=True)
    colours = colours.astype(float)
    index, palette = numpy.zeros(len(colours), numpy.uint8), b""
    for i, box in enumerate(median_cut(colours, counts)):
        index[box] = i
        mean = (colours[box] * counts[box, None]).sum(0) / counts[box].sum()
        palette += bytes(mean.round().astype(numpy.uint8))
    rows = numpy.zeros((height, width + 1), numpy.uint8)  # each begins with its filter: none
    rows[:, 1:] = index[inverse].reshape(height, width)

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    pathlib.Path(out).write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)) +
        chunk(b"PLTE", palette) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)) + chunk(b"IEND", b""))


if __name__ == "__main__":
    main()
