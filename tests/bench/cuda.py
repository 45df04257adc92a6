#!/usr/bin/env python3
"""`make bench-cuda`: holds an NVIDIA GPU's rays against the processor's, bit by bit, and measures them.

Every scene is baked in both layouts; a pixel that differs in any bit ends the run with exit code 1. Writes the table
between the markers in docs/results/tracing.md.
"""
import argparse
import json
import pathlib
import subprocess
import sys

from bakes import Bakes, label
from bench import OUT, RESULTS, ROOT, fill, processor
from bench_tables import table

# Scene, log2 of the grid, options of svdag-trace.
CASES = [("sponza", 14, ["--camera", "-7,1.2,0,8,2,0,65", "--light", "0,7,0,0.5"]),
         ("sponza", 16, ["--camera", "-7,1.2,0,8,2,0,65", "--light", "0,7,0,0.5"]),
         ("hairball", 12, []), ("scan 9M", 14, []), ("city", 14, ["--preset", "front"])]
# All are compared; the first two are measured.
VARIANTS = [[], ["--gpu-tree"], ["--cone", "9"], ["--no-beams", "--rounds", "1"], ["--no-beams", "--gpu-tree", "--rounds", "1"]]
LAYOUTS = ["plain", "compact"]
COLUMNS = {"plain": "", "compact": "compact, ", "tree": "tree, "}
RAYS = ["primary", "shadow", "soft", "ao"]
SIZE = ["--size", "1280x720", "--samples", "16"]


def compare(tracer, dag, options):
    done = subprocess.run([tracer, dag, "--compare", "--json", *SIZE, *options], stdout=subprocess.PIPE, text=True)
    if done.returncode > 1:
        sys.exit(f"{dag}: svdag-trace failed")
    return json.loads(done.stdout)


def rate(result, kind):
    """Millions of rays per second."""
    row = next(row for row in result["workloads"] if row["workload"] == kind)
    return row["rays"] / row["seconds"] / 1e6


def measure(bakes, tracer, scene, log2, options):
    """The rows of a scene, the pixels compared, how many of them differ, and the device; a missing scene has none."""
    if bakes.scene(scene) is None:
        return [], 0, 0, None
    bakes.report(scene, log2)
    plain = bakes.dag_file()
    compact = plain.with_name("compact.svdag")
    subprocess.run([bakes.programs / "svdag", "convert", plain, "-o", compact, "--layout", "compact", "-q"], check=True)
    results = {layout: [compare(tracer, file, options + variant) for variant in VARIANTS]
               for layout, file in zip(LAYOUTS, [plain, compact])}
    found = [result for variants in results.values() for result in variants]
    gpu = {layout: variants[0]["cuda"] for layout, variants in results.items()} | {"tree": results["plain"][1]["cuda"]}
    cpu = results["plain"][0]["cpu"]
    row = [f"{scene} {label(bakes.log2(log2))}³", *[f"{rate(gpu[layout], kind):.0f}" for layout in COLUMNS for kind in RAYS],
           *[f"{rate(gpu['plain'], kind) / rate(cpu, kind):.0f}" for kind in RAYS]]
    return [row], sum(r["pixels"] for r in found), sum(r["different"] for r in found), gpu["plain"]["device"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--tracer", type=pathlib.Path, default=ROOT / "build" / "cuda" / "svdag-trace")
    parser.add_argument("--coarser", type=int, default=0, metavar="N", help="all grids N doublings lower; does not change docs/")
    options = parser.parse_args()
    bakes = Bakes(options.programs.resolve(), OUT, options.coarser)
    rows, pixels, different, device = [], 0, 0, None
    for case in CASES:
        own, compared, differing, name = measure(bakes, options.tracer.resolve(), *case)
        rows, pixels, different, device = rows + own, pixels + compared, different + differing, name or device
    text = (f"{device}, beside {processor()}: {different} of {pixels:,} pixels differ. MRays/s:\n\n" +
            table(["grid", *[f"{what}{kind}" for what in (*COLUMNS.values(), "GPU / CPU, ") for kind in RAYS]], rows))
    print(text)
    if not options.coarser:
        fill(RESULTS / "tracing.md", {"trace cuda": text})
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
