#!/usr/bin/env python3
"""Tests that SIGINT, SIGTERM and SIGHUP end a bake within a second; the old output is kept, the work can be resumed."""
import shutil
import signal
import subprocess

import bakes
from moments import Moments, hit, time_of

SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]
# Bakes, and the number of times that each signal is sent.
BAKES = [(bakes.A_SECOND, 300), (bakes.SECONDS, 34)] if bakes.LONG else [(bakes.A_SECOND, 3)]
START = 0.05  # seconds to load the program, during which the signal still kills it directly
MAX_SECONDS = 1.0  # seconds from the signal to the end
LEFT = [bakes.OF_SCRATCH]


def failures_of(fixture, folder, number, ending, twice, moment):
    if ending.code == -number and moment < START and not twice:
        return bakes.leftovers(folder) + (["not started, but the old file is gone"] if fixture.state(folder) != "old" else [])
    if ending.code == 0:  # it finished before the signal, or after its rename
        return bakes.leftovers(folder) + (["no new file"] if fixture.state(folder) != "new" else [])
    found = []
    # The program exits with status 128 + n; a second signal kills it directly.
    if ending.code not in ({128 + number} | ({-number} if twice else set())):
        found.append(f"exit {ending.code}; {ending.stderr!r}")
    if ending.seconds > MAX_SECONDS:
        found.append(f"took {ending.seconds:.2f} s to end")
    # The second signal may kill it between the rename and its end.
    if fixture.state(folder) not in (("old", "new") if ending.code < 0 else ("old",)):
        found.append(f"the output is {fixture.state(folder)}")
    return found + bakes.leftovers(folder, LEFT)


def failures_of_next_bake(fixture, folder):
    done = subprocess.run(fixture.bake.command("--resume"), cwd=folder, capture_output=True, text=True)
    if done.returncode != 0 or fixture.state(folder) != "new":
        return [f"the next bake: exit {done.returncode}, {done.stderr!r}, the output is {fixture.state(folder)}"]
    return bakes.remaining_scratch(folder)


def hit_once(fixture, number, moments, run):
    """(name, failures, whether the signal came in time)."""
    folder, twice, moment = fixture.new_folder(), run % 3 == 2, moments.next()
    ending = hit(fixture.bake.command(), folder, moment, [number] * (1 + twice))
    moments.learn(ending)
    failures = failures_of(fixture, folder, number, ending, twice, moment)
    if ending.code != 0 and run % 3 == 0:
        failures += failures_of_next_bake(fixture, folder)
    shutil.rmtree(folder)
    return f"{number.name}{' twice' * twice} after {moment:.3f} s", failures, ending.code != 0


def main():
    report = bakes.Report()
    for bake, runs in BAKES:
        with bakes.BakeFixture(bake) as fixture:
            moments, caught, total = Moments(time_of(bake.command(), fixture.new_folder())), 0, runs * len(SIGNALS)
            for run in range(runs):
                for number in SIGNALS:
                    name, failures, in_time = hit_once(fixture, number, moments, run)
                    report.record(f"{bake.name}: {name}", failures)
                    caught += in_time
            report.record(f"{bake.name}: signals come in time", [f"{caught} of {total}"] * (caught < total / 4))
            print(f"{caught} of {total} bakes of {moments.seconds:.1f} s were caught, seed {moments.seed}")
    report.finish()


if __name__ == "__main__":
    main()
