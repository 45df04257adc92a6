#!/usr/bin/env python3
"""`svdag import` gives the same DAG for the same voxels: from our exports, or from files in others' layouts.

Usage: import_test.py PROGRAMS
"""
import hashlib
import io
import math
import random
import sys
import unittest

import numpy

import write_foreign
from baked import Bakery, askew, coarser, slices

BAKERY = Bakery(sys.argv.pop(1))
EXPORTED = {"hashdag": "x.basic_dag.dag.bin", "symvox": "x.svdag", "transform-dag": "x.svo", "npz": "x.npz",
            "binvox": "x.binvox", "vox": "x.vox"}


def nodes_of(dag):
    """A hash of each level's bytes, which the set of voxels determines."""
    return [hashlib.sha256(dag.section(k)).hexdigest() for k in range(dag.L - 1)]


class Import(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dag = BAKERY.bake("askew", askew(), "-r", "128")
        cls.voxels = cls.dag.voxels().astype("<i8")
        cls.small = BAKERY.bake("small", askew(), "-r", "32")
        cls.few = cls.small.voxels().astype("<i8")
        cls.full = BAKERY.bake("full", slices(16), "-r", "16")
        cls.empty = BAKERY.bake("empty", askew(), "-r", "32", "--bounds=900,900,900,901,901,901")

    def read(self, data, name, *options):
        """Imports `data`, with its axes; the Python reader requires the canonical form."""
        (BAKERY.folder / name).write_bytes(data)
        return self.imported(name, *options, *(["--up", "z"] if name.endswith(".vox") else []))

    def imported(self, name, *options):
        BAKERY.run("svdag", "import", name, "-o", "imported.svdag", "-q", *options)
        BAKERY.run("svdag-verify", "check", "imported.svdag", "-q")
        return BAKERY.dag("imported.svdag")

    def dense(self):
        volume = numpy.zeros((32, 32, 32), bool)
        volume[tuple(self.few.T)] = True
        return volume

    def expect_place(self, dag, corner, voxel_size):
        self.assertAlmostEqual(dag.voxel_size / voxel_size, 1, delta=1e-6)
        for got, own in zip(dag.corner, corner):
            self.assertAlmostEqual(got, own, delta=1e-6 * (abs(own) + 2**dag.L * voxel_size))

    def test_what_was_exported_comes_back_byte_for_byte(self):
        for name in ("askew", "full", "empty"):
            dag = BAKERY.dag(f"{name}.svdag")
            for form, path in EXPORTED.items():
                with self.subTest(name=name, form=form):
                    BAKERY.run("svdag", "export", f"{name}.svdag", "--format", form, "-o", path, "-q")
                    back = self.imported(path, "-r", 2**dag.L)
                    self.assertEqual(nodes_of(back), nodes_of(dag))
                    self.assertEqual(back.voxel_count, dag.voxel_count)
                    if form in ("vox", "transform-dag"):
                        self.assertEqual((back.corner, back.voxel_size), ([0, 0, 0], 1))
                    else:
                        self.expect_place(back, dag.corner, dag.voxel_size)

    def test_a_coarser_level_becomes_minimal(self):
        expected = {tuple(v) for v in coarser(self.voxels, 2).tolist()}
        for form, path in EXPORTED.items():
            with self.subTest(form=form):
                BAKERY.run("svdag", "export", "askew.svdag", "--format", form, "-o", path, "-q", "--level", "5")
                back = self.imported(path, "-r", "32")
                self.assertTrue({tuple(v) for v in back.voxels().tolist()} == expected)

    def test_verify_diff_compares_with_another_program(self):
        BAKERY.run("svdag", "export", "askew.svdag", "--format", "hashdag", "-o", "x.basic_dag.dag.bin", "-q")
        self.imported("x.basic_dag.dag.bin")
        BAKERY.run("svdag-verify", "diff", "imported.svdag", "askew.svdag")
        BAKERY.run("svdag-verify", "diff", "imported.svdag", "small.svdag", "--by-index", code=1)

    def test_trees_without_sharing_and_empty_nodes(self):
        voxels = self.few.tolist()
        for name, data in {
                "t.dag.bin": write_foreign.hashdag(voxels, 5), "e.dag.bin": write_foreign.hashdag(voxels, 5, empty_nodes=True),
                "t.svdag": write_foreign.symvox(voxels, 5), "t.svo": write_foreign.transform_dag(voxels, 5)}.items():
            with self.subTest(name=name):
                self.assertEqual(nodes_of(self.read(data, name)), nodes_of(self.small))
        for name, data in {"n.dag.bin": write_foreign.hashdag([], 5), "n2.dag.bin": write_foreign.hashdag([], 5, empty_nodes=True),
                           "n.svdag": write_foreign.symvox([], 5)}.items():
            with self.subTest(name=name):
                self.assertEqual(self.read(data, name).voxel_count, 0)

    def test_the_box_of_a_dag_gives_its_position(self):
        dag = self.read(write_foreign.hashdag(self.few.tolist(), 5, (-3, 7, 0.5), 8), "b.dag.bin")
        self.expect_place(dag, (-3, 7, 0.5), 0.25)
        dag = self.read(write_foreign.symvox(self.few.tolist(), 5, (1, 2, -3), 8), "b.svdag")
        self.expect_place(dag, (-3, -2, -7), 0.25)

    def test_arrays_of_every_kind(self):
        chance = random.Random(3)
        rows = self.few.tolist() + self.few[::3].tolist()  # repetitions
        chance.shuffle(rows)
        dense = self.dense()
        places = {"corner": numpy.array([1.5, -2, 3]), "voxel_size": numpy.float64(0.125)}
        for name, arrays in {
                "i4": {"coordinates": numpy.array(rows, "<i4")}, "i8": {"points": numpy.array(rows, "<i8")},
                "u1": {"x": numpy.array(rows, "u1")}, "u2": {"x": numpy.array(rows, "<u2")},
                "bool": {"window": dense}, "bytes": {"window": dense.astype("u1") * 7},
                "fortran": {"window": numpy.asfortranarray(dense)}}.items():
            for write in (write_foreign.npz, write_foreign.npz_commented):
                with self.subTest(name=name, write=write.__name__):
                    dag = self.read(write(**arrays, **places), "a.npz", "-r", "32")
                    self.assertEqual(nodes_of(dag), nodes_of(self.small))
                    self.expect_place(dag, (1.5, -2, 3), 0.125)
        numpy.save(BAKERY.folder / "lone.npy", numpy.array(rows, "<i4"))
        self.assertEqual(nodes_of(self.imported("lone.npy", "-r", "32")), nodes_of(self.small))

    def test_coordinates_column_by_column_in_every_type(self):
        rows = numpy.argwhere(self.dense())
        self.assertTrue(rows.flags.f_contiguous and not rows.flags.c_contiguous)
        for kind in ("i1", "u1", "<i2", "<u2", "<i4", "<u4", "<i8", "<u8"):
            with self.subTest(kind=kind):
                columns = numpy.asfortranarray(rows.astype(kind))
                self.assertIn(b"'fortran_order': True", write_foreign.npz(x=columns))
                dag = self.read(write_foreign.npz(x=columns), "f.npz", "-r", "32")
                self.assertEqual(nodes_of(dag), nodes_of(self.small))
                self.assertEqual(dag.voxel_count, len(self.few))
        for kind in ("i1", "<i2", "<i4", "<i8"):
            with self.subTest(negative=kind):
                columns = numpy.array([[0, 1, 2], [0, -1, 2], [3, 3, 3]], kind, order="F")
                (BAKERY.folder / "n.npz").write_bytes(write_foreign.npz(x=columns))
                self.assertIn("0 ... 1M - 1", BAKERY.run("svdag", "import", "n.npz", "-o", "n.svdag", code=3))

    def test_negative_coordinates_of_every_width_are_rejected(self):
        for width in ("i1", "<i2", "<i4", "<i8"):
            with self.subTest(width=width):
                (BAKERY.folder / "n.npz").write_bytes(write_foreign.npz(x=numpy.array([[0, 0, 0], [-1, 2, 3]], width)))
                self.assertIn("0 ... 1M - 1", BAKERY.run("svdag", "import", "n.npz", "-o", "n.svdag", code=3))
        for width, highest in (("i1", 127), ("u1", 255), ("<i2", 32767), ("<u2", 65535)):
            with self.subTest(width=width):
                dag = self.read(write_foreign.npz(x=numpy.array([[highest, 0, 0]], width)), "h.npz")
                self.assertEqual((2**dag.L, dag.voxel_count), (highest + 1, 1))

    def test_the_placement_arrays_have_every_type(self):
        x = numpy.array(self.few, "<i4")
        for kind in ("<f4", "<f8", "i1", "u1", "<i2", "<u2", "<i4", "<u4", "<i8", "<u8"):
            with self.subTest(kind=kind):
                low = -3 if numpy.dtype(kind).kind != "u" else 3
                places = {"corner": numpy.array([low, 20, 30], kind), "voxel_size": numpy.array(2, kind),
                          "resolution": numpy.array([64], kind)}
                dag = self.read(write_foreign.npz(x=x, **places), "p.npz")
                self.assertEqual((dag.L, dag.voxel_size, dag.corner), (6, 2, [low, 20, 30]))
        dag = self.read(write_foreign.npz(x=x, voxel_size=numpy.float32(0.1)), "p.npz")
        self.assertEqual(dag.voxel_size, float(numpy.float32(0.1)))

    def test_an_invalid_placement_array_is_rejected(self):
        x = numpy.array(self.few, "<i4")
        for name, array in (("voxel_size", numpy.float16(1)), ("voxel_size", numpy.array([1.0, 2, 3])),
                            ("voxel_size", numpy.True_), ("resolution", numpy.float32(64.5)),
                            ("corner", numpy.array([1.0, 2])), ("corner", numpy.array([1, 2, 3], "<f2")),
                            ("resolution", numpy.array([], "<i8")), ("resolution", numpy.int32(0)),
                            ("resolution", numpy.int64(2**20 + 1)), ("resolution", numpy.int8(-1))):
            with self.subTest(name=name, array=array):
                (BAKERY.folder / "w.npz").write_bytes(write_foreign.npz(x=x, **{name: array}))
                self.assertIn(name, BAKERY.run("svdag", "import", "w.npz", "-o", "w.svdag", code=3))

    def test_an_impossible_place_is_refused_by_the_name_of_the_file(self):
        for size in (0.0, -1.0, float("nan"), float("inf")):
            with self.subTest(size=size):
                (BAKERY.folder / "w.npz").write_bytes(
                    write_foreign.npz(x=numpy.array(self.few, "<i4"), voxel_size=numpy.float64(size)))
                self.assertIn("w.npz: invalid origin or voxel size of the grid",
                              BAKERY.run("svdag", "import", "w.npz", "-o", "w.svdag", code=3))

    def test_a_binvox_that_is_not_a_cube(self):
        high = self.few.max(0) + 1
        dense = numpy.zeros(high, bool)
        dense[tuple(self.few.T)] = True
        self.assertEqual(len(set(high)), 3)
        dag = self.read(write_foreign.binvox(dense, (4, 5, 6), max(high) / 2), "b.binvox", "-r", "32")
        self.assertEqual(nodes_of(dag), nodes_of(self.small))
        self.expect_place(dag, (4, 5, 6), 0.5)
        noted = write_foreign.binvox(dense, (4, 5, 6), max(high) / 2).replace(b"\n", b"\n# of another program\nauthor: me\n", 1)
        self.assertEqual(nodes_of(self.read(noted, "b.binvox", "-r", "32")), nodes_of(self.small))

    def test_vox_models_with_and_without_a_scene_graph(self):
        lone = write_foreign.vox((self.few, (32, 32, 32)))
        self.assertEqual(nodes_of(self.read(lone, "lone.vox", "-r", "32")), nodes_of(self.small))
        left = self.few[self.few[:, 0] < 11]
        right = self.few[self.few[:, 0] >= 11] - [11, 0, 0]
        sizes = (11, 32, 31), (21, 32, 32)  # the middle of an odd side is rounded down
        for shift in (0, -500):  # coordinates below 0 are shifted up
            places = [[shift + 5, shift + 16, shift + 15], [shift + 11 + 10, shift + 16, shift + 16]]
            data = write_foreign.vox((left, sizes[0]), (right, sizes[1]), places=places)
            with self.subTest(shift=shift):
                self.assertEqual(nodes_of(self.read(data, "two.vox", "-r", "32")), nodes_of(self.small))

    def test_the_z_of_a_vox_becomes_the_axis_that_is_up(self):
        (BAKERY.folder / "up.vox").write_bytes(write_foreign.vox((self.few, (32, 32, 32))))
        for up, turned in {"x": lambda x, y, z: (z, x, y), "y": lambda x, y, z: (x, z, 31 - y), "z": lambda x, y, z: (x, y, z)}.items():
            for options in [["--up", up]] + ([[]] if up == "y" else []):
                with self.subTest(up=up, options=options):
                    found = {tuple(v) for v in self.imported("up.vox", "-r", "32", *options).voxels().tolist()}
                    self.assertEqual(found, {turned(*v) for v in self.few.tolist()})

    def test_hidden_voxels_of_a_vox_file_are_ignored(self):
        shown, other = self.few[::2], self.few[1::2]
        places = [[16, 16, 16], [16, 16, 16]]
        for name, how in {"hidden": {"hidden": [1]}, "layer": {"hidden_layers": [1]}}.items():
            with self.subTest(name=name):
                data = write_foreign.vox((shown, (32, 32, 32)), (other, (32, 32, 32)), places=places, **how)
                self.assertEqual(self.read(data, "h.vox", "-r", "32").voxel_count, len(shown))
        models = (shown, (32, 32, 32)), (other, (32, 32, 32))
        for name, how in {"frames of a shape": {"places": places[:1], "frames": 2}, "frames of an old file": {}}.items():
            with self.subTest(name=name):
                data = write_foreign.vox(*models, **how)
                self.assertEqual(self.read(data, "f.vox", "-r", "32").voxel_count, len(shown))
        parts = self.read(write_foreign.vox(*models, pack=False), "p.vox", "-r", "32")
        self.assertEqual(parts.voxel_count, len(self.few))

    def test_an_unsupported_vox_model_is_an_error_only_if_shown(self):
        models = (self.few[::2], (32, 32, 32)), (self.few[1::2], (32, 32, 32))
        places = [[16, 16, 16], [16, 2**21, 16]]
        for hides in ({"hidden": [1]}, {"hidden_shapes": [1]}):
            data = write_foreign.vox(*models, places=places, **hides)
            self.assertEqual(self.read(data, "h.vox", "-r", "32").voxel_count, len(models[0][0]))
        (BAKERY.folder / "s.vox").write_bytes(write_foreign.vox(*models, places=places))
        self.assertIn("further than 1M", BAKERY.run("svdag", "import", "s.vox", "-o", "s.svdag", code=3))

    def test_vox_models_are_turned_around_half_their_size(self):
        """All 48 turns, of even and odd sizes: a voxel's centre turns around floor(size / 2)."""
        voxels, size = [(0, 0, 0), (2, 0, 0), (0, 1, 0), (0, 0, 3), (1, 4, 3)], (3, 5, 4)
        for first in range(3):
            for second in {0, 1, 2} - {first}:
                for signs in range(8):
                    rows = [first, second, 3 - first - second]
                    turned = []
                    for v in voxels:
                        centred = [v[a] + 0.5 - size[a] // 2 for a in range(3)]
                        turned.append([10 + math.floor((-1 if signs >> a & 1 else 1) * centred[rows[a]]) for a in range(3)])
                    expected = write_foreign.vox((turned, (32, 32, 32)))
                    turn = first | second << 2 | signs << 4
                    data = write_foreign.vox((voxels, size), places=[[10, 10, 10]], turns={0: turn})
                    with self.subTest(turn=turn):
                        self.assertEqual(nodes_of(self.read(data, "t.vox", "-r", "32")),
                                         nodes_of(self.read(expected, "e.vox", "-r", "32")))
        (BAKERY.folder / "s.vox").write_bytes(write_foreign.vox((voxels, size), places=[[10, 10, 10]], turns={0: 5}))
        self.assertIn("a rotation is not one", BAKERY.run("svdag", "import", "s.vox", "-o", "s.svdag", code=3))

    def test_compressed_and_big_endian_arrays_are_read(self):
        x = numpy.array(self.few, "<i4")
        for kind in ("<i4", ">i4", ">u2", ">i8"):
            packed = io.BytesIO()
            numpy.savez_compressed(packed, coordinates=x.astype(kind), resolution=numpy.array(32, ">f4"))
            for name, data in (("c.npz", packed.getvalue()), ("c.npy", self.npy(x.astype(kind)))):
                with self.subTest(kind=kind, name=name):
                    self.assertEqual(nodes_of(self.read(data, name, "-r", "32")), nodes_of(self.small))
            for at in (len(packed.getvalue()) // 3, len(packed.getvalue()) // 2):
                bad = bytearray(packed.getvalue())
                bad[at] ^= 0x55
                (BAKERY.folder / "b.npz").write_bytes(bytes(bad))
                BAKERY.run("svdag", "import", "b.npz", "-o", "b.svdag", code=3)

    @staticmethod
    def npy(array):
        out = io.BytesIO()
        numpy.save(out, array)
        return out.getvalue()

    def test_unrelated_arrays_are_ignored(self):
        x = numpy.array(self.few, "<i4")
        others = {"names": numpy.array(["a longer name"]), "numbers": numpy.array([1, 2], ">f8"),
                  "complex": numpy.array([1j]), "table": numpy.zeros(3, [("a", "<i4"), ("b", "<f4")])}
        self.assertEqual(self.read(write_foreign.npz(x=x, **others), "o.npz").voxel_count, len(self.few))
        colours = numpy.zeros((len(x), 3), "u1")
        for named in ({"coordinates": x, "colours": colours, "other": x}, {"coordinates": x, "points": x.astype("<f4")}):
            self.assertEqual(self.read(write_foreign.npz(**named), "o.npz").voxel_count, len(self.few))
        (BAKERY.folder / "w.npz").write_bytes(write_foreign.npz(**others))
        self.assertIn("of an unsupported type: names\n", BAKERY.run("svdag", "import", "w.npz", "-o", "w.svdag", code=3))

    def test_ambiguous_arrays_are_rejected(self):
        x, points = numpy.array(self.few, "<i4"), numpy.array(self.few, "<f4")
        colours = numpy.zeros((len(x), 3), "u1")
        for arrays, sentence in (({"x": x, "colours": colours}, "more than one array"),
                                 ({"points": points, "colours": colours}, "which may be colours"),
                                 ({"coordinates": points, "colours": colours}, "is not N x 3 integers")):
            (BAKERY.folder / "w.npz").write_bytes(write_foreign.npz(**arrays))
            self.assertIn(sentence, BAKERY.run("svdag", "import", "w.npz", "-o", "w.svdag", code=3))

    def expect_layers(self, dag, expected):
        """expected: {name: (colour or None, voxels)}"""
        self.assertEqual([layer.name.decode("utf-8", "replace") for layer in dag.layers], sorted(expected))
        for i, layer in enumerate(dag.layers):
            colour, voxels = expected[layer.name.decode("utf-8", "replace")]
            self.assertIn(colour, (None, layer.colour))
            self.assertEqual({tuple(v) for v in dag.voxels(i).tolist()}, {tuple(v) for v in voxels})

    def test_labels_of_every_type_are_layers(self):
        rows = [tuple(v) for v in self.few.tolist()]
        labels = [sum(v) * 7 % 5 for v in rows]
        rows += rows[:20]  # also of another layer
        labels += [(label + 1) % 5 for label in labels[:20]]
        of = [[row for row, label in zip(rows, labels) if label == i] for i in range(5)]
        names = ["b", "a", "wall \u00e9", "", "\u20ac\U0001f600"]
        colours = [0xff8001, 0, 0xffffff, 0x10203, 0xabcdef]
        x, text = numpy.array(rows, "<i4"), "".join(name + "\0" for name in names).encode()
        for kind in ("i1", "u1", "<i2", "<u2", "<i4", "<u4", "<i8", "<u8"):
            arrays = {"coordinates": x, "label": numpy.array(labels, kind), "layer_names": numpy.frombuffer(text, "u1"),
                      "layer_colours": numpy.array(colours, "<u4"), "layer_kind": numpy.frombuffer(b"file\0", "u1")}
            if kind == "u1":
                arrays.update(layer_names=numpy.array(names), layer_kind=numpy.array("file"))
            if kind == "<i8":
                arrays.update(layer_names=numpy.array([name.encode() for name in names]), layer_kind=numpy.array([b"file"]))
            with self.subTest(kind=kind):
                dag = self.read(write_foreign.npz(**arrays), "l.npz", "-r", "32")
                self.expect_layers(dag, {name: ((c >> 16, c >> 8 & 255, c & 255), of[i])
                                         for i, (name, c) in enumerate(zip(names, colours))})
                self.assertEqual((dag.layer_kind, dag.has_union), (3, 1))
        # The voxels are those of an import without layers.
        BAKERY.run("svdag", "import", "l.npz", "-o", "without.svdag", "-q", "-r", "32", "--no-layers")
        BAKERY.run("svdag", "convert", "imported.svdag", "-o", "a.svdag", "-q", "--layer", "a")
        self.assertEqual(nodes_of(BAKERY.dag("without.svdag")), nodes_of(self.small))
        self.assertEqual({tuple(v) for v in dag.voxels().tolist()}, set(rows))
        # A name without voxels is an empty layer; the kind and the colours may be absent.
        del arrays["layer_kind"], arrays["layer_colours"]
        arrays["layer_names"] = numpy.frombuffer(text + b"none\0", "u1")
        dag = self.read(write_foreign.npz(**arrays), "l.npz", "-r", "32")
        self.expect_layers(dag, {**{name: (None, of[i]) for i, name in enumerate(names)}, "none": (None, [])})
        self.assertEqual(dag.layer_kind, 2)
        # What is in no layer becomes the unnamed one, which is there or not.
        for none in (numpy.uint16(65535), numpy.int8(-1)):
            for text in (b"a\0b\0", b"a\0\0"):
                label = numpy.array([none, 0, 1] * len(rows))[:len(rows)]
                dag = self.read(write_foreign.npz(coordinates=x, label=label, layer_names=numpy.frombuffer(text, "u1")),
                                "l.npz", "-r", "32")
                self.expect_layers(dag, {"a": (None, rows[1::3]), **(
                    {"b": (None, rows[2::3]), "": (None, rows[::3])} if b"b" in text else {"": (None, rows[::3] + rows[2::3])})})

    def test_numbers_without_names_are_layers(self):
        rows = [tuple(v) for v in self.few.tolist()]
        for kind, numbers in (("<i8", (-5, 7, 10)), ("u1", (0, 7, 255)), ("<u8", (2**64 - 1, 0, 2**63))):
            with self.subTest(kind=kind):
                labels = numpy.array([numbers[sum(v) % 3] for v in rows], kind)
                dag = self.read(write_foreign.npz(coordinates=self.few, label=labels), "l.npz", "-r", "32")
                self.expect_layers(dag, {str(n): (None, [v for v in rows if sum(v) % 3 == i])
                                         for i, n in enumerate(numbers)})
        # Other arrays named label: of something else than rows.
        for arrays in ({"volume": self.dense(), "label": numpy.array([3])}, {"label": self.few},
                       {"coordinates": self.few, "label": numpy.array(3)}):
            self.assertEqual(self.read(write_foreign.npz(**arrays), "l.npz", "-r", "32").layers, [])

    def test_invalid_labels_are_rejected(self):
        count = len(self.few)

        def rejected(sentence, *options, **arrays):
            (BAKERY.folder / "w.npz").write_bytes(write_foreign.npz(coordinates=self.few, **arrays))
            error = BAKERY.run("svdag", "import", "w.npz", "-o", "w.svdag", *options, code=3)
            self.assertIn(sentence, error)
            self.assertEqual(error.count("\n"), 1)
            BAKERY.run("svdag", "import", "w.npz", "-o", "w.svdag", "-q", "--no-layers")

        def text(data):
            return numpy.frombuffer(data, "u1")
        good = numpy.arange(count) % 2
        for label in (good[1:], numpy.append(good, 0), good.astype("<f4"), good.astype(bool),
                      good.reshape(-1, 1)):
            rejected('has an array "label" that is not an integer for each row', label=label)
        for wrong in (2, -2, 65534, 65536):
            labels = good.copy()
            labels[-1] = wrong
            rejected("is not the number of one of the 2 layers", label=labels, layer_names=text(b"a\0b\0"))
        rejected("is not the number of one of the 0 layers", label=good, layer_names=text(b""))
        rejected("two layers are named a", label=good, layer_names=text(b"a\0b\0a\0"))
        rejected("two layers are named (unnamed)", label=good, layer_names=text(b"\0\0"))
        rejected('"layer_names" that does not end with a zero byte', label=good, layer_names=text(b"a\0b"))
        for names in (numpy.array([1.0, 2.0]), numpy.array([["a", "b"]]), numpy.array([0, 1])):
            rejected('"layer_names" that is not a row of texts', label=good, layer_names=names)
        for code in (0x110000, 0xd800):
            rejected('"layer_names" that is not valid Unicode', label=good, layer_names=numpy.array([97, code], "<u4").view("<U1"))
        for colours in (numpy.array([1]), numpy.array([1, 2, 3]), numpy.array([1.0, 2.0])):
            rejected('"layer_colours" that is not an integer for each layer', label=good, layer_names=text(b"a\0b\0"),
                     layer_colours=colours)
        rejected('"layer_colours" that is not of colours 0xRRGGBB', label=good, layer_names=text(b"a\0b\0"),
                 layer_colours=numpy.array([1, 2**24]))
        rejected('"layer_kind" that is not object, material, file or frame', label=good, layer_kind=text(b"none\0"))
        rejected('"layer_kind" that is not object, material, file or frame', label=good, layer_kind=numpy.array(["file", "file"]))

    def test_65535_layers_and_no_more(self):
        count = 65535
        numbers = numpy.arange(count + 1)
        x = numpy.stack([numbers % 64, numbers // 64 % 64, numbers // 4096], 1)
        names = b"".join(b"%d\0" % n for n in range(count))
        for arrays in ({}, {"layer_names": numpy.frombuffer(names, "u1")}):
            self.read(write_foreign.npz(coordinates=x[:-1], label=numbers[:-1], **arrays), "l.npz")
            self.assertIn('"count": 65535', BAKERY.run("svdag", "info", "imported.svdag", "--json"))
            if arrays:
                arrays["layer_names"] = numpy.frombuffer(names + b"one more\0", "u1")
            (BAKERY.folder / "l.npz").write_bytes(write_foreign.npz(coordinates=x, label=numbers, **arrays))
            self.assertIn("l.npz: has more than 65535 layers (--no-layers ignores them)\n",
                          BAKERY.run("svdag", "import", "l.npz", "-o", "w.svdag", code=3))

    def test_layers_come_back_byte_for_byte(self):
        """Where no voxel is in two layers. A .vox has no names, but numbers of colours in the order of the table."""
        scene = b"v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n"
        for i, name in enumerate((b"roof", b"\xff\xfe", b"wall \xc3\xa9")):
            scene += b"o %s\nv 0 0 %d\nv 9 0 %d\nv 0 9 %d\nf -1 -2 -3\n" % (name, *3 * [10 * i + 10])
        (BAKERY.folder / "parts.obj").write_bytes(scene)
        for kind in ("object", "material"):
            BAKERY.run("svdag", "build", "parts.obj", "-o", "parts.svdag", "-q", "-r", "128", "--layers", kind)
            dag = BAKERY.dag("parts.svdag")
            BAKERY.run("svdag", "export", "parts.svdag", "-o", "parts.npz", "-q")
            back = self.imported("parts.npz")
            self.assertEqual((nodes_of(back), back.layers, back.layer_kind), (nodes_of(dag), dag.layers, dag.layer_kind))
        BAKERY.run("svdag", "build", "parts.obj", "-o", "parts.svdag", "-q", "-r", "128", "--layers", "object")
        dag = BAKERY.dag("parts.svdag")
        BAKERY.run("svdag", "export", "parts.svdag", "-o", "parts.vox", "-q")
        back = self.imported("parts.vox", "-r", "128")
        self.assertEqual([layer.name for layer in back.layers], [b"colour-00%d" % (1 + i) for i in range(4)])
        self.assertEqual([layer[1:] for layer in back.layers], [layer[1:] for layer in dag.layers])
        self.assertEqual(nodes_of(back), nodes_of(dag))

    def test_colours_of_a_vox_are_layers(self):
        rows = [tuple(v) for v in self.few.tolist()]
        used = (1, 79, 255)
        coloured = numpy.array([(*v, used[sum(v) % 3]) for v in rows])
        of = {f"colour-{c:03}": [v for v in rows if used[sum(v) % 3] == c] for c in used}
        palette = bytes(range(256)) * 4
        colours = {c: tuple(palette[4 * c - 4:4 * c - 1]) for c in used}
        data = write_foreign.vox((coloured, (32, 32, 32)), palette=palette)
        self.expect_layers(self.read(data, "c.vox", "-r", "32"),
                           {f"colour-{c:03}": (colours[c], of[f"colour-{c:03}"]) for c in used})
        self.assertEqual(self.read(data, "c.vox", "-r", "32", "--no-layers").layers, [])
        # Without a palette, that of MagicaVoxel; a single colour is then none.
        coloured[:, 3] = 1 + numpy.arange(len(rows)) % 255
        dag = self.read(write_foreign.vox((coloured, (32, 32, 32)), palette=None), "d.vox", "-r", "32")
        default = {layer.name: layer.colour for layer in dag.layers}
        for number, colour in {1: (255, 255, 255), 2: (255, 255, 204), 7: (255, 204, 255), 37: (204, 255, 255),
                               215: (0, 0, 51), 216: (238, 0, 0), 226: (0, 238, 0), 236: (0, 0, 238), 246: (238, 238, 238),
                               255: (17, 17, 17)}.items():
            self.assertEqual(default[f"colour-{number:03}".encode()], colour, number)
        one = write_foreign.vox((self.few, (32, 32, 32)), palette=None)
        self.assertEqual(self.read(one, "o.vox", "-r", "32").layers, [])

    def test_colours_beside_a_hashdag_are_those_of_its_voxels(self):
        def morton(v):
            return [4 * (v[0] >> k & 1) + 2 * (v[1] >> k & 1) + (v[2] >> k & 1) for k in range(9, -1, -1)]

        def write(rows, colours, levels=5):
            (BAKERY.folder / "c.dag.bin").write_bytes(write_foreign.hashdag(rows, levels))
            (BAKERY.folder / "c.uncompressed_colors.bin").write_bytes(colours)
        rows = sorted((tuple(v) for v in self.few.tolist()), key=morton)
        kinds = ((1, 2, 3), (255, 0, 16), (0, 0, 0))
        colours = [kinds[sum(v) * 5 // 3 % 3] for v in rows]
        write(rows, write_foreign.hashdag_colours(colours))
        for options in ((), ("-m", "8M", "-j", "2"), ("--layout", "compact")):
            dag = self.imported("c.dag.bin", *options)
            self.assertEqual(({v: dag.colours[5, *v] for v in rows}, dag.layers),
                             ({v: "%02x%02x%02x" % c for v, c in zip(rows, colours)}, []))
            self.assertEqual({tuple(v) for v in dag.voxels().tolist()}, set(rows))
        without = self.imported("c.dag.bin", "--no-colours")
        self.assertEqual((nodes_of(without), without.colours), (nodes_of(self.small), {}))
        good = write_foreign.hashdag_colours(colours)
        for wrong, sentence in ((good[:-4], "its size does not match its counts"), (good + b"1", "its size does not match its counts"),
                                (good[:11], "its size does not match its counts"), (good[:16], "its size does not match its counts"),
                                (write_foreign.hashdag_colours(colours[1:]), f"colours, but the DAG has {len(rows):,} voxels")):
            write(rows, wrong)
            self.assertIn("c.uncompressed_colors.bin: ", BAKERY.run("svdag", "import", "c.dag.bin", "-o", "w.svdag", code=3))
            self.assertIn(sentence, BAKERY.run("svdag", "import", "c.dag.bin", "-o", "w.svdag", code=3))
        write([], write_foreign.hashdag_colours([]))
        self.assertEqual(self.imported("c.dag.bin").voxel_count, 0)
        many = sorted(((x, y, z) for x in range(64) for y in range(64) for z in range(16)), key=morton)
        write(many, write_foreign.hashdag_colours([(i & 255, i >> 8, 0) for i in range(len(many))]), 6)
        self.assertEqual(self.imported("c.dag.bin").voxel_count, len(many))

    def test_a_flipped_bit_in_an_archive_is_detected(self):
        good = write_foreign.npz(x=numpy.array(self.few, "<i4"), resolution=numpy.array(32))
        begin = good.index(b"\x93NUMPY") + 128
        for at in (begin, begin + 2 * len(self.few), begin + 12 * len(self.few) - 4):
            data = bytearray(good)
            data[at] ^= 1
            (BAKERY.folder / "flipped.npz").write_bytes(data)
            self.assertIn("checksum", BAKERY.run("svdag", "import", "flipped.npz", "-o", "w.svdag", code=3))
        self.assertEqual(self.read(good, "flipped.npz").voxel_count, len(self.few))

    def test_little_memory_gives_the_same_bytes(self):
        BAKERY.bake("large", askew(), "-r", "1K")
        for form in ("hashdag", "npz"):
            BAKERY.run("svdag", "export", "large.svdag", "--format", form, "-o", EXPORTED[form], "-q")
            BAKERY.run("svdag", "import", EXPORTED[form], "-o", "much.svdag", "-q", "-r", "1K")
            BAKERY.run("svdag", "import", EXPORTED[form], "-o", "little.svdag", "-q", "-r", "1K", "-m", "16M", "-j", "2")
            self.assertEqual((BAKERY.folder / "much.svdag").read_bytes(), (BAKERY.folder / "little.svdag").read_bytes())
            self.assertFalse((BAKERY.folder / "little.svdag.scratch").exists())
            self.assertEqual(nodes_of(BAKERY.dag("little.svdag")), nodes_of(BAKERY.dag("large.svdag")))
        x = numpy.load(BAKERY.folder / EXPORTED["npz"])["coordinates"]
        label = (x[:, 0] // 100 + x[:, 1] // 50).astype("u1")
        (BAKERY.folder / "l.npz").write_bytes(write_foreign.npz(coordinates=x, label=label))
        BAKERY.run("svdag", "import", "l.npz", "-o", "much.svdag", "-q", "-r", "1K")
        BAKERY.run("svdag", "import", "l.npz", "-o", "little.svdag", "-q", "-r", "1K", "-m", "16M", "-j", "2")
        self.assertEqual((BAKERY.folder / "much.svdag").read_bytes(), (BAKERY.folder / "little.svdag").read_bytes())

    def test_damaged_files_give_one_message(self):
        good = {"t.dag.bin": write_foreign.hashdag(self.few.tolist(), 5), "t.svdag": write_foreign.symvox(self.few.tolist(), 5),
                "t.svo": write_foreign.transform_dag(self.few.tolist(), 5),
                "t.npz": write_foreign.npz(x=numpy.array(self.few, "<i4")), "t.npy": b"\x93NUMPY\1\0\xff\xff",
                "t.binvox": write_foreign.binvox(numpy.ones((8, 8, 8), bool)), "t.vox": write_foreign.vox((self.few, (32, 32, 32)))}
        for name, data in good.items():
            for cut in (len(data) // 2, len(data) - 1):
                with self.subTest(name=name, cut=cut):
                    (BAKERY.folder / name).write_bytes(data[:cut])
                    error = BAKERY.run("svdag", "import", name, "-o", "broken.svdag", code=3)
                    self.assertEqual(error.count("\n"), 1)
                    self.assertFalse((BAKERY.folder / "broken.svdag").exists())

    def test_mirrored_nodes_are_rejected(self):
        data = bytearray(write_foreign.symvox(self.few.tolist(), 5))
        data[45] = 1  # mirrorX of the root
        (BAKERY.folder / "m.svdag").write_bytes(data)
        self.assertIn("ussvdag", BAKERY.run("svdag", "import", "m.svdag", "-o", "c.svdag", code=3))
        data = bytearray(write_foreign.symvox(self.few.tolist(), 5))
        data[-3] = 1  # a ninth voxel of the last leaf
        (BAKERY.folder / "m.svdag").write_bytes(data)
        self.assertIn("more than 8 voxels", BAKERY.run("svdag", "import", "m.svdag", "-o", "c.svdag", code=3))


if __name__ == "__main__":
    unittest.main()
