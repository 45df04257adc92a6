#!/usr/bin/env python3
"""Compares the snap with exact fractions: every operation is rounded once, and the total error is bounded.

Usage: snap_vs_fractions.py PROGRAM   (tests/io/dump_snapped.cpp)"""
import random
import subprocess
import sys
import unittest
from fractions import Fraction

PROGRAM = sys.argv.pop(1) if __name__ == "__main__" else None
CASES = 20_000
FAR = 2**62


def fraction_bits(levels):
    return min(23, 39 - levels)


def snap(kind, levels, size, origin, k0, p):
    """The lattice coordinate, or None if it is too far; float() of a Fraction is the nearest double."""
    offset = Fraction(p) if kind == "lattice" else Fraction(float(Fraction(p) - Fraction(origin)))
    quotient = Fraction(float(offset / Fraction(size)))
    q = round(quotient * 2**fraction_bits(levels))  # ties to even
    if abs(q) >= FAR:
        return None
    return q - (2 * k0 + (kind == "lattice")) * 2**(fraction_bits(levels) - 1)


def exact_position(kind, levels, size, origin, k0, p):
    """The lattice coordinate without rounding."""
    scale = 2**fraction_bits(levels)
    half = Fraction(1, 2) if kind == "lattice" else 0
    return ((Fraction(p) - Fraction(origin)) / Fraction(size) - k0 - half) * scale


def some_number(chance, size):
    """A coordinate near the grid, far from it, or on a voxel plane."""
    near = chance.uniform(-1, 1) * size * 2**chance.randrange(24)
    return chance.choice([near, round(near / size) * size, (round(near / size) + 0.5) * size,
                          near * 2**chance.randrange(30), float(round(near, 3)), 0.0])


class Snap(unittest.TestCase):
    def test_every_operation_is_rounded_once(self):
        chance = random.Random(7)
        cases, lines = [], []
        for _ in range(CASES):
            kind, levels = chance.choice(["box", "lattice", "origin"]), chance.randint(3, 20)
            size = chance.choice([0.1, 0.01, 1 / 3, chance.uniform(1e-3, 10), chance.uniform(1, 2) * 2.0**chance.randrange(-900, 900)])
            from_ = [1024 * chance.randint(-2**20, 2**20) if kind == "lattice" else some_number(chance, size) for _ in range(3)]
            p = [some_number(chance, size) for _ in range(3)]
            cases.append((kind, levels, size, from_, p))
            lines.append(" ".join([kind, str(levels), size.hex(),
                                   *(float(f).hex() for f in from_), *(c.hex() for c in p)]))
        done = subprocess.run([PROGRAM], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True)
        answers = done.stdout.splitlines()
        self.assertEqual(len(answers), CASES)
        far = 0
        for (kind, levels, size, from_, p), answer in zip(cases, answers):
            shift = 1024 if kind == "origin" else 0
            axes = [(0, k, c) if kind == "lattice" else (k, shift, c) for k, c in zip(from_, p)]
            expected = [snap(kind, levels, size, *axis) for axis in axes]
            if None in expected:
                far += 1
                self.assertEqual(answer, "far")
                continue
            found = [int(q) for q in answer.split()]
            self.assertEqual(found, expected)
            for q, axis in zip(found, axes):
                true = exact_position(kind, levels, size, *axis)
                away = abs(true) + abs(axis[1]) * 2**(fraction_bits(levels) + 1)  # distance from the zero of the lattice
                self.assertLessEqual(abs(q - true), Fraction(1, 2) + away / 2**52)
        self.assertLess(10, far)
        self.assertLess(far, CASES / 2)


if __name__ == "__main__":
    unittest.main()
