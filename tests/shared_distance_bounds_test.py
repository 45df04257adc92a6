#!/usr/bin/env python3
"""Tests that real scenes at 512³ are between the bounds of OpenVDB's distances, with both rules.

Usage: shared_distance_bounds_test.py PROGRAMS. Skipped without SVDAG_SCENES; `make bench-vdb` is the long form.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

SCENES = ["cgal_boeing.off", "cgal_elephant-with-holes.off", "draco_car.drc", "thingi10k_39202.stl",
          "thingi10k_472042.stl", "openfoam_terrain_utm.stl", "lyon_city_epsg3946.glb"]


def problem_of(programs, scene, rule):
    """A message about the first command that failed on a scene, or None."""
    with tempfile.TemporaryDirectory(prefix="svdag-shared-") as folder:
        dag = pathlib.Path(folder, "scene.svdag")
        for command in (["svdag", "build", scene, "-r", "512", "--rule", rule, "-o", dag, "-q"],
                        ["svdag-verify", "mesh", dag, scene, "--judge", "openvdb"]):
            done = subprocess.run([programs / command[0], *command[1:]], capture_output=True, text=True)
            if done.returncode != 0:
                return f"{command[0]} {command[1]} returned {done.returncode}: {done.stdout}{done.stderr}"
    return None


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    folder = os.environ.get("SVDAG_SCENES")
    if folder is None:
        print("0 passed, 0 failed, 1 skipped")
        return 0
    failed = 0
    cases = [(pathlib.Path(folder, name), rule) for name in SCENES for rule in ("conservative", "thin")]
    for scene, rule in cases:
        problem = problem_of(programs, scene, rule)
        failed += problem is not None
        if problem:
            print(f"{scene.name}, {rule}: {problem}")
    print(f"{len(cases) - failed} passed, {failed} failed, 0 skipped")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
