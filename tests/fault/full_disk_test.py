#!/usr/bin/env python3
"""A disk that is too small, of many sizes: exit 4, one sentence, and the old file alone is left.

The disks are tmpfs in a mount namespace of this test, which vanishes with it.
"""
import contextlib
import os
import pathlib
import shutil
import subprocess
import sys
import threading
from typing import NamedTuple

import bakes

PAGE = 4096
SIZES = 512 if bakes.LONG else 16
AMPLE = 1 << 30
UNSHARED = "SVDAG_TEST_UNSHARED"


class Case(NamedTuple):
    """The files on the small disk, which is the folder `disk` beside the scene."""
    name: str
    bake: bakes.Bake
    output: str
    exact: bool  # a disk that is smaller than the old and the new file together never suffices


CASES = [Case("output", bakes.Bake("city", ["city", "-n", "60K"], ["-r", "1K", "-m", "256M", "-j", "2"]),
              f"disk/{bakes.OUTPUT}", True),
         Case("scratch", bakes.Bake("hairball", ["hairball", "-n", "100K"],
                                    ["-r", "1K", "-m", "16M", "-j", "2", "--scratch", "disk"]), bakes.OUTPUT, False)]


def in_own_namespace():
    """Starts this test once more in a mount namespace of its own; the reason if that is not allowed."""
    if os.environ.get(UNSHARED) == "1":
        return None
    unshare = ["unshare", "-m" if os.geteuid() == 0 else "-rm", "--propagation", "private"]
    mount = ["sh", "-c", "mount -t tmpfs none /mnt"]
    try:
        tried = subprocess.run([*unshare, *mount], capture_output=True, text=True)
    except OSError as error:
        return f"unshare: {error.strerror}"
    if tried.returncode != 0:
        return f"no mounts are allowed here: {tried.stderr.strip()}"
    os.execvpe(unshare[0], [*unshare, sys.executable, "-B", *sys.argv], dict(os.environ, **{UNSHARED: "1"}))


@contextlib.contextmanager
def small_disk(kitchen, case, size):
    """A folder as Kitchen.table(), with `disk` of `size` bytes."""
    folder = kitchen.table()
    (folder / "disk").mkdir(exist_ok=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", folder / "disk"], check=True)
    try:
        (folder / bakes.OUTPUT).rename(folder / "old")
        shutil.move(folder / "old", folder / case.output)
        yield folder
    finally:
        subprocess.run(["umount", folder / "disk"], check=True)
        shutil.rmtree(folder)


def peak_use(kitchen, case):
    """Bytes that the bake uses on an ample disk at most, as far as polling sees."""
    with small_disk(kitchen, case, AMPLE) as folder:
        program = subprocess.Popen(case.bake.command(output=case.output), cwd=folder)
        peak, tick = 0, threading.Event()
        while program.poll() is None:
            peak = max(peak, used(folder / "disk"))
            tick.wait(0.001)
        assert program.returncode == 0
        return max(peak, used(folder / "disk"))


def used(disk):
    status = os.statvfs(disk)
    return (status.f_blocks - status.f_bfree) * status.f_frsize


def pages(data):
    return -(-len(data) // PAGE) * PAGE


def leftovers(case, folder):
    names = {p.name for p in (folder / "disk").iterdir()} - {pathlib.Path(case.output).name}
    return [f"disk/{name} was left" for name in sorted(names)] + \
           [c for c in bakes.leftovers(folder) if c != "disk was left"]


def complaints_about(kitchen, case, size, must_fail):
    with small_disk(kitchen, case, size) as folder:
        done = subprocess.run(case.bake.command(output=case.output), cwd=folder, capture_output=True, text=True)
        state, found = kitchen.state(folder, case.output), leftovers(case, folder)
    if done.returncode == 0 and not must_fail:
        return found + (["exit 0, but no new file"] if state != "new" else [])
    if done.returncode != 4:
        found.append(f"exit {done.returncode}, {done.stderr!r}")
    if not any(word in done.stderr for word in ("full", "free", "space")):
        found.append(f"does not speak of the disk: {done.stderr!r}")
    return found + bakes.sentences(done.stderr) + (["the old file is gone"] if state != "old" else [])


def run_case(report, case):
    with bakes.Kitchen(case.bake) as kitchen:
        old, both = pages(kitchen.old), pages(kitchen.old) + pages(kitchen.new)
        need = max(peak_use(kitchen, case), both if case.exact else 0)
        low = old if case.exact else 0
        sizes = sorted({low + (need - low) * i // SIZES // PAGE * PAGE for i in range(SIZES)} - {0})
        for size in sizes:
            report.judge(f"{case.name}: disk of {size} bytes",
                         complaints_about(kitchen, case, size, case.exact and size < both))
        report.judge(f"{case.name}: an ample disk", complaints_about(kitchen, case, 2 * need, False))
        print(f"{case.name}: {len(sizes)} sizes from {sizes[0]} to {sizes[-1]} bytes, {need} are needed")


def main():
    report = bakes.Report()
    reason = in_own_namespace()
    if reason is not None:
        report.skip(reason)
    else:
        for case in CASES:
            run_case(report, case)
    report.finish()


if __name__ == "__main__":
    main()
