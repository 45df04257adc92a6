#!/usr/bin/env python3
"""Tests full disks of many sizes: exit code 4, one message, and only the old file remains.

The disks are tmpfs mounts in a mount namespace of this test, which ends with it.
"""
import contextlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading
from typing import NamedTuple

import bakes

PAGE = 4096
SIZES = 512 if bakes.LONG else 16
AMPLE = 1 << 30
UNSHARED = "SVDAG_TEST_UNSHARED"


class Case(NamedTuple):
    """A bake with some of its files on the small disk, the folder `disk` beside the scene."""
    name: str
    bake: bakes.Bake
    output: str
    exact: bool  # a disk smaller than the old and the new file together is never enough


CASES = [Case("output", bakes.Bake("city", ["city", "-n", "60K"], ["-r", "1K", "-m", "256M", "-j", "2"]),
              f"disk/{bakes.OUTPUT}", True),
         Case("scratch", bakes.Bake("hairball", ["hairball", "-n", "100K"],
                                    ["-r", "1K", "-m", "16M", "-j", "2", "--scratch", "disk"]), bakes.OUTPUT, False)]


def in_own_namespace():
    """Restarts this test in its own mount namespace; returns the reason if that is not possible."""
    if os.environ.get(UNSHARED) == "1":
        return None
    unshare = ["unshare", "-m" if os.geteuid() == 0 else "-rm", "--propagation", "private"]
    mount = ["sh", "-c", "mount -t tmpfs none /mnt"]
    try:
        tried = subprocess.run([*unshare, *mount], capture_output=True, text=True)
    except OSError as error:
        return f"unshare: {error.strerror}"
    if tried.returncode != 0:
        return f"cannot mount: {tried.stderr.strip()}"
    os.execvpe(unshare[0], [*unshare, sys.executable, "-B", *sys.argv], dict(os.environ, **{UNSHARED: "1"}))


@contextlib.contextmanager
def small_disk(fixture, case, size):
    """A folder as of BakeFixture.new_folder(), with a `disk` of `size` bytes."""
    folder = fixture.new_folder()
    (folder / "disk").mkdir(exist_ok=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", folder / "disk"], check=True)
    try:
        (folder / bakes.OUTPUT).rename(folder / "old")
        shutil.move(folder / "old", folder / case.output)
        yield folder
    finally:
        subprocess.run(["umount", folder / "disk"], check=True)
        shutil.rmtree(folder)


def peak_use(fixture, case):
    """Peak bytes that the bake uses on an ample disk, measured by polling."""
    with small_disk(fixture, case, AMPLE) as folder:
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
    return [f"disk/{name} remains" for name in sorted(names)] + \
           [c for c in bakes.leftovers(folder) if c != "disk remains"]


def failures_of(fixture, case, size, must_fail):
    with small_disk(fixture, case, size) as folder:
        done = subprocess.run(case.bake.command(output=case.output), cwd=folder, capture_output=True, text=True)
        state, found = fixture.state(folder, case.output), leftovers(case, folder)
    if done.returncode == 0 and not must_fail:
        return found + (["exit 0, but no new file"] if state != "new" else [])
    if done.returncode != 4:
        found.append(f"exit {done.returncode}, {done.stderr!r}")
    if not any(word in done.stderr for word in ("full", "free", "space")):
        found.append(f"the message does not mention the disk: {done.stderr!r}")
    return found + bakes.check_message(done.stderr) + (["the old file is gone"] if state != "old" else [])


def dry_run_failures(fixture, case):
    """A dry run needs no space on the disk of the output, and reports that the bake will."""
    with small_disk(fixture, case, 2 * pages(fixture.old)) as folder:
        (folder / case.output).write_bytes(bytes(2 * pages(fixture.old)))
        words = [word for word in case.bake.command("--dry-run", output=case.output) if word != "-q"]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True)
    expected = "not enough disk space for the file: 0 bytes free"
    return [] if done.returncode == 0 and expected in done.stdout else [f"{done.returncode} {done}"]


