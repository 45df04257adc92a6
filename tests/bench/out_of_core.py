#!/usr/bin/env python3
"""`make bench-out-of-core`: measures bakes whose data is much larger than their memory.

Each row is one bake; its results are written to build/bench/out_of_core.json and to the table between the markers in
docs/results/performance.md. With --rows, the other rows keep their earlier results. Scenes and outputs are removed as soon as
no row needs them; 40 GB of disk must be free.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
from typing import NamedTuple

from bakes import GENERATED, Bakes, label
from bench import OUT, PAGE, ROOT, fill
from bench_tables import table

sys.path.append(str(ROOT / "tests" / "fault"))
from peak import Peak  # noqa: E402

RESULTS = OUT / "out_of_core.json"
MIB = 1 << 20
MARGIN = 64 * MIB  # memory beyond --memory: code, stacks, small allocations
SMALL = 1e6  # bytes; the scratch space is not compared with smaller files
HEAD = ["scene", "memory", "seconds", "CPU", "own MiB", "limit MiB", "file MB", "scratch / file",
        "read / scene", "missed targets"]
POLL_SECONDS = 0.01  # interval at which the memory of a process is polled


class Target(NamedTuple):
    """A limit on a result: value(row, all rows) <= max_value."""
    what: str
    max_value: float
    value: callable

    def is_missed(self, row, rows):
        value = self.value(row, rows)
        return value is not None and value > self.max_value


class Row(NamedTuple):
    name: str
    scene: str
    log2: int
    memory: str  # "" for the default
    targets: list


def wall(seconds):
    return Target("seconds", seconds, lambda row, rows: row["wall"])


def times_wall(times, other):
    return Target(f"times {other}", times,
                  lambda row, rows: row["wall"] / rows[other]["wall"] if other in rows else None)


MEMORY = Target("peak / limit", 1, lambda row, rows: row["own"] / row["limit"] if row["limit"] else 0)
SCRATCH = Target("scratch / file", 6, lambda row, rows: row["scratch"])
SCAN_SCRATCH = Target("scratch / file", 7, lambda row, rows: row["scratch"])  # 35 bytes a triangle
READ = Target("read / scene", 2.2, lambda row, rows: row["read"])
ROWS = [
    Row("hairball-16K", "hairball", 14, "2G", [MEMORY, wall(180), SCRATCH]),
    Row("scan-1G", "scan 100M", 14, "1G", [MEMORY, SCAN_SCRATCH, READ]),
    Row("scan-256M", "scan 100M", 14, "256M", [MEMORY, SCAN_SCRATCH, READ]),
    Row("shuffled-1G", "scan 100M, shuffled", 14, "1G", [MEMORY, READ]),
    Row("shuffled-256M", "scan 100M, shuffled", 14, "256M", [MEMORY, READ]),
    Row("speck", "speck", 16, "128M", [MEMORY]),
    Row("sponza", "sponza", 16, "", []),
    Row("sponza-512M", "sponza", 16, "512M", [MEMORY, times_wall(2, "sponza")]),
    Row("hairball-32K", "hairball", 15, "4G", [MEMORY, wall(600)]),
    Row("hairball-64K", "hairball", 16, "8G", [MEMORY, wall(900)]),
]


def bytes_of(memory):
    return int(memory[:-1]) * {"M": MIB, "G": 1024 * MIB}[memory[-1]] if memory else 0


def run_watched(command, watch=None, **streams):
    """(exit code, Peak, rusage). watch(program) may look at it until it ends; `streams` are those of Popen."""
    program = subprocess.Popen(command, **streams)
    peak = Peak(program.pid, POLL_SECONDS)
    peak.start()
    if watch is not None:
        watch(program)
    _, status, usage = os.wait4(program.pid, 0)
    program.returncode = os.waitstatus_to_exitcode(status)
    peak.done.set()
    peak.join()
    return program.returncode, peak, usage


def measure(bakes, row):
    """The results of one bake, as stored in out_of_core.json."""
    scene, report_file = bakes.scene(row.scene), bakes.folder / "report.json"
    command = [bakes.programs / "svdag", "build", scene, "-r", label(row.log2), "-o", bakes.dag_file(), "-q", "--restart",
               "--report", report_file, *(["-m", row.memory] if row.memory else [])]
    code, peak, usage = run_watched(command)
    if code != 0:
        return {"failed": f"svdag failed with exit code {code}"}
    report, limit = json.loads(report_file.read_text()), bytes_of(row.memory)
    return {"wall": report["seconds"]["total"], "cpu": usage.ru_utime + usage.ru_stime, "seconds": report["seconds"],
            # The kernel's peak includes mapped files, but misses no moment between two polls.
            "own": max(peak.own, 1024 * usage.ru_maxrss - peak.of_files), "resident": 1024 * usage.ru_maxrss,
            "limit": limit + MARGIN if limit else 0, "file": report["file_bytes"],
            "scratch": report["scratch"]["peak"] / report["file_bytes"], "runs": report["runs"],
            "read": (peak.read - report["scratch"]["read"]) / scene.stat().st_size, "hash": report["content_hash"]}


def output_key(row):
    """Identifies the output: rows with equal keys must give the same bytes."""
    return row.scene.split(",")[0], row.log2


def assert_same_hashes(results):
    hashes = {}
    for row in ROWS:
        if "hash" in results.get(row.name, {}):
            hashes.setdefault(output_key(row), set()).add(results[row.name]["hash"])
    for (scene, log2), found in hashes.items():
        assert len(found) == 1, f"{scene} at {label(log2)}: {sorted(found)}"


def line(row, results):
    m, head = results[row.name], [f"{row.scene}, {label(row.log2)}³", row.memory or "default"]
    if "failed" in m:
        return [*head, *[""] * (len(HEAD) - 3), m["failed"]]
    good = {name: other for name, other in results.items() if "wall" in other}
    return [*head, f"{m['wall']:.1f}", f"{m['cpu']:.1f}", f"{m['own'] / MIB:,.0f}",
            f"{m['limit'] / MIB:,.0f}" if m["limit"] else "–", f"{m['file'] / 1e6:,.0f}",
            f"{m['scratch']:.1f}" if m["file"] > SMALL else "–", f"{m['read']:.1f}",
            ", ".join(f"{t.what} ≤ {t.max_value:g}" for t in row.targets if t.is_missed(m, good)) or "none"]


def results_table(results):
    return table(HEAD, [line(row, results) for row in ROWS if row.name in results])


def clean_up(bakes, scene, needed, keep):
    bakes.dag_file().unlink(missing_ok=True)
    if not keep and scene not in needed and scene in GENERATED:
        bakes.generated_file(scene).unlink(missing_ok=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--rows", nargs="*", choices=[row.name for row in ROWS], help="only these rows")
    parser.add_argument("--keep-scenes", action="store_true", help="keep the generated scenes in build/bench")
    parser.add_argument("--json-only", action="store_true", help="do not change docs/")
    options = parser.parse_args()
    bakes = Bakes(options.programs.resolve(), OUT)
    results = json.loads(RESULTS.read_text()) if options.rows and RESULTS.exists() else {}
    selected = [row for row in ROWS if not options.rows or row.name in options.rows]
    for i, row in enumerate(selected):
        if bakes.scene(row.scene) is None:
            continue
        results[row.name] = measure(bakes, row)
        RESULTS.write_text(json.dumps(results, indent=1))
        print(" | ".join(line(row, results)), flush=True)
        clean_up(bakes, row.scene, {later.scene for later in selected[i + 1:]}, options.keep_scenes)
    print(results_table(results))
    assert_same_hashes(results)
    failed = [row.name for row in selected if row.name in results
              and ("failed" in results[row.name] or MEMORY.is_missed(results[row.name], results))]
    if failed:
        sys.exit(f"docs/ is not changed: {', '.join(failed)} failed or exceeded its memory")
    missing = [row.name for row in ROWS if row.name not in results]
    if missing and not options.json_only:
        sys.exit(f"docs/ is not changed: {', '.join(missing)} not measured yet (sponza is in the folder SVDAG_SCENES)")
    if not options.json_only:
        fill(PAGE, {"out of core": results_table(results)})


if __name__ == "__main__":
    main()
