#!/usr/bin/env python3
"""Tests that --resume after a kill in the middle of a phase repeats little work and gives the same bytes.

The repeated work is the CPU time of the killed and the resumed bake minus that of an undisturbed bake right after them,
as a fraction of the latter. On a shared machine the CPU time of equal bakes differs by a third, so the median of all
kills is checked, less strictly in the short form. The count of decisions does not vary: a resumed bake makes none for
saved cells, which after the voxelization are all cells.
"""
import json
import os
import random
import re
import select
import shutil
import statistics
import subprocess
import sys
import time
from typing import NamedTuple

import bakes

PHASES = ["split", "voxelize", "merge", "write"]
AFTER_VOXELIZE = ["merge", "write"]  # all voxelized cells are on disk by then
KILLS = 10 if bakes.LONG else 2  # of each phase
TRIES = 12  # a short phase may end before the signal, mostly on a busy machine
MAX_REPEATED = 0.10 if bakes.LONG else 0.25  # median over all kills
SLACK = 1.1  # factor of the expected number of remaining decisions
REPORT = ["--report", "report.json"]
BAKE = bakes.Bake("some seconds", ["hairball", "-n", "500K"], ["-r", "8K", "-m", "64M", "-j", "2"])
BAKE_SHORT = bakes.Bake("a second", ["hairball", "-n", "100K"], ["-r", "8K", "-m", "16M", "-j", "2"])


class ProcessTimes(NamedTuple):
    """One process: exit code, CPU seconds, start times of its phases, duration; times in seconds after its start."""
    code: int
    cpu: float
    begun: dict
    seconds: float

    def length(self, phase):
        return min([t for t in self.begun.values() if t > self.begun[phase]], default=self.seconds) - self.begun[phase]


def run_timed(command, folder, phase=None, delay=0.0):
    """Runs a bake; kills it `delay` seconds after `phase` began, if given."""
    start = time.monotonic()
    program = subprocess.Popen([*(a for a in command if a != "-q"), "--progress"], cwd=folder, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    begun, due, stderr = {}, None, b""
    while True:
        wait = None if due is None else max(0.0, due - time.monotonic())
        if not select.select([program.stderr], [], [], wait)[0]:
            program.kill()
            due = None
            continue
        data = os.read(program.stderr.fileno(), 1 << 16)
        if not data:
            break
        stderr += data
        for name in re.findall(rb"\r([a-z]+)", data):
            if begun.setdefault(name.decode(), time.monotonic() - start) and name.decode() == phase and due is None:
                due = start + begun[phase] + delay
    program.stderr.close()
    _, status, usage = os.wait4(program.pid, 0)
    program.returncode = os.waitstatus_to_exitcode(status)
    if program.returncode > 0:
        print(stderr.decode(), file=sys.stderr)
    return ProcessTimes(program.returncode, usage.ru_utime + usage.ru_stime, begun, time.monotonic() - start)


def report_of(folder):
    return json.loads((folder / "report.json").read_text())


def undisturbed(fixture):
    """(the ProcessTimes of a whole bake, its number of decisions)"""
    folder = fixture.new_folder()
    times, decisions = run_timed(fixture.bake.command(*REPORT), folder), report_of(folder)["decisions"]
    shutil.rmtree(folder)
    return times, decisions


def killed_in(fixture, phase, length):
    """(folder, ProcessTimes) of a bake killed in `phase`, before its output existed; the folder is None if every try
    was too late. The delay is halved after each try."""
    for _ in range(TRIES):
        folder = fixture.new_folder()
        times = run_timed(fixture.bake.command(), folder, phase, random.uniform(0, length))
        length /= 2
        if times.code != 0 and list(times.begun)[-1] == phase and fixture.state(folder) == "old":
            return folder, times
        shutil.rmtree(folder)
    return None, times


def decided_again(report, decisions):
    """A failure if a resumed bake voxelized saved cells; `decisions`: of an undisturbed bake. The strands of the scene
    are similar, so decisions are proportional to voxels."""
    max_decisions = SLACK * decisions * (1 - report["voxels_kept"] / report["voxels"])
    return [f"{report['decisions']} decisions, more than {max_decisions:.0f}"] * (report["decisions"] > max_decisions)


def repeated(report, fixture, phase, plain, decisions):
    """Fraction of the work that was repeated after one kill; None if no kill was in time."""
    folder, killed = killed_in(fixture, phase, plain.length(phase))
    if folder is None:
        return None
    resumed = run_timed(fixture.bake.command("--resume", *REPORT), folder)
    beside, _ = undisturbed(fixture)
    found = [] if resumed.code == 0 else [f"exit {resumed.code}"]
    found += [] if fixture.state(folder) == "new" else [f"the output is {fixture.state(folder)}"]
    found += [] if found else decided_again(report_of(folder), decisions)
    kept = 0 if found else report_of(folder)["voxels_kept"] / report_of(folder)["voxels"]
    found += [f"only {kept:.0%} of the voxels were saved"] * (phase in AFTER_VOXELIZE and kept < 1)
    report.record(f"killed in {phase} after {killed.seconds:.3f} s", found + bakes.remaining_scratch(folder))
    shutil.rmtree(folder)
    return (killed.cpu + resumed.cpu - beside.cpu) / beside.cpu


def main():
    report = bakes.Report()
    seed = random.randrange(10**6)
    random.seed(seed)
    with bakes.BakeFixture(BAKE if bakes.LONG else BAKE_SHORT) as fixture:
        plain, decisions = undisturbed(fixture)
        print(f"undisturbed: {plain.cpu:.2f} CPU seconds, {plain.seconds:.2f} s; seed {seed}")
        print(f"{'phase':<10} {'seconds':>7} {'kills':>5} {'median repeated':>15} {'max':>6}")
        shares = []
        for phase in PHASES:
            tried = [repeated(report, fixture, phase, plain, decisions) for _ in range(KILLS)]
            own = [share for share in tried if share is not None]
            shares += own
            shown = f"{statistics.median(own):>15.1%} {max(own):>6.1%}" if own else ""
            print(f"{phase:<10} {plain.length(phase):>7.3f} {len(own):>5} {shown}", flush=True)
            report.record(f"{phase}: kills come in time", ["none was in time"] * (not own))
    median = statistics.median(shares)
    print(f"all        {'':>7} {len(shares):>5} {median:>15.1%} {max(shares):>6.1%}")
    report.record(f"at most {MAX_REPEATED:.0%} of the work is repeated", [f"{median:.1%}"] * (median > MAX_REPEATED))
    report.finish()


if __name__ == "__main__":
    main()
