#!/usr/bin/env python3
"""Cross-checks .vdb files with Debian's python3-openvdb: it reads our exports, svdag-verify reads its grids.

World coordinates of a scene without symmetry are compared with each other and with the mesh, so that two
swapped axes or two shifts by half a voxel cannot cancel out. Skipped (77) without python3-openvdb.
"""
import itertools
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "dag"))
import read_svdag  # noqa: E402

try:
    import pyopenvdb
except ImportError:
    pyopenvdb = None

PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()

# Different extents, no symmetry, away from zero.
POINTS = numpy.array([[0.3, 10.1, -5.2], [7.1, 11.4, -4.1], [2.2, 13.9, -3.0], [5.0, 10.3, 4.7], [0.9, 12.2, 1.1]])
FACES = [(0, 1, 2), (1, 2, 3), (2, 4, 0)]


def run(*command, code=0):
    done = subprocess.run([PROGRAMS / command[0], *map(str, command[1:])], capture_output=True, text=True)
    if done.returncode != code:
        raise AssertionError(f"{command}: gave {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def active(grid):
    """The index coordinates of all active voxels."""
    lists = []
    for item in grid.iterOnValues():
        if item.value:
            ranges = [range(low, high + 1) for low, high in zip(item.min, item.max)]
            lists.extend(itertools.product(*ranges))
    return numpy.array(lists)


def worlds(grid):
    return numpy.array([grid.transform.indexToWorld(tuple(map(int, v))) for v in active(grid)])


def as_set(points, size):
    return {tuple(p) for p in numpy.rint(points / size * 1000).astype(int).tolist()}


def distance(point, corners):
    """An upper bound of the distance of a point from a triangle: the nearest of many points on it."""
    a, b, c = corners
    u, v = numpy.meshgrid(*[numpy.linspace(0, 1, 60)] * 2)
    keep = u + v <= 1
    on = a + u[keep][:, None] * (b - a) + v[keep][:, None] * (c - a)
    return numpy.sqrt(((on - point) ** 2).sum(axis=1)).min()


class VdbVsPython(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="svdag-vdb-")
        cls.at = pathlib.Path(cls.folder.name)
        scene = "".join(f"v {x} {y} {z}\n" for x, y, z in POINTS)
        scene += "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in FACES)
        (cls.at / "a.obj").write_text(scene)
        cls.dag = cls.at / "a.svdag"
        run("svdag", "build", cls.at / "a.obj", "-r", 64, "-o", cls.dag, "-q")
        cls.read = read_svdag.Svdag(cls.dag.read_bytes())
        about = json.loads(run("svdag", "info", cls.dag, "--json"))["grid"]
        cls.size, cls.corner = about["voxel_size"], numpy.array(about["corner"])
        cls.voxels = numpy.array(cls.read.voxels()).astype(int)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def export(self, *options):
        path = self.at / "x.vdb"
        run("svdag", "export", self.dag, "-o", path, "-q", *options)
        return pyopenvdb.read(str(path), "occupancy")

    def centres(self, voxels, size):
        return self.corner + (voxels + 0.5) * size

    def test_an_export_has_the_world_coordinates_of_its_voxels(self):
        found = worlds(self.export())
        self.assertGreater(len(found), 1000)
        self.assertEqual(as_set(found, self.size), as_set(self.centres(self.voxels, self.size), self.size))

    def test_all_grids_of_an_export_are_read(self):
        for kind, value in ([], True), (["--vdb-type", "float"], 1.0):
            self.export(*kind)
            grids, _ = pyopenvdb.readAll(str(self.at / "x.vdb"))
            self.assertEqual([grid.name for grid in grids], ["occupancy"])
            self.assertEqual({item["value"] for item in grids[0].citerOnValues()}, {value})

    def test_an_export_is_on_the_mesh(self):
        found = worlds(self.export())
        for point in POINTS:  # is in a voxel
            self.assertLessEqual(numpy.abs(found - point).max(axis=1).min(), self.size * 0.5001)
        for point in found[::37]:  # the centre of a voxel that touches the mesh
            nearest = min(distance(point, POINTS[list(face)]) for face in FACES)
            self.assertLessEqual(nearest, self.size * (0.8661 + 0.1 * 8))

    def test_a_level_has_the_world_coordinates_of_its_voxels(self):
        for level in range(3, 6):
            size = self.size * 2 ** (6 - level)
            parents = numpy.unique(self.voxels >> (6 - level), axis=0)
            self.assertEqual(as_set(worlds(self.export("--level", level)), size),
                             as_set(self.centres(parents, size), size))

    def test_a_window_holds_the_voxels_whose_interior_meets_it(self):
        low, high = numpy.array([1.0, 10.5, -5.0]), numpy.array([5.5, 12.0, 2.0])
        bounds = ",".join(map(str, [*low, *high]))
        found = worlds(self.export(f"--bounds={bounds}"))
        all_centres = self.centres(self.voxels, self.size)
        meets = ((all_centres + self.size / 2 > low) & (all_centres - self.size / 2 < high)).all(axis=1)
        self.assertEqual(as_set(found, self.size), as_set(all_centres[meets], self.size))
        self.assertLess(len(found), len(self.voxels))

    def test_a_transform_is_that_of_the_file_to_the_last_bit(self):
        scene = self.at / "exact.obj"
        for size, place in [(1e-6, (0.1, 0.2, 0.3)), (0.0003, (1841111.4, 5176075.3, 191.1)), (0.05, (0, 0, 0))]:
            points = [[p + 20 * size * (a == b) for a, p in enumerate(place)] for b in range(3)]
            scene.write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points) + "f 1 2 3\n")
            dag, path = self.at / "exact.svdag", self.at / "exact.vdb"
            run("svdag", "build", scene, "-s", size, "-o", dag, "-q")
            run("svdag", "export", dag, "-o", path, "-q")
            grid = json.loads(run("svdag", "info", dag, "--json"))["grid"]
            transform = pyopenvdb.read(str(path), "occupancy").transform
            self.assertEqual(transform.voxelSize(), (size, size, size))
            self.assertEqual(transform.indexToWorld((0.0, 0.0, 0.0)),
                             tuple(c + grid["voxel_size"] * 0.5 for c in grid["corner"]))

    def test_metadata_names_the_source_of_a_grid(self):
        grid = self.export("--level", "5")
        self.assertEqual((grid["svdag_level"], grid["svdag_levels"], grid["svdag_rule"]), ("5", "6", "conservative"))

    # Grids that Python wrote.

    def foreign(self, indices, matrix, kind=None, value=True):
        grid = (kind or pyopenvdb.BoolGrid)()
        grid.name = "foreign"
        grid.transform = pyopenvdb.createLinearTransform(matrix)
        accessor = grid.getAccessor()
        for index in indices:
            accessor.setValueOn(tuple(map(int, index)), value)
        return grid

    def verify(self, grid, *options, code=0):
        path = self.at / "foreign.vdb"
        pyopenvdb.write(str(path), [grid])
        text = run("svdag-verify", "vdb", self.dag, path, "--json", *options, code=code)
        return json.loads(text) if code < 2 else text

    def matrix(self, axes=(0, 1, 2), signs=(1, 1, 1), origin=(0, 0, 0), shift=0.0):
        """Index-to-world matrix for row vectors: their axis a is our axis axes[a], their voxel 0 our voxel `origin`."""
        m = numpy.zeros((4, 4))
        for a in range(3):
            m[a, axes[a]] = signs[a] * self.size
        m[3, :3] = self.corner + (numpy.array(origin) + 0.5 + shift) * self.size
        m[3, 3] = 1
        return m.tolist()

    def test_the_same_voxels_on_other_axes_are_the_same(self):
        for axes, signs in [((0, 1, 2), (1, 1, 1)), ((1, 2, 0), (1, 1, 1)), ((2, 1, 0), (-1, 1, -1)),
                            ((0, 2, 1), (-1, -1, -1))]:
            origin = numpy.array([7, 90, -3])
            index = numpy.empty_like(self.voxels)
            for a in range(3):
                index[:, a] = signs[a] * (self.voxels[:, axes[a]] - origin[axes[a]])
            result = self.verify(self.foreign(index, self.matrix(axes, signs, origin)))
            self.assertEqual((result["same"], result["both"]), (True, len(self.voxels)))
            # The same indices with other axes are other voxels.
            if axes != (0, 1, 2):
                self.assertFalse(self.verify(self.foreign(index, self.matrix(origin=origin)), code=1)["same"])

    def test_a_shift_by_half_a_voxel_is_rejected(self):
        text = self.verify(self.foreign(self.voxels, self.matrix(shift=-0.5)), code=2)
        self.assertRegex(text, r"its voxel centres are \(-?0\.5, -?0\.5, -?0\.5\) voxels away")

    def test_a_dropped_leaf_is_extra(self):
        leaf = self.voxels[0] >> 3
        kept = (self.voxels >> 3 != leaf).any(axis=1)
        result = self.verify(self.foreign(self.voxels[kept], self.matrix()), code=1)
        self.assertEqual((result["missing"], result["extra"]), (0, int((~kept).sum())))
        self.assertEqual(result["first_extra"][0], self.voxels[~kept][0].tolist())

    def test_tiles_are_compared_as_their_voxels(self):
        grid = self.foreign(self.voxels, self.matrix())
        grid.fill((128, 0, 0), (255, 127, 127), True)  # outside the file's grid
        grid.fill((0, 0, 0), (63, 63, 63), True)       # contains all of its voxels
        grid.prune()
        result = self.verify(grid, code=1)
        self.assertEqual((result["both"], result["missing"], result["extra"]),
                         (len(self.voxels), 128 ** 3 + 64 ** 3 - len(self.voxels), 0))

    def test_the_difference_has_the_transform_of_the_grid(self):
        moved = self.voxels[5:]
        path = self.at / "difference.vdb"
        grid = self.foreign([*moved, (60, 1, 2)], self.matrix())
        self.verify(grid, "--write-diff", path, code=1)
        for name, count in [("missing", 1), ("extra", 5)]:
            text = run("svdag-verify", "vdb", self.dag, path, "--grid", name, "--json", code=1)
            result = json.loads(text)
            if name == "extra":
                self.assertEqual((result["both"], result["missing"]), (count, 0))
            else:
                self.assertEqual((result["missing"], result["first_missing"]), (count, [[60, 1, 2]]))

    def test_a_tree_that_two_grids_share_is_read_for_both(self):
        grid = self.foreign(self.voxels, self.matrix())
        shifted = grid.copy()  # with the same tree
        shifted.name = "shifted"
        shifted.transform = pyopenvdb.createLinearTransform(self.matrix(origin=(0, 0, 1)))
        path = self.at / "shared.vdb"
        pyopenvdb.write(str(path), [grid, shifted])
        alone = self.at / "alone.vdb"
        pyopenvdb.write(str(alone), [grid])
        self.assertLess(path.stat().st_size, alone.stat().st_size + 2000)
        for name, code in [("foreign", 0), ("shifted", 1)]:
            text = run("svdag-verify", "vdb", self.dag, path, "--grid", name, "--sandbox", "--json", code=code)
            both = json.loads(text)["both"]
            (self.assertEqual if code == 0 else self.assertLess)(both, len(self.voxels))

    def test_values_of_a_float_grid_are_chosen_by_a_range(self):
        grid = self.foreign(self.voxels, self.matrix(), pyopenvdb.FloatGrid, 0.25)
        self.assertNotIn([60, 1, 2], self.voxels.tolist())
        grid.getAccessor().setValueOff((60, 1, 2), 7.0)
        self.assertIn("--iso", self.verify(grid, code=2))
        self.assertTrue(self.verify(grid, "--iso=0.1,0.5")["same"])
        self.assertEqual(self.verify(grid, "--iso=0.3,8", code=1)["both"], 0)
        self.assertEqual(self.verify(grid, "--iso=0.1,8", code=1)["missing"], 1)  # active or not
        self.assertIn("background", self.verify(grid, "--iso=-1,1", code=2))

    def test_other_types_and_nonlinear_transforms_are_rejected(self):
        grid = pyopenvdb.Vec3SGrid()
        grid.name = "foreign"
        self.assertIn("not mask, bool or float", self.verify(grid, code=3))
        grid = pyopenvdb.BoolGrid()
        grid.name = "foreign"
        grid.transform = pyopenvdb.createFrustumTransform((0, 0, 0), (10, 10, 10), 0.5, 10.0)
        self.assertIn("not linear", self.verify(grid, code=3))


