#!/usr/bin/env python3
"""Exports hold the stored colour of each voxel, and of each cube of a coarser level; imports have them again.

Usage: export_colours_test.py PROGRAMS [DUMP_LABELS]. What is expected is read by the Python reader. DUMP_LABELS prints
a grid that OpenVDB reads.
"""
import functools
import json
import math
import pathlib
import subprocess
import sys
import unittest

import numpy

from baked import Bakery
from read_foreign import read_hashdag_colours, read_vox_palette

DUMP = pathlib.Path(sys.argv.pop(2)).resolve() if len(sys.argv) > 2 else None
BAKERY = Bakery(sys.argv.pop(1))
NEUTRAL = "bcb5aa"

CORNERS = [[(50 if c >> a & 1 else 3) * (1 + a / 5) for a in range(3)] for c in range(8)]
FACES = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]


def write_box(path):
    """A closed box whose faces are gradients, except for two of one colour."""
    rows, faces = [], []
    for i, face in enumerate(FACES):
        for n, corner in enumerate(face):
            colour = (200, 40, 40) if i < 2 else [(37 * corner + 90 * n + 60 * a * i) % 256 for a in range(3)]
            rows.append(" ".join(map(str, [*CORNERS[corner], *colour])))
        faces += [f"3 {4 * i} {4 * i + 1} {4 * i + 2}", f"3 {4 * i} {4 * i + 2} {4 * i + 3}"]
    path.write_text("\n".join(["ply", "format ascii 1.0", f"element vertex {len(rows)}",
                               *(f"property float {a}" for a in "xyz"),
                               *(f"property uchar {c}" for c in ("red", "green", "blue")),
                               f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header",
                               *rows, *faces, ""]))


def linear(code):
    v = numpy.asarray(code) / 255
    return numpy.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


