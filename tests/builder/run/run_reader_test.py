#!/usr/bin/env python3
"""Tests with the independent Python reader that the runs of all parts hold the voxels of the whole bake."""
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

import read_run

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "io/dag"))
import read_svdag  # noqa: E402

PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()


def run(program, *arguments):
    return subprocess.run([PROGRAMS / program, *map(str, arguments)], capture_output=True, text=True)


def morton(voxel, levels):
    return sum((int(v) >> bit & 1) << 3 * bit + 2 - axis for axis, v in enumerate(voxel) for bit in range(levels))


class Reader(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="svdag-runs-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def bake(self, name, kind, count, *options):
        scene = self.folder / "scene.ply"
        self.assertEqual(run("svdag-scene", kind, "-n", count, "-q", "-o", scene).returncode, 0)
        done = run("svdag", "build", scene, "-o", self.folder / name, "-q", *options)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return (self.folder / name).read_bytes()

    def test_parts_hold_the_voxels_of_the_whole(self):
        for kind, count, grid in [("scan", 1000, ["-r", "64"]), ("city", 1200, ["-r", "128", "--rule", "thin"]),
                                  ("terrain", 2000, ["--voxel-size", "1.5"]), ("hairball", 5000, ["-r", "128"])]:
            dag = read_svdag.Svdag(self.bake("whole.svdag", kind, count, *grid))
            expected = sorted(morton(voxel, dag.L) for voxel in dag.voxels())
            self.assertGreater(len(expected), 20)
            found = []
            for i in range(1, 6):
                part = read_run.Run(self.bake("part.run", kind, count, *grid, "--part", f"{i}/5"))
                self.assertEqual(part.L, dag.L)
                codes = part.codes()
                self.assertTrue(all(any(b <= code < e for b, e in part.ranges) for code in codes))
                found += codes
            self.assertEqual(found, expected, kind)
            self.assertEqual(read_run.Run(self.bake("whole.run", kind, count, *grid)).codes(), expected, kind)

    def test_both_readers_detect_a_flipped_bit(self):
        good = self.bake("a.run", "rectangle", 2, "-r", "32")
        rng = random.Random(1)
        for _ in range(60):
            damaged = bytearray(good)
            damaged[rng.randrange(len(good))] ^= 1 << rng.randrange(8)
            with self.assertRaises(read_run.DamagedRun):
                read_run.Run(bytes(damaged))
            (self.folder / "a.run").write_bytes(damaged)
            self.assertEqual(run("svdag", "info", self.folder / "a.run").returncode, 3)


if __name__ == "__main__":
    unittest.main()
