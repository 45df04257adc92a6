#!/usr/bin/env python3
"""Exports hold the layer of each voxel: the first, in the order of the table, that has it.

Usage: export_layers_test.py PROGRAMS [DUMP_LABELS]. What is expected is made of exports of single layers, which have
no labels. DUMP_LABELS prints a grid that OpenVDB reads.
"""
import functools
import json
import pathlib
import subprocess
import sys
import unittest

import numpy

from baked import Bakery, askew, write_ply
from read_foreign import read_hashdag_colours

DUMP_LABELS = pathlib.Path(sys.argv.pop(2)).resolve() if len(sys.argv) > 2 else None
BAKERY = Bakery(sys.argv.pop(1))
NO_LAYER = -1
NO_LAYER_COLOUR = [0xbc, 0xb5, 0xaa]


def box(low, high):
    """The triangles of each face of a box, outward."""
    corner = [[(high if c >> a & 1 else low)[a] for a in range(3)] for c in range(8)]
    faces = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    return [[[corner[i] for i in (a, b, c)], [corner[i] for i in (a, c, d)]] for a, b, c, d in faces]


def keys(voxels):
    """One number for each voxel."""
    x, y, z = numpy.asarray(voxels).astype("<i8").reshape(-1, 3).T
    return (x << 40) + (y << 20) + z