class ExportColours(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        write_box(BAKERY.folder / "box.ply")
        for name, options in {"fine": ["--colour-level", "6"], "odd": ["--colour-level", "5"],
                              "solid": ["--rule", "solid", "--colour-level", "6", "--layers", "file"],
                              "coarse": ["--rule", "solid", "--colour-level", "4"],
                              "exact": ["--colour-level", "6", "--colour-error", "0"]}.items():
            BAKERY.run("svdag", "build", "box.ply", "-o", f"{name}.svdag", "-r", "64", "-q", "--colours", *options)
        cls.levels = {"fine": 6, "odd": 5, "solid": 6, "coarse": 4, "exact": 6}  # K
        cls.dags = {name: cls.colours_of(name) for name in cls.levels}

    @classmethod
    def colours_of(cls, name):
        """The colour of each cube (level, x, y, z) that has one."""
        if name not in ("solid", "coarse"):
            return BAKERY.dag(f"{name}.svdag").colours
        rows = [line.split() for line in BAKERY.run("tests/paint_dag", f"{name}.svdag").splitlines()]
        return {tuple(map(int, at)): colour for *at, colour in rows if colour != "none"}

    @classmethod
    def expected(cls, name, level, voxels):
        """The colour of each cube of a level: its own or the next coarser one's."""
        shown = min(level, cls.levels[name])
        shown -= (cls.levels[name] - shown) % 2
        codes = [cls.dags[name].get((shown, *(int(a) >> level - shown for a in voxel)), NEUTRAL) for voxel in voxels]
        return numpy.array([list(bytes.fromhex(code)) for code in codes])

    @classmethod
    def export(cls, name, out, *options):
        return BAKERY.run("svdag", "export", f"{name}.svdag", "-o", out, *options)

    @classmethod
    @functools.lru_cache(maxsize=None)
    def exports(cls):
        cases = []
        for name in cls.dags:
            for level in (6, 5, 4):
                cls.export(name, "x.npz", "--level", level)
                arrays = dict(numpy.load(BAKERY.folder / "x.npz"))
                cases.append((name, level, arrays, cls.expected(name, level, arrays["coordinates"])))
        return cases

    def test_the_scene_has_many_colours_and_insides_without(self):
        codes = {name: set(dag.values()) for name, dag in self.dags.items()}
        self.assertGreater(len(codes["exact"]), 300)
        self.export("solid", "x.npz")
        voxels = numpy.load(BAKERY.folder / "x.npz")["coordinates"]
        self.assertTrue(any((6, *voxel) not in self.dags["solid"] for voxel in voxels.tolist()))

    def test_npz_and_ply_hold_the_colour(self):
        for name, level, arrays, colours in self.exports():
            self.assertEqual(arrays["colours"].dtype, "u1")
            self.assertTrue(numpy.array_equal(arrays["colours"], colours))
            self.assertEqual("label" in arrays, name == "solid")
            self.export(name, "x.ply", "--level", level)
            points = (BAKERY.folder / "x.ply").read_bytes().split(b"end_header\n")[1]
            found = numpy.frombuffer(points, [("xyz", "<f8", 3), ("rgb", "u1", 3)])["rgb"]
            self.assertTrue(numpy.array_equal(found, colours))

    def test_a_hashdag_holds_the_colour(self):
        for name, level, arrays, colours in self.exports():
            self.export(name, "x.basic_dag.dag.bin", "--level", level, "--colours")
            found, own = read_hashdag_colours(BAKERY.folder / "x.basic_dag.dag.bin")
            self.assertTrue(numpy.array_equal(own, self.expected(name, level, found)))
            self.assertEqual(len(found), len(colours))

    def test_a_vox_holds_the_nearest_of_its_palette(self):
        for name, level, arrays, colours in self.exports():
            report = json.loads(self.export(name, "x.vox", "--level", level, "--up", "z", "--json"))["palette"]
            found, palette = read_vox_palette(BAKERY.folder / "x.vox")  # one model: the voxels have the order of npz
            distinct = len(numpy.unique(colours, axis=0))
            squared = ((found.astype("i8") - colours) ** 2).sum(axis=1)
            nearest = ((palette[:, None].astype("i8") - colours) ** 2).sum(axis=2).min(axis=0)
            self.assertTrue(numpy.array_equal(squared, nearest))
            self.assertEqual((report["colours"], report["largest_error"]), (distinct, math.sqrt(squared.max())))
            self.assertLessEqual(report["entries"], 255)
            if distinct <= 255:
                self.assertEqual(report["largest_error"], 0)
            else:
                self.assertLess(report["largest_error"], 40)

    @unittest.skipIf(DUMP is None, "without OpenVDB")
    def test_a_vdb_holds_the_colour_in_linear_light(self):
        for name, level, arrays, colours in self.exports():
            self.export(name, "x.vdb", "--level", level)
            lines = subprocess.run([DUMP, BAKERY.folder / "x.vdb", "Cd"], capture_output=True, text=True,
                                   check=True).stdout.splitlines()
            rows = numpy.array([line.split() for line in lines if line[0].isdigit()], "f8").reshape(-1, 7)
            found = {}
            for x, y, z, side, *light in rows.tolist():
                for i in range(int(side) ** 3):
                    a, b, c = i // int(side * side), i // int(side) % int(side), i % int(side)
                    found[int(x) + a, int(y) + b, int(z) + c] = light
            self.assertEqual(len(found), len(colours))
            light = numpy.array([found[tuple(voxel)] for voxel in arrays["coordinates"].tolist()])
            self.assertLess(numpy.abs(light - linear(colours)).max(), 1e-6)
            if name == "solid" and level == 6:
                self.assertTrue(numpy.any(rows[:, 3] >= 8))  # the inside is tiles

    def test_parts_and_layers_keep_their_colours(self):
        self.export("solid", "x.npz", "--bounds=5,5,5,20,20,20")
        arrays = numpy.load(BAKERY.folder / "x.npz")
        self.assertTrue(numpy.array_equal(arrays["colours"], self.expected("solid", 6, arrays["coordinates"])))
        self.export("solid", "y.npz", "--layer", "box.ply")
        arrays = numpy.load(BAKERY.folder / "y.npz")
        self.assertTrue(numpy.array_equal(arrays["colours"], self.expected("solid", 6, arrays["coordinates"])))

    def imported(self, name, *options):
        """The voxels and colours of an import, which are lossless and those of every voxel."""
        BAKERY.run("svdag", "import", name, "-o", "back.svdag", "-q", *options)
        BAKERY.run("svdag-verify", "check", "back.svdag", "-q")
        about = json.loads(BAKERY.run("svdag", "info", "back.svdag", "--json"))
        self.assertEqual((about["colours"]["level"], about["colours"]["error"]), (about["levels"], 0))
        self.export("back", "back.npz")
        return dict(numpy.load(BAKERY.folder / "back.npz"))

    def test_imports_have_the_colours_that_were_exported(self):
        for name, level, arrays, colours in self.exports():
            self.export(name, "x.npz", "--level", level)
            back = [self.imported("x.npz")]
            self.assertEqual("label" in back[0], name == "solid")
            self.export(name, "x.basic_dag.dag.bin", "--level", level, "--colours")
            back += [self.imported("x.basic_dag.dag.bin"), self.imported("x.npz", "--layout", "compact", "--no-layers", "-m", "8M")]
            self.export(name, "x.ply", "--level", level)
            back.append(self.imported("x.ply"))
            for found in back:
                self.assertEqual(found["resolution"], 2**level)
                self.assertLess(numpy.abs(found["corner"] - arrays["corner"]).max(), 1e-9)
                self.assertTrue(numpy.array_equal(found["coordinates"], arrays["coordinates"]))
                self.assertTrue(numpy.array_equal(found["colours"], colours))

    def test_an_imported_vox_has_the_colours_of_its_palette(self):
        for name, level, arrays, _ in self.exports():
            self.export(name, "x.vox", "--level", level, "--up", "z")
            shown, _ = read_vox_palette(BAKERY.folder / "x.vox")
            found = self.imported("x.vox", "--up", "z", "-r", 2**level)
            self.assertTrue(numpy.array_equal(found["coordinates"], arrays["coordinates"]))
            self.assertTrue(numpy.array_equal(found["colours"], shown))
            self.assertEqual(len(found["layer_colours"]), len(numpy.unique(shown, axis=0)))  # its numbers are layers, too
            self.assertNotIn("label", self.imported("x.vox", "--no-layers"))

    def test_no_colours_gives_the_bytes_without(self):
        self.export("exact", "x.npz")
        arrays = dict(numpy.load(BAKERY.folder / "x.npz"))
        colours = arrays.pop("colours")
        numpy.savez(BAKERY.folder / "y.npz", **arrays)
        BAKERY.run("svdag", "import", "y.npz", "-o", "y.svdag", "-q")
        BAKERY.run("svdag", "import", "x.npz", "-o", "x.svdag", "-q", "--no-colours")
        BAKERY.run("svdag", "import", "x.npz", "-o", "z.svdag", "-q")
        BAKERY.run("svdag", "convert", "z.svdag", "-o", "w.svdag", "-q", "--no-colours")
        for name in ("x", "w"):
            self.assertEqual((BAKERY.folder / f"{name}.svdag").read_bytes(), (BAKERY.folder / "y.svdag").read_bytes())
        # The rows may have any order, and either order of the array.
        order = numpy.random.default_rng(1).permutation(len(colours))
        for order_of in "CF":
            numpy.savez(BAKERY.folder / "s.npz", **{**arrays, "coordinates": arrays["coordinates"][order],
                                                    "colours": numpy.asarray(colours[order], order=order_of)})
            self.assertTrue(numpy.array_equal(self.imported("s.npz")["colours"], colours))
        numpy.savez(BAKERY.folder / "w.npz", **arrays, colours=colours[1:])
        self.assertIn("not a colour for each row", BAKERY.run("svdag", "import", "w.npz", "-o", "w.svdag", code=3))

    def test_several_colours_of_a_voxel_are_their_mean_in_linear_light(self):
        numpy.savez(BAKERY.folder / "m.npz", coordinates=[[1, 2, 3], [7, 7, 7], [1, 2, 3], [1, 2, 3]], resolution=8,
                    colours=numpy.array([[255, 0, 10], [9, 9, 9], [0, 0, 10], [0, 255, 10]], "u1"))
        self.assertEqual(self.imported("m.npz")["colours"].tolist(), [[156, 156, 10], [9, 9, 9]])

    def test_without_colours_exports_are_those_of_before(self):
        BAKERY.run("svdag", "build", "box.ply", "-o", "plain.svdag", "-r", "64", "-q")
        BAKERY.run("svdag", "convert", "fine.svdag", "-o", "bare.svdag", "-q", "--no-colours")
        for ending in ("vox", "ply", "npz"):
            self.export("plain", f"a.{ending}")
            self.export("bare", f"b.{ending}")
            self.assertEqual((BAKERY.folder / f"a.{ending}").read_bytes(), (BAKERY.folder / f"b.{ending}").read_bytes())


if __name__ == "__main__":
    unittest.main(verbosity=0)
