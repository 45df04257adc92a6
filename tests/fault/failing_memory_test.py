#!/usr/bin/env python3
"""Tests failing allocations: each fails once, or with all later ones; the bake exits with 5 and one message, or succeeds
with the same bytes.

It never crashes and never damages the output. After a failure the scratch folder may remain; the next bake reuses it or
reports it. Libraries may continue without an allocation that failed.
"""
import os
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor

import bakes
import shim
from shim import Fault

FIRST = 10_000  # allocations; each fails in the long form
SHORT = 60  # number of allocations that fail in the short form
LAST = 40  # allocations at the end, which all fail: the output is renamed there


def chosen_allocations(allocations):
    """The numbers of the allocations that fail: all, or some with growing distances, and the last ones."""
    last = set(range(allocations - LAST + 1, allocations + 1))
    if bakes.LONG:
        return sorted(set(range(1, min(allocations, FIRST) + 1)) | last)
    return sorted({round(allocations ** (i / (SHORT - 1))) for i in range(SHORT)} | last)


def failures_of_next_bake(fixture, folder):
    """Failures unless the next bake finishes, or reports the unfinished one and finishes with --resume."""
    run = lambda *more: subprocess.run(fixture.bake.command(*more), cwd=folder, capture_output=True, text=True)
    done = run()
    if done.returncode == 2 and "--restart" in done.stderr:
        done = run("--resume")
    good = done.returncode == 0 and fixture.state(folder) == "new"
    return [] if good else [f"the next bake: exit {done.returncode}, {done.stderr!r}, {fixture.state(folder)}"]


def failures_of(fixture, folder, fault, outcome):
    if not outcome.fired:
        return [] if outcome.code == 0 and fixture.state(folder) == "new" else ["the fault did not fire"]
    found = []
    state = fixture.state(folder)
    if outcome.code not in (0, 5):
        found.append(f"exit {outcome.code}, {outcome.stderr!r}")
    elif outcome.code == 5:
        found += bakes.check_message(outcome.stderr)
    renamed = outcome.counts.get("rename", 0) > 0
    if state != ("new" if outcome.code == 0 or renamed else "old"):
        found.append(f"the output is {state}")
    may_stay = fault.stays or "--resume" in outcome.stderr
    return (found + bakes.leftovers(folder, [bakes.OF_SCRATCH] * may_stay) +
            (failures_of_next_bake(fixture, folder) if outcome.code != 0 else []))


def run_one(fixture, fault):
    folder = fixture.new_folder()
    outcome = shim.run(bakes.SHIM, fixture.bake.command(), folder, fault)
    found = failures_of(fixture, folder, fault, outcome)
    shutil.rmtree(folder)
    return f"allocation {fault.at}{' and all later ones' * fault.stays}", found, outcome.code


def main():
    report = bakes.Report()
    with bakes.BakeFixture(bakes.SAVING) as fixture, ThreadPoolExecutor(os.cpu_count()) as pool:
        counted = shim.run(bakes.SHIM, fixture.bake.command(), fixture.new_folder(), Fault())
        allocations = counted.counts.get("alloc", 0)
        seen = allocations > 1000 and counted.counts["fsync"] > 4
        report.record("allocations are counted, and the bake spills", [f"{counted.counts}"] * (not seen))
        planned = [Fault("alloc", k, "12", stays) for k in chosen_allocations(allocations) for stays in (False, True)]
        codes = []
        for name, found, code in pool.map(lambda fault: run_one(fixture, fault), planned):
            report.record(name, found)
            codes.append(code)
    print(f"{allocations} allocations; {len(planned)} faults: {codes.count(5)} reported, {codes.count(0)} succeeded")
    report.finish()


if __name__ == "__main__":
    main()
