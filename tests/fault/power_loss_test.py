#!/usr/bin/env python3
"""A power cut at any moment of a bake: the output is the old file or the complete new one, byte for byte, and
--resume gives the right bytes or refuses.

A bake is logged once (log.h); states that the disk may be in after a cut at a random place of the log are laid out
(replay.py), judged and resumed. What the journal has promised must be there: --resume finds it.
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

STATES = 10_000 if bakes.LONG else 200  # in all
AT_ONCE = 64
SEED = int(os.environ.get("SVDAG_SEED", "1"))
IN_MEMORY = bakes.SMALL[0]
SPILLING = bakes.SAVING
# Of the same scene; what it spills looks like what the other spills.
COARSER = SPILLING._replace(options=["-r", "512", *SPILLING.options[2:]])
# Runs alone: the triangles stay in memory.
RUNS = SPILLING._replace(options=["-r", "2K", "-m", "16M", "-j", "2", "--checkpoint", "0.001"])


class Case(NamedTuple):
    """A bake that is logged; before it the folder has what a killed bake of `before` left."""
    name: str
    share: float  # of the states
    bake: bakes.Bake
    more: list
    no_tmpfile: bool = False
    before: bakes.Bake = None


CASES = [Case("in memory", 0.1, IN_MEMORY, []),
         Case("in memory, no O_TMPFILE", 0.1, IN_MEMORY, [], no_tmpfile=True),
         Case("spilling", 0.3, SPILLING, []),
         Case("runs alone", 0.1, RUNS, []),
         Case("resumed", 0.2, SPILLING, ["--resume"], before=SPILLING),
         Case("restarted", 0.2, SPILLING, ["--restart"], before=COARSER)]


class State(NamedTuple):
    place: str  # in the log
    files: dict
    promised: bool  # there is something to resume


def leave_unfinished(kitchen, folder):
    """Kills a bake in the middle of its checkpoints; how many there are differs from bake to bake."""
    at = shim.run(bakes.SHIM, kitchen.bake.command(), kitchen.table(), Fault()).counts["fsync"] // 2
    before = (folder / bakes.OUTPUT).read_bytes()
    while True:
        killed = shim.run(bakes.SHIM, kitchen.bake.command("--restart"), folder, Fault("fsync", at, "exit"))
        assert killed.code == 137, killed
        if (folder / bakes.OUTPUT).read_bytes() == before:
            assert (folder / bakes.SCRATCH / "journal").exists(), killed
            return
        (folder / bakes.OUTPUT).write_bytes(before)
        at = at * 2 // 3


def is_promised(disk, new):
    """The journal speaks of work that is done (its second record and on), and the output is not there yet."""
    journal, output = (disk.find(disk.root / p) for p in (f"{bakes.SCRATCH}/journal", bakes.OUTPUT))
    return journal is not None and journal.syncs >= 2 and output.now() != new


def states(disk, operations, count, new):
    """`count` states after cuts at random places, of which half are beside a sync or a change of names."""
    chance = random.Random(SEED)
    turning = [i for i, op in enumerate(operations) if op.what not in ("write", "truncate")]
    places = sorted(min(len(operations), chance.choice(turning) + chance.randrange(2)) if chance.random() < 0.5
                    else chance.randrange(len(operations) + 1) for _ in range(count))
    done = 0
    for place in places:
        for op in operations[done:place]:
            disk.apply(op)
        done = place
        yield State(f"cut after {place} of {len(operations)}", disk.after_cut(chance), is_promised(disk, new))


def complaints_about_replay(disk, operations, folder):
    """The log replayed to its end must give what the folder really holds."""
    for op in operations:
        disk.apply(op)
    whole = lambda f: {n: whole(w) if isinstance(w, replay.Folder) else bytes(w.now()) for n, w in f.now().items()}
    return [] if whole(disk.top) == whole(replay.loaded(folder)) else ["the log does not tell all that was done"]


def resume(kitchen, folder):
    """The complaints about --resume, and with what sentence it refused."""
    run = lambda *more: subprocess.run(kitchen.bake.command(*more), cwd=folder, capture_output=True, text=True)
    done = run("--resume")
    if done.returncode == 0:
        return [f"--resume gave {kitchen.state(folder)}"] * (kitchen.state(folder) != "new"), ""
    found = bakes.sentences(done.stderr)
    if done.returncode not in (2, 4):
        found.append(f"--resume: exit {done.returncode}, {done.stderr!r}")
    again = run("--restart")
    if again.returncode != 0 or kitchen.state(folder) != "new":
        found.append(f"--restart after that: exit {again.returncode}, {again.stderr!r}, {kitchen.state(folder)}")
    return found, done.stderr


def judge(case, kitchens, state):
    """`kitchens`: that of the logged bake, then that of the one before it."""
    with tempfile.TemporaryDirectory(prefix="state-", dir=kitchens[0].root) as name:
        folder = kitchens[0].root / name
        replay.lay(state.files, folder)
        now = kitchens[0].state(folder)
        found = [f"the output is {now}"] * (now not in ("old", "new"))
        if state.promised:  # a bake that does not want it stumbles over it
            refused = subprocess.run(case.bake.command(), cwd=folder, capture_output=True, text=True)
            if refused.returncode != 2 or "--resume" not in refused.stderr:
                found.append(f"what the journal promised is lost: exit {refused.returncode}, {refused.stderr!r}")
        refusals = []
        for kitchen in kitchens:
            copy = folder.with_name(folder.name + "-copy")
            shutil.copytree(folder, copy)
            complaints, refused = resume(kitchen, copy)
            found += [f"{kitchen.bake.options[1]}: {c}" for c in complaints]
            refusals.append(refused)
            shutil.rmtree(copy)
        if state.promised and refusals[0]:
            found.append(f"what the journal promised cannot be resumed: {refusals[0]!r}")
    return f"{case.name}, {state.place}", found, refusals[0]


def run(report, case, pool):
    with bakes.Kitchen(case.bake) as kitchen:
        folder = kitchen.table()
        kitchens = [kitchen]
        if case.before is not None:
            with bakes.Kitchen(case.before) as before:
                leave_unfinished(before, folder)
                kitchens += [before] * (case.before is not case.bake)
        start = kitchen.root / "start"
        shutil.copytree(folder, start)
        log = kitchen.root / "log"
        fault = Fault(no_tmpfile=case.no_tmpfile)
        outcome = shim.run(bakes.SHIM, case.bake.command(*case.more), folder, fault, log=log)
        shutil.copytree(folder, kitchen.root / "end")
        # The log speaks of `folder`, so that is where the disk begins.
        shutil.rmtree(folder)
        start.rename(folder)
        operations = replay.operations(log.read_bytes())
        complaints = [f"exit {outcome.code}"] * (outcome.code != 0)
        complaints += complaints_about_replay(replay.Disk(folder), operations, kitchen.root / "end")
        report.judge(f"{case.name}: logged", complaints)
        count, refused, promised = int(STATES * case.share), 0, 0
        todo = states(replay.Disk(folder), operations, count, kitchen.new)
        while batch := list(itertools.islice(todo, AT_ONCE)):
            promised += sum(state.promised for state in batch)
            for name, found, did_refuse in pool.map(lambda state: judge(case, kitchens, state), batch):
                report.judge(name, found)
                refused += did_refuse != ""
        report.judge(f"{case.name}: promises are made", ["none"] * (case.bake is not IN_MEMORY and promised == 0))
    print(f"{case.name}: {len(operations)} operations, {count} states, {promised} with a promise, {refused} refused")


def main():
    report = bakes.Report()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for case in CASES:
            run(report, case, pool)
    report.finish()


if __name__ == "__main__":
    main()
