#!/usr/bin/env python3
"""Tests the Python package as it is installed: what it reads is what the programs say, what it makes has their bytes, and no
argument crashes it.

Usage: package_test.py SOURCE [TEST...], by the Python of the environment that has the package.
"""
import json
import multiprocessing
import os
import pathlib
import pickle
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import types
import unittest

import numpy as np

import svdag
from svdag import _make, _programs

SOURCE = pathlib.Path()


def program(name, *arguments, text=None):
    done = subprocess.run([_programs.program(name), *map(str, arguments)], capture_output=True, text=True, input=text)
    assert done.returncode == 0, done.stderr
    return done.stdout


def sphere_mesh(n=24):
    """A closed sphere of radius 1 around (3, 4, 5): vertices and faces."""
    u, v = np.meshgrid(np.linspace(0, np.pi, n + 1)[1:-1], np.linspace(0, 2 * np.pi, 2 * n, endpoint=False), indexing="ij")
    points = np.stack([np.sin(u) * np.cos(v), np.sin(u) * np.sin(v), np.cos(u)], -1).reshape(-1, 3)
    points = np.vstack([points, [[0, 0, 1], [0, 0, -1]]]) + [3, 4, 5]
    m, faces = 2 * n, []
    for j in range(m):
        k = (j + 1) % m
        faces.append([len(points) - 2, j, k])
        faces.append([len(points) - 1, (n - 2) * m + k, (n - 2) * m + j])
        for i in range(n - 2):
            faces += [[i * m + j, (i + 1) * m + j, (i + 1) * m + k], [i * m + j, (i + 1) * m + k, i * m + k]]
    return points, np.array(faces)


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="svdag-python-")
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.random = np.random.default_rng(1)
        cls.coords = np.unique(cls.random.integers(0, 200, (20000, 3)), axis=0)
        cls.coords = np.vstack([cls.coords, np.argwhere(np.ones((20, 20, 20), bool)) + 64])
        cls.coords = np.unique(cls.coords, axis=0)
        cls.grid = np.zeros((256, 256, 256), bool)
        cls.grid[tuple(cls.coords.T)] = True
        cls.plain = cls.folder / "plain.svdag"
        svdag.from_coords(cls.random.permutation(cls.coords), cls.plain, voxel_size=0.25, origin=(-3, 2, 7))
        cls.compact, cls.packed = cls.folder / "compact.svdag", cls.folder / "packed.svdag.pack"
        program("svdag", "convert", cls.plain, "-o", cls.compact, "--layout", "compact", "-q")
        program("svdag", "pack", cls.plain, "-o", cls.packed, "-q")
        svdag.build({"ball": sphere_mesh(), "floor": ([[0, 0, 4.5], [9, 0, 4.5], [0, 9, 4.5]], [[0, 1, 2]])},
                    path=cls.folder / "layers.svdag", resolution=128)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def every(self):
        return [svdag.open(path) for path in (self.plain, self.compact, self.packed)]


