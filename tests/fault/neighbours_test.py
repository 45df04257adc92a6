#!/usr/bin/env python3
"""Many bakes at once in one scratch folder, some killed, two of them of one output: no byte of one in another's file.

Who comes second to an output is refused, in a sentence and with exit 2. What a killed bake left goes with the next
bake of its output.
"""
import pathlib
import random
import signal
import subprocess
import tempfile
import time

import bakes

PROCESSES, ROUNDS = (16, 100) if bakes.LONG else (4, 10)
SEED = 14
IN_USE = "another bake is using this scratch folder"
# Each spills triangles and runs, and saves both for --resume; no two outputs have the same bytes.
OPTIONS = ["-m", "3M", "-j", "1", "--checkpoint", "0.02", "--scratch", bakes.SHARED_SCRATCH, "-q", "--resume"]


class Neighbour:
    """The bake of one output, time after time."""

    def __init__(self, folder, number):
        self.folder, self.output = folder, f"{number}.svdag"
        self.command = [bakes.BUILD / "svdag", "build", "scene.ply", "-s", str(0.004 + 0.0001 * number), *OPTIONS, "-o"]
        subprocess.run([*self.command, "expected"], cwd=folder, check=True)
        (folder / "expected").rename(folder / f"{number}.expected")
        self.expected = (folder / f"{number}.expected").read_bytes()

    def begin(self):
        return subprocess.Popen([*self.command, self.output], cwd=self.folder, stderr=subprocess.PIPE, text=True)

    def forget(self):
        (self.folder / self.output).unlink(missing_ok=True)

    def complaints(self):
        path = self.folder / self.output
        return [f"{self.output}: other bytes"] * (path.exists() and path.read_bytes() != self.expected)


def round_of(neighbours, chance):
    """Complaints about one round, and how many were refused and killed in it."""
    for neighbour in neighbours:
        neighbour.forget()
    twice = chance.choice(neighbours)
    started = [(n, n.begin()) for n in [*neighbours, twice]]
    killed = {process.pid for _, process in started if chance.random() < 0.3}
    time.sleep(chance.random() * 0.2)
    for _, process in started:
        if process.pid in killed:
            process.kill()
    found, refused, died, done = [], 0, 0, set()
    for neighbour, process in started:
        _, said = process.communicate(timeout=120)
        if process.returncode == 2 and IN_USE in said:
            refused += 1
            found += bakes.sentences(said) + ["refused alone"] * (neighbour is not twice)
        elif process.returncode == 0:
            done.add(neighbour.output)
        elif process.pid in killed and process.returncode == -9:
            died += 1
        else:
            found.append(f"{neighbour.output}: exit {process.returncode}, {said!r}")
    for neighbour in neighbours:
        found += neighbour.complaints()
        found += [f"{neighbour.output} is not there"] * (neighbour.output in done and
                                                         not (neighbour.folder / neighbour.output).exists())
    return found, refused, died


def complaints_about_a_second(neighbour):
    """While the first is there, and does not go on, a second bake of its output does not begin."""
    for _ in range(20):  # the first may be quicker than we are
        neighbour.forget()
        neighbour.begin().communicate(timeout=120)  # what a killed one left is gone
        neighbour.forget()
        first = neighbour.begin()
        while first.poll() is None and not list(neighbour.folder.glob(f"{bakes.SHARED_SCRATCH}/{neighbour.output}-*/journal")):
            time.sleep(0.001)
        first.send_signal(signal.SIGSTOP)
        if first.poll() is None:
            break
        first.communicate()
    else:
        return ["the first was never caught"]
    second = neighbour.begin()
    said = second.communicate(timeout=120)[1]
    refused = second.returncode == 2 and IN_USE in said
    first.send_signal(signal.SIGCONT)
    first.communicate(timeout=120)
    found = [] if refused else [f"the second: exit {second.returncode}, {said!r}"]
    return found + [f"the first: exit {first.returncode}"] * (first.returncode != 0) + neighbour.complaints()


def main():
    report = bakes.Report()
    chance = random.Random(SEED)
    with tempfile.TemporaryDirectory(prefix="svdag-fault-") as name:
        folder = pathlib.Path(name).resolve()
        (folder / bakes.SHARED_SCRATCH).mkdir()
        subprocess.run([bakes.BUILD / "svdag-scene", "hairball", "-n", "5K", "-q", "-o", folder / "scene.ply"], check=True)
        neighbours = [Neighbour(folder, n) for n in range(PROCESSES)]
        report.judge("their bytes differ", ["some do not"] * (len({n.expected for n in neighbours}) != PROCESSES))
        refused = died = 0
        for number in range(ROUNDS):
            found, more_refused, more_died = round_of(neighbours, chance)
            report.judge(f"round {number}", found)
            refused, died = refused + more_refused, died + more_died
        report.judge("two of one output", complaints_about_a_second(neighbours[0]))
        report.judge("kills come in time", [f"only {died}"] * (died < ROUNDS / 4))
        for neighbour in neighbours:
            neighbour.forget()
            process = neighbour.begin()
            said = process.communicate(timeout=120)[1]
            report.judge(f"{neighbour.output} at last", [f"exit {process.returncode}, {said!r}"] *
                         (process.returncode != 0) + neighbour.complaints())
        left = sorted(p.name for p in (folder / bakes.SHARED_SCRATCH).iterdir())
        left += sorted(p.name for p in folder.iterdir() if p.suffix not in (".svdag", ".expected", ".ply") and p.is_file())
        report.judge("nothing is left", left)
        print(f"{died} killed, {refused} refused")
    report.finish()


if __name__ == "__main__":
    main()
