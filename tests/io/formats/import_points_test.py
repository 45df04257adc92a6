#!/usr/bin/env python3
"""`svdag import` of points sets exactly the half-open voxels that hold them, as fractions tell.

Usage: import_points_test.py PROGRAMS [--any-memory]. --any-memory: of programs whose memory is not theirs alone.
"""
import collections
import fractions
import math
import random
import struct
import subprocess
import sys
import unittest

import numpy

import write_points
from baked import Bakery

ANY_MEMORY = "--any-memory" in sys.argv and sys.argv.pop(2)
BAKERY = Bakery(sys.argv.pop(1))
CLASS_NAMES = {0: b"never classified", 2: b"ground", 6: b"building", 8: b"class 8", 12: b"class 12", 18: b"high noise", 19: b"class 19",
               31: b"class 31", 64: b"class 64", 200: b"class 200"}


def exact(points, scale=(1, 1, 1), offset=(0, 0, 0)):
    return [[fractions.Fraction(p[a]) * fractions.Fraction(scale[a]) + fractions.Fraction(offset[a]) for a in range(3)] for p in points]


def cells(points, dag):
    """The voxel of each exact point on the grid of a file."""
    size = fractions.Fraction(dag.voxel_size)
    if dag.kind == 2:
        return [tuple(math.floor(p[a] / size) - dag.k0[a] for a in range(3)) for p in points]
    return [tuple(math.floor((p[a] - fractions.Fraction(dag.corner[a])) / size) for a in range(3)) for p in points]


def voxels_of(dag, layer=None):
    return {tuple(v) for v in dag.voxels(layer).astype("<i8").tolist()}


