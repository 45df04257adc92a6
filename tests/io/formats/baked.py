"""Bakes small scenes for the tests of foreign formats."""
import itertools
import pathlib
import random
import struct
import subprocess
import sys
import tempfile

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "dag"))
import read_svdag  # noqa: E402


def write_ply(path, triangles):
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {3 * len(triangles)}\n"
                   "property double x\nproperty double y\nproperty double z\n"
                   f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        for triangle in triangles:
            for point in triangle:
                file.write(struct.pack("<3d", *point))
        for i in range(len(triangles)):
            file.write(struct.pack("<B3i", 3, 3 * i, 3 * i + 1, 3 * i + 2))


def askew():
    """Triangles without symmetry: no permutation or reflection of the axes maps them to themselves."""
    chance = random.Random(7)
    corners = [[chance.uniform(0, s) + o for s, o in ((5, -1.25), (3.1, 2), (1.7, 0.375))] for _ in range(16)]
    return [[corners[i], corners[i + 1], corners[i + 2]] for i in range(14)]


def slices(n):
    """A plane through the middle of every layer of n^3 voxels of side 1: all of them are set."""
    return [t for z in range(n) for t in ([[0, 0, z], [n - 1, 0, z], [n - 1, n - 1, z]],
                                          [[0, 0, z], [n - 1, n - 1, z], [0, n - 1, z]])]


def is_asymmetric(voxels, resolution):
    """True if all 47 other permutations and reflections of the axes give another set."""
    own = {tuple(v) for v in voxels.tolist()}
    images = set()
    for axes in itertools.permutations(range(3)):
        for signs in itertools.product((False, True), repeat=3):
            image = voxels[:, axes].astype("<i8")
            for axis, mirrored in enumerate(signs):
                if mirrored:
                    image[:, axis] = resolution - 1 - image[:, axis]
            images.add(frozenset(map(tuple, image.tolist())))
    return len(images) == 48 and own in images


class Bakery:
    """Runs the programs in a temporary folder."""

    def __init__(self, programs):
        self.programs = pathlib.Path(programs).resolve()
        self.holder = tempfile.TemporaryDirectory(prefix="svdag-formats-")
        self.folder = pathlib.Path(self.holder.name)

    def run(self, *arguments, code=0):
        """stdout; stderr of an expected failure."""
        done = subprocess.run([self.programs / arguments[0], *map(str, arguments[1:])], capture_output=True,
                              text=True, cwd=self.folder)
        if done.returncode != code:
            raise AssertionError(f"{arguments}: exit {done.returncode}: {done.stderr}")
        return done.stdout if code == 0 else done.stderr

    def bake(self, name, triangles, *grid):
        write_ply(self.folder / f"{name}.ply", triangles)
        self.run("svdag", "build", f"{name}.ply", "-o", f"{name}.svdag", "-q", *grid)
        return self.dag(f"{name}.svdag")

    def dag(self, name):
        return read_svdag.Svdag((self.folder / name).read_bytes())


def coarser(voxels, levels):
    """The content of cubes of 2^levels voxels."""
    return numpy.unique(voxels.astype("<i8") >> levels, axis=0).reshape(-1, 3)


def inside(voxels, dag, level, bounds):
    """Voxels of a level whose interior meets the box."""
    size = dag.voxel_size * 2.0**(dag.L - level)
    low = [(b - c) / size for b, c in zip(bounds[:3], dag.corner)]
    high = [(b - c) / size for b, c in zip(bounds[3:], dag.corner)]
    return voxels[numpy.all((voxels + 1 > low) & (voxels < high), axis=1)]