def refusal_failures(fixture, case):
    """A bake whose nodes alone need more space than there is ends before its merge."""
    with small_disk(fixture, case, pages(fixture.old) + len(fixture.new) // 8) as folder:
        done = subprocess.run(case.bake.command("--scratch", ".", output=case.output), cwd=folder, capture_output=True,
                              text=True)
    expected = f"svdag: {case.output}: needs at least"
    return [] if done.returncode == 4 and done.stderr.startswith(expected) else [f"{done.returncode} {done}"]


def plan_failures():
    """A plan on a disk that cannot hold half of what it predicts is refused before its work."""
    found = []
    with tempfile.TemporaryDirectory(prefix="svdag-fault-") as name:
        folder = pathlib.Path(name)
        svdag = bakes.BUILD / "svdag"
        subprocess.run([bakes.BUILD / "svdag-scene", "scan", "-n", "20K", "-q", "-o", "a.ply"], cwd=folder, check=True)
        subprocess.run([svdag, "plan", "a.ply", "-r", "1K", "--shards", "2", "-o", "a.plan", "-q"], cwd=folder, check=True)
        own = sum(pages(path.read_bytes()) + PAGE for path in (folder / "a.plan").rglob("*") if path.is_file())
        steps = json.loads((folder / "a.plan/plan.json").read_text())["steps"]
        need = sum(step["predicted"]["output_bytes"] for step in steps)
        (folder / "disk").mkdir()
        for share, step, code, text in [(0.3, [], 4, "a.plan: the plan is predicted to write about "),
                                        (0.1, ["--step", "shard-1"], 4, "runs: shard-1 is predicted to write about "),
                                        (0.75, ["--step", "shard-1"], 0, "")]:
            size = own + 16 * PAGE + int(share * need)
            subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", folder / "disk"], check=True)
            try:
                shutil.copytree(folder / "a.plan", folder / "disk/a.plan")
                done = subprocess.run([svdag, "run", "disk/a.plan", "-q", *step], cwd=folder, capture_output=True, text=True)
            finally:
                subprocess.run(["umount", folder / "disk"], check=True)
            if done.returncode != code or text not in done.stderr or (done.stderr != "") != (text != ""):
                found.append(f"{share} of the space, {step}: {done}")
    return found


def colours_failures():
    """The colours of a HashDAG take 4 bytes a voxel: too small a disk is reported before a byte is written."""
    with tempfile.TemporaryDirectory(prefix="svdag-fault-") as name:
        folder = pathlib.Path(name)
        (folder / "disk").mkdir()
        subprocess.run([bakes.BUILD / "svdag-scene", "rectangle", "-q", "-o", "a.ply"], cwd=folder, check=True)
        subprocess.run([bakes.BUILD / "svdag", "build", "a.ply", "-o", "a.svdag", "-q", "-r", "256", "--layers", "file"],
                       cwd=folder, check=True)
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "none", folder / "disk"], check=True)
        try:
            done = subprocess.run([bakes.BUILD / "svdag", "export", "a.svdag", "--format", "hashdag", "--colours", "-o",
                                   "disk/a.basic_dag.dag.bin"], cwd=folder, capture_output=True, text=True)
            left = list((folder / "disk").iterdir())
        finally:
            subprocess.run(["umount", folder / "disk"], check=True)
    good = done.returncode == 4 and "the DAG and its colours take" in done.stderr and not left
    return bakes.check_message(done.stderr) + ([] if good else [f"{done} {left}"])


def work_array_failures(command):
    """Arrays of nodes beyond half of the memory are mapped from the disk: a full one is a sentence, not a signal."""
    with tempfile.TemporaryDirectory(prefix="svdag-fault-") as name:
        folder = pathlib.Path(name)
        (folder / "disk").mkdir()
        for words in (["svdag-scene", "atrium", "-n", "90000", "-q", "-o", "a.ply"],
                      ["svdag", "build", "a.ply", "-o", "a.svdag", "-q", "-r", "4096"],
                      ["svdag", "pack", "a.svdag", "-o", "a.svdag.pack", "-q"]):
            subprocess.run([bakes.BUILD / words[0], *words[1:]], cwd=folder, check=True)
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "none", folder / "disk"], check=True)
        try:
            done = subprocess.run([bakes.BUILD / "svdag", *command, "-m", "1M"], cwd=folder, capture_output=True, text=True,
                                  env=dict(os.environ, TMPDIR="disk"))
            left = list((folder / "disk").iterdir())
        finally:
            subprocess.run(["umount", folder / "disk"], check=True)
    good = done.returncode == 4 and "for an array of nodes" in done.stderr and not left
    return bakes.check_message(done.stderr) + ([] if good else [f"{done} {left}"])


def run_case(report, case):
    with bakes.BakeFixture(case.bake) as fixture:
        old, both = pages(fixture.old), pages(fixture.old) + pages(fixture.new)
        need = max(peak_use(fixture, case), both if case.exact else 0)
        low = old if case.exact else 0
        sizes = sorted({low + (need - low) * i // SIZES // PAGE * PAGE for i in range(SIZES)} - {0})
        for size in sizes:
            report.record(f"{case.name}: disk of {size} bytes",
                         failures_of(fixture, case, size, case.exact and size < both))
        report.record(f"{case.name}: an ample disk", failures_of(fixture, case, 2 * need, False))
        if case.exact:
            report.record(f"{case.name}: a dry run", dry_run_failures(fixture, case))
            report.record(f"{case.name}: refused early", refusal_failures(fixture, case))
        print(f"{case.name}: {len(sizes)} sizes from {sizes[0]} to {sizes[-1]} bytes, {need} needed")


def main():
    report = bakes.Report()
    reason = in_own_namespace()
    if reason is not None:
        report.skip(reason)
    else:
        for case in CASES:
            run_case(report, case)
        report.record("a plan: refused early", plan_failures())
        report.record("colours of an export: refused early", colours_failures())
        for command in (["convert", "a.svdag", "--layout", "compact", "-o", "disk/b.svdag"],
                        ["unpack", "a.svdag.pack", "-o", "disk/b.svdag"],
                        ["export", "a.svdag.pack", "-o", "disk/b.npz", "--level", "6"]):
            report.record(f"arrays of {command[0]}: a full disk", work_array_failures(command))
    report.finish()


if __name__ == "__main__":
    main()
