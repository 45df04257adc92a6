#!/usr/bin/env python3
"""Tests that a bake runs under an external memory limit of --memory + 64 MiB, with the same bytes.

The limit is a cgroup if SVDAG_CGROUP is a folder of the memory controller (v1 or v2) in which this test may create
groups, else RLIMIT_DATA, which counts mapped memory, whether it is touched or not.
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
MARGIN = 64 * MIB  # code, stacks, small allocations
GIVEN_CGROUP = os.environ.get("SVDAG_CGROUP")


class Row(NamedTuple):
    """A bake within a budget; the verdict is "finishes", or "refuses" (exit code 5, one message)."""
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
    """A function for preexec_fn that limits the memory of the child to `limit` bytes."""
    if GIVEN_CGROUP is None:
        yield lambda: resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
        return
    group = pathlib.Path(GIVEN_CGROUP) / f"svdag-test-{os.getpid()}"
    group.mkdir()
    try:
        v2 = (group / "memory.max").exists()
        (group / ("memory.max" if v2 else "memory.limit_in_bytes")).write_text(str(limit))
        with contextlib.suppress(OSError):  # no swap, so that only memory is limited
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
    # The kernel's peak includes mapped files, but misses no moment between two polls.
    return program.returncode, stderr, max(peak.own, 1024 * usage.ru_maxrss - peak.of_files)


def failures_of(fixture, row):
    folder, limit = fixture.new_folder(), row.mib * MIB + MARGIN
    code, stderr, peak = run_capped(fixture.bake.command("-m", f"{row.mib}M", "-j", str(row.threads)), folder, limit)
    found = bakes.leftovers(folder)
    if peak > limit:
        found.append(f"peak {peak / MIB:.1f} MiB")
    if code != (0 if row.verdict == "finishes" else 5):
        found.append(f"exit {code}, {stderr!r}")
    if row.verdict == "refuses":
        found += bakes.check_message(stderr)
    if fixture.state(folder) != ("new" if row.verdict == "finishes" else "old"):
        found.append(f"the output is {fixture.state(folder)}")
    shutil.rmtree(folder)
    return found, peak


def main():
    report = bakes.Report()
    rows = ROWS_LONG if bakes.LONG else ROWS
    print(f"the limit is {'a cgroup' if GIVEN_CGROUP else 'RLIMIT_DATA'}")
    for scene, resolution in dict.fromkeys((tuple(row.scene), row.resolution) for row in rows):
        with bakes.BakeFixture(bakes.Bake(scene[0], list(scene), ["-r", resolution])) as fixture:
            for row in [r for r in rows if (tuple(r.scene), r.resolution) == (scene, resolution)]:
                name = f"{scene[0]} {scene[2]} at {resolution}, {row.threads} threads, {row.mib} MiB"
                failures, peak = failures_of(fixture, row)
                report.record(f"{name}: {row.verdict}", failures)
                print(f"{name}: {row.verdict}, peak {peak / MIB:.1f} MiB")
    report.finish()


if __name__ == "__main__":
    main()
