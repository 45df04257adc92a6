#!/usr/bin/env python3
"""Surfaces of `svdag export` have each face between a set voxel and one that is not, once, outward and closed.

Usage: export_surface_test.py PROGRAMS. What is expected is made of the voxels by NumPy; the files are read by plain
readers of their formats. Baked as a solid on its grid, a surface sets the voxels that it came from and those that
touch them.
"""
import itertools
import json
import pathlib
import struct
import sys
import unittest

import numpy

from baked import Bakery, coarser

BAKERY = Bakery(sys.argv.pop(1))
ENDINGS = {"glb": "x.glb", "obj": "x.obj", "stl": "x.stl", "ply-surface": "x.ply"}
TILE = 64


def read_glb(path):
    """Corners of triangles in the world, and their colours in linear light or None."""
    data = path.read_bytes()
    magic, version, length, json_bytes, kind = struct.unpack_from("<4sIII4s", data)
    assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON")
    scene = json.loads(data[20:20 + json_bytes])
    binary = data[28 + json_bytes:]
    if "meshes" not in scene:
        return numpy.zeros((0, 3, 3)), None
    def array(number, dtype, width):
        accessor = scene["accessors"][number]
        view = scene["bufferViews"][accessor["bufferView"]]
        begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        item = numpy.dtype((dtype, (width,)))
        return numpy.ndarray((accessor["count"], width), dtype, binary, begin,
                             (view.get("byteStride", item.itemsize), numpy.dtype(dtype).itemsize)), accessor
    primitive = scene["meshes"][0]["primitives"][0]
    places, accessor = array(primitive["attributes"]["POSITION"], "<f4", 3)
    assert accessor["min"] == places.min(0).tolist() and accessor["max"] == places.max(0).tolist()
    node = scene["nodes"][0]
    world = places.astype("f8") * node["scale"] + node["translation"]
    corners = array(primitive["indices"], "<u4", 1)[0].reshape(-1, 3)
    assert set(numpy.unique(corners)) == set(range(len(places))), "vertices without a face"
    colours = None
    if "COLOR_0" in primitive["attributes"]:
        colours = (array(primitive["attributes"]["COLOR_0"], "<u2", 4)[0][:, :3] / 65535)[corners]
    return world[corners], colours


def linear(code):
    v = numpy.asarray(code, "f8") / 255
    return numpy.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


def halves(quads):
    return [half for a, b, c, d in quads for half in ((a, b, c), (a, c, d))]


def read_obj(path):
    vertices, quads = [], []
    for line in path.read_text().splitlines():
        kind, *words = line.split()
        if kind == "v":
            vertices.append(list(map(float, words)))
        elif kind == "f":
            quads.append([int(w) - 1 for w in words])
    if not vertices:
        return numpy.zeros((0, 3, 3)), None
    vertices = numpy.array(vertices)
    corners = numpy.array(halves(quads), int).reshape(-1, 3)
    colours = linear(255 * vertices[:, 3:])[corners] if vertices.shape[1] > 3 else None
    return vertices[:, :3][corners], colours


def read_stl(path):
    data = path.read_bytes()
    facets = numpy.frombuffer(data, [("n", "<f4", 3), ("v", "<f4", (3, 3)), ("x", "<u2")], offset=84)
    assert len(facets) == struct.unpack_from("<I", data, 80)[0]
    v = facets["v"].astype("f8")
    normal = numpy.cross(v[:, 1] - v[:, 0], v[:, 2] - v[:, 0])
    assert numpy.array_equal(numpy.sign(numpy.where(abs(normal) == abs(normal).max(1, keepdims=True, initial=0), normal, 0)),
                             facets["n"]), "normals"
    return v, None


def read_ply(path):
    head, body = path.read_bytes().split(b"end_header\n", 1)
    counts = [int(line.split()[2]) for line in head.decode().splitlines() if line.startswith("element")]
    fields = [("xyz", "<f8", 3)] + ([("rgb", "u1", 3)] if b"red" in head else [])
    vertices = numpy.frombuffer(body, fields, counts[0])
    faces = numpy.frombuffer(body, [("n", "u1"), ("i", "<u4", 4)], counts[1], vertices.nbytes)
    assert vertices.nbytes + faces.nbytes == len(body) and (faces["n"] == 4).all()
    corners = numpy.array(halves(faces["i"]), int).reshape(-1, 3)
    return vertices["xyz"][corners], linear(vertices["rgb"])[corners] if b"red" in head else None


READERS = {"glb": read_glb, "obj": read_obj, "stl": read_stl, "ply-surface": read_ply}


