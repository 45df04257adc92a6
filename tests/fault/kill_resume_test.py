#!/usr/bin/env python3
"""Tests that a bake killed by SIGKILL at a random moment can be resumed to the same bytes, even if killed twice.

Without --resume, an unfinished bake gives one message and exit code 2; --restart begins again.
"""
import shutil
import signal
import subprocess

import bakes
from moments import Moments, hit, time_of

DOUBLE = 5  # every fifth bake is killed again while it resumes
# Bakes, and the number of kills of each. Their memory is so small that they spill and have work to resume.
BAKES = ([(bakes.A_SECOND, 900), (bakes.SECONDS, 100), (bakes.COLOURS, 200)] if bakes.LONG
         else [(bakes.HALF_A_SECOND, 10), (bakes.COLOURS, 10)])


def run(fixture, folder, *more):
    return subprocess.run(fixture.bake.command(*more), cwd=folder, capture_output=True, text=True)


def failures_of_end(fixture, folder, done):
    found = [] if done.returncode == 0 else [f"exit {done.returncode}, {done.stderr!r}"]
    if fixture.state(folder) != "new":
        found.append(f"the output is {fixture.state(folder)}")
    return found + bakes.remaining_scratch(folder) + bakes.leftovers(folder, bakes.LEFT_BY_KILL)


def failures_without_resume(fixture, folder):
    """Failures of a bake without --resume: without saved work it succeeds, otherwise it names the options."""
    before = fixture.state(folder)
    done = run(fixture, folder)
    if done.returncode == 0:
        return [f"without --resume: the output is {fixture.state(folder)}"] * (fixture.state(folder) != "new")
    found = [] if done.returncode == 2 else [f"without --resume: exit {done.returncode}"]
    found += bakes.check_message(done.stderr)
    found += [f"the message does not mention {name}: {done.stderr!r}" for name in ("--resume", "--restart")
              if name not in done.stderr]
    return found + (["the output changed"] if fixture.state(folder) != before else [])


def kill_and_resume(fixture, moments, n):
    folder = fixture.new_folder()
    times = [moments.next() for _ in range(2 if n % DOUBLE == 0 else 1)]
    found, killed = [], 0
    for i, moment in enumerate(times):
        ending = hit(fixture.bake.command(*["--resume"] * (i > 0)), folder, moment, [signal.SIGKILL])
        killed += ending.code != 0
        if i == 0:
            moments.learn(ending)
        if ending.code not in (0, -signal.SIGKILL):
            found.append(f"exit {ending.code}, {ending.stderr!r}")
        if fixture.state(folder) not in ("old", "new"):
            found.append(f"the output is {fixture.state(folder)}")
    if n % 3 == 0:
        found += failures_without_resume(fixture, folder)
    done = run(fixture, folder, "--restart" if n % 10 == 9 else "--resume")
    found += failures_of_end(fixture, folder, done)
    shutil.rmtree(folder)
    return f"killed after {', '.join(f'{t:.3f}' for t in times)} s", found, killed


def main():
    report = bakes.Report()
    for bake, runs in BAKES:
        with bakes.BakeFixture(bake) as fixture:
            folder = fixture.new_folder()
            moments = Moments(time_of(fixture.bake.command("--resume"), folder))  # there is nothing to resume yet
            report.record(f"{bake.name}: --resume without an unfinished bake", ["the bytes differ"] * (fixture.state(folder) != "new"))
            killed = 0
            for n in range(runs):
                name, failures, kills = kill_and_resume(fixture, moments, n)
                report.record(f"{bake.name}: {name}", failures)
                killed += kills
            report.record(f"{bake.name}: kills come in time", [f"only {killed}"] * (4 * killed < runs))
            print(f"{bake.name}: {killed} kills in {moments.seconds:.1f} s bakes, seed {moments.seed}")
    report.finish()


if __name__ == "__main__":
    main()
