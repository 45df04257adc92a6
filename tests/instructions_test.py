#!/usr/bin/env python3
"""Compares the instruction counts of small bakes under callgrind with those in tests/instructions.json.

Times vary from run to run, instruction counts hardly, so this test finds performance regressions. A ratio above
RISE fails. A ratio below FALL fails too: record the improvement with --update. The instruction set is fixed to one
that valgrind emulates; the counts are of the release build on the Debian version of `make test`.
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
EXPECTED = HERE / "instructions.json"
RISE, FALL = 1.05, 0.80
VECTORS = "SSE4"
# name: (arguments of svdag-scene, of svdag build)
BAKES = {"atrium": (["atrium", "-n", "90K"], ["-r", "512"]), "scan": (["scan", "-n", "20K"], ["-r", "512"]),
         "sheet": (["sheet"], ["-r", "4K"]), "thin": (["atrium", "-n", "90K"], ["-r", "512", "--rule", "thin"])}


def count(programs, name, folder):
    """Number of instructions of one bake with one thread."""
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


def failure(name, now, expected):
    if expected is None:
        return f"{name}: {now:,} instructions, no expected count is recorded: record it with --update"
    if now > RISE * expected:
        return f"{name}: {now:,} instructions, {now / expected - 1:.1%} more than the expected {expected:,}"
    if now < FALL * expected:
        return (f"{name}: {now:,} instructions, {1 - now / expected:.1%} less than the expected {expected:,}: "
                "record it with --update")
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path, help="folder of the built programs")
    parser.add_argument("--update", action="store_true", help="record the counts of these programs")
    options = parser.parse_args()
    if shutil.which("valgrind") is None:
        print("valgrind is not on PATH (make deps installs it).\n0 passed, 0 failed, 1 skipped")
        return 0
    with tempfile.TemporaryDirectory(prefix="svdag-instructions-") as folder, ThreadPoolExecutor(os.cpu_count()) as pool:
        counts = dict(zip(BAKES, pool.map(lambda name: count(options.programs, name, pathlib.Path(folder)), BAKES)))
    if options.update:
        EXPECTED.write_text(json.dumps(counts, indent=2) + "\n")
    expected = json.loads(EXPECTED.read_text())
    failures = [c for c in (failure(name, now, expected.get(name)) for name, now in counts.items()) if c]
    for name, now in counts.items():
        print(f"{name}: {now:,} instructions, {now / expected.get(name, now):.3f} of the expected count")
    if failures:
        print(*failures, sep="\n")
        print("If this is intended: tests/instructions_test.py build/release --update")
    print(f"{len(counts) - len(failures)} passed, {len(failures)} failed, 0 skipped")
    return len(failures) > 0


if __name__ == "__main__":
    sys.exit(main())
