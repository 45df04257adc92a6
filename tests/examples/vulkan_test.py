#!/usr/bin/env python3
"""Tests shaders/svdag.glsl by the program of examples/vulkan, on Mesa's software device: it hits the voxels that
svdag-trace hits; points, boxes, layers and colours are those of the file.

Usage: vulkan_test.py BUILD [TEST...]. Builds the example against what is installed. With SVDAG_SCENES the scenes are real
ones, else those of svdag-scene.
"""
import functools
import glob
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

import numpy

WIDTH, HEIGHT = 640, 360
NONE = 0xffffffff
ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = os.environ.get("SVDAG_SCENES")
TEMPORARY = tempfile.TemporaryDirectory(prefix="svdag-vulkan-")
FOLDER = pathlib.Path(TEMPORARY.name)
BUILD = None


def run(*command):
    done = subprocess.run([*map(str, command)], capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{command}: {done.returncode}, {done.stdout}{done.stderr}")
    return done.stdout


@functools.cache
def example(*options):
    """The folder of the built example."""
    prefix, build = FOLDER / "prefix", FOLDER / "-".join(["example", *options])
    if not prefix.exists():
        run("cmake", "--install", BUILD, "--component", "development", "--prefix", prefix)
    run("cmake", "-G", "Ninja", "-S", ROOT / "examples" / "vulkan", "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}",
        *(f"-D{option}" for option in options))
    run("cmake", "--build", build)
    return build


def queries(buffers, *definitions):
    """Compiles queries.comp; gives its name without the number of buffers, as svdag-vulkan takes it."""
    run("glslangValidator", "-V", "--quiet", f"-I{FOLDER}/prefix/include", f"-DSVDAG_BUFFERS={buffers}", *definitions,
        "-o", FOLDER / f"queries{buffers}.spv", pathlib.Path(__file__).with_name("queries.comp"))
    return FOLDER / "queries"


@functools.cache
def baked(shared, kind, triangles, *options):
    """A file of a shared scene, or without them of a generated one."""
    output = FOLDER / f"{len(list(FOLDER.glob('*.svdag')))}-{kind}.svdag"
    scene = pathlib.Path(SCENES or "", shared)
    if SCENES is None:
        scene = FOLDER / f"{kind}.obj"
        if not scene.exists():
            run(BUILD / "svdag-scene", kind, "-n", triangles, "-q", "-o", scene)
    run(BUILD / "svdag", "build", scene, "-o", output, "-q", *options)
    return output


def compact(file):
    output = FOLDER / f"compact-{file.name}"
    run(BUILD / "svdag", "convert", file, "--layout", "compact", "-q", "-o", output)
    return output


def info(file):
    return json.loads(run(BUILD / "svdag", "info", file, "--json"))


def cameras(file, count):
    """Cameras around and inside what is set: position, target, angle."""
    random = numpy.random.default_rng(1)
    low, high = numpy.array(info(file)["occupied"]["bounds"]).reshape(2, 3)
    middle, size = (low + high) / 2, numpy.linalg.norm(high - low)
    for i in range(count):
        away = random.normal(size=3)
        away /= numpy.linalg.norm(away)
        inside = low + (high - low) * random.uniform(0.3, 0.7, 3)
        yield (middle + size * away, middle, 40.0) if i % 2 == 0 else (inside, inside + away, 70.0)


def text(point):
    return ",".join(map(repr, map(float, point)))


def shaded(build, file, camera, shader=None):
    """The pixels that a shader writes, row by row."""
    output = FOLDER / "pixels.bin"
    eye, target, angle = camera
    run(build / "svdag-vulkan", shader or build / "trace", file, FOLDER / "picture.png", text(eye), text(target), angle, output)
    pixel = numpy.dtype([("voxel", "<i4", 3), ("face", "<u4"), ("layer", "<u4"), ("colour", "<u4"), ("shown", "<u4"), ("t", "<u4")])
    return numpy.fromfile(output, pixel).reshape(HEIGHT, WIDTH)


def traced(file, camera):
    """The pixels of svdag-trace."""
    output = FOLDER / "hits.bin"
    run(BUILD / "svdag-trace", file, "--size", f"{WIDTH}x{HEIGHT}", f"--camera={text(camera[0])},{text(camera[1])},{camera[2]}",
        "--dump", output, "--samples", "1", "--rounds", "1")
    pixel = numpy.dtype([("found", "<u4"), ("voxel", "<u4", 3), ("level", "<u4"), ("axis", "<u4"), ("t", "<f8"),
                         ("blocked", "<u4", 3), ("layer", "<u4"), ("none", "<u4", 2)])
    return numpy.fromfile(output, pixel).reshape(HEIGHT, WIDTH)


def differing(shown, hits):
    same = numpy.where(hits["found"] == 1, (shown["face"] > 0) & (shown["voxel"] == hits["voxel"]).all(axis=2), shown["face"] == 0)
    return numpy.argwhere(~same)


def chord(grid, camera, at, voxel):
    """The length, in voxels, of a pixel's ray in a voxel; negative: the distance by which it misses it."""
    eye, target = (numpy.array(p, numpy.longdouble) for p in camera[:2])
    forward = (target - eye) / numpy.linalg.norm(target - eye)
    right = numpy.cross(forward, [0, 1, 0])
    right /= numpy.linalg.norm(right)
    slope = numpy.tan(numpy.radians(camera[2]) / 2)
    x, y = (at[1] + 0.5) / WIDTH, (at[0] + 0.5) / HEIGHT
    ray = forward + right * (2 * x - 1) * slope * WIDTH / HEIGHT + numpy.cross(right, forward) * (1 - 2 * y) * slope
    origin = (eye - grid["corner"]) / grid["voxel_size"]
    times = numpy.sort([(voxel - origin) / ray, (voxel + 1 - origin) / ray], axis=0)
    return float((times[1].min() - times[0].max()) * numpy.linalg.norm(ray))


def ray_lengths(angle):
    """The length of each pixel's direction in trace.comp, which is the unit of its times."""
    step = 2 * numpy.tan(numpy.radians(angle) / 2) / HEIGHT
    y, x = (numpy.mgrid[:HEIGHT, :WIDTH].T + 0.5 - numpy.array([HEIGHT, WIDTH]) / 2).T * step
    return numpy.sqrt(1 + x * x + y * y)


class Rays(unittest.TestCase):
    def test_hits_are_those_of_the_tracer(self):
        """1K³ to 64K³, both layouts, ten cameras each. Every pixel that differs is that of a ray which grazes one of the
        two voxels at an edge."""
        build = example()
        files = [baked("crytek_sponza.glb", "atrium", "90K", "-r", "8K"),
                 baked("stanford_dragon.ply", "scan", "20K", "-r", "2K"),
                 baked("lyon_city_epsg3946.glb", "city", "20K", "-r", "64K"),
                 baked("stk_black_forest.glb", "terrain", "20K", "-r", "4K", "--layers", "object"),
                 baked("trimesh_fandisk.obj", "hairball", "20K", "-r", "1K")]
        differ, worst, edge, hit = 0, 0, 0, 0
        for file in files:
            grid, both = info(file)["grid"], [file, compact(file)]
            for camera in cameras(file, 10):
                hits = traced(file, camera)
                hit += hits["found"].mean() / 50
                for layout in both:
                    shown = shaded(build, layout, camera)
                    pixels = differing(shown, hits)
                    differ += len(pixels)
                    worst = max(worst, len(pixels))
                    for at in map(tuple, pixels):
                        lengths = [chord(grid, camera, at, numpy.array(one["voxel"][at], float))
                                   for one, found in [(shown, shown["face"][at]), (hits, hits["found"][at])] if found]
                        edge = max(edge, min(map(abs, lengths)))
                    same = (hits["found"] == 1) & (shown["face"] > 0) & (shown["voxel"] == hits["voxel"]).all(axis=2)
                    t = shown["t"].view(numpy.float32) * ray_lengths(camera[2])
                    numpy.testing.assert_allclose(t[same], hits["t"][same], rtol=1e-6, atol=1e-5)
                    self.assertTrue((shown["layer"] + 1 == hits["layer"])[same].all())
        print(f"pixels that differ from svdag-trace: {differ} of {100 * WIDTH * HEIGHT:,}, at most {worst} of a picture; "
              f"{100 * hit:.0f} % hit; they graze a voxel by {edge:.1e} of its side or less", file=sys.stderr)
        self.assertGreater(hit, 0.2)
        self.assertLess(worst, 1e-4 * WIDTH * HEIGHT)
        self.assertLess(edge, 1e-3)

    def test_a_file_may_be_in_many_buffers(self):
        file = baked("trimesh_fandisk.obj", "hairball", "20K", "-r", "1K")
        words = file.stat().st_size // 4
        build = example("BUFFERS=4", f"BUFFER_BITS={(words // 3).bit_length()}")
        for layout in [file, compact(file)]:
            camera = next(cameras(file, 1))
            self.assertLess(len(differing(shaded(build, layout, camera), traced(file, camera))), 1e-4 * WIDTH * HEIGHT)


class Queries(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scene = FOLDER / "attributes.glb"
        run(BUILD / "svdag-scene", "atrium", "-n", "90K", "-q", "-o", scene)
        cls.file = FOLDER / "attributes.svdag"
        run(BUILD / "svdag", "build", scene, "-r", "256", "-q", "--colours", "--layers", "material", "-o", cls.file)
        run(BUILD / "svdag", "export", cls.file, "-q", "-o", FOLDER / "voxels.npz")
        voxels = numpy.load(FOLDER / "voxels.npz")
        cls.layers = numpy.full((256, 256, 256), NONE, numpy.uint32)
        cls.layers[tuple(voxels["coordinates"].T)] = voxels["label"]
        cls.set = cls.layers != NONE

    @staticmethod
    def root_of(file, layer):
        """The index in level 0 of the root of a layer (docs/format.md)."""
        data = file.read_bytes()
        section, table = (struct.unpack_from("<Q", data, at)[0] for at in (176, 792))
        root, = struct.unpack_from("<I", data, table + 24 * layer + 8)
        if data[768] == 0:  # plain: the nodes before it
            at = 0
            for _ in range(root):
                at += 1 + data[section + 4 * at].bit_count()
            root = at
        return root

    def found(self, build, file, shader):
        camera = next(cameras(self.file, 1))
        shaded_pixels = shaded(build, file, camera, shader).ravel()
        return shaded_pixels, tuple(shaded_pixels["voxel"].T)

    def require_points_and_boxes(self, pixels, at, voxels):
        self.assertGreater(voxels[at].sum(), 500)
        numpy.testing.assert_array_equal(pixels["face"] & 1, voxels[at])
        sums = numpy.pad(voxels, ((1, 0),) * 3).astype(numpy.int32).cumsum(0).cumsum(1).cumsum(2)
        ends = [numpy.minimum(a + 1 + (pixels["shown"] >> 6 * i & 63), 256) for i, a in enumerate(at)]
        count = sum((-1) ** (3 - i - j - k) * sums[tuple((low, high)[bit] for low, high, bit in zip(at, ends, (i, j, k)))]
                    for i in range(2) for j in range(2) for k in range(2))
        numpy.testing.assert_array_equal(pixels["face"] >> 1, count > 0)
        self.assertGreater((count == 0).sum(), 1000)

    def test_points_boxes_layers_and_colours(self):
        build = example()
        for file in [self.file, compact(self.file)]:
            pixels, at = self.found(build, file, queries(1, "-DATTRIBUTES"))
            self.require_points_and_boxes(pixels, at, self.set)
            numpy.testing.assert_array_equal(pixels["layer"], self.layers[at])
            self.assertGreater(len(numpy.unique(pixels["layer"])), 5)
            self.require_empty_sides(pixels, at)
            self.require_colours(pixels)

    def require_empty_sides(self, pixels, at):
        """The largest empty cube of the octree around each voxel."""
        expected = numpy.zeros(len(pixels), int)
        for shift in range(9):
            side = 1 << shift
            cubes = self.set.reshape(256 // side, side, 256 // side, side, 256 // side, side).any(axis=(1, 3, 5))
            expected[~cubes[tuple(a >> shift for a in at)]] = side
        numpy.testing.assert_array_equal(pixels["t"], expected)

    def require_colours(self, pixels):
        """As svdag query prints them."""
        grid = info(self.file)["grid"]
        some = pixels[self.set[tuple(pixels["voxel"].T)]][:5000]
        points = grid["corner"] + (some["voxel"] + 0.5) * grid["voxel_size"]
        lines = subprocess.run([BUILD / "svdag", "query", self.file], input="\n".join(" ".join(map(repr, map(float, p))) for p in points),
                               capture_output=True, text=True, check=True).stdout.splitlines()
        printed = [line.split()[-1] for line in lines]
        shown = ["none" if c == NONE else f"#{c & 255:02x}{c >> 8 & 255:02x}{c >> 16 & 255:02x}" for c in map(int, some["colour"])]
        self.assertEqual(shown, printed)
        self.assertGreater(len(set(shown)), 100)

    def test_a_layer_alone(self):
        table = json.loads(run(BUILD / "svdag", "info", self.file, "--layers", "--json"))["layer_table"]
        layer = max(range(1, len(table)), key=lambda i: table[i]["voxels"])
        run(BUILD / "svdag", "export", self.file, "-q", "-o", FOLDER / "layer.npz", "--layer", table[layer]["name"])
        voxels = numpy.zeros_like(self.set)
        voxels[tuple(numpy.load(FOLDER / "layer.npz")["coordinates"].T)] = True
        for file in [self.file, compact(self.file)]:
            pixels, at = self.found(example(), file, queries(1, f"-DROOT={self.root_of(file, layer)}u"))
            self.require_points_and_boxes(pixels, at, voxels)

    def test_points_and_boxes_in_fifteen_buffers(self):
        plain = FOLDER / "plain.svdag"
        run(BUILD / "svdag", "build", FOLDER / "attributes.glb", "-r", "256", "-q", "-o", plain)
        bits = ((plain.stat().st_size // 4 + 32) // 15).bit_length()  # half of the buffers, or more
        build = example("BUFFERS=15", f"BUFFER_BITS={bits}")
        pixels, at = self.found(build, plain, queries(15, f"-DSVDAG_BUFFER_BITS={bits}"))
        self.require_points_and_boxes(pixels, at, self.set)


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
    software = glob.glob("/usr/share/vulkan/icd.d/lvp_icd.*.json")
    if not software:
        sys.exit("mesa-vulkan-drivers is not installed")
    os.environ.setdefault("VK_ICD_FILENAMES", software[0])
    os.environ["MESA_SHADER_CACHE_DIR"] = str(FOLDER / "cache")
    unittest.main(verbosity=2)
