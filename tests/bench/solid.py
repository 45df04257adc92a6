#!/usr/bin/env python3
"""`make bench-solid`: what interiors cost in bytes and time; the table of docs/results/performance.md, "Solids"."""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from bench import PAGE, fill
from bench_tables import table

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
CASES = [("stanford_dragon.ply", "8K"), ("cgal_refined_elephant.off", "8K"), ("thingi10k_39202.stl", "32K"),
         ("trimesh_torus.stl", "8K"), ("trimesh_fandisk.obj", "8K")]
ROUNDS = 3  # of both rules in turns; the least time counts


def bake(programs, scene, resolution, rule, folder):
    report = pathlib.Path(folder, "report.json")
    done = subprocess.run([programs / "svdag", "build", scene, "-r", resolution, "--rule", rule, "-o", pathlib.Path(folder, "s.svdag"),
                           "-q", "--report", report], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{scene}: {done.stderr}")
    return json.loads(report.read_text())


def row(programs, scene, resolution, folder):
    reports = {"conservative": [], "solid": []}
    for _ in range(ROUNDS):
        for rule, list_of in reports.items():
            list_of.append(bake(programs, scene, resolution, rule, folder))
    surface, solid = (min(r, key=lambda report: report["seconds"]["cpu"]) for r in reports.values())
    a, b = surface["file_bytes"], solid["file_bytes"]
    return [scene.name, f"{resolution}³", f"{surface['voxels']:,}", f"{solid['voxels']:,}", f"{solid['voxels'] / solid['volume_voxels']:.4f}",
            f"{a / 1e6:.1f}", f"{b / 1e6:.1f}", f"{b / a:.2f}",
            f"{surface['seconds']['cpu']:.2f}", f"{solid['seconds']['cpu'] / surface['seconds']['cpu']:.2f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    options = parser.parse_args()
    if "SVDAG_SCENES" not in os.environ:
        sys.exit("SVDAG_SCENES is not set: there are no scenes to measure")
    with tempfile.TemporaryDirectory(prefix="svdag-solid-") as folder:
        rows = [row(options.programs.resolve(), pathlib.Path(os.environ["SVDAG_SCENES"], name), grid, folder) for name, grid in CASES]
    fill(PAGE, {
        "solids": table(["scene", "grid", "voxels of the surface", "of the solid", "solid / enclosed volume", "surface, MB", "solid, MB",
                         "ratio", "CPU of the surface, s", "CPU, ratio"], rows)})


if __name__ == "__main__":
    sys.exit(main())
