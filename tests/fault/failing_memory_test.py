#!/usr/bin/env python3
"""Every request for memory is refused, once or from then on: exit 5 and one sentence, or the same bytes.

Never a crash, never a damaged output. Who has no memory left may leave the scratch folder, which the next bake
takes over or speaks of; the libraries below the program may do without what they were refused.
"""
import os
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor

import bakes
import shim
from shim import Fault

FIRST = 10_000  # requests, each refused in the long form
SHORT = 60  # places, and each refused once and from then on
LAST = 40  # requests, each refused: the output gets its name there


def places(requests):
    """Every request, or few of them: dense at the beginning, then farther and farther apart; and the last ones."""
    last = set(range(requests - LAST + 1, requests + 1))
    if bakes.LONG:
        return sorted(set(range(1, min(requests, FIRST) + 1)) | last)
    return sorted({round(requests ** (i / (SHORT - 1))) for i in range(SHORT)} | last)


def complaints_about_the_next(kitchen, folder):
    """The next bake finishes, or says what it found and obeys --restart."""
    run = lambda *more: subprocess.run(kitchen.bake.command(*more), cwd=folder, capture_output=True, text=True)
    done = run()
    if done.returncode == 2 and "--restart" in done.stderr:
        done = run("--resume")
    good = done.returncode == 0 and kitchen.state(folder) == "new"
    return [] if good else [f"the next bake: exit {done.returncode}, {done.stderr!r}, {kitchen.state(folder)}"]


def complaints_about(kitchen, folder, fault, outcome):
    if not outcome.fired:
        return [] if outcome.code == 0 and kitchen.state(folder) == "new" else ["the fault did not fire"]
    found = []
    state = kitchen.state(folder)
    if outcome.code not in (0, 5):
        found.append(f"exit {outcome.code}, {outcome.stderr!r}")
    elif outcome.code == 5:
        found += bakes.sentences(outcome.stderr)
    renamed = outcome.counts.get("rename", 0) > 0
    if state != ("new" if outcome.code == 0 or renamed else "old"):
        found.append(f"the output is {state}")
    may_stay = fault.stays or "--resume" in outcome.stderr
    return (found + bakes.leftovers(folder, [bakes.OF_SCRATCH] * may_stay) +
            (complaints_about_the_next(kitchen, folder) if outcome.code != 0 else []))


def run_one(kitchen, fault):
    folder = kitchen.table()
    outcome = shim.run(bakes.SHIM, kitchen.bake.command(), folder, fault)
    found = complaints_about(kitchen, folder, fault, outcome)
    shutil.rmtree(folder)
    return f"request {fault.at}{' and all later ones' * fault.stays}", found, outcome.code


def main():
    report = bakes.Report()
    with bakes.Kitchen(bakes.SAVING) as kitchen, ThreadPoolExecutor(os.cpu_count()) as pool:
        counted = shim.run(bakes.SHIM, kitchen.bake.command(), kitchen.table(), Fault())
        requests = counted.counts.get("alloc", 0)
        seen = requests > 1000 and counted.counts["fsync"] > 4
        report.judge("requests are seen, and the bake spills", [f"{counted.counts}"] * (not seen))
        planned = [Fault("alloc", k, "12", stays) for k in places(requests) for stays in (False, True)]
        codes = []
        for name, found, code in pool.map(lambda fault: run_one(kitchen, fault), planned):
            report.judge(name, found)
            codes.append(code)
    print(f"{requests} requests; {len(planned)} faults: {codes.count(5)} reported, {codes.count(0)} succeeded")
    report.finish()


if __name__ == "__main__":
    main()
