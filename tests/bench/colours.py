#!/usr/bin/env python3
"""`make bench-colour`: bytes, errors and speed of colours that are functions of the position.

Others, of the colours of real scenes: Dolonius 2017 3.7 bits a colour, Dado 2016 4.6, HashDAG 32.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

COLUMNS = [("scene", ""), ("level", ""), ("error", ""), ("colours", "M colours"), ("bits", "bits a colour"), ("psnr", "PSNR, dB"),
           ("worst", "largest error"), ("encoded_per_second", "M encoded a second"), ("random_ns", "look-up, ns: random"),
           ("ordered_ns", "in order"), ("dag_ns", "voxel alone")]
SCENES = [("city", "200K", "1K"), ("scan", "200K", "512"), ("atrium", "90K", "1K")]


def run(programs, program, *words):
    done = subprocess.run([programs / program, *map(str, words)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{program} {words}: {done.stderr}")
    return done.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", type=pathlib.Path, required=True)
    programs = parser.parse_args().programs.resolve()
    print("| " + " | ".join(title or key for key, title in COLUMNS) + " |")
    print("|---|" + "--:|" * (len(COLUMNS) - 1))
    with tempfile.TemporaryDirectory(prefix="svdag-colours-") as name:
        folder = pathlib.Path(name)
        for kind, count, resolution in SCENES:
            scene, dag = folder / f"{kind}.{'obj' if kind == 'atrium' else 'ply'}", folder / "a.svdag"
            run(programs, "svdag-scene", kind, "-n", count, "-q", "-o", scene)
            run(programs, "svdag", "build", scene, "-o", dag, "-r", resolution, "-q")
            levels = json.loads(run(programs, "svdag", "info", dag, "--json"))["levels"]
            for level, error in [(levels, 9), (levels, 12.75), (levels, 0), (levels - 2, 9)]:
                row = json.loads(run(programs, "tests/bench/colours_bench", dag, level, error, folder / "b.svdag"))
                row |= {"scene": f"{kind} {resolution}³", "level": level, "error": error}
                for key in ("colours", "encoded_per_second"):
                    row[key] = f"{row[key] / 1e6:.2f}"
                print("| " + " | ".join(str(row[key]) for key, _ in COLUMNS) + " |", flush=True)


if __name__ == "__main__":
    main()
