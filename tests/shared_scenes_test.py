#!/usr/bin/env python3
"""Tests every real scene: it bakes, no voxel is missing or extra, and rays agree with its triangles.

Usage: shared_scenes_test.py PROGRAMS [RESOLUTION]. The scenes are all mesh files in the folder named by
SVDAG_SCENES; without it the test is skipped.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

FORMATS = {".ply", ".stl", ".obj", ".off", ".gltf", ".glb", ".drc", ".om"}


def problem_of(programs, scene, resolution):
    """A message about the first command that failed on a scene, or None."""
    with tempfile.TemporaryDirectory(prefix="svdag-shared-") as folder:
        dag = pathlib.Path(folder, "scene.svdag")
        bake = ["svdag", "build", scene, "-r", resolution, "-o", dag, "-q"]
        for command in (bake,
                        ["svdag-verify", "check", dag],
                        ["svdag-verify", "mesh", dag, scene],
                        [*bake, "--no-cutouts"],  # which the tracer does not judge
                        ["svdag-verify", "trace", dag, scene, "--no-cutouts", "--rays", "100K"]):
            done = subprocess.run([programs / command[0], *command[1:]], capture_output=True, text=True)
            if done.returncode != 0 and "built without Embree" not in done.stderr:
                return f"{command[0]} {command[1]} returned {done.returncode}: {done.stdout}{done.stderr}"
    return None


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    resolution = sys.argv[2] if len(sys.argv) > 2 else "2K"
    folder = os.environ.get("SVDAG_SCENES")
    if folder is None:
        print("0 passed, 0 failed, 1 skipped")
        return 0
    scenes = sorted(p for p in pathlib.Path(folder).iterdir() if p.suffix in FORMATS)
    failed = 0 if scenes else 1
    for scene in scenes:
        problem = problem_of(programs, scene, resolution)
        failed += problem is not None
        if problem:
            print(f"{scene.name}: {problem}")
    print(f"{len(scenes) - failed if scenes else 0} passed, {failed} failed, 0 skipped")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