class VdbImports(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="svdag-vdb-")
        self.addCleanup(folder.cleanup)
        self.at = pathlib.Path(folder.name)

    def imported(self, grid, *options):
        """(report of svdag info, path of the grid, path of the DAG)"""
        path, dag = self.at / "theirs.vdb", self.at / "ours.svdag"
        pyopenvdb.write(str(path), [grid])
        run("svdag-import", path, "-o", dag, "-q", "-m", "64M", *options)
        return json.loads(run("svdag", "info", "--json", dag)), path, dag

    def test_a_level_set_becomes_its_inside(self):
        sphere = pyopenvdb.createLevelSetSphere(radius=30, center=(3, -5, 7), voxelSize=0.5)
        array = numpy.empty((140, 140, 140))
        sphere.copyToArray(array, ijk=(-64, -80, -56))
        info, path, dag = self.imported(sphere, "--iso=-inf,0")
        self.assertEqual(info["voxels"], int((array <= 0).sum()))
        self.assertTrue(json.loads(run("svdag-verify", "vdb", dag, path, "--iso=-inf,0", "--json"))["same"])

    def test_a_float_grid_needs_a_range(self):
        sphere = pyopenvdb.createLevelSetSphere(radius=3)
        path = self.at / "theirs.vdb"
        pyopenvdb.write(str(path), [sphere])
        self.assertIn("--iso", run("svdag-import", path, "-o", self.at / "ours.svdag", code=2))

    def test_tiles_cost_nodes_and_not_voxels(self):
        low, high = (-300, -100, 7), (5000, 300, 400)
        solid = pyopenvdb.BoolGrid()
        solid.fill(low, high, True)
        solid.prune()
        info, path, dag = self.imported(solid)
        self.assertEqual(info["voxels"], math.prod(h - l + 1 for l, h in zip(low, high)))
        self.assertLess(sum(info["nodes"]), 1000)
        self.assertTrue(json.loads(run("svdag-verify", "vdb", dag, path, "--json"))["same"])


if __name__ == "__main__":
    if pyopenvdb is None:
        sys.exit(77)
    unittest.main()
