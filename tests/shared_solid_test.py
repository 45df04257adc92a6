#!/usr/bin/env python3
"""Tests that closed real scenes fill up: by the judge, voxel by voxel, and by OpenVDB's sign.

Usage: shared_solid_test.py PROGRAMS. Skipped without SVDAG_SCENES. A voxel whose centre is farther from the surface than
any touched voxel's must be set exactly where OpenVDB's level set is negative. OpenVDB fills from outside: it takes a
crease that its grid closes off for inside. So where the two differ, the sum of the solid angles decides.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy
import pyopenvdb

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "io" / "scene"))
import independent_reader  # noqa: E402

# Scene, resolution of OpenVDB's comparison; 0: none, since it overlaps itself.
SCENES = [("cgal_refined_elephant.off", 256), ("stanford_dragon.ply", 256), ("trimesh_torus.stl", 256),
          ("thingi10k_472042.stl", 256), ("thingi10k_39202.stl", 0), ("trimesh_fandisk.obj", 256)]
MAX_DIFFERING = 200  # voxels that OpenVDB may get wrong in a scene
FARTHEST = 3 ** 0.5 / 2 + 1e-3  # voxels: of the centre of a touched voxel from the surface


def svdag(programs, *arguments):
    done = subprocess.run([programs / arguments[0], *arguments[1:]], capture_output=True, text=True)
    if done.returncode != 0:
        raise ValueError(f"{arguments[0]} {arguments[1]} returned {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout


def winding(soup, point):
    """How often triangles wind around a point: the sum of their solid angles (Van Oosterom and Strackee 1983)."""
    a = soup - point
    lengths = numpy.linalg.norm(a, axis=2)
    dots = [(a[:, i] * a[:, (i + 1) % 3]).sum(axis=1) * lengths[:, (i + 2) % 3] for i in range(3)]
    volume = (a[:, 0] * numpy.cross(a[:, 1], a[:, 2])).sum(axis=1)
    return numpy.arctan2(volume, lengths.prod(axis=1) + sum(dots)).sum() / (2 * numpy.pi)


def wrong_signs(programs, folder, scene, resolution):
    """Numbers of voxels whose inside differs, of those compared, and of those inside."""
    svdag(programs, "svdag", "build", scene, "-r", str(resolution), "--rule", "solid", "-o", folder / "s.svdag", "-q")
    svdag(programs, "svdag", "export", folder / "s.svdag", "-o", folder / "s.npz", "-q")
    grid = json.loads(svdag(programs, "svdag", "info", folder / "s.svdag", "--json"))["grid"]
    soup = numpy.array(independent_reader.triangles(str(scene))).reshape(-1, 3, 3)
    index = (soup.reshape(-1, 3) - grid["corner"]) / grid["voxel_size"] - 0.5  # voxel centres are integers
    points, corners = numpy.unique(index.astype(numpy.float32), axis=0, return_inverse=True)
    level_set = pyopenvdb.FloatGrid.createLevelSetFromPolygons(points, triangles=corners.reshape(-1, 3).astype(numpy.uint32))
    distance = numpy.zeros([resolution] * 3, numpy.float32)
    level_set.copyToArray(distance)
    inside = numpy.zeros(distance.shape, bool)
    inside[tuple(numpy.load(folder / "s.npz")["coordinates"].T)] = True
    far = abs(distance) > FARTHEST
    differing = numpy.argwhere(((distance < 0) != inside) & far)
    triangles = index.reshape(-1, 3, 3)
    wrong = sum((round(winding(triangles, voxel)) != 0) != inside[tuple(voxel)] for voxel in differing[:MAX_DIFFERING])
    return wrong + max(0, len(differing) - MAX_DIFFERING), int(far.sum()), int((far & inside).sum())


def problem_of(programs, scene, resolution):
    """A message about the first thing that is wrong with a scene, or None."""
    with tempfile.TemporaryDirectory(prefix="svdag-shared-") as folder:
        folder = pathlib.Path(folder)
        try:
            svdag(programs, "svdag", "build", scene, "-r", "1K", "--rule", "solid", "-o", folder / "k.svdag", "-q")
            svdag(programs, "svdag-verify", "mesh", folder / "k.svdag", scene)
            if resolution == 0:
                return None
            wrong, compared, inside = wrong_signs(programs, folder, scene, resolution)
        except ValueError as error:
            return str(error)
        return f"{wrong} of {compared} voxels differ from OpenVDB ({inside} inside)" if wrong or inside < 1000 else None


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    folder = os.environ.get("SVDAG_SCENES")
    if folder is None:
        print("0 passed, 0 failed, 1 skipped")
        return 0
    failed = 0
    for name, resolution in SCENES:
        problem = problem_of(programs, pathlib.Path(folder, name), resolution)
        failed += problem is not None
        if problem:
            print(f"{name}: {problem}")
    print(f"{len(SCENES) - failed} passed, {failed} failed, 0 skipped")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
