#!/usr/bin/env python3
"""`make bench-out-of-core`: bakes with much less memory than they have data, watched from outside.

Each row is one bake; its figures go to build/bench/out_of_core.json and the table between the markers of
docs/performance.md. With --rows the others keep the figures they had. Scenes and outputs are removed as soon as no
row needs them; 30 GB of disk have to be free.
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

KNOWN = OUT / "out_of_core.json"
MIB = 1 << 20
MARGIN = 64 * MIB  # beside --memory: code, stacks, the heap's small change
SMALL = 1e6  # bytes of a file with which scratch is not compared
HEAD = ["scene", "memory", "seconds", "CPU", "counted MiB", "own MiB", "resident MiB", "limit MiB", "file MB",
        "scratch MB", "scratch / file", "read / scene", "content", "asked"]
LOOK = 0.01  # seconds between two looks at a process


class Asked(NamedTuple):
    """A figure that a row is to reach: `of`(row, all rows) at most `most`."""
    what: str
    most: float
    of: callable

    def verdict(self, row, rows):
        value = self.of(row, rows)
        return f"{self.what} ≤ {self.most:g}: " + ("–" if value is None else "yes" if value <= self.most else "**no**")


class Row(NamedTuple):
    name: str
    scene: str
    log2: int
    memory: str  # "" for the default
    asked: list


def wall(seconds):
    return Asked("seconds", seconds, lambda row, rows: row["wall"])


def times_wall(times, other):
    return Asked(f"times {other}", times, lambda row, rows: row["wall"] / rows[other]["wall"] if other in rows else None)


HELD = Asked("peak / limit", 1, lambda row, rows: row["own"] / row["limit"] if row["limit"] else 0)
SCRATCH = Asked("scratch / file", 6, lambda row, rows: row["scratch"])
READ = Asked("read / scene", 6, lambda row, rows: row["read"])
ROWS = [
    Row("hairball-16K", "hairball", 14, "2G", [HELD, wall(180), SCRATCH]),
    Row("scan-1G", "scan 100M", 14, "1G", [HELD, READ]),
    Row("scan-256M", "scan 100M", 14, "256M", [HELD, READ]),
    Row("shuffled-1G", "scan 100M, shuffled", 14, "1G", [HELD, READ]),
    Row("shuffled-256M", "scan 100M, shuffled", 14, "256M", [HELD, READ]),
    Row("speck", "speck", 16, "128M", [HELD]),
    Row("sponza", "sponza", 16, "", []),
    Row("sponza-512M", "sponza", 16, "512M", [HELD, times_wall(2, "sponza")]),
    Row("hairball-32K", "hairball", 15, "4G", [HELD, wall(600)]),
]


def bytes_of(memory):
    return int(memory[:-1]) * {"M": MIB, "G": 1024 * MIB}[memory[-1]] if memory else 0


def watched(command):
    """(exit code, Peak, rusage)."""
    program = subprocess.Popen(command)
    peak = Peak(program.pid, LOOK)
    peak.start()
    _, status, usage = os.wait4(program.pid, 0)
    program.returncode = os.waitstatus_to_exitcode(status)
    peak.done.set()
    peak.join()
    return program.returncode, peak, usage


def measure(bakes, row):
    """What one bake took, as it is kept in out_of_core.json."""
    scene, report_file = bakes.scene(row.scene), bakes.folder / "report.json"
    command = [bakes.programs / "svdag", "build", scene, "-r", label(row.log2), "-o", bakes.dag_file(), "-q", "--restart",
               "--report", report_file, *(["-m", row.memory] if row.memory else [])]
    code, peak, usage = watched(command)
    if code != 0:
        return {"failed": f"svdag ended with {code}"}
    report, limit = json.loads(report_file.read_text()), bytes_of(row.memory)
    return {"wall": report["seconds"]["total"], "cpu": usage.ru_utime + usage.ru_stime, "seconds": report["seconds"],
            "counted": report["memory"]["peak_counted"],
            # The kernel's own peak counts files, too, and misses no moment.
            "own": max(peak.own, 1024 * usage.ru_maxrss - peak.of_files), "resident": 1024 * usage.ru_maxrss,
            "limit": limit + MARGIN if limit else 0, "file": report["file_bytes"],
            "scratch": report["scratch"]["peak"] / report["file_bytes"], "runs": report["runs"],
            "read": (peak.read - report["scratch"]["read"]) / scene.stat().st_size, "hash": report["content_hash"]}


def content(row):
    """Rows of which this is the same are to give the same bytes."""
    return row.scene.split(",")[0], row.log2


def assert_same_hashes(known):
    hashes = {}
    for row in ROWS:
        if "hash" in known.get(row.name, {}):
            hashes.setdefault(content(row), set()).add(known[row.name]["hash"])
    for (scene, log2), found in hashes.items():
        assert len(found) == 1, f"{scene} at {label(log2)}: {sorted(found)}"


def line(row, known):
    m, head = known[row.name], [f"{row.scene}, {label(row.log2)}³", row.memory or "default"]
    if "failed" in m:
        return [*head, *[""] * (len(HEAD) - 3), m["failed"]]
    good = {name: other for name, other in known.items() if "wall" in other}
    return [*head, f"{m['wall']:.1f}", f"{m['cpu']:.1f}", *[f"{m[key] / MIB:,.0f}" for key in ("counted", "own", "resident")],
            f"{m['limit'] / MIB:,.0f}" if m["limit"] else "–", f"{m['file'] / 1e6:,.0f}",
            f"{m['scratch'] * m['file'] / 1e6:,.0f}", f"{m['scratch']:.1f}" if m["file"] > SMALL else "–",
            f"{m['read']:.1f}", m["hash"][:8], ", ".join(asked.verdict(m, good) for asked in row.asked)]


def made_table(known):
    return table(HEAD, [line(row, known) for row in ROWS if row.name in known])


def clean_up(bakes, scene, needed, keep):
    bakes.dag_file().unlink(missing_ok=True)
    if not keep and scene not in needed and scene in GENERATED:
        bakes.generated_file(scene).unlink(missing_ok=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--rows", nargs="*", choices=[row.name for row in ROWS], help="only these")
    parser.add_argument("--keep-scenes", action="store_true", help="the generated scenes stay in build/bench")
    parser.add_argument("--json-only", action="store_true", help="leave docs/ alone")
    options = parser.parse_args()
    bakes = Bakes(options.programs.resolve(), OUT)
    known = json.loads(KNOWN.read_text()) if options.rows and KNOWN.exists() else {}
    wanted = [row for row in ROWS if not options.rows or row.name in options.rows]
    for i, row in enumerate(wanted):
        if bakes.scene(row.scene) is None:
            continue
        known[row.name] = measure(bakes, row)
        KNOWN.write_text(json.dumps(known, indent=1))
        print(" | ".join(line(row, known)), flush=True)
        clean_up(bakes, row.scene, {later.scene for later in wanted[i + 1:]}, options.keep_scenes)
    print(made_table(known))
    assert_same_hashes(known)
    failed = [row.name for row in wanted if row.name in known
              and ("failed" in known[row.name] or "**no**" in HELD.verdict(known[row.name], known))]
    if failed:
        sys.exit(f"docs/ stay as they are: {', '.join(failed)} failed, or took more than its memory")
    missing = [row.name for row in ROWS if row.name not in known]
    if missing and not options.json_only:
        sys.exit(f"docs/ stay as they are: {', '.join(missing)} was never measured (SVDAG_SCENES names the folder of sponza)")
    if not options.json_only:
        fill(PAGE, {"out of core": made_table(known)})


if __name__ == "__main__":
    main()
