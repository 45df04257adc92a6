#!/usr/bin/env python3
"""`make bench-colour`: bytes, errors and speed of the colours of real scenes (SVDAG_SCENES), or else of the generated atrium.

Others, of the colours of real scenes: Dolonius 2017 3.7 bits a colour, Dado 2016 4.6, HashDAG 32. Greedy runs with the
headers of Dolonius, of the colours of the helmet at 1K³ with the largest error 12.75: 2.81 bits at 37.9 dB.
"""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

COLUMNS = [("scene", ""), ("level", "K"), ("error", ""), ("colours", "M colours"), ("bits", "bits a colour"),
           ("bits_per_cube", "bits a cube"), ("psnr", "PSNR, dB"), ("worst", "largest error"),
           ("encoded_per_second", "M encoded a second"), ("pass", "pass, CPU s"), ("pair_ns", "ns a pair"), ("random_ns", "look-up, ns: random"),
           ("ordered_ns", "in order"), ("dag_ns", "voxel alone")]
SHARED = [("helmet", "damaged_helmet.glb", ("512", "1K", "2K")), ("truck", "cesium_milk_truck_textured.glb", ("1K",)),
          ("capsule", "trimesh_capsule/capsule.obj", ("1K",)), ("forest", "stk_black_forest_textured.glb", ("2K",))]


def run(programs, program, *words):
    """Returns the output and CPU seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([programs / program, *map(str, words)], capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(f"{program} {words}: {done.stderr}")
    return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", type=pathlib.Path, required=True)
    programs = parser.parse_args().programs.resolve()
    shared = os.environ.get("SVDAG_SCENES")
    print("| " + " | ".join(title or key for key, title in COLUMNS) + " |")
    print("|---|" + "--:|" * (len(COLUMNS) - 1))
    with tempfile.TemporaryDirectory(prefix="svdag-colours-") as name:
        folder = pathlib.Path(name)
        scenes = [(kind, pathlib.Path(shared or "", file), grids) for kind, file, grids in SHARED]
        if shared is None:
            scenes = [("atrium", folder / "atrium.glb", ("1K", "2K"))]
            run(programs, "svdag-scene", "atrium", "-q", "-o", scenes[0][1])
        for kind, scene, grids in scenes:
            for grid in grids:
                dag, lossless, lossy = (folder / f"{kind}.svdag" for kind in ("dag", "lossless", "lossy"))
                run(programs, "svdag", "build", scene, "-o", dag, "-r", grid, "-q")
                levels = json.loads(run(programs, "svdag", "info", dag, "--json")[0])["levels"]
                # As the figures of others: a colour for each voxel.
                words = ["--colour-level", levels, "-q", "--threads", 1]
                run(programs, "svdag", "colour", dag, scene, "-o", lossless, "--colour-error", 0, *words)
                report = json.loads(run(programs, "svdag", "build", scene, "-o", lossy, "-r", grid, "--colours", "--json", *words)[0])
                pair_ns = round(1e9 * report["colours"]["walk_seconds"] / max(1, report["colours"]["pairs"]))
                for error in (12.25, 9):
                    _, cpu = run(programs, "svdag", "colour", dag, scene, "-o", lossy, "--colour-error", error, *words)
                    row = json.loads(run(programs, "tests/bench/colours_bench", lossy, lossless)[0])
                    row |= {"scene": f"{kind} {grid}³", "error": error, "pass": f"{cpu:.2f}", "pair_ns": pair_ns}
                    for key in ("colours", "encoded_per_second"):
                        row[key] = f"{row[key] / 1e6:.2f}"
                    print("| " + " | ".join(str(row[key]) for key, _ in COLUMNS) + " |", flush=True)
                    lossy.unlink()
                for file in (dag, lossless):
                    file.unlink()


if __name__ == "__main__":
    main()
