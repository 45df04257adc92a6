#!/usr/bin/env python3
"""`make bench-before BEFORE=FOLDER`: prints a table of the programs of this version beside those of another, in turns.

Seconds and memory of a machine say little about a change, since they differ from machine to machine and from hour to hour; ratios
of commands that take turns do. Each cell is the least of all rounds, before and now, and the median of the rounds' ratios.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

from bakes import Bakes
from bench import OUT, ROOT, processor
from bench_tables import table

# (work, rounds, words of the command): a name of tests/bench/bakes.py is a scene.
WORKS = [("sponza 64K³", 5, ["build", "sponza", "-r", "64K"]),
         ("sponza 16K³", 7, ["build", "sponza", "-r", "16K"]),
         ("sponza 16K³, one thread", 5, ["build", "sponza", "-r", "16K", "-j", "1"]),
         ("scan of 9M triangles 16K³", 3, ["build", "scan 9M", "-r", "16K"]),
         ("scan of 70K triangles 8K³", 9, ["build", "scan 70K", "-r", "8K"]),
         ("hairball of 2.88M triangles 4K³", 5, ["build", "hairball", "-r", "4K"]),
         ("merge of 16 runs of sponza 64K³", 5, ["merge", "RUNS"])]


class Before:
    def __init__(self, programs, before, folder):
        self.svdags = [before / "svdag", programs / "svdag"]
        self.bakes = Bakes(programs, folder)
        self.output = folder / "before.svdag"

    def call(self, *words):
        subprocess.run([self.svdags[0], *words, "-q"], check=True)

    def runs(self):
        """The runs of the shards of a plan, baked by the version before."""
        plan = self.bakes.folder / "before.plan"
        self.call("plan", self.bakes.scene("sponza"), "-r", "64K", "--shards", "16", "-o", plan)
        shards = [step for step in json.loads((plan / "plan.json").read_text())["steps"] if step["name"].startswith("shard")]
        for step in shards:
            self.call(*step["command"][1:])
        return [plan / step["output"] for step in shards]

    def words(self, words):
        """The words of a command, with the paths of what they name."""
        command, name, *options = words
        inputs = self.runs() if name == "RUNS" else [self.bakes.scene(name)]
        return [command, *inputs, *options]

    def measure(self, svdag, words):
        """(wall seconds, CPU seconds, peak MiB)"""
        self.output.unlink(missing_ok=True)
        begin = time.monotonic()
        pid = os.posix_spawn(svdag, [svdag, *words, "-q", "-o", self.output], os.environ)
        _, status, usage = os.wait4(pid, 0)
        if status != 0:
            sys.exit(f"{svdag} {words}: failed")
        return time.monotonic() - begin, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024

    def row(self, work, rounds, words):
        words = self.words(words)
        measured = ([], [])  # before, now
        for i in range(rounds):
            for at in (0, 1) if i % 2 else (1, 0):
                measured[at].append(self.measure(self.svdags[at], words))
        cells = [work]
        for unit, digits in enumerate((".2f", ".2f", ",.0f")):
            before, now = ([m[unit] for m in versions] for versions in measured)
            ratio = statistics.median(n / b for b, n in zip(before, now))
            cells.append(f"{min(before):{digits}} → {min(now):{digits}} ({ratio:.2f})")
        print(" | ".join(cells), flush=True)
        return cells


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--before", type=pathlib.Path, required=True, help="the folder of the other version's svdag")
    options = parser.parse_args()
    if not (options.before / "svdag").exists():
        sys.exit(f"BEFORE={options.before} is not a folder with svdag")
    OUT.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="before-", dir=OUT) as folder:
        before = Before(options.programs.resolve(), options.before.resolve(), pathlib.Path(folder))
        if before.bakes.scene("sponza") is None:
            sys.exit("SVDAG_SCENES is not a folder with crytek_sponza.glb")
        rows = [before.row(*work) for work in WORKS]
    print(f"{processor()}.\n\n" + table(["work", "wall s", "CPU s", "peak MiB"], rows))


if __name__ == "__main__":
    main()
