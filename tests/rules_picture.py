#!/usr/bin/env python3
"""Draws docs/images/rules.svg: the two rules in two dimensions, with a line for the triangle and squares for voxels.

Usage: rules_picture.py OUT.svg. The squares are decided in exact fractions, by the definitions in docs/concepts.md.
"""
import pathlib
import sys
from fractions import Fraction

WIDTH, HEIGHT, SIDE, GAP = 10, 6, 30, 40
A, B = (Fraction(7, 10), Fraction(6, 10)), (Fraction(93, 10), Fraction(53, 10))  # the ends of the line
HALF = Fraction(1, 2)


def touched(x, y):
    """Whether the closed line meets the closed square: clipping it by the four half-planes leaves a part of it."""
    low, high = Fraction(0), Fraction(1)
    for axis, corner in ((0, x), (1, y)):
        start, step = A[axis], B[axis] - A[axis]
        if step == 0:
            if not corner <= start <= corner + 1:
                return False
            continue
        ends = sorted(((corner - start) / step, (corner + 1 - start) / step))
        low, high = max(low, ends[0]), min(high, ends[1])
    return low <= high


def crossed(x, y):
    """Whether the line crosses the centre segment along x or along y (no tie occurs here)."""
    centre = (x + HALF, y + HALF)
    for along in (0, 1):
        across = 1 - along
        if (A[across] < centre[across]) == (B[across] < centre[across]):
            continue
        t = (centre[across] - A[across]) / (B[across] - A[across])
        if abs(A[along] + t * (B[along] - A[along]) - centre[along]) < HALF:
            return True
    return False


def panel(left, title, rule, segments):
    def at(x, y):
        return left + float(x) * SIDE, 30 + (HEIGHT - float(y)) * SIDE

    out = [f'<text x="{left}" y="18">{title}</text>']
    for x in range(WIDTH):
        for y in range(HEIGHT):
            px, py = at(x, y + 1)
            out.append(f'<rect x="{px:g}" y="{py:g}" width="{SIDE}" height="{SIDE}" class="{"set" if rule(x, y) else "none"}"/>')
            if segments:
                cx, cy = at(x + HALF, y + HALF)
                r = SIDE / 2
                out.append(f'<path class="centre" d="M{cx - r:g} {cy:g}h{SIDE}M{cx:g} {cy - r:g}v{SIDE}"/>')
    (x0, y0), (x1, y1) = at(*A), at(*B)
    out.append(f'<line x1="{x0:g}" y1="{y0:g}" x2="{x1:g}" y2="{y1:g}"/>')
    return out


def main():
    width = 2 * WIDTH * SIDE + GAP + 20
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {HEIGHT * SIDE + 45}" width="{width}">',
             "<style>text{font:15px sans-serif;fill:#777} .none{fill:none;stroke:#999} .set{fill:#4a86c5;stroke:#999}",
             "line{stroke:#d95f02;stroke-width:3} .centre{stroke:#9997;stroke-dasharray:2 2}</style>"]
    lines += panel(10, "conservative: the line touches the square", touched, False)
    lines += panel(10 + WIDTH * SIDE + GAP, "thin: it crosses a line through the centre", crossed, True)
    pathlib.Path(sys.argv[1]).write_text("\n".join(lines + ["</svg>"]) + "\n")


if __name__ == "__main__":
    main()