class ExportLayers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scene = askew()
        cls.bake("surfaces", {"b": scene[:5], "a": scene[4:9], "": scene[9:]}, "-r", "128")
        # Solids that overlap in a part, and touch.
        solids = {"one": box([0, 0, 0], [40, 30, 20]), "two": box([20, 10, 5], [60, 50, 40]),
                  "three": box([40, 0, 0], [50, 10, 8])}
        cls.bake("solids", {name: sum(faces, []) for name, faces in solids.items()}, "-r", "128", "--rule", "solid")
        # Surfaces that enclose a solid together: its inside is in no layer.
        cls.bake("faces", dict(zip("abcdef", box([0, 0, 0], [50, 40, 30]))), "-r", "64", "--rule", "solid")
        # All voxels of a grid are set.
        whole = box([-9, -9, -9], [9, 9, 9])
        cls.bake("whole", {"cube": sum(whole, [])}, "-r", "32", "--rule", "solid", "--cube=-4,-4,-4,8")
        cls.scenes = {"surfaces": 7, "solids": 7, "faces": 6, "whole": 5}  # and their levels

    @classmethod
    def bake(cls, name, layers, *options):
        folder = BAKERY.folder / name
        folder.mkdir()
        for layer, triangles in layers.items():
            write_ply(folder / f"{layer}.ply", triangles)
        BAKERY.run("svdag", "build", *sorted(folder.iterdir()), "-o", f"{name}.svdag", "-q", "--layers", "file", *options)

    def npz(self, name, *options):
        BAKERY.run("svdag", "export", f"{name}.svdag", "-o", "x.npz", "-q", *options)
        return numpy.load(BAKERY.folder / "x.npz")

    def table(self, name):
        return json.loads(BAKERY.run("svdag", "info", f"{name}.svdag", "--layers", "--json"))["layer_table"]

    def colours(self, name, labels):
        table = [[int(layer["colour"][i:i + 2], 16) for i in (1, 3, 5)] for layer in self.table(name)]
        return numpy.array(table + [NO_LAYER_COLOUR])[labels]

    @functools.lru_cache(maxsize=None)
    def expected(self, name, *options):
        """The voxels of an export, and the label of each."""
        voxels = self.npz(name, *options)["coordinates"]
        labels = numpy.full(len(voxels), NO_LAYER)
        for number, layer in reversed(list(enumerate(self.table(name)))):
            there = self.npz(name, "--layer", layer["name"], *options)["coordinates"]
            labels[numpy.isin(keys(voxels), keys(there))] = number
        return voxels, labels

    def test_scenes_have_voxels_of_several_layers_and_of_none(self):
        self.assertEqual(set(self.expected("surfaces")[1]), {0, 1, 2})
        self.assertEqual(set(self.expected("solids")[1]), {0, 1, 2})
        self.assertEqual(set(self.expected("faces")[1]), {NO_LAYER, 0, 1, 2, 3, 4, 5})
        self.assertEqual(len(self.expected("whole")[0]), 32**3)

    def test_npz_and_ply_hold_the_first_layer(self):
        for name in self.scenes:
            voxels, labels = self.expected(name)
            self.assertTrue(numpy.array_equal(self.npz(name)["label"], labels.astype("<u2")), name)
            BAKERY.run("svdag", "export", f"{name}.svdag", "-o", "x.ply", "-q")
            points = (BAKERY.folder / "x.ply").read_bytes().split(b"end_header\n")[1]
            found = numpy.frombuffer(points, [("xyz", "<f8", 3), ("rgb", "u1", 3)])["rgb"]
            self.assertTrue(numpy.array_equal(found, self.colours(name, labels)), name)

    def test_a_hashdag_holds_the_colour_of_each_voxel(self):
        for name, levels in (("surfaces", 7), ("surfaces", 5), ("solids", 7), ("faces", 6), ("whole", 5), ("whole", 3)):
            with self.subTest(name, level=levels):
                out = "x.basic_dag.dag.bin"
                BAKERY.run("svdag", "export", f"{name}.svdag", "--format", "hashdag", "-o", out, "--level", levels,
                           "--colours", "-q")
                found, colours = read_hashdag_colours(BAKERY.folder / out)
                voxels, labels = self.expected(name, "--level", levels)
                order, expected_order = numpy.argsort(keys(found)), numpy.argsort(keys(voxels))
                self.assertTrue(numpy.array_equal(found[order], voxels[expected_order]))
                self.assertTrue(numpy.array_equal(colours[order], self.colours(name, labels)[expected_order]))
                # Readers of the DAG alone ignore the numbers in it.
                BAKERY.run("svdag", "import", out, "-o", "back.svdag", "-q")
                back = numpy.load(BAKERY.folder / self.exported("back", "back.npz"))["coordinates"]
                self.assertTrue(numpy.array_equal(numpy.sort(keys(back)), numpy.sort(keys(voxels))))

    def exported(self, name, output):
        BAKERY.run("svdag", "export", f"{name}.svdag", "-o", output, "-q")
        return output

    def test_many_levels_have_a_list_of_counts(self):
        """Nodes 8 levels and more above the voxels."""
        scene = askew()
        self.bake("high", {"a": scene[:5], "b": scene[5:]}, "-r", "1K")
        BAKERY.run("svdag", "export", "high.svdag", "--format", "hashdag", "-o", "high", "--colours", "-q")
        found, colours = read_hashdag_colours(BAKERY.folder / "high1k.basic_dag.dag.bin")
        voxels, labels = self.expected("high")
        order, expected_order = numpy.argsort(keys(found)), numpy.argsort(keys(voxels))
        self.assertTrue(numpy.array_equal(found[order], voxels[expected_order]))
        self.assertTrue(numpy.array_equal(colours[order], self.colours("high", labels)[expected_order]))

    @unittest.skipIf(DUMP_LABELS is None, "without OpenVDB")
    def test_a_vdb_holds_the_number_of_the_layer(self):
        boxes = ["--bounds=-0.61,2.3,0.5,2.2,4.1,1.9"], ["--level", "5"], ["--level", "4"], ["--vdb-type", "mask"], []
        for name in self.scenes:
            about = json.loads(BAKERY.run("svdag", "info", f"{name}.svdag", "--json"))["grid"]
            for options in boxes if name == "surfaces" else boxes[1:]:
                with self.subTest(name, options=options):
                    self.expect_vdb(name, about, options)

    def expect_vdb(self, name, about, options):
        BAKERY.run("svdag", "export", f"{name}.svdag", "-o", "x.vdb", "-q", *options)
        lines = subprocess.run([DUMP_LABELS, BAKERY.folder / "x.vdb"], capture_output=True, text=True,
                               check=True).stdout.splitlines()
        metadata = dict(line.split("=", 1) for line in lines if "=" in line)
        layers = self.table(name)
        self.assertEqual(metadata["layer_count"], str(len(layers)))
        for i, layer in enumerate(layers):
            self.assertEqual(metadata[f"layer_{i}_name"], layer["name"])
            self.assertEqual(metadata[f"layer_{i}_colour"], layer["colour"])
        self.assertEqual({line for line in lines if line.startswith("grid ")}, {"grid occupancy", "grid layer"})
        shift = 0 if options[:1] != ["--level"] else self.scenes[name] - int(options[1])
        [placed] = [line for line in lines if line.startswith("origin ")]
        *origin, size = map(float, placed.replace(",", "").replace("origin", "").replace("size", "").split())
        self.assertAlmostEqual(size / about["voxel_size"], 2**shift, delta=1e-12)
        for a in range(3):
            self.assertAlmostEqual(origin[a], about["corner"][a] + size / 2, delta=1e-9)

        at = lines.index("background -1")
        rows = numpy.array([line.split() for line in lines if line[0].isdigit()], "<i8").reshape(-1, 5)
        pieces = []
        for side in numpy.unique(rows[:, 3]):
            inside = numpy.stack(numpy.meshgrid(*[numpy.arange(side)] * 3, indexing="ij"), -1).reshape(-1, 3)
            of_side = rows[rows[:, 3] == side]
            voxels = (of_side[:, None, :3] + inside).reshape(-1, 3)
            pieces.append(numpy.column_stack([keys(voxels), numpy.repeat(of_side[:, 4], len(inside))]))
        found = numpy.concatenate(pieces)
        found = found[numpy.argsort(found[:, 0])]
        voxels, labels = self.expected(name, *[o for o in options if not o.startswith(("--vdb", "mask"))])
        order = numpy.argsort(keys(voxels))
        self.assertTrue(numpy.array_equal(found[:, 0], keys(voxels)[order]))
        self.assertTrue(numpy.array_equal(found[:, 1], labels[order]))

        # Only blocks without one label are leaves.
        block, where = numpy.unique(keys(voxels // 8), return_inverse=True)
        same = numpy.bincount(where) == 512
        same &= numpy.array([len(set(labels[where == b])) == 1 if same[b] else False for b in range(len(block))])
        self.assertEqual(lines[at + 1], f"leaves {numpy.sum(~same)}")
        if name == "solids" and not options:
            self.assertGreater(numpy.sum(same), 100)

        # An import takes the other grid, unasked.
        BAKERY.run("svdag", "import", "x.vdb", "-o", "back.svdag", "-q")
        back = numpy.load(BAKERY.folder / self.exported("back", "back.npz"))["coordinates"]
        self.assertEqual(len(back), len(voxels))


if __name__ == "__main__":
    unittest.main(verbosity=0)