class ImportPoints(unittest.TestCase):
    def setUp(self):
        self.chance = random.Random(self.id())

    def imported(self, data, name, *options):
        (BAKERY.folder / name).write_bytes(data)
        BAKERY.run("svdag", "import", name, "-o", "imported.svdag", "-q", *options)
        BAKERY.run("svdag-verify", "check", "imported.svdag", "-q")
        dag = BAKERY.dag("imported.svdag")
        self.assertEqual(dag.rule, 4)
        return dag

    def expect(self, data, name, points, *options):
        dag = self.imported(data, name, *options)
        self.assertEqual(voxels_of(dag), set(cells(points, dag)))
        return dag

    def las_points(self, count, reach=20000):
        return [[self.chance.randrange(-reach, reach) for _ in range(3)] for _ in range(count)]

    def test_las_of_every_version_and_format(self):
        for form in range(11):
            for minor in range(5):
                with self.subTest(form=form, minor=minor):
                    points = self.las_points(60)
                    scale = [self.chance.choice([0.01, 0.001, 1e-7, 0.25, -0.01]) for _ in range(3)]
                    offset = [self.chance.choice([0, 500000.0, -3.7, 1e-3]) for _ in range(3)]
                    data = write_points.las(points, scale, offset, minor, form, extra=self.chance.randrange(4))
                    # The largest extent is at most 400 in x 0.25, or 1e-7: a grid of 2^14 voxels holds each.
                    self.expect(data, "a.las", exact(points, scale, offset), "-r", "256")
                    self.expect(data, "a.las", exact(points, scale, offset), "-s", "0.7")

    def test_points_on_planes_are_in_the_upper_voxel(self):
        # Every point is a multiple of 0.05, in decimals, whose double is another number: so is the product with the scale.
        points = [[k, 5 * k, 25 * k] for k in range(-300, 300)]
        for size in ("0.05", "0.1", "0.01", "0.125"):
            for scale, offset in (((0.01,) * 3, (0, 0, 0)), ((0.01,) * 3, (0.1, 431000.05, -7.3)), ((0.05, 0.01, 0.002), (0, 1e6, 1e6))):
                with self.subTest(size=size, scale=scale):
                    self.expect(write_points.las(points, scale, offset), "a.las", exact(points, scale, offset), "-s", size)

    def test_planes_of_a_divided_box(self):
        # With 2^L - 1 voxels from the first point to the last, every point is mid-voxel or on a plane, or next to it.
        for step in (0.5, 0.1, 1 / 3):
            points = [[v * step, ((7 * v) % 127) * step, math.nextafter(v * step, self.chance.choice([-9, 999]))] for v in range(128)]
            points += [[0, 0, 0], [63.5 * step] * 3, [127 * step] * 3]
            self.expect(write_points.xyz(points), "a.xyz", exact(points), "-r", "64")

    def test_text_ply_and_pcd(self):
        wide = [[self.chance.uniform(-5, 5) * 10.0 ** self.chance.randrange(-3, 2) for _ in range(3)] for _ in range(200)]
        single = [[float(numpy.float32(v)) for v in p] for p in wide]
        files = {"a.xyz": (write_points.xyz(wide), wide), "b.xyz": (write_points.xyz(wide, separator=", "), wide)}
        for kind in ("ascii", "binary_little_endian", "binary_big_endian"):
            files[f"{kind}.ply"] = write_points.ply(wide, kind), wide
            files[f"{kind}-single.ply"] = write_points.ply(single, kind, "float"), single
        for kind in ("ascii", "binary"):
            files[f"{kind}.pcd"] = write_points.pcd(wide, kind), wide
            files[f"{kind}-single.pcd"] = write_points.pcd(single, kind, 4), single
        for name, (data, points) in files.items():
            with self.subTest(name=name):
                self.expect(data, name, exact(points), "-s", "0.3")
                self.expect(data, name, exact(points), "-r", "1K")

    def test_colours_of_every_format(self):
        points = [[float(v) for v in (i % 7, i // 7, i % 3)] for i in range(49)]
        colours = [[self.chance.randrange(256) for _ in range(3)] for _ in points]
        wide = [[c * 256 + self.chance.randrange(256) for c in rgb] for rgb in colours]
        wide[0][0] = 65535
        rows = [[int(v) for v in p] for p in points]
        files = {"c.xyz": write_points.xyz(points, colours), "c.pcd": write_points.pcd(points, "binary", 4, colours),
                 "ca.pcd": write_points.pcd(points, "ascii", 8, colours), "c.ply": write_points.ply(points, "ascii", "float", colours),
                 "cb.ply": write_points.ply(points, "binary_little_endian", "double", colours),
                 "low.las": write_points.las(rows, (1,) * 3, (0,) * 3, form=2, colours=colours)}
        for form in (2, 3, 5, 7, 8, 10):
            files[f"{form}.las"] = write_points.las(rows, (1,) * 3, (0,) * 3, 4, form, wide)
        for name, data in files.items():
            with self.subTest(name=name):
                dag = self.imported(data, name, "-s", "1")
                expected = [[255, *c[1:]] if i == 0 and name[0].isdigit() else c for i, c in enumerate(colours)]
                BAKERY.run("svdag", "export", "imported.svdag", "-o", "x.npz", "-q")
                with numpy.load(BAKERY.folder / "x.npz") as npz:
                    found = {tuple(v): c for v, c in zip(npz["coordinates"].tolist(), npz["colours"].tolist())}
                self.assertEqual(found, dict(zip(cells(exact(points), dag), expected)))
                self.assertLess(self.imported(data, name, "-s", "1", "--no-colours").version, 3)

    def test_classes_become_layers(self):
        for form, numbers in ((1, (0, 2, 6, 8, 12, 18, 19, 31)), (6, (0, 2, 6, 18, 64, 200))):
            points = self.las_points(400, 30)
            classes = [self.chance.choice(numbers) for _ in points]
            data = write_points.las(points, (0.1,) * 3, (0,) * 3, 4 if form == 6 else 2, form, classes=classes)
            dag = self.expect(data, "a.las", exact(points, (0.1,) * 3), "-s", "1", "--layers", "class")
            sets = collections.defaultdict(set)
            for cell, number in zip(cells(exact(points, (0.1,) * 3), dag), classes):
                sets[CLASS_NAMES[number]].add(cell)
            self.assertEqual({layer.name: voxels_of(dag, i) for i, layer in enumerate(dag.layers)}, sets)

    def test_min_points_counts_all_layers_together(self):
        points = self.las_points(3000, 50)
        classes = [self.chance.choice((2, 6)) for _ in points]
        data = write_points.las(points, (0.1,) * 3, (0,) * 3, 2, 2, [[9, 9, 999]] * len(points), classes)
        for least in (1, 2, 4):
            for options in ((), ("--no-colours",), ("--layers", "class"), ("--no-colours", "--layers", "class")):
                dag = self.imported(data, "a.las", "-s", "1", "--min-points", least, *options)
                counts = collections.Counter(cells(exact(points, (0.1,) * 3), dag))
                self.assertEqual(voxels_of(dag), {cell for cell, count in counts.items() if count >= least})

    def test_tiles_of_one_size_agree(self):
        points = self.las_points(2000)
        whole = self.expect(write_points.las(points, (0.01,) * 3, (5, 0, 0)), "a.las", exact(points, (0.01,) * 3, (5, 0, 0)), "-s", "0.3")
        together = set()
        for k in range(2):
            part = points[k::2]
            dag = self.imported(write_points.las([[x - 700, y, z] for x, y, z in part], (0.01,) * 3, (12, 0, 0)), "t.las", "-s", "0.3")
            together |= {tuple(numpy.add(v, dag.k0).tolist()) for v in voxels_of(dag)}
        shifted = exact([[x - 700, y, z] for x, y, z in points], (0.01,) * 3, (12, 0, 0))
        self.assertEqual(together, {tuple(math.floor(v / fractions.Fraction(0.3)) for v in p) for p in shifted})
        self.assertEqual(whole.kind, 2)

    def test_several_files_share_a_grid(self):
        parts, points = [], []
        for i, name in enumerate(("a.las", "b.xyz", "c.ply", "none.las")):
            rows = self.las_points(0 if i == 3 else 300, 1000)
            scale, offset = ((0.01,) * 3, (7.1 * i, 0, -i)) if name.endswith("las") else ((1,) * 3, (0,) * 3)
            if not name.endswith("las"):
                rows = [[v / 90 + i for v in row] for row in rows]
            write = {"las": lambda r: write_points.las(r, scale, offset), "xyz": write_points.xyz, "ply": write_points.ply}[name[-3:]]
            (BAKERY.folder / name).write_bytes(write(rows))
            parts.append((name, exact(rows, scale, offset)))
            points += parts[-1][1]
        for grid in (("-s", "0.7"), ("-r", "64")):
            BAKERY.run("svdag", "import", *[name for name, _ in parts], "-o", "imported.svdag", "-q", "--layers", "file", *grid)
            dag = BAKERY.dag("imported.svdag")
            self.assertEqual(voxels_of(dag), set(cells(points, dag)))
            self.assertEqual({layer.name.decode(): voxels_of(dag, i) for i, layer in enumerate(dag.layers)},
                             {name: set(cells(part, dag)) for name, part in parts})

    def test_missing_and_withheld_points_are_left_out(self):
        points = [[0.0, 0, 0], [math.nan, 1, 1], [5, 5, 5], [1, math.nan, 0]]
        dag = self.imported(write_points.pcd(points, "binary", 4), "a.pcd", "-s", "1")
        self.assertEqual(voxels_of(dag), set(cells(exact([points[0], points[2]]), dag)))
        for form in (1, 6):
            rows = [[0, 0, 0], [7, 7, 7], [3, 3, 3]]
            dag = self.imported(write_points.las(rows, (1,) * 3, (0,) * 3, 4, form, withheld={1}), "a.las", "-s", "1")
            self.assertEqual(voxels_of(dag), set(cells(exact([rows[0], rows[2]]), dag)))

    def test_threads_and_memory_do_not_change_a_byte(self):
        points = numpy.random.default_rng(1).integers(0, 1 << 20, (300000, 3)).tolist()
        (BAKERY.folder / "a.las").write_bytes(write_points.las(points, (0.01,) * 3, (0,) * 3))
        files = set()
        for options in (("-j", 1), ("-j", 2), ("-j", 1, "-m", "24M")):
            BAKERY.run("svdag", "import", "a.las", "-o", "imported.svdag", "-q", "-r", "4K", *options)
            files.add((BAKERY.folder / "imported.svdag").read_bytes())
        self.assertEqual(len(files), 1)

    @unittest.skipIf(ANY_MEMORY, "the programs are sanitized")
    def test_ten_million_points_stay_within_the_memory(self):
        count = 10_000_000
        points = numpy.random.default_rng(2).integers(0, 1 << 24, (count, 5), dtype="<i4")
        points[:, 2] >>= 8  # a thin layer
        with open(BAKERY.folder / "large.las", "wb") as file:
            header = write_points.las([[0, 0, 0]], (0.001,) * 3, (0,) * 3)[:-20]
            file.write(header[:107] + struct.pack("<I", count) + header[111:])
            points[:, 3] = 0
            points.tofile(file)
        del points
        # Measured from a small process: the peak of a child counts the memory that it had before it became the program.
        code = ("import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True); "
                "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)")
        out = subprocess.run([sys.executable, "-c", code, BAKERY.programs / "svdag-import", "large.las", "-o", "large.svdag", "-q",
                              "-r", "2K", "-m", "64M"], cwd=BAKERY.folder, check=True, capture_output=True, text=True).stdout
        self.assertLess(int(out) * 1024, (64 + 32) << 20)

    def test_hostile_files_are_one_sentence(self):
        las = write_points.las([[1, 2, 3], [4, 5, 6]], (0.01,) * 3, (0,) * 3, 4, 7)
        text = write_points.pcd([[1, 2, 3.5]], "ascii")
        binary = write_points.pcd([[1, 2, 3.5]], "binary")
        vertices = write_points.ply([[1, 2, 3]], "binary_little_endian")

        def patched(data, at, form, *values):
            data = bytearray(data)
            struct.pack_into(form, data, at, *values)
            return bytes(data)
        cases = {
            "cut.las": las[:300], "short.las": las[:-1], "header.las": las[:100],
            "version.las": patched(las, 25, "B", 5), "laz.las": patched(las, 104, "B", 128 + 7),
            "format.las": patched(las, 104, "B", 11), "record.las": patched(las, 105, "<H", 35),
            "begin.las": patched(las, 96, "<I", 1 << 31), "early.las": patched(las, 96, "<I", 5),
            "count.las": patched(las, 247, "<Q", 1 << 63), "none.las": patched(las, 247, "<Q", 0),
            "scale.las": patched(las, 131, "<d", 0), "nan.las": patched(las, 139, "<d", math.nan),
            "infinite.las": patched(las, 155, "<d", math.inf),
            "count.pcd": text.replace(b"POINTS 1", b"POINTS 99999999999"), "size.pcd": text.replace(b"SIZE 8", b"SIZE 3"),
            "fields.pcd": text.replace(b"COUNT 1 1 1", b"COUNT 1 1"), "wide.pcd": text.replace(b"COUNT 1", b"COUNT 60000"),
            "x.pcd": text.replace(b"FIELDS x", b"FIELDS w"), "end.pcd": text[:40], "cut.pcd": binary[:-1],
            "compressed.pcd": text.replace(b"DATA ascii", b"DATA binary_compressed"), "word.pcd": text.replace(b"2.0", b"two"),
            "cut.ply": vertices[:-1], "count.ply": vertices.replace(b"vertex 1", b"vertex 4000000000"),
            "y.ply": vertices.replace(b"double y", b"double w"),
            "two.xyz": b"1 2\n", "word.xyz": b"1 2 3\n1 b 3\n", "far.xyz": b"1 2 1e300\n1 1 1\n", "infinite.xyz": b"1 2 inf\n",
            "empty.xyz": b"# nothing\n", "colour.xyz": b"1 2 3 4 5 6\n1 2 3 4 5 256\n", "e.e57": b"ASTM-E57" + bytes(60),
        }
        for name, data in cases.items():
            with self.subTest(name=name):
                (BAKERY.folder / name).write_bytes(data)
                text = BAKERY.run("svdag", "import", name, "-o", "never.svdag", "-s", "1", code=3)
                self.assertRegex(text, rf"^svdag: {name}: .+\n$")
                self.assertFalse((BAKERY.folder / "never.svdag").exists())

    def test_a_file_that_ends_early_is_one_sentence_or_fewer_points(self):
        files = {"a.las": write_points.las([[1, 2, 3], [4, 5, 6]], (0.01,) * 3, (0,) * 3, 4, 7),
                 "t.pcd": write_points.pcd([[1, 2, 3.5], [4, 5, 6]], "ascii"), "b.pcd": write_points.pcd([[1, 2, 3.5]], "binary"),
                 "a.ply": write_points.ply([[1, 2, 3], [4, 5, 6]], "binary_little_endian"), "a.xyz": b"1 2 3 255 0 9\n4 5 6 1 2 3\n"}
        for name, data in files.items():
            for size in range(0, len(data), 5):
                (BAKERY.folder / name).write_bytes(data[:size])
                done = subprocess.run([BAKERY.programs / "svdag-import", name, "-o", "cut.svdag", "-q", "-s", "1"],
                                      cwd=BAKERY.folder, capture_output=True, text=True)
                with self.subTest(name=name, size=size):
                    self.assertIn(done.returncode, (0, 3))
                    self.assertRegex(done.stderr, r"^$" if done.returncode == 0 else r"^svdag: .+\n$")


if __name__ == "__main__":
    unittest.main()