def faces_of(voxels, side):
    """(direction, x, y, z) of each face: of which voxel it is."""
    grid = numpy.zeros((side + 2,) * 3, bool)
    if len(voxels):
        grid[tuple((voxels + 1).T)] = True
    found = set()
    for axis, up in itertools.product(range(3), (0, 1)):
        beside = numpy.roll(grid, -1 if up else 1, axis)
        for at in numpy.argwhere(grid & ~beside) - 1:
            found.add((2 * axis + up, *at.tolist()))
    return found


class Surface:
    """An exported surface, on the planes of voxels."""

    def __init__(self, form, about, level, *, exact=True):
        corners, colours = READERS[form](BAKERY.folder / ENDINGS[form])
        size = about["voxel_size"] * 2.0 ** (about["levels"] - level)
        planes = (corners - about["corner"]) / size
        assert abs(planes - planes.round()).max(initial=0) < (1e-9 if exact else 1e-3)
        planes = planes.round().astype(int)
        assert len(planes) % 2 == 0
        # Two triangles 0 1 2, 0 2 3 of a rectangle.
        first, second = planes[0::2], planes[1::2]
        assert numpy.array_equal(first[:, 0], second[:, 0]) and numpy.array_equal(first[:, 2], second[:, 1])
        self.quads = numpy.concatenate([first, second[:, 2:]], axis=1)
        self.colours = None
        if colours is not None:
            assert (colours == colours[:, :1]).all() and numpy.array_equal(colours[0::2], colours[1::2])
            self.colours = colours[0::2, 0]

    def faces(self):
        """Each face that a quad covers, with the number of its quad; tests that quads are rectangles of one tile."""
        found = []
        for number, (a, b, c, d) in enumerate(self.quads):
            assert numpy.array_equal(a + c, b + d)
            normal = numpy.cross(b - a, d - a)
            axis = int(numpy.flatnonzero(normal)[0])
            assert numpy.count_nonzero(normal) == 1 and numpy.count_nonzero(b - a) == 1
            up = int(normal[axis] > 0)
            low, high = numpy.minimum(a, c), numpy.maximum(a, c)
            low[axis] -= up
            high[axis] = low[axis] + 1
            assert numpy.array_equal(low // TILE, (high - 1) // TILE), "a quad across tiles"
            for at in itertools.product(*map(range, low, high)):
                found.append(((2 * axis + up, *at), number))
        return found

    def unit_edges(self):
        """How often each edge of a voxel is passed forwards, less backwards."""
        passed = {}
        for quad in self.quads:
            for p, q in zip(quad, numpy.roll(quad, -1, axis=0)):
                axis = int(numpy.flatnonzero(q - p)[0])
                for k in range(min(p[axis], q[axis]), max(p[axis], q[axis])):
                    at = p.copy()
                    at[axis] = k
                    key = (axis, *at.tolist())
                    passed[key] = passed.get(key, 0) + (1 if q[axis] > p[axis] else -1)
        return passed


class ExportSurface(unittest.TestCase):
    def import_voxels(self, name, voxels, side, **arrays):
        numpy.savez(BAKERY.folder / f"{name}.npz", coordinates=voxels, resolution=side, corner=[-1.5, 2.25, 1e3],
                    voxel_size=0.1, **arrays)
        BAKERY.run("svdag", "import", f"{name}.npz", "-o", f"{name}.svdag", "-q", "-r", side)
        return self.about(name)

    def about(self, name):
        info = json.loads(BAKERY.run("svdag", "info", f"{name}.svdag", "--json"))
        return {"levels": info["levels"], **{key: info["grid"][key] for key in ("voxel_size", "corner")}}

    def export(self, name, form, about, *options, level=None):
        report = json.loads(BAKERY.run("svdag", "export", f"{name}.svdag", "--format", form, "-o", ENDINGS[form],
                                       "--json", *options, *(() if level is None else ("--level", level))))
        surface = Surface(form, about, about["levels"] if level is None else level, exact=form != "stl")
        self.assertEqual(report["quads"], len(surface.quads))
        return surface, report

    def expect(self, surface, report, voxels, side):
        faces = surface.faces()
        self.assertEqual(len(faces), report["faces"])
        self.assertEqual({face for face, _ in faces}, faces_of(voxels, side))
        self.assertEqual(len(faces), len(set(face for face, _ in faces)), "a face is covered twice")
        self.assertFalse(any(surface.unit_edges().values()), "not closed")
        self.assertEqual(report["voxels"], len(voxels))

    def random_sets(self):
        random = numpy.random.default_rng(5)
        for side, share in [(8, 0.5), (8, 0.03), (16, 0.3), (32, 0.9), (64, 0.02), (128, 0.002)]:
            grid = random.random((side,) * 3) < share
            if side >= 32:  # boxes, across tiles and at the border of the grid
                for _ in range(4):
                    low = random.integers(0, side, 3)
                    high = low + random.integers(1, side // 2, 3)
                    grid[tuple(map(slice, low, high))] = random.random() < 0.7
            yield side, numpy.argwhere(grid)

    def test_random_sets_have_each_face_once_and_are_closed(self):
        for i, (side, voxels) in enumerate(self.random_sets()):
            about = self.import_voxels("random", voxels, side)
            for form in ENDINGS if side <= 16 else ["glb"]:
                with self.subTest(side=side, form=form):
                    surface, report = self.export("random", form, about)
                    self.expect(surface, report, voxels, side)
                    if i < 4:
                        self.assertLess(report["quads"], report["faces"])

    def test_without_merging_each_face_is_a_quad_and_edges_match_one_by_one(self):
        for side, voxels in itertools.islice(self.random_sets(), 5):
            about = self.import_voxels("random", voxels, side)
            surface, report = self.export("random", "glb", about, "--no-merge")
            self.assertEqual(report["quads"], report["faces"])
            self.expect(surface, report, voxels, side)

    def test_a_bake_of_the_surface_sets_the_same_voxels_and_those_that_touch_them(self):
        for side, voxels in self.random_sets():
            if side not in (16, 64):
                continue
            about = self.import_voxels("random", voxels, side)
            cube = ",".join(map(repr, [*about["corner"], about["voxel_size"] * side]))
            for form in ("glb", "obj", "ply-surface"):
                self.export("random", form, about)
                BAKERY.run("svdag", "build", ENDINGS[form], "-o", "back.svdag", "-q", "-r", side, "--rule", "solid",
                           f"--cube={cube}")
                near = numpy.unique((voxels[:, None] + numpy.argwhere(numpy.ones((3,) * 3)) - 1).reshape(-1, 3), axis=0)
                near = near[((near >= 0) & (near < side)).all(axis=1)]
                self.assertTrue(numpy.array_equal(numpy.unique(BAKERY.dag("back.svdag").voxels().astype(int), axis=0), near))

    def test_large_full_cubes_have_faces_at_their_border_alone(self):
        side = 512
        voxels = numpy.argwhere(numpy.ones((256,) * 3, bool))
        about = self.import_voxels("full", voxels, side)
        surface, report = self.export("full", "glb", about)
        self.assertEqual((report["faces"], report["quads"]), (6 * 256 ** 2, 6 * 4 ** 2))
        self.assertFalse(any(surface.unit_edges().values()))

    def test_levels_boxes_and_layers_are_closed_surfaces_of_their_voxels(self):
        random = numpy.random.default_rng(6)
        voxels = numpy.unique(random.integers(0, 64, (3000, 3)), axis=0)
        label = random.integers(0, 2, len(voxels)).astype("u2")
        about = self.import_voxels("parts", voxels, 64, label=label, layer_names=numpy.array(["a", "b"]))
        for level in (5, 4, 3):
            surface, report = self.export("parts", "glb", about, level=level)
            self.expect(surface, report, coarser(voxels, 6 - level), 2**level)
        corner = numpy.array(about["corner"])
        low, high = corner + 0.1 * 10.5, corner + 0.1 * 41.5
        surface, report = self.export("parts", "obj", about, "--bounds=" + ",".join(map(str, [*low, *high])))
        self.expect(surface, report, voxels[((voxels >= 10) & (voxels < 42)).all(axis=1)], 64)
        surface, report = self.export("parts", "glb", about, "--layer", "b")
        self.expect(surface, report, voxels[label == 1], 64)
        self.import_voxels("none", numpy.zeros((0, 3), int), 8)
        for form in ENDINGS:
            self.export("none", form, self.about("none"))

    def test_faces_have_the_colour_of_their_voxel(self):
        random = numpy.random.default_rng(7)
        voxels = numpy.argwhere(random.random((16,) * 3) < 0.5)
        colours = random.integers(0, 3, (len(voxels), 3)).astype("u1") * 100
        about = self.import_voxels("colours", voxels, 16, colours=colours)
        own = {tuple(v): linear(c) for v, c in zip(voxels.tolist(), colours)}
        for form in ("glb", "obj", "ply-surface"):
            surface, report = self.export("colours", form, about)
            self.expect(surface, report, voxels, 16)
            for (_, *at), number in surface.faces():
                self.assertLess(numpy.abs(surface.colours[number] - own[tuple(at)]).max(), 1e-5)
        self.assertIsNone(self.export("colours", "stl", about)[0].colours)

    def test_too_many_quads_are_refused_with_their_number(self):
        self.import_voxels("box", numpy.argwhere(numpy.ones((4,) * 3, bool)), 8)
        (BAKERY.folder / "kept.glb").write_text("old")
        message = BAKERY.run("svdag", "export", "box.svdag", "-o", "kept.glb", "--max-quads", 5, code=2)
        self.assertIn("the surface has 6 quads, more than 5", message)
        self.assertEqual((BAKERY.folder / "kept.glb").read_text(), "old")


if __name__ == "__main__":
    unittest.main(verbosity=0)
