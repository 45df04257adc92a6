#!/usr/bin/env python3
"""kill -9 at any moment, some bakes killed again while they resume: --resume gives the same bytes.

Without --resume, a bake that can be resumed is a sentence and exit 2; --restart begins again.
"""
import shutil
import signal
import subprocess

import bakes
from moments import Moments, hit, time_of

DOUBLE = 5  # every fifth bake is killed once more while it resumes
# Bakes, and how many of each are killed. One that has something to resume has so little memory that it spills.
BAKES = [(bakes.A_SECOND, 900), (bakes.SECONDS, 100)] if bakes.LONG else [(bakes.HALF_A_SECOND, 10)]


def run(kitchen, folder, *more):
    return subprocess.run(kitchen.bake.command(*more), cwd=folder, capture_output=True, text=True)


def complaints_about_the_end(kitchen, folder, done):
    found = [] if done.returncode == 0 else [f"exit {done.returncode}, {done.stderr!r}"]
    if kitchen.state(folder) != "new":
        found.append(f"the output is {kitchen.state(folder)}")
    return found + bakes.scratch_left(folder) + bakes.leftovers(folder, bakes.LEFT_BY_KILL)


def complaints_without_resume(kitchen, folder):
    """What is left is either taken over silently, for there is nothing to resume, or spoken of."""
    before = kitchen.state(folder)
    done = run(kitchen, folder)
    if done.returncode == 0:
        return [f"without --resume: the output is {kitchen.state(folder)}"] * (kitchen.state(folder) != "new")
    found = [] if done.returncode == 2 else [f"without --resume: exit {done.returncode}"]
    found += bakes.sentences(done.stderr)
    found += [f"does not tell of {name}: {done.stderr!r}" for name in ("--resume", "--restart")
              if name not in done.stderr]
    return found + (["the output changed"] if kitchen.state(folder) != before else [])


def kill_and_resume(kitchen, moments, n):
    folder = kitchen.table()
    times = [moments.next() for _ in range(2 if n % DOUBLE == 0 else 1)]
    found, killed = [], 0
    for i, moment in enumerate(times):
        ending = hit(kitchen.bake.command(*["--resume"] * (i > 0)), folder, moment, [signal.SIGKILL])
        killed += ending.code != 0
        if i == 0:
            moments.learn(ending)
        if ending.code not in (0, -signal.SIGKILL):
            found.append(f"exit {ending.code}, {ending.stderr!r}")
        if kitchen.state(folder) not in ("old", "new"):
            found.append(f"the output is {kitchen.state(folder)}")
    if n % 3 == 0:
        found += complaints_without_resume(kitchen, folder)
    done = run(kitchen, folder, "--restart" if n % 10 == 9 else "--resume")
    found += complaints_about_the_end(kitchen, folder, done)
    shutil.rmtree(folder)
    return f"killed after {', '.join(f'{t:.3f}' for t in times)} s", found, killed


def main():
    report = bakes.Report()
    for bake, runs in BAKES:
        with bakes.Kitchen(bake) as kitchen:
            folder = kitchen.table()
            moments = Moments(time_of(kitchen.bake.command("--resume"), folder))  # nothing to resume: as a new bake
            report.judge(f"{bake.name}: --resume begins afresh", ["other bytes"] * (kitchen.state(folder) != "new"))
            killed = 0
            for n in range(runs):
                name, complaints, kills = kill_and_resume(kitchen, moments, n)
                report.judge(f"{bake.name}: {name}", complaints)
                killed += kills
            report.judge(f"{bake.name}: kills come in time", [f"only {killed}"] * (4 * killed < runs))
            print(f"{bake.name}: {killed} kills in {moments.seconds:.1f} s bakes, seed {moments.seed}")
    report.finish()


if __name__ == "__main__":
    main()
