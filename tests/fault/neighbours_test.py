#!/usr/bin/env python3
"""Tests concurrent bakes with one --scratch folder: some are killed, two have the same output, and none affects another.

The second bake of an output is rejected with one message and exit code 2. The next bake of an output removes the
scratch folder of a killed one.
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
    """Repeated bakes of one output."""

    def __init__(self, folder, number):
        self.folder, self.output = folder, f"{number}.svdag"
        self.command = [bakes.BUILD / "svdag", "build", "scene.ply", "-s", str(0.004 + 0.0001 * number), *OPTIONS, "-o"]
        subprocess.run([*self.command, "expected.svdag"], cwd=folder, check=True)
        (folder / "expected.svdag").rename(folder / f"{number}.expected")
        self.expected = (folder / f"{number}.expected").read_bytes()

    def begin(self):
        return subprocess.Popen([*self.command, self.output], cwd=self.folder, stderr=subprocess.PIPE, text=True)

    def forget(self):
        (self.folder / self.output).unlink(missing_ok=True)

    def failures(self):
        path = self.folder / self.output
        return [f"{self.output}: the bytes differ"] * (path.exists() and path.read_bytes() != self.expected)


def round_of(neighbours, random_source):
    """(failures of one round, number of rejected bakes, number of killed bakes)"""
    for neighbour in neighbours:
        neighbour.forget()
    twice = random_source.choice(neighbours)
    started = [(n, n.begin()) for n in [*neighbours, twice]]
    killed = {process.pid for _, process in started if random_source.random() < 0.3}
    time.sleep(random_source.random() * 0.2)
    for _, process in started:
        if process.pid in killed:
            process.kill()
    found, rejected, died, done = [], 0, 0, set()
    for neighbour, process in started:
        _, stderr = process.communicate(timeout=120)
        if process.returncode == 2 and IN_USE in stderr:
            rejected += 1
            found += bakes.check_message(stderr) + ["rejected without a second bake"] * (neighbour is not twice)
        elif process.returncode == 0:
            done.add(neighbour.output)
        elif process.pid in killed and process.returncode == -9:
            died += 1
        else:
            found.append(f"{neighbour.output}: exit {process.returncode}, {stderr!r}")
    for neighbour in neighbours:
        found += neighbour.failures()
        found += [f"{neighbour.output} is missing"] * (neighbour.output in done and
                                                         not (neighbour.folder / neighbour.output).exists())
    return found, rejected, died


def failures_of_second_bake(neighbour):
    """Failures unless a second bake of an output is rejected while the first is stopped."""
    for _ in range(20):  # the first may finish before it is stopped
        neighbour.forget()
        neighbour.begin().communicate(timeout=120)  # removes the scratch folder of a killed bake
        neighbour.forget()
        first = neighbour.begin()
        while first.poll() is None and not list(neighbour.folder.glob(f"{bakes.SHARED_SCRATCH}/{neighbour.output}-*/journal")):
            time.sleep(0.001)
        first.send_signal(signal.SIGSTOP)
        if first.poll() is None:
            break
        first.communicate()
    else:
        return ["the first was never stopped in time"]
    second = neighbour.begin()
    stderr = second.communicate(timeout=120)[1]
    rejected = second.returncode == 2 and IN_USE in stderr
    first.send_signal(signal.SIGCONT)
    first.communicate(timeout=120)
    found = [] if rejected else [f"the second: exit {second.returncode}, {stderr!r}"]
    return found + [f"the first: exit {first.returncode}"] * (first.returncode != 0) + neighbour.failures()


def main():
    report = bakes.Report()
    random_source = random.Random(SEED)
    with tempfile.TemporaryDirectory(prefix="svdag-fault-") as name:
        folder = pathlib.Path(name).resolve()
        (folder / bakes.SHARED_SCRATCH).mkdir()
        subprocess.run([bakes.BUILD / "svdag-scene", "hairball", "-n", "5K", "-q", "-o", folder / "scene.ply"], check=True)
        neighbours = [Neighbour(folder, n) for n in range(PROCESSES)]
        report.record("their bytes differ", ["some do not"] * (len({n.expected for n in neighbours}) != PROCESSES))
        rejected = died = 0
        for number in range(ROUNDS):
            found, more_refused, more_died = round_of(neighbours, random_source)
            report.record(f"round {number}", found)
            rejected, died = rejected + more_refused, died + more_died
        report.record("two of one output", failures_of_second_bake(neighbours[0]))
        report.record("kills come in time", [f"only {died}"] * (died < ROUNDS / 4))
        for neighbour in neighbours:
            neighbour.forget()
            process = neighbour.begin()
            stderr = process.communicate(timeout=120)[1]
            report.record(f"{neighbour.output}: final bake", [f"exit {process.returncode}, {stderr!r}"] *
                         (process.returncode != 0) + neighbour.failures())
        left = sorted(p.name for p in (folder / bakes.SHARED_SCRATCH).iterdir())
        left += sorted(p.name for p in folder.iterdir() if p.suffix not in (".svdag", ".expected", ".ply") and p.is_file())
        report.record("no file remains", left)
        print(f"{died} killed, {rejected} rejected")
    report.finish()


if __name__ == "__main__":
    main()
