#!/usr/bin/env python3
"""Tests that a LAZ is imported with the bytes of its LAS.

Usage: laz_test.py [TEST...], by the Python of the environment that has the package and laspy with lazrs.
"""
import pathlib
import tempfile
import unittest

import laspy
import numpy as np

import svdag


class Laz(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="svdag-laz-test-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.random = np.random.default_rng(1)

    def write(self, name, count):
        """Points with colours and classes, as NAME.las and NAME.laz."""
        header = laspy.LasHeader(version="1.4", point_format=7)
        header.scales, header.offsets = [0.01, 0.001, 0.01], [5e5, 4e6, 0]
        las = laspy.LasData(header)
        las.X, las.Y, las.Z = self.random.integers(-10 ** 6, 10 ** 6, (3, count))
        las.red, las.green, las.blue = self.random.integers(0, 65536, (3, count))
        las.classification = self.random.integers(0, 9, count)
        for ending in "las", "laz":
            las.write(str(self.folder / f"{name}.{ending}"))

    def test_a_laz_has_the_voxels_of_its_las(self):
        self.write("a", 2_500_000)
        self.write("b", 10)
        bakes = []
        for ending in "las", "laz":
            report = svdag.import_file([self.folder / f"{name}.{ending}" for name in "ab"], self.folder / f"{ending}.svdag",
                                       resolution="1K", layers="class")
            self.assertEqual(report["points"], 2_500_010)
            bakes.append((self.folder / f"{ending}.svdag").read_bytes())
        self.assertEqual(bakes[0], bakes[1])
        self.assertFalse(list(self.folder.glob(".svdag-*")), "a temporary LAS is left")

    def test_a_damaged_laz_is_one_sentence(self):
        self.write("a", 100_000)
        data = (self.folder / "a.laz").read_bytes()
        for damaged in data[:100], data[:len(data) // 2], b"", data[:400] + bytes(1000) + data[1400:]:
            (self.folder / "damaged.laz").write_bytes(damaged)
            with self.assertRaises(svdag.Error) as caught:
                svdag.import_file(self.folder / "damaged.laz", self.folder / "out.svdag", resolution=64)
            self.assertEqual(caught.exception.code, 3)
            self.assertFalse((self.folder / "out.svdag").exists())


if __name__ == "__main__":
    unittest.main()
