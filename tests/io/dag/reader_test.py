#!/usr/bin/env python3
"""Tests that the C++ reader and the Python reader, written from docs/format.md, find the same voxels."""
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import unittest

import read_svdag
import xxhash

PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()


def run(program, *arguments, text=""):
    done = subprocess.run([PROGRAMS / program, *map(str, arguments)], input=text, capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{program} {arguments}: {done.stderr}")
    return done.stdout


def repaired(data):
    """A plain file of one block with the hashes that its bytes need."""
    data = bytearray(data)
    table_at, = struct.unpack_from("<Q", data, 152)
    struct.pack_into("<Q", data, table_at, xxhash.xxh3_64_intdigest(bytes(data[1024:table_at])))
    own_hash = data[8] == 3  # with colours
    header = bytes(data[:632]) + bytes(16) + bytes(data[648:1016]) + bytes(8)
    digest = xxhash.xxh3_128_intdigest(bytes(data[table_at:]) if own_hash else header + data[table_at:])
    struct.pack_into("<2Q", data, 776 if own_hash else 632, digest & (2**64 - 1), digest >> 64)
    struct.pack_into("<Q", data, 1016, xxhash.xxh3_64_intdigest(bytes(data[:1016])))
    return bytes(data)


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

    def expect_layers_of_separate_bakes(self, kind, scenes, names, *grid):
        """The union and each layer have the voxels of separate bakes, in each layout, with and without union."""
        def bake(*options):
            dag = scenes[0].with_name("baked.svdag")
            run("svdag", "build", *scenes, "-o", dag, "-q", *grid, *options)
            return read_svdag.Svdag(dag.read_bytes())

        alone = {name: bake("--include", f"{kind}:{name}").voxels().tolist() for name in names}
        for union in ([], ["--no-union"]):
            plain, compact = (bake("--layers", kind, "--layout", layout, *union) for layout in ("plain", "compact"))
            self.assertEqual(compact.plain_form(), plain.data)
            for file in (plain, compact):
                self.assertEqual([layer.name.decode() for layer in file.layers], names)
                for number, layer in enumerate(file.layers):
                    self.assertEqual(file.voxels(number).tolist(), alone[names[number]], layer.name)
                first = next(alone[name] for name in names if alone[name]) if union else bake().voxels().tolist()
                self.assertEqual(file.voxels().tolist(), first)

    def test_layers_are_those_of_separate_bakes(self):
        folder = self.bake("rectangle", 2, "-r", "8").parent
        for kind, count in [("scan", 1000), ("city", 1200)]:
            run("svdag-scene", kind, "-n", count, "-q", "-o", folder / f"{kind}.ply")
        scenes = [folder / "scan.ply", folder / "city.ply"]
        for rule in ("conservative", "thin"):
            self.expect_layers_of_separate_bakes("file", scenes, ["city.ply", "scan.ply"], "-r", "128",
                                                 "--cube=-64,-64,-64,128", "--rule", rule)
        atrium = folder / "atrium.obj"
        run("svdag-scene", "atrium", "-n", "90K", "-q", "-o", atrium)
        names = ["blue cloth", "floor", "leaves", "plaster", "red cloth", "roof", "stone", "tile", "vase"]
        for kind in ("object", "material"):
            # The cube has five of these; the first is not one of them.
            self.expect_layers_of_separate_bakes(kind, [atrium], names, "-r", "64", "--cube=-13,-1,-6,4")

    def test_both_readers_reject_impossible_layer_tables(self):
        folder = self.bake("rectangle", 2, "-r", "8").parent
        for name, corners in [("a", "000 700 070"), ("b", "000 070 007"), ("c", "900 970 907")]:  # c is outside of the cube
            (folder / f"{name}.obj").write_text("".join(f"v {' '.join(corner)}\n" for corner in corners.split()) + "f 1 2 3\n")
        voxels, root, size, reserved = 0, 8, 12, 19  # in an entry
        names = 3 * 24
        edits = {  # (offset in the layer table, value) of each byte
            "names in another order": [(names, ord("z"))], "equal names": [(names, ord("b"))],
            "a name beyond the table": [(48 + size, 6)], "bytes after the names": [(48 + size, 4)],
            "reserved": [(reserved, 1)], "a root that does not exist": [(24 + root, 9)],
            "a root without voxels": [(48 + root, 0)], "voxels without a root": [(48 + voxels, 1)],
        }
        header_edits = {"fewer layers": (808, 2), "more layers": (808, 4), "no kind": (812, 0), "an unknown kind": (812, 5),
                        "an unknown union": (816, 2), "padding": (820, 1), "reserved": (824, 1), "version": (8, 1)}
        for union in ([], ["--no-union"]):
            dag = folder / "layers.svdag"
            run("svdag", "build", *(folder / f"{name}.obj" for name in "abc"), "-o", dag, "-r", "8", "--cube=0,0,0,8",
                "--layers", "file", *union)
            good = dag.read_bytes()
            self.assertEqual(repaired(good), good)
            file = read_svdag.Svdag(good)
            self.assertEqual([layer.voxels > 0 for layer in file.layers], [True, True, False])
            table = file.layers_at
            cases = {what: [(table + at, value) for at, value in pairs] for what, pairs in edits.items()}
            cases.update((f"header: {what}", [pair]) for what, pair in header_edits.items())
            roots = [good[table + 24 * i + root] for i in (0, 1)]
            cases["a root that no layer has"] = [(table + 24 + root, roots[0])]
            if union:
                cases["another first root"] = [(table + root, roots[1]), (table + 24 + root, roots[0])]
            recoloured = bytearray(good)
            recoloured[table + 16] ^= 1
            dag.write_bytes(repaired(recoloured))
            self.assertGreater(self.expect_same_voxels(dag), 20)
            for what, pairs in cases.items():
                with self.subTest(what, union=not union):
                    damaged = bytearray(good)
                    for at, value in pairs:
                        damaged[at] = value
                    damaged = repaired(damaged)
                    with self.assertRaises(read_svdag.InvalidFile):
                        read_svdag.Svdag(damaged)
                    dag.write_bytes(damaged)
                    with self.assertRaises(AssertionError):
                        run("tests/dump_voxels", dag)

    def shown(self, dag, levels):
        """What the C++ look-up shows of all cubes, by level; cubes without a level of their own as their parents."""
        colours = [line.split() for line in run("tests/paint_dag", dag).splitlines()]
        return {(int(level), int(x), int(y), int(z)): colour for level, x, y, z, colour in colours if int(level) in levels}

    def test_both_readers_see_the_same_colours(self):
        for kind, count, grid in [("rectangle", 2, ["-r", "8"]), ("city", 1200, ["-r", "64"]), ("hairball", 5000, ["-r", "64"])]:
            for layout in ("plain", "compact"):
                dag = self.bake(kind, count, *grid, "--layout", layout)
                bare = dag.read_bytes()
                finest = read_svdag.Svdag(bare).L
                for level, error in [(finest, 9), (finest - 1, 0), (finest - 2, 12.75), (1, 0)]:
                    with self.subTest(kind=kind, layout=layout, level=level):
                        painted = dag.with_name("painted.svdag")
                        run("tests/paint_dag", dag, painted, level, error)
                        file = read_svdag.Svdag(painted.read_bytes())
                        self.assertEqual(file.without_colours(), bare)
                        self.assertEqual(file.colours, self.shown(painted, range(level, -1, -2)))
                        self.assertGreater(len(file.colours), 0)
                        self.expect_colours_of_query(painted, file)

    def expect_colours_of_query(self, painted, file):
        """`svdag query` prints the colour of each voxel's cube of level K."""
        voxels = file.voxels().tolist()[::7]
        middles = [[c + (v + 0.5) * file.voxel_size for c, v in zip(file.corner, voxel)] for voxel in voxels]
        lines = run("svdag", "query", painted, text="".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in middles)).splitlines()
        expected = [file.colours.get((file.K, *(v >> file.L - file.K for v in voxel))) for voxel in voxels]
        self.assertEqual([line.split()[-1] for line in lines], [f"#{colour}" if colour else "none" for colour in expected])

    def test_both_readers_reject_damaged_colours(self):
        dag = self.bake("city", 1200, "-r", "32")
        painted = dag.with_name("painted.svdag")
        run("tests/paint_dag", dag, painted, 5, 9)
        good = painted.read_bytes()
        self.assertEqual(repaired(good), good)
        file = read_svdag.Svdag(good)
        cases = {"level 0": (864, 0), "level 6": (864, 6), "another level": (864, 4), "error": (870, 255), "version": (8, 2),
                 "fewer colours": (856, good[856] ^ 1), "reserved": (888, 1), "the chunk's place": (file.directory_at + 8, 1),
                 "the first number": (file.directory_at, 1), "runs": (file.chunks_at, good[file.chunks_at] ^ 1),
                 "a group": (file.chunks_at + 5, good[file.chunks_at + 5] ^ 1)}
        for what, (at, value) in cases.items():
            with self.subTest(what):
                damaged = bytearray(good)
                damaged[at] = value
                damaged = repaired(damaged)
                with self.assertRaises(read_svdag.InvalidFile):
                    read_svdag.Svdag(damaged)
                painted.write_bytes(damaged)
                with self.assertRaises(AssertionError):
                    run("tests/paint_dag", painted)

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
