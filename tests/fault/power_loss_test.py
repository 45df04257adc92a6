#!/usr/bin/env python3
"""Tests power cuts at any moment of a bake: the output is the old file or the complete new one, and --resume gives the
right bytes or reports an error.

The operations of a bake are logged once (log.h). Possible states of the disk after a cut at a random position of the
log are restored (replay.py), checked and resumed. Work recorded in the journal must be found by --resume.
"""
import itertools
import os
import random
import shutil
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import bakes
import replay
import shim
from shim import Fault

STATES = 10_000 if bakes.LONG else 200  # of all cases together
AT_ONCE = 64
SEED = int(os.environ.get("SVDAG_SEED", "1"))
IN_MEMORY = bakes.SMALL[0]
SPILLING = bakes.SAVING
# A bake of the same scene, whose spilled data looks like that of the other.
COARSER = SPILLING._replace(options=["-r", "512", *SPILLING.options[2:]])
# Spills only runs: the triangles stay in memory.
RUNS = SPILLING._replace(options=["-r", "2K", "-m", "16M", "-j", "2", "--checkpoint", "0.001"])


class Case(NamedTuple):
    """A logged bake; its folder begins with the remains of a killed bake of `before`."""
    name: str
    share: float  # of the states
    bake: bakes.Bake
    more: list
    no_tmpfile: bool = False
    before: bakes.Bake = None


CASES = [Case("in memory", 0.1, IN_MEMORY, []),
         Case("in memory, no O_TMPFILE", 0.1, IN_MEMORY, [], no_tmpfile=True),
         Case("spilling", 0.3, SPILLING, []),
         Case("only runs", 0.1, RUNS, []),
         Case("resumed", 0.2, SPILLING, ["--resume"], before=SPILLING),
         Case("restarted", 0.2, SPILLING, ["--restart"], before=COARSER)]


class State(NamedTuple):
    position: str  # in the log
    files: dict
    promised: bool  # the journal has work to resume


def leave_unfinished(fixture, folder):
    """Kills a bake in the middle of its checkpoints, whose number varies between runs."""
    at = shim.run(bakes.SHIM, fixture.bake.command(), fixture.new_folder(), Fault()).counts["fsync"] // 2
    before = (folder / bakes.OUTPUT).read_bytes()
    while True:
        killed = shim.run(bakes.SHIM, fixture.bake.command("--restart"), folder, Fault("fsync", at, "exit"))
        assert killed.code == 137, killed
        if (folder / bakes.OUTPUT).read_bytes() == before:
            assert (folder / bakes.SCRATCH / "journal").exists(), killed
            return
        (folder / bakes.OUTPUT).write_bytes(before)
        at = at * 2 // 3


def is_promised(disk, new):
    """Whether the journal records finished work (from its second record) and the output is not new yet."""
    journal, output = (disk.find(disk.root / p) for p in (f"{bakes.SCRATCH}/journal", bakes.OUTPUT))
    return journal is not None and journal.syncs >= 2 and output.now() != new


def states(disk, operations, count, new):
    """`count` states after cuts at random positions, half of them next to a sync or a change of names."""
    chance = random.Random(SEED)
    boundaries = [i for i, op in enumerate(operations) if op.what not in ("write", "truncate")]
    positions = sorted(min(len(operations), chance.choice(boundaries) + chance.randrange(2)) if chance.random() < 0.5
                    else chance.randrange(len(operations) + 1) for _ in range(count))
    done = 0
    for position in positions:
        for op in operations[done:position]:
            disk.apply(op)
        done = position
        yield State(f"cut after {position} of {len(operations)}", disk.after_cut(chance), is_promised(disk, new))


def failures_of_replay(disk, operations, folder):
    """A failure unless replaying the whole log gives the real content of the folder."""
    for op in operations:
        disk.apply(op)
    whole = lambda f: {n: whole(w) if isinstance(w, replay.Folder) else bytes(w.now()) for n, w in f.now().items()}
    return [] if whole(disk.top) == whole(replay.loaded(folder)) else ["the log is incomplete"]


