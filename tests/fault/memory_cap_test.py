#!/usr/bin/env python3
"""Under a cap from outside of --memory + 64 MiB a bake is not killed, gives the same bytes, and stays within.

The cap is a cgroup if SVDAG_CGROUP names a folder of the memory controller (v1 or v2) that was given to us,
else RLIMIT_DATA, which counts what is mapped, touched or not.
"""
import contextlib
import os
import pathlib
import resource
import shutil
import subprocess
from typing import NamedTuple

import bakes
from peak import Peak

MIB = 1 << 20
MARGIN = 64 * MIB  # code, stacks, the heap's small change
GIVEN_CGROUP = os.environ.get("SVDAG_CGROUP")


class Row(NamedTuple):
    """A bake within a budget; the verdict is "finishes", or "refuses" (exit 5, one sentence)."""
    scene: list
    resolution: str
    threads: int
    mib: int
    verdict: str


HAIRBALL, CITY, ATRIUM, TERRAIN = (["hairball", "-n", "100K"], ["city", "-n", "60K"], ["atrium", "-n", "200K"],
                                   ["terrain", "-n", "200K"])
ROWS = [Row(HAIRBALL, "8K", 2, 32, "finishes"), Row(HAIRBALL, "8K", 2, 96, "finishes"),
        Row(CITY, "4K", 1, 64, "finishes"), Row(ATRIUM, "4K", 2, 32, "finishes"), Row(TERRAIN, "4K", 2, 96, "finishes")]
ROWS_LONG = ROWS + [
    Row(scene, resolution, threads, mib, "finishes")
    for scene, resolution in [(HAIRBALL, "16K"), (CITY, "16K"), (ATRIUM, "8K"), (TERRAIN, "8K"),
                              (["scan", "-n", "1M"], "4K")]
    for threads in (1, 2) for mib in (96, 256, 512, 1024, 4096)]


@contextlib.contextmanager
def cap(limit):
    """What a child calls before it becomes the program, so that it gets `limit` bytes at most."""
    if GIVEN_CGROUP is None:
        yield lambda: resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
        return
    group = pathlib.Path(GIVEN_CGROUP) / f"svdag-test-{os.getpid()}"
    group.mkdir()
    try:
        v2 = (group / "memory.max").exists()
        (group / ("memory.max" if v2 else "memory.limit_in_bytes")).write_text(str(limit))
        with contextlib.suppress(OSError):  # no swap: the cap is about memory
            (group / ("memory.swap.max" if v2 else "memory.memsw.limit_in_bytes")).write_text("0" if v2 else str(limit))
        yield lambda: (group / "cgroup.procs").write_text(str(os.getpid()))
    finally:
        group.rmdir()


def run_capped(command, cwd, limit):
    """(exit code, stderr, peak bytes)."""
    with cap(limit) as enter:
        program = subprocess.Popen(command, cwd=cwd, stderr=subprocess.PIPE, text=True, preexec_fn=enter)
        peak = Peak(program.pid)
        peak.start()
        stderr = program.stderr.read()
        program.stderr.close()
        _, status, usage = os.wait4(program.pid, 0)
        program.returncode = os.waitstatus_to_exitcode(status)
        peak.done.set()
        peak.join()
    # The kernel's own peak counts files, too, and misses no moment.
    return program.returncode, stderr, max(peak.own, 1024 * usage.ru_maxrss - peak.of_files)


def complaints_about(kitchen, row):
    folder, limit = kitchen.table(), row.mib * MIB + MARGIN
    code, stderr, peak = run_capped(kitchen.bake.command("-m", f"{row.mib}M", "-j", str(row.threads)), folder, limit)
    found = bakes.leftovers(folder)
    if peak > limit:
        found.append(f"peak {peak / MIB:.1f} MiB")
    if code != (0 if row.verdict == "finishes" else 5):
        found.append(f"exit {code}, {stderr!r}")
    if row.verdict == "refuses":
        found += bakes.sentences(stderr)
    if kitchen.state(folder) != ("new" if row.verdict == "finishes" else "old"):
        found.append(f"the output is {kitchen.state(folder)}")
    shutil.rmtree(folder)
    return found, peak


def main():
    report = bakes.Report()
    rows = ROWS_LONG if bakes.LONG else ROWS
    print(f"the cap is {'a cgroup' if GIVEN_CGROUP else 'RLIMIT_DATA'}")
    for scene, resolution in dict.fromkeys((tuple(row.scene), row.resolution) for row in rows):
        with bakes.Kitchen(bakes.Bake(scene[0], list(scene), ["-r", resolution])) as kitchen:
            for row in [r for r in rows if (tuple(r.scene), r.resolution) == (scene, resolution)]:
                name = f"{scene[0]} {scene[2]} at {resolution}, {row.threads} threads, {row.mib} MiB"
                complaints, peak = complaints_about(kitchen, row)
                report.judge(f"{name}: {row.verdict}", complaints)
                print(f"{name}: {row.verdict}, peak {peak / MIB:.1f} MiB")
    report.finish()


if __name__ == "__main__":
    main()
