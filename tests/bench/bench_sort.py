#!/usr/bin/env python3
"""`make bench-sort`: compares the external sort with std::sort and STXXL, and prints a table.

sort_bench (tests/bench/sort_bench.cpp) sorts 2^LOG2 keys of 32 bytes, in memory and with an eighth of that memory.
"""
import argparse
import csv
import os
import pathlib
import subprocess
import sys

from bench import OUT, ROOT, processor

COLUMNS = ["keys are", "memory", "sort", "keys", "wall", "cpu", "written", "read", "right"]


def measure(program, log2, rounds):
    """A row per kind of keys, memory and sort."""
    # Passive: waiting threads of STXXL sleep. Spinning slows it down fourfold on a busy machine.
    quiet = os.environ | {"STXXLLOGFILE": "/dev/null", "STXXLERRLOGFILE": "/dev/null", "OMP_WAIT_POLICY": "passive"}
    rows = []
    for memory in ["memory", "disk"]:
        done = subprocess.run([program, OUT, str(log2), str(rounds), memory], env=quiet, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        lines = [line for line in done.stdout.splitlines() if line.count(",") == len(COLUMNS) - 1]
        if done.returncode not in (0, 1) or not lines:
            sys.exit(f"sort_bench failed: {done.stderr}")
        rows += [dict(zip(COLUMNS, line.split(","))) for line in lines]
    if wrong := [row for row in rows if row["right"] != "1"]:
        sys.exit(f"not sorted, or not the same keys: {wrong}")
    return rows


def rate(row, seconds):
    return float(row["keys"]) / float(row[seconds]) / 1e6


def table(rows):
    lines = ["| keys | memory | sort | M keys/s | M keys per CPU second | bytes to disk and back, per key | "
             "times STXXL | by CPU |", "| --- | --- | --- | --: | --: | --: | --: | --: |"]
    for row in rows:
        peers = [r for r in rows if r["sort"] == "stxxl" and all(r[c] == row[c] for c in ("keys are", "memory"))]
        times = [f"{rate(row, s) / rate(peers[0], s):.1f}" if peers else "" for s in ("wall", "cpu")]
        bytes_per_key = float(row["written"]) + float(row["read"]) if row["memory"] != "all" else 0
        lines.append(f"| {row['keys are']} | {row['memory']} | {row['sort']} | {rate(row, 'wall'):.1f} | "
                     f"{rate(row, 'cpu'):.1f} | {bytes_per_key:.1f} | {' | '.join(times)} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--log2", type=int, default=24, help="log2 of the number of keys")
    parser.add_argument("--rounds", type=int, default=3, help="number of repetitions; the minimum time is used")
    options = parser.parse_args()
    OUT.mkdir(parents=True, exist_ok=True)
    rows = measure(options.programs.resolve() / "tests" / "bench" / "sort_bench", options.log2, options.rounds)
    if all(row["sort"] != "stxxl" for row in rows):
        print("STXXL is missing (Debian: libstxxl-dev)")
    print(f"{processor()}, {1 << options.log2:,} keys.\n\n{table(rows)}")
    with open(OUT / "sort.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