class Reading(Files):
    def test_attributes_are_those_of_info(self):
        printed = json.loads(program("svdag", "info", self.plain, "--json"))
        for file in self.every():
            self.assertEqual((file.resolution, file.levels, file.voxels, file.voxel_size, file.rule),
                             (256, 8, len(self.coords), 0.25, "conservative"))
            self.assertEqual(file.content_hash, printed["content_hash"])
            np.testing.assert_array_equal(file.origin, [-3, 2, 7])
            np.testing.assert_array_equal(file.bounds, [[-3, 2, 7], [61, 66, 71]])
            np.testing.assert_array_equal(file.occupied_bounds.ravel(), printed["occupied"]["bounds"])
            self.assertEqual(file.layers, [])
            self.assertIn("256^3", repr(file))
        self.assertEqual([f.layout for f in self.every()], ["plain", "compact", "plain"])
        self.assertEqual(svdag.__version__, program("svdag", "--version").split()[1])

    def test_windows_are_the_grid(self):
        for file in self.every():
            np.testing.assert_array_equal(file.window((0, 0, 0), (256, 256, 256)), self.grid)
            for _ in range(50):
                low = self.random.integers(-30, 250, 3)
                high = low + self.random.integers(0, 70, 3)
                expected = np.zeros(high - low, bool)
                inside = [slice(max(0, a), max(0, min(256, b))) for a, b in zip(low, high)]
                part = self.grid[tuple(inside)]
                at = [slice(s.start - a, s.start - a + n) for s, a, n in zip(inside, low, part.shape)]
                if part.size:
                    expected[tuple(at)] = part
                window = file.window(low, high)
                np.testing.assert_array_equal(window, expected)
                self.assertTrue(window.flags["C_CONTIGUOUS"] and window.dtype == bool)
                self.assertEqual(file.count(low, high), expected.sum())
                self.assertEqual(file.box_occupied(low, high), expected.any())
                np.testing.assert_array_equal(np.sort(file.coords(low, high), 0), np.sort(np.argwhere(expected) + low, 0))

    def test_levels_are_the_grid_made_coarser(self):
        file = svdag.open(self.compact)
        for level in range(3, 9):
            step = 256 >> level
            coarse = self.grid.reshape([256 // step, step] * 3).any((1, 3, 5))
            np.testing.assert_array_equal(file.window((0, 0, 0), (2 ** level,) * 3, level=level), coarse)
            self.assertEqual(file.count(level=level), coarse.sum())
            voxels = file.coords(level=level)
            self.assertEqual(voxels.dtype, np.int32)
            np.testing.assert_array_equal(np.unique(voxels, axis=0), np.argwhere(coarse))

    def test_points_of_both_kinds(self):
        points = self.random.integers(-20, 280, (50000, 3))
        inside = ((points >= 0) & (points < 256)).all(1)
        expected = np.zeros(len(points), bool)
        expected[inside] = self.grid[tuple(points[inside].T)]
        for file in self.every():
            for dtype in (np.int64, np.int32, np.int16):
                np.testing.assert_array_equal(file.occupied(points.astype(dtype)), expected)
            world = file.origin + (points + self.random.uniform(0.01, 0.99, points.shape)) * file.voxel_size
            np.testing.assert_array_equal(file.occupied(world), expected)
            far = [[np.nan, 0, 0], [np.inf, 0, 0], [-np.inf, 1, 1], [1e300, 0, 0]]
            self.assertFalse(file.occupied(far).any())
            self.assertFalse(file.occupied(np.array([[2 ** 63 - 1, 0, 0], [-2 ** 63, 0, 0], [2 ** 32, 0, 0]])).any())
            self.assertFalse(file.occupied(np.array([[2 ** 64 - 1, 0, 0]], np.uint64)).any())

    def test_a_ball_touches_what_is_near(self):
        file = svdag.open(self.plain)
        for _ in range(20):
            center, radius = self.random.uniform(-10, 266, 3), self.random.uniform(0, 60)
            off = np.maximum(np.maximum(self.coords - center, center - (self.coords + 1)), 0)
            near = self.coords[(off ** 2).sum(1) <= radius ** 2]
            np.testing.assert_array_equal(np.unique(file.sphere(center, radius).reshape(-1, 3), axis=0), near)

    def nearest_of_all(self, coords, points):
        """The numbers and distances, in voxels, of the nearest voxels; of several, the first."""
        numbers, distances = [], []
        for point in points:
            off = np.maximum(np.maximum(coords - point, point - (coords + 1)), 0)
            squares = (off ** 2).sum(1)
            numbers.append(squares.argmin())
            distances.append(np.sqrt(squares.min()))
        return np.array(numbers), np.array(distances)

    def test_the_nearest_voxel_is_that_of_a_search_of_all(self):
        points = np.vstack([self.random.uniform(-100, 350, (150, 3)), self.random.uniform(60, 90, (150, 3))])
        points = np.round(points * 1024) / 1024
        voxels = self.random.integers(-9, 250, (200, 3))
        for file in self.every():
            coords = file.coords()
            for given, middles in [(file.origin + points * file.voxel_size, points), (voxels, voxels + 0.5)]:
                numbers, distances = self.nearest_of_all(coords, middles)
                found, away = file.nearest(given)
                self.assertEqual((found.dtype, away.dtype), (np.int32, np.float64))
                np.testing.assert_array_equal(found, coords[numbers])
                np.testing.assert_allclose(away, distances * file.voxel_size, rtol=1e-12, atol=0)
                limit = float(np.median(away))
                found, within = file.nearest(given, max_distance=limit)
                np.testing.assert_array_equal(within, np.where(away <= limit, away, np.inf))
                np.testing.assert_array_equal(found[away > limit], -1)
            self.assertFalse(np.isfinite(file.nearest([[np.nan, 0, 0], [np.inf, 0, 0], [0, -1e300, 0]])[1]).any())
            self.assertFalse(np.isfinite(file.nearest(np.array([[2 ** 63, 0, 0]], np.uint64))[1]).any())
            with self.assertRaises(ValueError):
                file.nearest([[0, 0, 0]], max_distance=-1)
        lines = program("svdag", "query", self.plain, "--nearest", text="".join("{} {} {}\n".format(*p) for p in points)).splitlines()
        away = svdag.open(self.plain).nearest(points)[1]
        self.assertEqual([float(line.split()[1]) for line in lines], list(away))

    def test_the_nearest_voxel_of_a_layer(self):
        with svdag.open(self.folder / "layers.svdag") as file:
            point = file.origin + self.random.uniform(-10, 140, (40, 3)) * file.voxel_size
            for layer in ("ball", "floor"):
                coords = file.coords(layer=layer)
                numbers, distances = self.nearest_of_all(coords, (point - file.origin) / file.voxel_size)
                found, away = file.nearest(point, layer=layer)
                np.testing.assert_allclose(away, distances * file.voxel_size, rtol=0, atol=2 ** -22 * file.voxel_size)
                self.assertTrue(file.occupied(found, layer=layer).all())

    def test_bricks_are_all_voxels_in_any_chunk(self):
        for file in self.every():
            for chunk in (1, 7, 1 << 16):
                if chunk == 1 and file.layout == "compact":
                    continue
                found, order = [], []
                for corners, words in file.bricks((60, 0, 0), (120, 256, 90), chunk=chunk):
                    cubes = svdag.unpack_bricks(words)
                    self.assertTrue((words != 0).all())
                    brick, *at = np.nonzero(cubes)
                    found.append(corners[brick] + np.stack(at, 1))
                    order += [tuple(c) for c in corners]
                self.assertEqual(len(order), len(set(order)))
                voxels = np.concatenate(found)
                inside = ((self.coords >= [60, 0, 0]) & (self.coords < [120, 256, 92])).all(1)
                np.testing.assert_array_equal(np.unique(voxels, axis=0), self.coords[inside])

    def test_rays_hit_what_svdag_trace_hits(self):
        for path in (self.plain, self.compact):
            dump = self.folder / "hits.bin"
            camera = (-40, 10, 60, 20, 30, 30, 50)
            program("svdag-trace", path, "--size", "320x200", "--camera=" + ",".join(map(str, camera)), "--dump", dump,
                    "--samples", "1")
            printed = np.fromfile(dump, [("found", "u4"), ("voxel", "u4", 3), ("level", "u4"), ("axis", "u4"), ("t", "f8"),
                                      ("rest", "u4", 6)])
            eye, target = np.array(camera[:3], float), np.array(camera[3:6], float)
            forward = (target - eye) / np.linalg.norm(target - eye)
            right = np.cross(forward, [0, 1, 0])
            right /= np.linalg.norm(right)
            slope = np.tan(np.radians(camera[6] / 2))
            y, x = np.mgrid[0:200, 0:320]
            across, down = (2 * (x + .5) / 320 - 1) * slope * 1.6, (1 - 2 * (y + .5) / 200) * slope
            rays = forward + across[..., None] * right + down[..., None] * np.cross(right, forward)
            hits = svdag.open(path).trace(eye, rays.reshape(-1, 3))
            found = np.isfinite(hits.t)
            self.assertGreater(found.mean(), 0.2)
            # The rays are rounded otherwise here: a few pixels in a hundred thousand may differ.
            self.assertLess((found != (printed["found"] == 1)).mean(), 1e-4)
            both = found & (printed["found"] == 1)
            self.assertLess((hits.voxel[both] != printed["voxel"][both]).any(1).mean(), 1e-3)
            normal = hits.normal[both]
            self.assertLess((np.abs(normal).argmax(1) != printed["axis"][both]).mean(), 1e-3)
            self.assertTrue((np.einsum("ij,ij->i", normal, rays.reshape(-1, 3)[both]) <= 0).all())
            point = eye + hits.t[both, None] * rays.reshape(-1, 3)[both]
            middle = svdag.open(path).origin + (hits.voxel[both] + 0.5) * 0.25
            self.assertLess(np.abs(point - middle).max(), 0.126)

    def test_rays_end_at_tmax(self):
        file = svdag.open(self.plain)
        hits = file.trace([-3 + 70 * 0.25, 2 + 70 * 0.25, 0], [0, 0, 1])
        self.assertTrue(np.isfinite(hits.t[0]))
        self.assertTrue(np.isfinite(file.trace([-3 + 70 * 0.25, 2 + 70 * 0.25, 0], [0, 0, 1], tmax=hits.t[0] + 1e-9).t[0]))
        missed = file.trace([-3 + 70 * 0.25, 2 + 70 * 0.25, 0], [0, 0, 1], tmax=hits.t[0] - 1e-9)
        self.assertEqual((missed.t[0], *missed.voxel[0], *missed.normal[0], missed.layer[0]), (np.inf, -1, -1, -1, 0, 0, 0, -1))

    def test_layers_are_those_of_the_file(self):
        with svdag.open(self.folder / "layers.svdag") as file:
            self.assertEqual([layer.name for layer in file.layers], ["ball", "floor"])
            whole = file.window((0, 0, 0), (128,) * 3)
            parts = [file.window((0, 0, 0), (128,) * 3, layer=i) for i in range(2)]
            np.testing.assert_array_equal(whole, parts[0] | parts[1])
            for part, layer in zip(parts, file.layers):
                self.assertEqual(part.sum(), layer.voxels)
                self.assertEqual(file.count(layer=layer.name), layer.voxels)
            hits = file.trace([[3, 4, 9], [1, 1, 9], [8, 8, 9]], [0, 0, -1.0])
            np.testing.assert_array_equal(hits.layer, [0, 1, -1])
            np.testing.assert_array_equal(file.trace([3, 4, 9], [0, 0, -1.0], layer="floor").layer, [1])
            with self.assertRaises(KeyError):
                file.count(layer="roof")
            with self.assertRaises(IndexError):
                file.count(layer=2)

    def test_a_closed_file_is_refused(self):
        file = svdag.open(self.plain)
        file.close()
        with self.assertRaisesRegex(ValueError, "closed"):
            file.count()

    def test_threads_share_a_file(self):
        file = svdag.open(self.compact)
        points = self.random.integers(0, 256, (100000, 3))
        expected, wrong = self.grid[tuple(points.T)], []

        def look():
            for _ in range(5):
                if not (file.occupied(points) == expected).all():
                    wrong.append(1)
        threads = [threading.Thread(target=look) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])

    def test_opening_takes_little_memory(self):
        big = self.folder / "big.svdag"
        svdag.from_coords(self.random.integers(0, 2 ** 14, (1000000, 3)), big)

        def own_kilobytes():
            return int(re.search(r"RssAnon:\s+(\d+)", pathlib.Path("/proc/self/status").read_text()).group(1))
        svdag.open(self.plain)
        before = own_kilobytes()
        file = svdag.open(big)
        self.assertGreater(big.stat().st_size, 10 << 20)
        self.assertLess(own_kilobytes() - before, 1024)
        del file


class Making(Files):
    def test_a_build_has_the_bytes_of_the_program(self):
        vertices, faces = sphere_mesh()
        ply = self.folder / "scene.ply"
        _make.write_ply(ply, vertices, faces)
        for options, words in [({"resolution": "256"}, ["-r", "256"]), ({"voxel_size": 0.1, "rule": "thin"}, ["-s", "0.1", "--rule", "thin"]),
                               ({"resolution": 128, "rule": "solid", "layout": "compact", "bounds": (3, 4, 5, 9, 9, 9)},
                                ["-r", "128", "--rule", "solid", "--layout", "compact", "--bounds=3,4,5,9,9,9"])]:
            report = svdag.build(vertices, faces, self.folder / "a.svdag", **options)
            program("svdag", "build", ply, "-o", self.folder / "b.svdag", "-q", *words)
            self.assertEqual((self.folder / "a.svdag").read_bytes(), (self.folder / "b.svdag").read_bytes())
            self.assertEqual(report["content_hash"], svdag.open(self.folder / "a.svdag").content_hash)
        self.assertEqual([p.name for p in self.folder.iterdir() if p.name.startswith(".")], [])

    def test_arrays_of_any_kind_make_the_same_file(self):
        vertices, faces = sphere_mesh()
        svdag.build(vertices, faces, self.folder / "a.svdag", resolution=64)
        wide = np.zeros((len(vertices), 5))
        wide[:, 1:4] = vertices
        for v, f in [(wide[:, 1:4], faces[:, ::1]), (np.asfortranarray(vertices), faces.astype(np.uint8) if len(vertices) < 256 else faces),
                     (vertices.tolist(), faces.tolist()), (vertices[::-1], len(vertices) - 1 - faces)]:
            svdag.build(v, f, self.folder / "b.svdag", resolution=64)
            self.assertTrue(svdag.diff(self.folder / "a.svdag", self.folder / "b.svdag")["same"])

    def test_an_object_with_vertices_and_faces_is_a_mesh(self):
        vertices, faces = sphere_mesh()
        mesh = type("Trimesh", (), {"vertices": vertices, "faces": faces})()
        svdag.build(vertices, faces, self.folder / "a.svdag", resolution=64)
        svdag.build(mesh, path=self.folder / "b.svdag", resolution=64)
        self.assertTrue(svdag.diff(self.folder / "a.svdag", self.folder / "b.svdag")["same"])
        svdag.build({"ball": mesh}, path=self.folder / "b.svdag", resolution=64)
        self.assertEqual(svdag.open(self.folder / "b.svdag").layers[0].name, "ball")

    def test_coordinates_have_the_bytes_of_an_import(self):
        npz = self.folder / "coords.npz"
        svdag.export(self.plain, npz)
        again = self.folder / "again.svdag"
        program("svdag", "import", npz, "-o", again, "-q")
        self.assertEqual(svdag.open(again).content_hash, svdag.open(self.plain).content_hash)
        for options in ({"layout": "compact"}, {"resolution": 1024}, {"rule": "thin"}):
            svdag.from_coords(self.coords, again, **options)
            self.assertIn("sound", program("svdag-verify", "check", again))
        svdag.from_array(self.grid, again, voxel_size=0.25, origin=(-3, 2, 7))
        self.assertEqual(svdag.open(again).content_hash, svdag.open(self.plain).content_hash)
        self.assertEqual(svdag.from_coords(np.zeros((0, 3), int), again)["voxels"], 0)
        self.assertEqual(svdag.open(again).count(), 0)

    def test_a_file_is_verified_and_compared(self):
        vertices, faces = sphere_mesh()
        ply = self.folder / "scene.ply"
        _make.write_ply(ply, vertices, faces)
        svdag.build_files(ply, self.folder / "a.svdag", resolution=64)
        self.assertTrue(svdag.verify_mesh(self.folder / "a.svdag", ply)["ok"])
        _make.write_ply(ply, vertices + 0.05, faces)
        self.assertFalse(svdag.verify_mesh(self.folder / "a.svdag", [ply])["ok"])
        other = self.folder / "b.svdag"
        svdag.build_files([ply], other, resolution=64, rule="thin")
        self.assertTrue(svdag.diff(other, other)["same"])
        self.assertFalse(svdag.diff(other, self.folder / "a.svdag", by_index=True)["same"])

    def test_progress_is_reported(self):
        printed = []
        vertices, faces = sphere_mesh(60)
        svdag.build(vertices, faces, self.folder / "a.svdag", resolution="2K", progress=lambda phase, share: printed.append((phase, share)))
        self.assertTrue(printed and all(phase and 0 <= share <= 1 for phase, share in printed), printed)

    def seconds_after_interrupt(self, name, call):
        sent = []

        def interrupt():
            time.sleep(0.25)
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)
        # A process in the background, as of nohup, ignores interrupts.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        thread = threading.Thread(target=interrupt)
        thread.start()
        try:
            with self.assertRaises(KeyboardInterrupt, msg=name):
                call()
                time.sleep(2)  # it was faster than the interrupt
            return time.monotonic() - sent[0]
        finally:
            thread.join()

    def test_interrupts_end_within_a_tenth_of_a_second(self):
        vertices, faces = sphere_mesh(200)
        coords = self.random.integers(0, 2 ** 16, (8000000, 3)).astype(np.uint32)
        file = svdag.open(self.folder / "plain.svdag")
        origins = self.random.uniform(0, 60, (4000000, 3))
        solid = self.folder / "solid.svdag"
        svdag.from_array(np.ones((256,) * 3, bool), solid)
        full = svdag.open(solid)
        # A floor, and a box of the empty voxels in its bricks: no voxel is found in 67 million.
        floor = self.folder / "floor.svdag"
        svdag.build([[0, 0, 0.3], [1, 0, 0.3], [1, 1, 0.3], [0, 1, 0.3]], [[0, 1, 2], [0, 2, 3]], floor, resolution="32K",
                    cube=(0, 0, 0, 1))
        flat = svdag.open(floor)
        z = flat.occupied_voxels[:, 2]
        low, high = (z[1], -(-z[1] // 4) * 4) if z[1] % 4 else (z[0] // 4 * 4, z[0])
        slab = (0, 0, int(low)), (2 ** 15, 2 ** 15, int(high))
        self.assertLess(slab[0][2], slab[1][2])
        calls = {"box_occupied": lambda: flat.box_occupied(*slab), "count": lambda: flat.count(*slab),
                 "bricks": lambda: [None for _ in flat.bricks(chunk=1 << 26)], "build": lambda: svdag.build(vertices, faces, self.folder / "i.svdag", resolution="32K"),
                 "from_coords": lambda: svdag.from_coords(coords, self.folder / "i.svdag"),
                 "coords": lambda: full.coords(),
                 "trace": lambda: file.trace(origins, [0.3, 0.5, 0.7])}
        for name, call in calls.items():
            for attempt in range(8):  # a busy machine is late itself
                seconds = self.seconds_after_interrupt(name, call)
                if seconds < 0.1:
                    break
            print(f"{name} ended {1000 * seconds:.0f} ms after Ctrl-C", file=sys.stderr)
            self.assertLess(seconds, 0.1)
        self.assertFalse((self.folder / "i.svdag").exists())
        self.assertEqual(file.count(), len(self.coords))  # all goes on


class Programs(Files):
    def hash_of(self, path):
        return json.loads(program("svdag", "info", path, "--json"))["content_hash"]

    def test_edit_convert_and_pack_give_the_files_and_reports_of_the_program(self):
        made = self.folder / "made.svdag"
        for call, *line in [
                (lambda: svdag.edit(self.plain, output=made, level=5), "edit", self.plain, "--level", "5"),
                (lambda: svdag.edit(svdag.open(self.plain), self.compact, output=made, intersection=True), "edit", self.plain,
                 self.compact, "--intersection"),
                (lambda: svdag.convert(self.folder / "layers.svdag", made, layer=["floor", "ball"], layout="compact"), "convert",
                 self.folder / "layers.svdag", "--layer", "floor", "--layer", "ball", "--layout", "compact"),
                (lambda: svdag.unpack(self.packed, made), "unpack", self.packed)]:
            report = call()
            expected = self.folder / "expected.svdag"
            program("svdag", *line, "-o", expected, "-q")
            self.assertEqual(made.read_bytes(), expected.read_bytes())
            file = svdag.open(made)
            self.assertEqual((report["voxels"], report["levels"], report["content_hash"], report["file_bytes"]),
                             (file.voxels, file.levels, file.content_hash, made.stat().st_size))
        report = svdag.pack(self.compact, self.folder / "again.pack")
        self.assertEqual((self.folder / "again.pack").read_bytes(), self.packed.read_bytes())
        self.assertEqual(report["file_bytes"], self.packed.stat().st_size)

    def test_import_is_the_way_back_from_export(self):
        report = svdag.export(self.plain, self.folder / "a.npz")
        self.assertEqual((report["format"], report["voxels"]), ("npz", len(self.coords)))
        report = svdag.import_file(self.folder / "a.npz", self.folder / "back.svdag")
        self.assertEqual(report["voxels"], len(self.coords))
        self.assertTrue(svdag.diff(self.plain, self.folder / "back.svdag")["same"])

    def test_a_surface_encloses_the_voxels(self):
        side = svdag.open(self.plain).voxel_size
        for options in {"no_merge": True}, {"level": 5}, {}:
            mesh = svdag.to_mesh(self.plain, **options)
            with svdag.open(self.plain, level=options.get("level")) as file:
                enclosed = file.voxels * (side * 2 ** (svdag.open(self.plain).levels - file.levels)) ** 3
            a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
            self.assertAlmostEqual(np.einsum("ij,ij->", a, np.cross(b, c)) / 6 / enclosed, 1, 9)
        self.assertIsNone(mesh.colours)
        with svdag.from_coords([[1, 2, 3], [4, 5, 6]], self.folder / "two.svdag") and svdag.open(self.folder / "two.svdag") as two:
            faces = svdag.to_mesh(two).faces
        self.assertEqual(faces.shape, (24, 3))
        edges = [tuple(face[[i, (i + 1) % 3]]) for face in faces for i in range(3)]
        self.assertEqual(sorted(edges), sorted((b, a) for a, b in edges))
        colours = svdag.to_mesh(self.folder / "layers.svdag").colours
        self.assertEqual({tuple(c) for c in colours.tolist()}, {layer.colour for layer in svdag.open(self.folder / "layers.svdag").layers})
        with self.assertRaisesRegex(svdag.Error, "quads"):
            svdag.to_mesh(self.plain, max_quads=3)

    def test_colours_of_vertices_are_baked(self):
        mesh = svdag.to_mesh(self.folder / "layers.svdag", level=5)
        svdag.build(mesh, self.folder / "again.svdag", resolution=64, colours=True, colour_error=0)
        with svdag.open(self.folder / "again.svdag") as file:
            found = {tuple(c) for c in file.colours(file.coords()).tolist()}
        self.assertLessEqual({layer.colour for layer in svdag.open(self.folder / "layers.svdag").layers}, found)
        with svdag.build({"all": mesh}, resolution=64) as file:
            self.assertEqual([layer.name for layer in file.layers], ["all"])
        with self.assertRaisesRegex(TypeError, "colours: an array"):
            svdag.build(mesh, resolution=64, colours=mesh.colours)
        with self.assertRaisesRegex(ValueError, "shape"):
            svdag.build(mesh._replace(colours=mesh.colours[1:]), resolution=64)
        with self.assertRaisesRegex(TypeError, "not a mesh"):
            svdag.build(type("Scene", (), {"geometry": {}})(), resolution=64)

    def test_distances_are_those_to_the_set_voxels(self):
        report = svdag.export(self.plain, self.folder / "distances.npz", distance=5, level=5)
        found = np.load(self.folder / "distances.npz")
        self.assertEqual(report["distances"], 32 ** 3)
        with svdag.open(self.plain, level=5) as file:
            coords = file.coords()
            self.assertTrue((found["corner"] == file.origin).all() and found["voxel_size"] == file.voxel_size)
        for at in self.random.integers(0, 32, (200, 3)):
            square = min(25, ((coords - at) ** 2).sum(1).min())
            self.assertEqual(found["distance"][tuple(at)], np.sqrt(np.float32(square)))

    def test_points_set_the_voxels_that_hold_them(self):
        points = self.random.uniform(-9, 9, (5000, 3))
        points[:20] = np.floor(points[:20])
        colours = self.random.integers(0, 256, points.shape, np.uint8)
        report = svdag.from_points(points, self.folder / "points.svdag", voxel_size=0.5, colours=colours)
        self.assertEqual(report["points"], len(points))
        cells, counts = np.unique(np.floor(points / 0.5), axis=0, return_counts=True)
        with svdag.open(self.folder / "points.svdag") as file:
            self.assertEqual((file.rule, file.voxels), ("points", len(cells)))
            self.assertTrue(file.occupied(points).all())
        with svdag.from_points(points, resolution="1K", min_points=2) as file:
            self.assertLess(file.voxels, len(points))
        self.assertEqual(svdag.from_points(points, self.folder / "points.svdag", voxel_size=0.5, min_points=3)["voxels"],
                         (counts >= 3).sum())
        with self.assertRaises(ValueError):
            svdag.from_points(points, voxel_size=0.5, colours=colours[1:])
        with self.assertRaises(svdag.Error):
            svdag.from_points(points)

    def test_info_is_that_of_the_program(self):
        printed = json.loads(program("svdag", "info", self.folder / "layers.svdag", "--layers", "--json"))
        with svdag.open(self.folder / "layers.svdag") as file:
            self.assertEqual(svdag.info(file, layers=True), printed)
        with self.assertRaises(svdag.Error):
            svdag.info(self.folder / "none.svdag")

    def test_a_result_in_memory_is_that_of_a_path(self):
        mesh = sphere_mesh()
        report = svdag.build(*mesh, self.folder / "a.svdag", resolution=64)
        files = lambda: {*pathlib.Path(tempfile.gettempdir()).glob("svdag-memory-*"), *pathlib.Path("/dev/shm").glob("svdag-memory-*")}  # noqa: E731
        before = files()
        with svdag.build(*mesh, resolution=64) as file:
            self.assertEqual(files(), before)  # the file has no name
            self.assertEqual((file.path, file.content_hash), (None, self.hash_of(self.folder / "a.svdag")))
            self.assertEqual(file.report["voxels"], report["voxels"])
            self.assertIn("in memory", repr(file))
            for use in (lambda: pickle.dumps(file), lambda: svdag.info(file)):
                with self.assertRaisesRegex((TypeError, ValueError), "in memory"):
                    use()
        np.testing.assert_array_equal(svdag.from_coords(self.coords).coords(), svdag.open(self.plain).coords())
        self.assertEqual(svdag.from_array(np.ones((8, 8, 8), bool)).report["voxels"], 512)
        _make.write_ply(self.folder / "ball.ply", *mesh)
        self.assertEqual(svdag.build_files(self.folder / "ball.ply", resolution=64).voxels, report["voxels"])
        for scene in ({"ball": mesh}, types.SimpleNamespace(vertices=mesh[0], faces=mesh[1])):
            with self.assertRaisesRegex(TypeError, "path="):
                svdag.build(scene, mesh[1], self.folder / "a.svdag", resolution=64)
            report = svdag.build(scene, self.folder / "named.svdag", resolution=64)
            self.assertEqual(report["output"], str(self.folder / "named.svdag"))
            (self.folder / "named.svdag").unlink()
        with self.assertRaises(svdag.Error) as caught:
            svdag.build({"hull": ([[np.nan, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])}, resolution=64)
        self.assertTrue(str(caught.exception).startswith("hull: "), caught.exception)
        self.assertEqual(files(), before)

    def test_a_result_that_does_not_fit_in_memory_is_a_temporary_file(self):
        tried = []

        def make(output):
            tried.append(output)
            if output.startswith(_make._MEMORY):
                raise svdag.Error("no space is left", 4)
            return svdag.from_coords([[1, 2, 3]], output)
        self.assertEqual(_make.made(None, make, 1).voxels, 1)
        self.assertEqual(_make.made(None, make, 1 << 40).voxels, 1)
        self.assertFalse(tried[-1].startswith(_make._MEMORY))

    def test_a_file_is_pickled_by_its_path(self):
        file = svdag.open(self.folder / "layers.svdag", layers=["floor"], level=6)
        again = pickle.loads(pickle.dumps(file))
        self.assertEqual(again.content_hash, file.content_hash)
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            self.assertEqual(pool.apply(svdag.File.count, [file]), file.count())
        file.close()
        with self.assertRaisesRegex(ValueError, "closed"):
            pickle.dumps(file)

    def test_threads_change_no_answer(self):
        file = svdag.open(self.plain)
        points = self.random.uniform(*file.bounds, (5000, 3))
        box = (3, 5, 7), (200, 180, 190)
        for threads in (1, 3):
            np.testing.assert_array_equal(file.window(*box, threads=threads), file.window(*box))
            np.testing.assert_array_equal(file.occupied(points, threads=threads), file.occupied(points))
            np.testing.assert_array_equal(file.nearest(points, threads=threads)[1], file.nearest(points)[1])
            np.testing.assert_array_equal(file.trace(points, [0, 0, 1], threads=threads).t, file.trace(points, [0, 0, 1]).t)
        for threads in (0, -1, 2 ** 40):
            with self.assertRaisesRegex(ValueError, "threads"):
                file.occupied(points, threads=threads)

    def test_centres_are_the_middles_of_coords(self):
        file = svdag.open(self.plain)
        np.testing.assert_allclose(file.centres(), file.origin + (file.coords() + 0.5) * 0.25)
        np.testing.assert_allclose(file.centres((0, 0, 0), (16, 16, 16), level=5),
                                   file.origin + (file.coords((0, 0, 0), (16, 16, 16), level=5) + 0.5) * 2)
        self.assertTrue(file.occupied(file.centres()).all())


class Colours(unittest.TestCase):
    """The colours of a file are those of the plain reader of tests, which is written from docs/format.md, and of `svdag query`."""

    @classmethod
    def setUpClass(cls):
        sys.path.insert(0, str(SOURCE / "tests" / "io" / "dag"))
        import read_svdag
        cls.temporary = tempfile.TemporaryDirectory(prefix="svdag-python-")
        cls.addClassCleanup(cls.temporary.cleanup)
        folder = pathlib.Path(cls.temporary.name)
        points, faces = sphere_mesh()
        with (folder / "ball.obj").open("w") as file:
            for point in points:
                file.write("v {} {} {} {} {} {}\n".format(*point, *((point - [2, 3, 4]) / 2)))
            file.writelines("f {} {} {}\n".format(*face) for face in faces + 1)
        svdag.build_files(folder / "ball.obj", folder / "bare.svdag", resolution=64, rule="solid")
        cls.paths = []
        for layout in ("plain", "compact"):
            for level in (6, 5, 3):
                cls.paths.append(folder / f"{layout}{level}.svdag")
                svdag.build_files(folder / "ball.obj", cls.paths[-1], resolution=64, rule="solid", colours=True, layout=layout,
                                  colour_level=level)
        cls.files = [svdag.open(path) for path in cls.paths]
        cls.readers = [read_svdag.Svdag(path.read_bytes()) for path in cls.paths]
        cls.bare = svdag.open(folder / "bare.svdag")

    @staticmethod
    def expected(reader, window, level, fill):
        """What each cube of a level shows: its own colour, or that of the next coarser cube that has one."""
        shown = min(level, reader.K)
        shown -= (reader.K - shown) % 2
        colours = np.full((*window.shape, 3), fill, np.uint8)
        for cube in np.argwhere(window):
            colour = reader.colours.get((shown, *(int(c) >> level - shown for c in cube)))
            if colour is not None:
                colours[tuple(cube)] = list(bytes.fromhex(colour))
        return colours

    def test_points_and_windows_of_every_level(self):
        for file, reader in zip(self.files, self.readers):
            for level in range(3, 7):
                side, fill = 2 ** level, (1, 2, 3)
                expected = self.expected(reader, file.window((0,) * 3, (side,) * 3, level=level), level, fill)
                cubes = np.argwhere(np.ones((side,) * 3))
                middles = file.origin + (cubes + 0.5) * (file.resolution * file.voxel_size / side)
                for points in (cubes, cubes.astype(np.uint16), middles):
                    np.testing.assert_array_equal(file.colours(points, level=level, fill=fill), expected.reshape(-1, 3))
                np.testing.assert_array_equal(file.window_colours((0,) * 3, (side,) * 3, level=level, fill=fill), expected)
                window = file.window_colours((-3, 1, 2), (side - 1, side + 5, side), level=level)
                np.testing.assert_array_equal(window[3:, :-5], file.window_colours((0, 1, 2), (side - 1, side, side), level=level))
                self.assertFalse(window[:3].any() or window[:, -5:].any())
            full = file.window((0,) * 3, (64,) * 3) & (file.window_colours((0,) * 3, (64,) * 3) == 0).all(-1)
            self.assertTrue(reader.K < 5 or full.any())  # the inside of the ball has no colour

    def test_points_are_those_of_query(self):
        file, path = self.files[0], self.paths[0]
        points = np.random.default_rng(3).uniform(*file.bounds, (2000, 3))
        lines = program("svdag", "query", path, text="".join("{!r} {!r} {!r}\n".format(*map(float, p)) for p in points)).splitlines()
        colours = file.colours(points, fill=(9, 9, 9))
        for line, colour, is_set in zip(lines, colours, file.occupied(points)):
            self.assertEqual(line.startswith("set"), is_set)
            if line.split()[-1].startswith("#"):
                self.assertEqual(line.split()[-1], "#" + bytes(colour).hex())
            else:
                np.testing.assert_array_equal(colour, [9, 9, 9])

    def test_rays_have_the_colour_of_their_voxel(self):
        file = self.files[1]
        hits = file.trace(np.random.default_rng(4).uniform([1.5, 2.5, 9], [4.5, 5.5, 9], (500, 3)), [0, 0, -1.0])
        found = np.isfinite(hits.t)
        self.assertTrue(found.any() and not found.all())
        np.testing.assert_array_equal(hits.colour[found], file.colours(hits.voxel[found]))
        self.assertTrue(hits.colour[found].any(1).all())
        self.assertFalse(hits.colour[~found].any())

    def test_what_a_program_leaves_out_is_a_warning(self):
        with self.assertWarnsRegex(UserWarning, "colours are left out") as caught:
            svdag.edit(*self.paths[:2], output=self.paths[0].with_name("union.svdag"), union=True)
        self.assertEqual(caught.filename, __file__)

    def test_a_file_without_colours_and_a_wrong_fill_are_refused(self):
        for call in (lambda: self.bare.colours([[0, 0, 0]]), lambda: self.bare.window_colours((0,) * 3, (8,) * 3),
                     lambda: self.bare.trace([3, 4, 9], [0, 0, -1.0]).colour):
            with self.assertRaisesRegex(ValueError, "no colours"):
                call()
        for fill in ((0, 0, 256), (-1, 0, 0), (0, 0)):
            with self.assertRaisesRegex(ValueError, "fill"):
                self.files[0].colours([[0, 0, 0]], fill=fill)


class Refusals(Files):
    def test_errors_have_a_code_a_path_and_the_sentence(self):
        missing = self.folder / "missing.svdag"
        with self.assertRaises(svdag.Error) as caught:
            svdag.open(missing)
        self.assertEqual((caught.exception.code, caught.exception.path), (3, str(missing)))
        printed = subprocess.run([_programs.program("svdag"), "info", missing], capture_output=True, text=True).stderr
        self.assertEqual(printed.strip(), f"svdag: {caught.exception}")
        damaged = self.folder / "damaged.svdag"
        damaged.write_bytes(self.plain.read_bytes()[:-1])
        with self.assertRaises(svdag.Error):
            svdag.open(damaged)
        with self.assertRaises(svdag.Error) as caught:
            svdag.build(*sphere_mesh(), self.folder / "a.svdag", resolution=64, rool="thin")
        self.assertEqual(caught.exception.code, 2)
        self.assertIn("rool", str(caught.exception))
        self.assertNotIn("--", str(caught.exception))
        self.assertIsInstance(caught.exception, ValueError)
        with self.assertRaises(svdag.Error) as caught:
            svdag.build_files(self.folder / "no.ply", self.folder / "a.svdag", resolution=64)
        self.assertEqual((caught.exception.code, caught.exception.path), (3, str(self.folder / "no.ply")))
        with self.assertRaises(svdag.Error) as caught:
            svdag.from_coords([[0, 0, 0]], self.folder / "none" / "a.svdag")
        self.assertEqual(caught.exception.code, 4)
        self.assertTrue(issubclass(svdag.Error, Exception))

    def test_a_wrong_option_is_a_value_error_that_names_the_argument(self):
        for call, name in [(lambda: svdag.build(*sphere_mesh(), self.folder / "a.svdag", voxel_size=-1), "voxel_size"),
                           (lambda: svdag.build(*sphere_mesh(), self.folder / "a.svdag", resolution=7), "resolution"),
                           (lambda: svdag.open(self.plain, level=99), "level"),
                           (lambda: svdag.build({}, path=self.folder / "a.svdag", resolution=64), "no mesh"),
                           (lambda: svdag.build({"..": sphere_mesh()}, path=self.folder / "a.svdag", resolution=64), "layer")]:
            with self.assertRaisesRegex(ValueError, name) as caught:
                call()
            self.assertNotIn("--", str(caught.exception))

    def test_an_error_of_arrays_names_no_file_of_the_package(self):
        with self.assertRaises(svdag.Error) as caught:
            svdag.build({"hull": ([[np.nan, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])}, path=self.folder / "a.svdag", resolution=64)
        self.assertTrue(str(caught.exception).startswith("hull: "), caught.exception)
        self.assertEqual((caught.exception.code, caught.exception.path), (3, "hull"))

    def test_types_that_would_be_cut_to_integers_are_refused(self):
        vertices, faces = sphere_mesh()
        for v, f in [(vertices, faces.astype(float)), (vertices, faces > 0), (vertices + 0j, faces), (vertices > 0, faces)]:
            with self.assertRaises(TypeError):
                svdag.build(v, f, self.folder / "a.svdag", resolution=64)
        field = np.linspace(-1, 1, 512).reshape(8, 8, 8)
        field[0, 0, 0] = np.nan
        for array in (field, np.full((8, 8, 8), -1), field + 0j):
            with self.assertRaises(TypeError):
                svdag.from_array(array, self.folder / "a.svdag")
        self.assertEqual(svdag.from_array(field, self.folder / "a.svdag", threshold=0)["voxels"], 256)
        self.assertEqual(svdag.from_array(np.full((8, 8, 8), 3), self.folder / "a.svdag")["voxels"], 512)

    def test_no_argument_crashes(self):
        """Random arguments of random kinds: any exception of Python, but no crash and no other."""
        file, layers = svdag.open(self.plain), svdag.open(self.folder / "layers.svdag")
        random = np.random.default_rng(5)
        expected = (ValueError, TypeError, IndexError, KeyError, OverflowError, MemoryError, svdag.Error)
        values = [None, -1, 0, 1, 7, 256, 2 ** 31, 2 ** 40, 2 ** 63, 2 ** 64, -2 ** 63, 10 ** 30, 0.5, np.nan, np.inf, -np.inf, 1e300,
                  1e-320, "", "x", b"x", [], [1], [1, 2, 3], (0, 0, 0), (8, 8, 8), (2 ** 62, 0, 0), (-2 ** 70, 2 ** 70, 5), [np.nan] * 3,
                  [[0, 0, 1]], np.zeros((0, 3)), np.zeros((3, 0)), np.zeros((4, 3), np.float16), np.zeros((5, 3), np.complex128),
                  np.full((3, 3), np.nan), np.full((3, 3), np.inf), np.zeros((6, 3), bool), np.zeros((2, 3), ">i4"), np.zeros((3, 2, 3)),
                  np.zeros((9, 6))[:, ::2], np.zeros((3, 8), np.int32).T, np.zeros((3, 3), object), np.array(["a", "b", "c"]),
                  np.ma.zeros((3, 3)), np.full((3, 3), 2 ** 64 - 1, np.uint64), np.zeros((2, 3), "M8[s]"), {}, {"a": 1}, object(), len,
                  np.int64(5), np.float64(2.5), True, slice(3), self.coords[:10], self.coords[:10].astype(float), [[1, 2], [3]]]
        calls = [(f.window, 2, 4) for f in (file, layers)] + [(f.coords, 0, 4) for f in (file, layers)] + [
            (file.sphere, 2, 3), (layers.sphere, 2, 3), (file.occupied, 1, 2), (layers.occupied, 1, 2), (file.nearest, 1, 3), (layers.nearest, 1, 3), (file.box_occupied, 2, 3),
            (file.count, 0, 4), (layers.count, 0, 4), (file.trace, 2, 4), (layers.trace, 2, 4), (svdag.unpack_bricks, 1, 1),
            (lambda *a: list(file.bricks(*a)), 0, 4), (svdag.open, 1, 1), (svdag.from_array, 2, 2), (svdag.from_coords, 2, 2)]
        outputs = [None, "", 5, "/nonexistent/a", str(self.folder), str(self.folder / "f.svdag"), b"\xff", "\0", "a\0b"]
        ran = {}
        os.chdir(self.folder)  # "x" may be written
        for i in range(6000):
            call, least, most = calls[i % len(calls)]
            count = int(random.integers(least, most + 1))
            arguments = [values[int(random.integers(len(values)))] for _ in range(count)]
            if call in (svdag.from_array, svdag.from_coords):
                arguments[1] = outputs[int(random.integers(len(outputs)))]
            try:
                call(*arguments)
                ran[call] = ran.get(call, 0) + 1
            except expected:
                pass
            except UnicodeDecodeError:
                pass
        self.assertGreater(len(ran), 10)
        self.assertEqual(file.count(), len(self.coords))


class Wheel(unittest.TestCase):
    def test_it_needs_no_library_of_the_system_but_what_manylinux_expects(self):
        package = pathlib.Path(svdag.__file__).parent
        binaries = [*package.glob("_svdag*.so"), *(package / "bin").iterdir()]
        self.assertEqual(len(binaries), 6)
        for binary in binaries:
            needed = subprocess.run(["/usr/bin/ldd", binary], capture_output=True, text=True).stdout
            for name, path in re.findall(r"(\S+) => (\S+)", needed):
                self.assertTrue(path.startswith(str(package)) or re.match(r"lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+|expat|z)\.so", name),
                                f"{binary}: {name} {path}")
        self.assertFalse(any(p.is_symlink() for p in package.rglob("*")))

    def test_it_holds_the_notices_of_what_it_ships(self):
        folder = pathlib.Path(svdag.__file__).parent / "share" / "doc"
        notices = {path.parent.name for path in folder.glob("*/copyright")}
        self.assertLessEqual({"libzstd1", "libxxhash0", "libcli11-dev", "nlohmann-json3-dev", "libstb-dev"}, notices)

    def test_its_programs_are_on_path(self):
        for name in ("svdag", "svdag-verify", "svdag-trace"):
            done = subprocess.run([pathlib.Path(sys.executable).parent / name, "--version"], capture_output=True, text=True)
            self.assertEqual(done.stdout.split(), [name, svdag.__version__])


class Documents(unittest.TestCase):
    def test_the_examples_of_the_page_run(self):
        text = (SOURCE / "docs" / "python.md").read_text()
        blocks = re.findall(r"^```python\n(.*?)^```$", text, re.M | re.S)
        self.assertGreater(len(blocks), 5)
        with tempfile.TemporaryDirectory() as folder:
            before = os.getcwd()
            os.chdir(folder)
            try:
                points, faces = sphere_mesh()
                _make.write_ply(pathlib.Path("part.ply"), points, faces)
                triangles = points[faces].astype("<f4")
                with open("part.stl", "wb") as file:
                    file.write(bytes(80) + np.uint32(len(triangles)).tobytes())
                    rows = np.zeros(len(triangles), [("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
                    rows["v"] = triangles
                    file.write(rows.tobytes())
                names = {}
                for block in blocks:
                    if "matplotlib" in block:
                        try:
                            import matplotlib  # noqa: F401
                        except ImportError:
                            print("matplotlib is missing: its example was not run", file=sys.stderr)
                            continue
                    exec(compile(block, "docs/python.md", "exec"), names)
            finally:
                os.chdir(before)


    def test_the_tour_makes_its_pictures(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, SOURCE / "python" / "examples" / "tour.py"], cwd=folder, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(len(list(pathlib.Path(folder).glob("*.png"))), 4)
            volume, exact = map(float, re.search(r"volume ([\d.]+), exactly ([\d.]+)", done.stdout).groups())
            self.assertLess(abs(volume / exact - 1), 0.02)


if __name__ == "__main__":
    SOURCE = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
