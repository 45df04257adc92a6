#!/usr/bin/env python3
"""`make bench-trace`: compares rays through the DAG with the same rays through the triangles by Embree.

Bakes Sponza, runs trace_rows (tests/bench/trace_rows.cpp), which traces both in turns on one thread, and writes
build/bench/trace.csv and the tables between the markers in docs/results/tracing.md.
"""
import argparse
import csv
import pathlib
import subprocess
import sys

from bakes import Bakes, label
from bench import OUT, RESULTS, ROOT, fill, processor, write_csv
from bench_tables import table

SCENE = "sponza"
GRIDS = [12, 14, 16]
# Cameras inside the atrium: position, target (in metres, the scene's unit), angle of view.
VIEWS = ["-7,1.2,0,8,2,0,65", "-7.2,4.6,3.4,6,3.5,-1.5,65", "0,0.3,0.5,-6,2.5,-2.5,70"]
LIGHT = "0,7,0,0.1,0.5,2"  # position and radii
NAMES = {"soft shadow 0": "soft shadow, light of 0.1 m", "soft shadow 1": "soft shadow, light of 0.5 m",
         "soft shadow 2": "soft shadow, light of 2 m", "ao 0": "AO, as far as the scene",
         "ao 1": "AO, 5 % of the scene"}
OURS = {"svdag": "svdag", "svdag, without beams": "without beams", "svdag, the file": "the file", "svdag, plain": "plain",
        "svdag, huge pages": "huge pages", "svdag, cut": "cone of 9°", "svdag, depth-first": "depth-first"}
TARGETS = {"primary": 0.35, "ao 0": 0.15, "ao 1": 0.25}  # of rays without packets: docs/tracing.md
TARGET_GRID = "16K"
SHOWN = ("16K", "64K")  # in the table; the CSV file has all


def measure(programs, bakes, log2):
    bakes.report(SCENE, log2)
    done = subprocess.run([programs / "tests" / "bench" / "trace_rows", bakes.dag_file(), bakes.scene(SCENE), LIGHT,
                           *VIEWS], check=True, stdout=subprocess.PIPE, text=True)
    return [typed({"grid": label(bakes.log2(log2)), **row}) for row in csv.DictReader(done.stdout.splitlines())]


def measure_all(programs, coarser):
    bakes = Bakes(programs, OUT, coarser)
    if bakes.scene(SCENE) is None:
        sys.exit("SVDAG_SCENES is not a folder with crytek_sponza.glb")
    rows = []
    for log2 in GRIDS:
        rows += measure(programs, bakes, log2)
        write_csv(OUT / "trace.csv", rows)
    bakes.dag_file().unlink(missing_ok=True)
    return rows


def read():
    with open(OUT / "trace.csv", newline="") as file:
        return [typed(row) for row in csv.DictReader(file)]


def typed(row):
    return row | {"rays": int(row["rays"]), "mrays": float(row["mrays"]), "hits": int(row["hits"])}


def grouped(rows):
    """{(grid, workload): {method: row}}"""
    cases = {}
    for row in rows:
        cases.setdefault((row["grid"], row["workload"]), {})[row["method"]] = row
    return cases


def name_of(case):
    return f"{case[0]}³, {NAMES.get(case[1], case[1])}"


def best_embree(own):
    return max((row for method, row in own.items() if method.startswith("Embree")), key=lambda row: row["mrays"])


def share(row):
    return f"{100 * row['hits'] / row['rays']:.1f}"


def target(case, ratio):
    if case[0] != TARGET_GRID or case[1] not in TARGETS:
        return ""
    return f"{TARGETS[case[1]]} {'met' if ratio >= TARGETS[case[1]] else '**missed**'}"


def has_cone(case):
    """Whether the rays together fill a solid angle, so that each may stop at a cube as large as its cone."""
    return case[1].startswith(("soft", "ao"))


def against(rows):
    lines = []
    for case, own in grouped(rows).items():
        if case[0] not in SHOWN:
            continue
        mine, peer, single = own["svdag"], best_embree(own), own["Embree, 1"]
        ratio = mine["mrays"] / peer["mrays"]
        cut = own["svdag, cut"]["mrays"] / peer["mrays"] if has_cone(case) else None
        lines.append([name_of(case), f"{mine['mrays']:.2f}",
                      f"{peer['mrays']:.2f} ({peer['method'].removeprefix('Embree, ')})", f"{ratio:.2f}",
                      f"{mine['mrays'] / single['mrays']:.2f}", f"{cut:.2f}" if cut else "", target(case, ratio)])
    return table(["grid, rays", "svdag", "best of Embree", "ratio", "to its single rays", "with the cone", "target"], lines)


def ours(rows):
    lines = []
    for case, own in grouped(rows).items():
        if case[0] != TARGET_GRID:
            continue
        cell = lambda method: "" if method == "svdag, cut" and not has_cone(case) else f"{own[method]['mrays']:.2f}"
        lines.append([name_of(case), *map(cell, OURS), share(own["svdag"]),
                      share(own["svdag, cut"]) if has_cone(case) else ""])
    return table(["grid, rays", *OURS.values(), "hits, %", "hits with the cone, %"], lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--coarser", type=int, default=0, metavar="N",
                        help="all grids N doublings lower; requires --csv-only")
    parser.add_argument("--csv-only", action="store_true", help="do not change docs/")
    parser.add_argument("--tables-only", action="store_true", help="make the tables from the CSV file of the last run")
    options = parser.parse_args()
    if options.coarser and not options.csv_only:
        parser.error("--coarser requires --csv-only")
    rows = read() if options.tables_only else measure_all(options.programs.resolve(), options.coarser)
    contents = {"trace against": f"{processor(1)}, MRays/s.\n\n{against(rows)}", "trace ours": ours(rows)}
    print("\n\n".join(contents.values()))
    if not options.csv_only:
        fill(RESULTS / "tracing.md", contents)


if __name__ == "__main__":
    main()
