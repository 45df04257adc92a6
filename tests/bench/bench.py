#!/usr/bin/env python3
"""`make bench`: measures bakes of scenes at rising resolutions.

Every bake is a row of build/bench/bakes.csv; levels.csv has a row per level. The tables are written between the
markers in docs/results/performance.md and README.md, the plots to docs/images. Scenes are generated or, if it is set, in the
folder SVDAG_SCENES. `make bench-giants` (--giants) updates only the table of giants.
"""
import argparse
import csv
import os
import pathlib
import re
import subprocess
import sys

import bench_figures
import bench_tables as tables
from bakes import Bakes
from bench_plots import plot

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
OUT = ROOT / "build" / "bench"
RESULTS = ROOT / "docs" / "results"
PAGE = RESULTS / "performance.md"
README = ROOT / "README.md"
# Log2 of the highest resolution of each scene; all start at LOWEST.
SCENES = {"atrium": 17, "scan": 14, "sponza": 16, "dragon": 14}
LOWEST = 9
WITHOUT_MEMO = {"atrium": range(12, 15), "sponza": range(12, 16)}
THREADS = {"sponza": 14, "scan": 13}


def bake_scenes(bakes, selected):
    """(rows of bakes, rows of levels)"""
    rows, levels = [], []
    for name in selected:
        for log2 in range(LOWEST, SCENES[name] + 1):
            row = bakes.bake(name, log2)
            if row is None:
                break
            info = bakes.info()
            rows.append(row | {"svo_nodes": info["svo_nodes"], "nodes_paper": info["paper_dag_nodes"],
                               "svo_nodes_16": info["level_table"][row["log2"] - 4]["svo_nodes"]})
            levels += [{"scene": name, "resolution": row["resolution"], "level": k, "svo_nodes": level["svo_nodes"],
                        "dag_nodes": level["dag_nodes"], "bytes": level["bytes"]}
                       for k, level in enumerate(info["level_table"] + [{**info["blocks"], "bytes": 0}])]
    return rows, levels


def bake_without_memo(bakes, selected):
    return [(bakes.bake(name, log2), bakes.bake(name, log2, "--no-plane-memo"))
            for name, grids in WITHOUT_MEMO.items() if name in selected and bakes.scene(name) for log2 in grids]


def bake_with_threads(bakes, selected):
    """Per scene, the rows with 1, 2, 4 ... threads."""
    powers = [1 << k for k in range(len(os.sched_getaffinity(0)).bit_length())]
    return [[bakes.bake(name, log2, "-j", str(n)) for n in powers]
            for name, log2 in THREADS.items() if name in selected and bakes.scene(name)]


def processor(threads=len(os.sched_getaffinity(0))):
    """The name of the processor, and the number of threads."""
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return f"{model.group(1) if model else 'unknown processor'}, {threads} threads"


def machine(row):
    """Processor, vectors and compiler, to compare times."""
    compiler = subprocess.run(["c++", "--version"], capture_output=True, text=True).stdout.splitlines()[0]
    return (f"{processor(row['threads'])}, vectors {row['vectors']} "
            f"({32 * row['lanes']} bits, {row['lanes']} floats). Compiler: {compiler}, release build.")


def write_csv(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def fill(page, contents):
    """Replaces the text between the markers of each name in `page`."""
    text = page.read_text()
    for marker, content in contents.items():
        pattern = re.compile(rf"(<!-- {marker} -->\n).*?(<!-- end {marker} -->)", re.S)
        if not pattern.search(text):
            sys.exit(f"{page.name}: the markers <!-- {marker} --> and <!-- end {marker} --> are missing")
        text = pattern.sub(lambda m: m.group(1) + content + "\n" + m.group(2), text)
    page.write_text(text)


def skipped_scenes(bakes, selected):
    """Scenes that are missing or not selected, whose rows the tables would lose."""
    return [name for name in SCENES if name not in selected or bakes.scene(name) is None]


def bench(bakes, selected, csv_only):
    missing = skipped_scenes(bakes, selected)
    if missing and not csv_only:
        print(f"docs/ and README.md are not changed: {', '.join(missing)} not measured "
              "(sponza and dragon are in the folder SVDAG_SCENES)", file=sys.stderr)
        csv_only = True
    rows, levels = bake_scenes(bakes, selected)
    if not rows:
        sys.exit("all selected scenes are missing: set SVDAG_SCENES")
    pairs, groups = bake_without_memo(bakes, selected), bake_with_threads(bakes, selected)
    contents = {"figures": machine(rows[-1]) + "\n\n" + bench_figures.figures(bakes, rows[-1]["vectors"]), "bakes": tables.bakes(rows)}
    print(*contents.values(), tables.papers_layout(rows), tables.memo(rows), tables.growths(rows), tables.without_memo(pairs),
          tables.threads(groups), sep="\n\n")
    write_csv(OUT / "bakes.csv", bakes.rows())
    write_csv(OUT / "levels.csv", levels)
    if csv_only:
        return
    fill(PAGE, contents)
    fill(README, {"figures": tables.readme(rows)})
    plot(rows, ROOT / "docs" / "images" / "seconds.svg", lambda r: r["s_total"], "seconds")
    plot(rows, ROOT / "docs" / "images" / "nodes.svg", lambda r: r["nodes"], "DAG nodes (4³ leaves)")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--coarser", type=int, default=0, metavar="N",
                        help="all resolutions N doublings lower, to test this script; requires --csv-only")
    parser.add_argument("--csv-only", action="store_true", help="do not change docs/ and README.md")
    parser.add_argument("--giants", action="store_true", help="only the table of giants (up to an hour)")
    parser.add_argument("scenes", nargs="*", help="scenes to bake (default: all): " + ", ".join(SCENES))
    options = parser.parse_args()
    if options.coarser and not options.csv_only or not set(options.scenes) <= set(SCENES):
        parser.error("--coarser requires --csv-only" if options.coarser else "unknown scenes")
    bakes = Bakes(options.programs.resolve(), OUT, options.coarser)
    if options.giants:
        content, failed = bench_figures.giants(bakes)
        print(content)
        if bakes.rows():
            write_csv(OUT / "giants.csv", bakes.rows())
        if failed:
            sys.exit("docs/ is not changed: a giant failed")
        if not options.csv_only:
            fill(PAGE, {"giants": content})
    else:
        bench(bakes, options.scenes or list(SCENES), options.csv_only)
    bakes.dag_file().unlink(missing_ok=True)


if __name__ == "__main__":
    main()