def resume(fixture, folder):
    """(failures of --resume, its error message or "")."""
    run = lambda *more: subprocess.run(fixture.bake.command(*more), cwd=folder, capture_output=True, text=True)
    done = run("--resume")
    if done.returncode == 0:
        return [f"after --resume the output is {fixture.state(folder)}"] * (fixture.state(folder) != "new"), ""
    found = bakes.check_message(done.stderr)
    if done.returncode not in (2, 4):
        found.append(f"--resume: exit {done.returncode}, {done.stderr!r}")
    again = run("--restart")
    if again.returncode != 0 or fixture.state(folder) != "new":
        found.append(f"--restart after that: exit {again.returncode}, {again.stderr!r}, {fixture.state(folder)}")
    return found, done.stderr


def check_state(case, fixtures, state):
    """`fixtures`: that of the logged bake, then that of the bake before it."""
    with tempfile.TemporaryDirectory(prefix="state-", dir=fixtures[0].root) as name:
        folder = fixtures[0].root / name
        replay.write_state(state.files, folder)
        now = fixtures[0].state(folder)
        found = [f"the output is {now}"] * (now not in ("old", "new"))
        if state.promised:  # a bake without --resume must be rejected
            refused = subprocess.run(case.bake.command(), cwd=folder, capture_output=True, text=True)
            if refused.returncode != 2 or "--resume" not in refused.stderr:
                found.append(f"work in the journal is lost: exit {refused.returncode}, {refused.stderr!r}")
        refusals = []
        for fixture in fixtures:
            copy = folder.with_name(folder.name + "-copy")
            shutil.copytree(folder, copy)
            failures, refused = resume(fixture, copy)
            found += [f"{fixture.bake.options[1]}: {c}" for c in failures]
            refusals.append(refused)
            shutil.rmtree(copy)
        if state.promised and refusals[0]:
            found.append(f"work in the journal cannot be resumed: {refusals[0]!r}")
    return f"{case.name}, {state.position}", found, refusals[0]


def run(report, case, pool):
    with bakes.BakeFixture(case.bake) as fixture:
        folder = fixture.new_folder()
        fixtures = [fixture]
        if case.before is not None:
            with bakes.BakeFixture(case.before) as before:
                leave_unfinished(before, folder)
                fixtures += [before] * (case.before is not case.bake)
        start = fixture.root / "start"
        shutil.copytree(folder, start)
        log = fixture.root / "log"
        fault = Fault(no_tmpfile=case.no_tmpfile)
        outcome = shim.run(bakes.SHIM, case.bake.command(*case.more), folder, fault, log=log)
        shutil.copytree(folder, fixture.root / "end")
        # The paths in the log are in `folder`, so its initial state must be there.
        shutil.rmtree(folder)
        start.rename(folder)
        operations = replay.operations(log.read_bytes())
        failures = [f"exit {outcome.code}"] * (outcome.code != 0)
        failures += failures_of_replay(replay.Disk(folder), operations, fixture.root / "end")
        report.record(f"{case.name}: logged", failures)
        count, refused, promised = int(STATES * case.share), 0, 0
        todo = states(replay.Disk(folder), operations, count, fixture.new)
        while batch := list(itertools.islice(todo, AT_ONCE)):
            promised += sum(state.promised for state in batch)
            for name, found, did_refuse in pool.map(lambda state: check_state(case, fixtures, state), batch):
                report.record(name, found)
                refused += did_refuse != ""
        report.record(f"{case.name}: work is recorded", ["none"] * (case.bake is not IN_MEMORY and promised == 0))
    print(f"{case.name}: {len(operations)} operations, {count} states, {promised} with work to resume, {refused} rejected")


def main():
    report = bakes.Report()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for case in CASES:
            run(report, case, pool)
    report.finish()


if __name__ == "__main__":
    main()
