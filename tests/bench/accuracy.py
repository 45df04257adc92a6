#!/usr/bin/env python3
"""`make bench-accuracy`: measures run time against error, and volume error against resolution.

Runs accuracy_bench, `svdag build` and `svdag-verify trace`. Writes build/bench/accuracy.csv, volume.csv and rays.csv,
the plots docs/images/accuracy_*.svg, and the tables between the markers in docs/results/accuracy.md. Real scenes are in the
folder SVDAG_SCENES; if it is not set, docs/ is not changed.
"""
import argparse
import csv
import json
import os
import pathlib
import platform
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from bench import RESULTS, ROOT, fill  # noqa: E402
from bench_tables import table  # noqa: E402
import accuracy_plots  # noqa: E402
import accuracy_rays  # noqa: E402
import accuracy_volume  # noqa: E402

OUT = ROOT / "build" / "bench"
PAGE = RESULTS / "accuracy.md"
OURS = "svdag"
TARGET = {"scene": 1.2, "family": 2.5}
BAKED = ("Crytek Sponza", "crytek_sponza.glb", "2K")


def run_to_csv(program, path, measure):
    """Rows of the CSV that `program` prints (if `measure`) or printed in the last run; numbers are converted."""
    if measure:
        path.write_text(subprocess.run([program], check=True, stdout=subprocess.PIPE, text=True).stdout)
    with open(path, newline="") as file:
        return [{key: number(value) for key, value in row.items()} for row in csv.DictReader(file)]


def number(text):
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def label(row):
    return f"{row['case']}, {row['grid']}"


def grouped(rows, group, world="world"):
    """{case label: {method: row}} in the order of the file."""
    cases = {}
    for row in rows:
        if row["group"] == group and row["input"] == world:
            cases.setdefault(label(row), {})[row["method"]] = row
    return cases


def per_million(count, row):
    return 1e6 * count / row["voxels"]


def error_cell(row):
    if row["misses"] == row["extras"] == 0:
        return "0"
    return " / ".join(f"{per_million(row[k], row):,.0f}" if per_million(row[k], row) >= 1 or row[k] == 0
                      else f"{per_million(row[k], row):.2f}" for k in ("misses", "extras"))


def matrix(rows, world, cell, skip=(), groups=("scene", "family")):
    """A table with a row per scene and family and a column per method."""
    cases = {name: own for group in groups for name, own in grouped(rows, group, world).items()}
    methods = [m for m in next(iter(cases.values())) if m not in skip]
    return table(["case, grid", *methods],
                 [[name, *[cell(own[m]) if m in own else "" for m in methods]] for name, own in cases.items()])


def ratio_table(rows):
    """A table of svdag against the fastest peer and the fastest peer without errors."""
    lines = []
    for group in ("scene", "family"):
        for name, own in grouped(rows, group).items():
            peers = [r for m, r in own.items() if not m.startswith(OURS)]
            time = own[OURS]["ns_per_pair"]
            fastest = min(peers, key=lambda r: r["ns_per_pair"])
            exact = min((r for r in peers if r["misses"] == r["extras"] == 0), key=lambda r: r["ns_per_pair"])
            ratio = time / fastest["ns_per_pair"]
            lines.append([name, f"{own[OURS]['misses'] + own[OURS]['extras']}", f"{time:.1f}",
                          f"{fastest['method']} {fastest['ns_per_pair']:.1f}", f"{ratio:.2f}",
                          f"{TARGET[group]} {'met' if ratio <= TARGET[group] else '**missed**'}",
                          f"{exact['method']} {exact['ns_per_pair']:.1f}", f"{time / exact['ns_per_pair']:.2f}"])
    return table(["case, grid", "errors of svdag", "svdag, ns", "fastest peer, ns", "ratio", "target",
                  "fastest peer without error, ns", "ratio"], lines)


