#!/usr/bin/env python3
"""SIGINT, SIGTERM and SIGHUP end a bake within a second; the output stays, what is left can be resumed."""
import shutil
import signal
import subprocess

import bakes
from moments import Moments, hit, time_of

SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]
# Bakes, and how often each signal hits them.
BAKES = [(bakes.A_SECOND, 300), (bakes.SECONDS, 34)] if bakes.LONG else [(bakes.A_SECOND, 3)]
START = 0.05  # seconds in which the system loads the program: until then it dies by the signal itself
AT_MOST = 1.0  # seconds from the signal to the end
LEFT = [bakes.OF_SCRATCH]


def complaints_about(kitchen, folder, number, ending, twice, moment):
    if ending.code == -number and moment < START and not twice:
        return bakes.leftovers(folder) + (["not begun, but no old file"] if kitchen.state(folder) != "old" else [])
    if ending.code == 0:  # it was faster, or the file was already there
        return bakes.leftovers(folder) + (["no new file"] if kitchen.state(folder) != "new" else [])
    found = []
    # The program ends itself, with status 128 + n; the second signal ends it at once.
    if ending.code not in ({128 + number} | ({-number} if twice else set())):
        found.append(f"exit {ending.code}; {ending.stderr!r}")
    if ending.seconds > AT_MOST:
        found.append(f"took {ending.seconds:.2f} s to end")
    # Death itself may come between the rename and the end.
    if kitchen.state(folder) not in (("old", "new") if ending.code < 0 else ("old",)):
        found.append(f"the output is {kitchen.state(folder)}")
    return found + bakes.leftovers(folder, LEFT)


def complaints_about_the_next(kitchen, folder):
    done = subprocess.run(kitchen.bake.command("--resume"), cwd=folder, capture_output=True, text=True)
    if done.returncode != 0 or kitchen.state(folder) != "new":
        return [f"the next bake: exit {done.returncode}, {done.stderr!r}, the output is {kitchen.state(folder)}"]
    return bakes.scratch_left(folder)


def hit_once(kitchen, number, moments, run):
    """(name, complaints, whether the signal came in time)."""
    folder, twice, moment = kitchen.table(), run % 3 == 2, moments.next()
    ending = hit(kitchen.bake.command(), folder, moment, [number] * (1 + twice))
    moments.learn(ending)
    complaints = complaints_about(kitchen, folder, number, ending, twice, moment)
    if ending.code != 0 and run % 3 == 0:
        complaints += complaints_about_the_next(kitchen, folder)
    shutil.rmtree(folder)
    return f"{number.name}{' twice' * twice} after {moment:.3f} s", complaints, ending.code != 0


def main():
    report = bakes.Report()
    for bake, runs in BAKES:
        with bakes.Kitchen(bake) as kitchen:
            moments, caught, total = Moments(time_of(bake.command(), kitchen.table())), 0, runs * len(SIGNALS)
            for run in range(runs):
                for number in SIGNALS:
                    name, complaints, in_time = hit_once(kitchen, number, moments, run)
                    report.judge(f"{bake.name}: {name}", complaints)
                    caught += in_time
            report.judge(f"{bake.name}: signals come in time", [f"{caught} of {total}"] * (caught < total / 4))
            print(f"{caught} of {total} bakes of {moments.seconds:.1f} s were caught, seed {moments.seed}")
    report.finish()


if __name__ == "__main__":
    main()
