#!/usr/bin/env python3
"""kill -9 in the middle of a phase, then --resume: little of the work is done twice, and the bytes are the same.

What is repeated is the CPU time of the killed and of the resumed bake beyond that of an undisturbed one that runs
right after them, as a share of it. The CPU time of one and the same bake differs by a third on a machine that others
share, so that the median over all kills is judged, and less strictly in the short form. Decisions are counted, which no
machine disturbs: a resumed bake makes none for what was kept, which after the voxelization is everything.
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
AFTER_VOXELIZE = ["merge", "write"]  # what was voxelized is all on disk by then
KILLS = 10 if bakes.LONG else 2  # of each phase
TRIES = 12  # a short phase may be over before the signal arrives, most of all on a busy machine
MOST_REPEATED = 0.10 if bakes.LONG else 0.25  # median over all kills
SLACK = 1.1  # of the decisions that are left by right
REPORT = ["--report", "report.json"]
BAKE = bakes.Bake("some seconds", ["hairball", "-n", "500K"], ["-r", "8K", "-m", "64M", "-j", "2"])
BAKE_SHORT = bakes.Bake("a second", ["hairball", "-n", "100K"], ["-r", "8K", "-m", "16M", "-j", "2"])


class Life(NamedTuple):
    """One process: exit code, CPU seconds, when its phases began, in seconds after its start, and its whole time."""
    code: int
    cpu: float
    begun: dict
    seconds: float

    def length(self, phase):
        return min([t for t in self.begun.values() if t > self.begun[phase]], default=self.seconds) - self.begun[phase]


def live(command, folder, phase=None, delay=0.0):
    """Runs a bake; kills it `delay` seconds after `phase` began, if a phase is named."""
    start = time.monotonic()
    program = subprocess.Popen([*(a for a in command if a != "-q"), "--progress"], cwd=folder, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    begun, due, said = {}, None, b""
    while True:
        wait = None if due is None else max(0.0, due - time.monotonic())
        if not select.select([program.stderr], [], [], wait)[0]:
            program.kill()
            due = None
            continue
        data = os.read(program.stderr.fileno(), 1 << 16)
        if not data:
            break
        said += data
        for name in re.findall(rb"\r([a-z]+)", data):
            if begun.setdefault(name.decode(), time.monotonic() - start) and name.decode() == phase and due is None:
                due = start + begun[phase] + delay
    program.stderr.close()
    _, status, usage = os.wait4(program.pid, 0)
    program.returncode = os.waitstatus_to_exitcode(status)
    if program.returncode > 0:
        print(said.decode(), file=sys.stderr)
    return Life(program.returncode, usage.ru_utime + usage.ru_stime, begun, time.monotonic() - start)


def report_of(folder):
    return json.loads((folder / "report.json").read_text())


def undisturbed(kitchen):
    """(a whole bake, its decisions)"""
    folder = kitchen.table()
    life, decisions = live(kitchen.bake.command(*REPORT), folder), report_of(folder)["decisions"]
    shutil.rmtree(folder)
    return life, decisions


def killed_in(kitchen, phase, length):
    """(folder, Life) of a bake that was killed in `phase`, before its output was there; the folder is None if none
    could be. Each try that came too late makes the next one come sooner."""
    for _ in range(TRIES):
        folder = kitchen.table()
        life = live(kitchen.bake.command(), folder, phase, random.uniform(0, length))
        length /= 2
        if life.code != 0 and list(life.begun)[-1] == phase and kitchen.state(folder) == "old":
            return folder, life
        shutil.rmtree(folder)
    return None, life


def decided_again(report, decisions):
    """Complaints about a resumed bake that voxelized what was kept; `decisions`: of an undisturbed one. Strands are
    much alike, so that decisions are shared out as voxels are."""
    most = SLACK * decisions * (1 - report["voxels_kept"] / report["voxels"])
    return [f"{report['decisions']} decisions, not {most:.0f} at most"] * (report["decisions"] > most)


def repeated(report, kitchen, phase, plain, decisions):
    """Share of the work that one kill made the two bakes repeat; None if no kill came in time."""
    folder, killed = killed_in(kitchen, phase, plain.length(phase))
    if folder is None:
        return None
    resumed = live(kitchen.bake.command("--resume", *REPORT), folder)
    beside, _ = undisturbed(kitchen)
    found = [] if resumed.code == 0 else [f"exit {resumed.code}"]
    found += [] if kitchen.state(folder) == "new" else [f"the output is {kitchen.state(folder)}"]
    found += [] if found else decided_again(report_of(folder), decisions)
    kept = 0 if found else report_of(folder)["voxels_kept"] / report_of(folder)["voxels"]
    found += [f"only {kept:.0%} were kept"] * (phase in AFTER_VOXELIZE and kept < 1)
    report.judge(f"killed in {phase} after {killed.seconds:.3f} s", found + bakes.scratch_left(folder))
    shutil.rmtree(folder)
    return (killed.cpu + resumed.cpu - beside.cpu) / beside.cpu


def main():
    report = bakes.Report()
    seed = random.randrange(10**6)
    random.seed(seed)
    with bakes.Kitchen(BAKE if bakes.LONG else BAKE_SHORT) as kitchen:
        plain, decisions = undisturbed(kitchen)
        print(f"undisturbed: {plain.cpu:.2f} CPU seconds, {plain.seconds:.2f} s; seed {seed}")
        print(f"{'phase':<10} {'seconds':>7} {'kills':>5} {'median repeated':>15} {'most':>6}")
        shares = []
        for phase in PHASES:
            tried = [repeated(report, kitchen, phase, plain, decisions) for _ in range(KILLS)]
            own = [share for share in tried if share is not None]
            shares += own
            shown = f"{statistics.median(own):>15.1%} {max(own):>6.1%}" if own else ""
            print(f"{phase:<10} {plain.length(phase):>7.3f} {len(own):>5} {shown}", flush=True)
            report.judge(f"{phase}: kills come in time", ["none did"] * (not own))
    median = statistics.median(shares)
    print(f"all        {'':>7} {len(shares):>5} {median:>15.1%} {max(shares):>6.1%}")
    report.judge(f"at most {MOST_REPEATED:.0%} of the work is repeated", [f"{median:.1%}"] * (median > MOST_REPEATED))
    report.finish()


if __name__ == "__main__":
    main()
