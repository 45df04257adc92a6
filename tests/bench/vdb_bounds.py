#!/usr/bin/env python3
"""`make bench-vdb`: tests every real scene against the bounds of OpenVDB's distances.

Compares whole files at 512³ (both rules) and 1K³, and samples of windows of 512³ voxels on the surface of some 64K³
bakes. Sums per grid and rule are written between their markers in docs/results/accuracy.md, the rows to build/bench/vdb_bounds.json. The exit
code is 1 if there is a violation.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import time

from bench import RESULTS, fill
from bench_tables import table

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
OUT = ROOT / "build" / "bench"
FORMATS = {".ply", ".stl", ".obj", ".off", ".gltf", ".glb", ".drc", ".om"}
WINDOWS = 8
# Baked at 64K³ as well: architecture, a city, terrain, scans, far coordinates, dirty input.
SAMPLED = ["cgal_boeing.off", "cgal_elephant-with-holes.off", "cgal_polygon_mesh.off", "crytek_sponza.glb", "draco_car.drc",
           "lyon_city_epsg3946.glb", "openfoam_terrain_utm.stl", "samurai_monastery.obj", "stanford_dragon.ply",
           "thingi10k_39202.stl"]


def judge(programs, scene, resolution, rule, windows):
    """Bakes a scene and returns the verdict of svdag-verify as a row."""
    dag = OUT / "vdb_bounds.svdag"
    subprocess.run([programs / "svdag", "build", scene, "-r", resolution, "--rule", rule, "-o", dag, "-q"], check=True)
    sample = ["--sample", str(windows)] if windows else []
    start = time.monotonic()
    done = subprocess.run([programs / "svdag-verify", "mesh", dag, scene, "--judge", "openvdb", "--json", *sample],
                          capture_output=True, text=True)
    seconds = time.monotonic() - start
    dag.unlink()
    if done.returncode > 1:
        sys.exit(f"{scene.name}, {resolution}³: {done.stderr}")
    return dict(json.loads(done.stdout), scene=scene.name, resolution=resolution, seconds=seconds)


def sums(head, rows):
    """A line of the table: sums over rows."""
    windows = "all" if not any(r["sampled"] for r in rows) else f"{sum(r['windows'] for r in rows):,}"
    return [*head, f"{len(rows)}", windows, *[f"{sum(r[c] for r in rows):,}" for c in ("tested", "file_voxels")],
            f"{sum(r['missing'] + r['extra'] for r in rows):,}", *[f"{sum(r[c] for r in rows):,}" for c in ("decided_exactly", "openvdb_errors")]]


def bounds_table(rows):
    groups = {}
    for r in rows:
        groups.setdefault((r["resolution"], r["rule"]), []).append(r)
    return table(["grid", "rule", "files", "windows", "voxels tested", "set", "violations", "on a bound", "errors of OpenVDB"],
                 [sums([f"{resolution}³", rule], own) for (resolution, rule), own in groups.items()])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--tables-only", action="store_true", help="make the table from the rows of the last run")
    options = parser.parse_args()
    programs, results = options.programs.resolve(), OUT / "vdb_bounds.json"
    OUT.mkdir(parents=True, exist_ok=True)
    if options.tables_only:
        rows = json.loads(results.read_text())
    elif "SVDAG_SCENES" not in os.environ:
        sys.exit("SVDAG_SCENES is not set: there are no scenes to test")
    else:
        scenes = sorted(p for p in pathlib.Path(os.environ["SVDAG_SCENES"]).iterdir() if p.suffix in FORMATS)
        plan = [(s, r, rule, 0) for s in scenes for r, rule in
                [("512", "conservative"), ("512", "thin"), ("1K", "conservative")]]
        plan += [(s, "64K", "conservative", WINDOWS) for s in scenes if s.name in SAMPLED]
        rows = []
        for job in plan:
            rows.append(judge(programs, *job))
            print(" ".join(f"{k} {rows[-1][k]}" for k in ("scene", "resolution", "rule", "tested", "missing", "extra",
                                                           "decided_exactly", "openvdb_errors")),
                  f"{rows[-1]['seconds']:.1f} s", flush=True)
            results.write_text(json.dumps(rows))
    fill(RESULTS / "accuracy.md", {"vdb bounds": bounds_table(rows)})
    return any(not r["ok"] for r in rows)


if __name__ == "__main__":
    sys.exit(main())
