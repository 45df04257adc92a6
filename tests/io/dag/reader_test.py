#!/usr/bin/env python3
"""Tests that the C++ reader and the Python reader, written from docs/format.md, find the same voxels."""
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

import read_svdag

PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()


def run(program, *arguments):
    done = subprocess.run([PROGRAMS / program, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{program} {arguments}: {done.stderr}")
    return done.stdout


class Reader(unittest.TestCase):
    def bake(self, kind, count, *grid):
        folder = tempfile.TemporaryDirectory(prefix="svdag-reader-")
        self.addCleanup(folder.cleanup)
        scene, dag = pathlib.Path(folder.name, "scene.ply"), pathlib.Path(folder.name, "scene.svdag")
        run("svdag-scene", kind, "-n", count, "-q", "-o", scene)
        run("svdag", "build", scene, "-o", dag, "-q", *grid)
        return dag

    def expect_same_voxels(self, dag):
        voxels = read_svdag.Svdag(dag.read_bytes()).voxels()
        listed = [[int(n) for n in line.split()] for line in run("tests/dump_voxels", dag).splitlines()]
        self.assertEqual(voxels.tolist(), sorted(listed))
        return len(voxels)

    def test_both_readers_see_the_same_voxels(self):
        for kind, count, grid in [("rectangle", 2, ["-r", "8"]), ("scan", 1000, ["-r", "64"]),
                                  ("city", 1200, ["-r", "128"]), ("hairball", 5000, ["-r", "128"]),
                                  ("terrain", 2000, ["--voxel-size", "1.5"])]:
            with self.subTest(kind=kind):
                self.assertGreater(self.expect_same_voxels(self.bake(kind, count, *grid)), 20)

    def test_both_readers_see_the_same_voxels_and_plain_files_in_the_compact_layout(self):
        for kind, count, grid in [("rectangle", 2, ["-r", "8"]), ("rectangle", 2, ["-r", "32"]), ("city", 1200, ["-r", "128"]),
                                  ("hairball", 5000, ["-r", "128"]), ("terrain", 2000, ["--voxel-size", "1.5"])]:
            with self.subTest(kind=kind):
                plain = self.bake(kind, count, *grid)
                compact = self.bake(kind, count, *grid, "--layout", "compact")
                self.assertGreater(self.expect_same_voxels(compact), 20)
                self.assertEqual(read_svdag.Svdag(compact.read_bytes()).plain_form(), plain.read_bytes())
        empty = self.bake("city", 1200, "-r", "64", "--bounds=500,500,500,501,501,501", "--layout", "compact")
        self.assertEqual(self.expect_same_voxels(empty), 0)

    def test_layers_are_those_of_separate_bakes(self):
        cube = ["-r", "128", "--cube=-64,-64,-64,128"]
        folder = self.bake("rectangle", 2, "-r", "8").parent
        for kind, count in [("scan", 1000), ("city", 1200)]:
            run("svdag-scene", kind, "-n", count, "-q", "-o", folder / f"{kind}.ply")
        scenes = [folder / "scan.ply", folder / "city.ply"]
        for layout in ("plain", "compact"):
            for union in ([], ["--no-union"]):
                dag = folder / "layers.svdag"
                run("svdag", "build", *scenes, "-o", dag, *cube, "--layers", "file", "--layout", layout, *union)
                file = read_svdag.Svdag(dag.read_bytes())
                self.assertEqual([layer[0] for layer in file.layers], [b"city.ply", b"scan.ply"])
                for number, scene in [(0, scenes[1]), (1, scenes[0])] + ([] if union else [(None, scenes)]):
                    alone = folder / "alone.svdag"
                    run("svdag", "build", *(scene if number is None else [scene]), "-o", alone, *cube)
                    expected = read_svdag.Svdag(alone.read_bytes()).voxels()
                    self.assertEqual(file.voxels(number).tolist(), expected.tolist())
                if layout == "compact":
                    run("svdag", "convert", dag, "-o", folder / "plain.svdag", "--layout", "plain")
                    self.assertEqual(file.plain_form(), (folder / "plain.svdag").read_bytes())

    def test_bounds_and_empty_bounds(self):
        dag = self.bake("city", 1200, "-r", "64", "--bounds=0,-10,0,20,10,20")
        self.assertGreater(self.expect_same_voxels(dag), 20)
        dag = self.bake("city", 1200, "-r", "64", "--bounds=500,500,500,501,501,501")
        self.assertEqual(self.expect_same_voxels(dag), 0)

    def test_both_readers_detect_flipped_bits(self):
        chance = random.Random(1)
        for layout in ("plain", "compact"):
            dag = self.bake("rectangle", 2, "-r", "32", "--layout", layout)
            good = dag.read_bytes()
            for _ in range(60):
                damaged = bytearray(good)
                damaged[chance.randrange(len(good))] ^= 1 << chance.randrange(8)
                with self.assertRaises(read_svdag.InvalidFile):
                    read_svdag.Svdag(bytes(damaged))
                dag.write_bytes(damaged)
                with self.assertRaises(AssertionError):
                    run("tests/dump_voxels", dag)

    def test_truncated_and_longer_files_are_detected(self):
        good = self.bake("rectangle", 2, "-r", "8").read_bytes()
        for bad in [b"", good[:1000], good[:1024], good[:-1], good + b"\0", good[1:]]:
            with self.assertRaises(read_svdag.InvalidFile):
                read_svdag.Svdag(bad)


if __name__ == "__main__":
    unittest.main()
