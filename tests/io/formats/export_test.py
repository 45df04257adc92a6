#!/usr/bin/env python3
"""Independent readers read the files of `svdag export` as the same voxels.

Usage: export_test.py PROGRAMS
"""
import pathlib
import struct
import sys
import unittest

import numpy

from baked import Bakery, askew, coarser, inside, is_asymmetric, slices
from read_foreign import READERS, XYZ, ZYX, Broken, read_ply

BAKERY = Bakery(sys.argv.pop(1))
DAGS = {"hashdag": "x.basic_dag.dag.bin", "symvox": "x.svdag", "transform-dag": "x.svo", "octree": "x.octree"}
LISTS = {"npz": "x.npz", "binvox": "x.binvox", "vox": "x.vox", "ply": "x.ply"}
BOUNDS = (-0.61, 2.3, 0.5, 2.2, 4.1, 1.9)


def bounds_option(bounds):
    return "--bounds=" + ",".join(map(str, bounds))


class Export(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dag = BAKERY.bake("askew", askew(), "-r", "128")
        cls.voxels = cls.dag.voxels().astype("<i8")
        cls.full = BAKERY.bake("full", slices(32), "-r", "32")
        cls.large = BAKERY.bake("large", askew(), "-r", "512")
        cls.empty = BAKERY.bake("empty", askew(), "-r", "64", "--bounds=900,900,900,901,901,901")

    def export(self, name, form, *options):
        output = {**DAGS, **LISTS}[form]
        BAKERY.run("svdag", "export", f"{name}.svdag", "--format", form, "-o", output, "-q", *options)
        return BAKERY.folder / output

    def expect_same(self, found, voxels):
        """Avoids unittest's comparison of lists, which takes minutes to describe a difference."""
        self.assertTrue(numpy.array_equal(found, voxels), f"{len(found)} voxels instead of {len(voxels)}")

    def expect(self, dag, name, form, level, voxels, *options, low=(0, 0, 0), corner=True):
        """Checks that the export holds `voxels`, relative to `low`, at the right world coordinates."""
        path = self.export(name, form, *options)
        size = dag.voxel_size * 2.0**(dag.L - level)
        if form == "ply":
            numbers = (read_ply(path) - dag.corner) / size - 0.5
            self.assertLess(numpy.abs(numbers - numbers.round()).max(initial=0), 1e-6)
            numbers = numbers.round().astype("<i8")
            self.expect_same(numpy.unique(numbers, axis=0).reshape(-1, 3), voxels)
            return self.assertEqual(len(numbers), len(voxels))
        found = READERS[form](path)
        self.expect_same(found.voxels + low, voxels)
        if not any(low) and found.resolution is not None:
            tight = form == "binvox" and len(voxels) == 0  # one empty voxel
            self.assertEqual(found.resolution, 1 if tight else 2**level)
        if found.corner is not None:
            self.assertAlmostEqual(found.voxel_size / size, 1, delta=1e-6)
            for got, own, first in zip(found.corner, dag.corner, low):
                self.assertAlmostEqual(got, own + size * first, delta=1e-6 * (abs(own) + size * 2**level))

    def test_the_scene_has_no_symmetry(self):
        self.assertTrue(is_asymmetric(self.voxels, 128))
        self.assertTrue(is_asymmetric(coarser(self.voxels, 3), 16))

    def test_every_format_holds_the_same_voxels(self):
        for form in {**DAGS, **LISTS}:
            with self.subTest(form=form):
                self.expect(self.dag, "askew", form, 7, self.voxels)

    def test_a_coarser_level_has_the_voxels_that_are_not_empty(self):
        for form in {**DAGS, **LISTS}:
            for level in (6, 5, 4, 3):
                with self.subTest(form=form, level=level):
                    self.expect(self.dag, "askew", form, level, coarser(self.voxels, 7 - level), "--level", level)

    def test_full_and_empty_grids(self):
        everything = numpy.stack(numpy.meshgrid(*[numpy.arange(32)] * 3, indexing="ij"), -1).reshape(-1, 3)
        self.assertEqual(len(self.full.voxels()), 32**3)
        for form in {**DAGS, **LISTS}:
            with self.subTest(form=form):
                self.expect(self.full, "full", form, 5, everything)
                self.expect(self.full, "full", form, 3, everything[:512] * 0 + coarser(everything, 2), "--level", 3)
                self.expect(self.empty, "empty", form, 6, self.voxels[:0])
                self.expect(self.empty, "empty", form, 3, self.voxels[:0], "--level", 3)

    def test_a_part_with_bounds(self):
        for form in {**DAGS, **LISTS}:
            for level in (7, 5):
                with self.subTest(form=form, level=level):
                    voxels = inside(coarser(self.voxels, 7 - level), self.dag, level, BOUNDS)
                    self.assertTrue(20 < len(voxels) < len(coarser(self.voxels, 7 - level)))
                    size = self.dag.voxel_size * 2.0**(7 - level)
                    low = [int((b - c) // size) for b, c in zip(BOUNDS, self.dag.corner)] if form == "binvox" else (0, 0, 0)
                    self.expect(self.dag, "askew", form, level, voxels, "--level", level, bounds_option(BOUNDS), low=low)

    def test_a_part_is_the_minimal_dag_of_an_edit(self):
        for options in (["--level", "5"], [bounds_option(BOUNDS)], ["--level", "5", bounds_option(BOUNDS)]):
            BAKERY.run("svdag", "edit", "askew.svdag", "-o", "part.svdag", "-q", *options)
            for form in DAGS:
                with self.subTest(form=form, options=options):
                    expected = self.export("part", form).read_bytes()
                    self.assertEqual(self.export("askew", form, *options).read_bytes(), expected)

    def test_a_part_of_a_full_grid_cuts_full_cubes(self):
        bounds = (2.7, 3.2, 0.8, 25.1, 19.9, 30.3)
        everything = self.full.voxels().astype("<i8")
        voxels = inside(everything, self.full, 5, bounds)
        for form in ("npz", "vox", "ply"):
            with self.subTest(form=form):
                self.expect(self.full, "full", form, 5, voxels, bounds_option(bounds))

    def test_vox_joins_tiles(self):
        self.expect(self.large, "large", "vox", 9, self.large.voxels().astype("<i8"))

    def test_dags_are_as_large_as_ours(self):
        words = sum(self.large.entries[k][1] // 4 for k in range(7))
        size = self.export("large", "hashdag").stat().st_size
        self.assertEqual(size, 60 + 4 * words + 8 * len(self.large.bricks))
        self.assertLess(self.export("large", "octree").stat().st_size, 100)

    def test_another_order_of_children_is_detected(self):
        for form, order in (("hashdag", ZYX), ("symvox", ZYX), ("transform-dag", XYZ), ("octree", XYZ)):
            with self.subTest(form=form):
                found = READERS[form](self.export("askew", form), order)
                self.assertFalse(numpy.array_equal(found.voxels, self.voxels))

    def test_a_header_off_by_one_is_detected(self):
        fields = {"hashdag": [48, 52], "symvox": [28, 32, 36, 40], "transform-dag": [0, 4, 8, 16, 40, -12, -8, -4]}
        for form, offsets in fields.items():
            path = self.export("askew", form)
            good = path.read_bytes()
            for offset in offsets:
                for step in (-1, 1):
                    data = bytearray(good)
                    at = offset % len(data)
                    value, = struct.unpack_from("<I", data, at)
                    struct.pack_into("<I", data, at, (value + step) % 2**32)
                    path.write_bytes(data)
                    with self.subTest(form=form, offset=offset, step=step):
                        with self.assertRaises((Broken, struct.error, ValueError, IndexError)):
                            if not numpy.array_equal(READERS[form](path).voxels, self.voxels):
                                raise Broken("other voxels")

    def test_the_name_of_a_hashdag_is_made_from_its_depth(self):
        BAKERY.bake("named", askew()[:2], "-r", "2K")
        out = BAKERY.run("svdag", "export", "named.svdag", "--format", "hashdag", "-o", "atrium")
        self.assertTrue((BAKERY.folder / "atrium2k.basic_dag.dag.bin").exists(), out)
        self.assertIn("atrium2k.basic_dag.dag.bin", out)
        BAKERY.run("svdag", "export", "named.svdag", "--format", "hashdag", "-o", "atrium", "--level", "10")
        self.assertEqual(READERS["hashdag"](BAKERY.folder / "atrium1k.basic_dag.dag.bin").resolution, 1024)
        BAKERY.run("svdag", "export", "named.svdag", "-o", "ended.dag.bin")
        self.assertTrue((BAKERY.folder / "ended2k.basic_dag.dag.bin").exists())
        wrong = "atrium64k.basic_dag.dag.bin"
        self.assertIn("the name says 64K^3, but the grid has 2K^3", BAKERY.run("svdag", "export", "named.svdag", "-o", wrong, "--format", "hashdag", code=2))
        self.assertFalse((BAKERY.folder / wrong).exists())

    def test_a_position_that_floats_cannot_store_is_rejected(self):
        near, far = (BAKERY.bake(name, askew()[:2], "-s", "0.01", f"--bounds={x},0,0,{x + 1},1,1")
                     for name, x in (("near", 1000), ("far", 4000000.3)))
        BAKERY.run("svdag", "export", "near.svdag", "--format", "symvox", "-o", "near-symvox.svdag")
        self.assertEqual(near.L, far.L)
        self.assertIn("float32", BAKERY.run("svdag", "export", "far.svdag", "--format", "symvox", "-o", "far-symvox.svdag", code=2))

    def test_an_archive_is_the_same_bytes_each_time(self):
        first = self.export("askew", "npz").read_bytes()
        self.assertEqual(first, self.export("askew", "npz").read_bytes())

    def test_too_many_voxels_are_rejected_before_writing(self):
        for form in LISTS:
            path = BAKERY.folder / f"refused.{form}"
            error = BAKERY.run("svdag", "export", "askew.svdag", "--format", form, "-o", path, "--max-voxels",
                               len(self.voxels) - 1, code=2)
            self.assertIn("--level", error)
            self.assertFalse(path.exists())
            BAKERY.run("svdag", "export", "askew.svdag", "--format", form, "-o", path, "--max-voxels", len(self.voxels))


if __name__ == "__main__":
    unittest.main()
