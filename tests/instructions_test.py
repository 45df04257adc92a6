#!/usr/bin/env python3
"""Instructions of small bakes under callgrind, against tests/instructions.json.

Seconds vary from run to run, instructions hardly: a slow path that comes back shows here. More than
RISE fails; less than FALL requests an --update of the numbers, so that the gain is kept. Vectors are
fixed to what valgrind emulates; the numbers belong to the release build of the Debian that make test names.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

HERE = pathlib.Path(__file__).resolve().parent
KNOWN = HERE / "instructions.json"
RISE, FALL = 1.05, 0.80
VECTORS = "SSE4"
# name: (arguments of svdag-scene, of svdag build)
BAKES = {"atrium": (["atrium", "-n", "90K"], ["-r", "512"]), "scan": (["scan", "-n", "20K"], ["-r", "512"]),
         "sheet": (["sheet"], ["-r", "4K"]), "thin": (["atrium", "-n", "90K"], ["-r", "512", "--rule", "thin"])}


def count(programs, name, folder):
    """Instructions of one bake with one thread."""
    (scene, grid), ply = BAKES[name], folder / f"{name}.ply"
    subprocess.run([programs / "svdag-scene", *scene, "-q", "-o", ply], check=True)
    done = subprocess.run(
        ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder / name}.out",
         programs / "svdag", "build", ply,
         *grid, "-o", folder / f"{name}.svdag", "-j", "1", "-m", "1G", "--vectors", VECTORS, "-q"],
        stdin=subprocess.DEVNULL, capture_output=True, text=True, env=dict(os.environ, LC_ALL="C"))
    collected = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or not collected:
        sys.exit(f"{name} did not run under callgrind:\n{done.stderr}")
    return int(collected.group(1))


def complaint(name, now, known):
    if known is None:
        return f"{name}: {now:,} instructions, and no number is kept"
    if now > RISE * known:
        return f"{name}: {now:,} instructions, {now / known - 1:.1%} more than the {known:,} that are kept"
    if now < FALL * known:
        return f"{name}: {now:,} instructions, {1 - now / known:.1%} less than the {known:,} that are kept: keep the gain"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path, help="folder of the built programs")
    parser.add_argument("--update", action="store_true", help="keep what the programs need now")
    options = parser.parse_args()
    if shutil.which("valgrind") is None:
        print("valgrind is not on PATH (make deps installs it).\n0 passed, 0 failed, 1 skipped")
        return 0
    with tempfile.TemporaryDirectory(prefix="svdag-instructions-") as folder, ThreadPoolExecutor(os.cpu_count()) as pool:
        counts = dict(zip(BAKES, pool.map(lambda name: count(options.programs, name, pathlib.Path(folder)), BAKES)))
    if options.update:
        KNOWN.write_text(json.dumps(counts, indent=2) + "\n")
    known = json.loads(KNOWN.read_text())
    complaints = [c for c in (complaint(name, now, known.get(name)) for name, now in counts.items()) if c]
    for name, now in counts.items():
        print(f"{name}: {now:,} instructions, {now / known.get(name, now):.3f} of what is kept")
    if complaints:
        print(*complaints, sep="\n")
        print("If this is meant to be: tests/instructions_test.py build/release --update")
    print(f"{len(counts) - len(complaints)} passed, {len(complaints)} failed, 0 skipped")
    return len(complaints) > 0


if __name__ == "__main__":
    sys.exit(main())