def bake_table(rows, program):
    """A table of whole bakes in memory by every method, and by the program from file to file."""
    own = next(iter(grouped(rows, "bake").values()))
    lines = [[m, f"{r['cpu_seconds']:.2f}", f"{r['misses']:,}", f"{r['extras']:,}"] for m, r in own.items()]
    report = OUT / "accuracy-bake.json"
    subprocess.run([program, "build", pathlib.Path(os.environ["SVDAG_SCENES"], BAKED[1]), "-r", BAKED[2], "-q", "-o",
                    OUT / "accuracy-bake.svdag", "--report", report], check=True)
    seconds = json.loads(report.read_text())["seconds"]
    lines.append([f"`svdag build`, from file to file ({seconds['total']:.2f} s by the clock)",
                  f"{seconds['cpu']:.2f}", "not judged here", "not judged here"])
    (OUT / "accuracy-bake.svdag").unlink()
    return table([f"{BAKED[0]}, {BAKED[2]}: {own[OURS]['voxels']:,} voxels, {own[OURS]['pairs']:,} pairs",
                  "CPU seconds", "misses", "extras"], lines)


def machine():
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")),
               platform.machine())
    compiler = subprocess.run(["g++", "--version"], capture_output=True, text=True).stdout.splitlines()[0]
    return f"Processor: {cpu}, {os.cpu_count()} cores. Compiler: {compiler}, release build."


def write(rows, path):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def rows_of(part, name, programs, tables_only):
    """The rows that `part` measures, or those of the last run."""
    path = OUT / f"{name}.csv"
    if not tables_only:
        write(part.measure(programs, OUT), path)
    with open(path, newline="") as file:
        return [{key: number(value) for key, value in row.items()} for row in csv.DictReader(file)]


def rays(programs, tables_only):
    """Fills in the table and the plot of rays; returns whether there is an error."""
    rows = rows_of(accuracy_rays, "rays", programs, tables_only)
    if "SVDAG_SCENES" in os.environ:
        fill(PAGE, {"rays": accuracy_rays.rays_table(rows)})
        accuracy_plots.rays_plot(rows, "accuracy_rays")
    return any(row["late"] + row["far"] + row.get("uncovered", 0) for row in rows)


def volume(programs, tables_only):
    rows = rows_of(accuracy_volume, "volume", programs, tables_only)
    if "SVDAG_SCENES" in os.environ:
        fill(PAGE, {"volume": accuracy_volume.volume_table(rows)})
        accuracy_plots.volume_plot(rows, "accuracy_volume")
    return False


PARTS = {"rays": rays, "volume": volume}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--tables-only", action="store_true", help="make the tables from the CSV files of the last run")
    parser.add_argument("--only", choices=PARTS, help="only this table and its plot")
    options = parser.parse_args()
    programs = options.programs.resolve()
    OUT.mkdir(parents=True, exist_ok=True)
    if options.only:
        return PARTS[options.only](programs, options.tables_only)
    rows = run_to_csv(programs / "tests" / "bench" / "accuracy_bench", OUT / "accuracy.csv",
                      not options.tables_only)
    ours = [r for r in rows if r["method"].startswith(OURS)]
    wrong = sum(r["misses"] + r["extras"] for r in ours)
    print(f"svdag: {wrong} errors in {sum(r['voxels'] for r in ours):,} voxels judged")
    if "SVDAG_SCENES" not in os.environ:
        print("SVDAG_SCENES is not set: docs/ is not changed")
        return wrong != 0
    print(ratio_table(rows), matrix(rows, "snapped", error_cell, {"svdag + reduction"}), bake_table(rows, programs / "svdag"),
          sep="\n\n")
    fill(PAGE, {"machine": machine(), "errors": matrix(rows, "world", error_cell, {"svdag + reduction"}),
                "times": matrix(rows, "world", lambda r: f"{r['ns_per_pair']:.0f}", groups=["scene"])})
    accuracy_plots.error_plot(grouped(rows, "scene"), "accuracy_scenes", columns=3)
    accuracy_plots.error_plot(grouped(rows, "family"), "accuracy_families", columns=3)
    failed = [part(programs, options.tables_only) for part in PARTS.values()]
    return any(failed) or wrong != 0


if __name__ == "__main__":
    sys.exit(main())
