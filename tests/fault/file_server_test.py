#!/usr/bin/env python3
"""Tests a plan on a simulated NFS server, with scratch on a local disk, against the behaviour of NFS.

No O_TMPFILE; fsync of folders fails; a rename succeeds, is sent again, and returns an error; no locks, or locks that
need a file open for writing; files replaced on the server (ESTALE); a server that does not respond (ETIMEDOUT).
"""
import errno
import fcntl
import pathlib
import shutil
import subprocess
import tempfile
import threading
import time

import bakes
import shim
from shim import Fault

SVDAG = bakes.BUILD / "svdag"
STEPS = ["shard-1", "shard-2", "merge-1"]


class Farm:
    """A plan of two shards in the folder `served`, whose calls can fail, and a scratch folder `local`."""

    def __init__(self, root):
        self.served, self.local = root / "served", root / "local"
        self.served.mkdir()
        self.local.mkdir()
        scene = root / "scene.ply"
        subprocess.run([bakes.BUILD / "svdag-scene", "hairball", "-n", "5K", "-q", "-o", scene], check=True)
        subprocess.run([SVDAG, "build", scene, "-r", "256", "-q", "-o", root / "one.svdag"], check=True)
        subprocess.run([SVDAG, "plan", scene, "-r", "256", "--shards", "2", "-q", "-o", self.served / "plan"], check=True)
        self.bytes = (root / "one.svdag").read_bytes()

    def clear(self):
        for path in [*(self.served / "plan" / "runs").iterdir(), self.served / "plan" / "plan.svdag", *self.local.iterdir()]:
            shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)

    def step(self, step, fault, local_scratch=True):
        scratch = ["--scratch", self.local] if local_scratch else []
        return shim.run(bakes.SHIM, [SVDAG, "run", "plan", "--step", step, "--keep", "-q", "-m", "3M", *scratch], self.served, fault)

    def failures(self, fault):
        """Failures of all steps with the fault: each must succeed, and the output equal that of one bake."""
        self.clear()
        found = []
        for step in STEPS:
            outcome = self.step(step, fault)
            if outcome.code != 0:
                found.append(f"{step}: exit {outcome.code}, {outcome.stderr!r}")
        return found + self.failures_of_output()

    def failures_of_output(self):
        output = self.served / "plan" / "plan.svdag"
        same = output.exists() and output.read_bytes() == self.bytes
        left = [p.name for p in (self.served / "plan" / "runs").iterdir() if p.suffix not in (".run", ".json")]
        return ([] if same else ["the bytes differ from those of one bake"]) + [f"{name} remains" for name in left]


def check_oddities(report, farm):
    report.record("no O_TMPFILE", farm.failures(Fault(no_tmpfile=True)))
    for error in (errno.EINVAL, errno.EOPNOTSUPP):
        report.record(f"no fsync of folders: {errno.errorcode[error]}", farm.failures(Fault(folder_sync=error)))
    report.record("renames sent twice", farm.failures(Fault(no_tmpfile=True, rename_twice=True)))


def check_locks(report, farm):
    no_locks = Fault("lock", 1, str(errno.ENOLCK), True)
    report.record("no locks, local scratch", farm.failures(no_locks))
    farm.clear()
    outcome = farm.step(STEPS[0], no_locks, local_scratch=False)
    output = [] if outcome.code == 4 and "--scratch" in outcome.stderr else [f"exit {outcome.code}, {outcome.stderr!r}"]
    report.record("no locks, scratch on the server", output + bakes.check_message(outcome.stderr))


def check_range_locks(report, farm):
    """Scratch on the server: a step that another process runs is not started a second time."""
    farm.clear()
    runs = farm.served / "plan" / "runs"
    scratch = runs / "shard-1.run.scratch"
    scratch.mkdir(mode=0o700)
    with open(scratch / "owner", "w") as owner:
        fcntl.flock(owner, fcntl.LOCK_EX)
        holder = threading.Thread(target=unlock_after, args=(owner, runs / "shard-2.json"))
        holder.start()
        outcome = shim.run(bakes.SHIM, [SVDAG, "run", "plan", "-j", "1", "-q"], farm.served, Fault(range_locks=True))
        holder.join()
    found = [] if outcome.code == 0 else [f"exit {outcome.code}, {outcome.stderr!r}"]
    output = (farm.served / "plan" / "logs" / "shard-1.log").read_text()
    report.record("locks of NFS", found + [output] * (output.count("shard-1 is done") != 1) + farm.failures_of_output())


def unlock_after(lock, receipt):
    """Simulates the other process: holds the lock until the receipt exists."""
    deadline = time.monotonic() + 60
    while not receipt.exists() and time.monotonic() < deadline:
        time.sleep(0.02)
    fcntl.flock(lock, fcntl.LOCK_UN)


def check_lost_calls(report, farm):
    """Each open and read of the served files fails once: exit code 4, and repeating the step gives the file."""
    fired = 0
    farm.failures(Fault())
    for number, step in enumerate(STEPS):
        farm.clear()
        for before in STEPS[:number]:
            farm.step(before, Fault())
        counts = farm.step(step, Fault()).counts
        output = farm.served / "plan" / (f"runs/{step}.run" if number < 2 else "plan.svdag")
        expected = output.read_bytes()
        for kind in ("open", "read"):
            for k in range(1, counts[kind] + 1):
                error = errno.ESTALE if k % 2 else errno.ETIMEDOUT
                for path in [output, *farm.served.glob(f"plan/runs/{step}.*")]:
                    path.unlink(missing_ok=True)
                outcome = farm.step(step, Fault(kind, k, str(error)))
                fired += bool(outcome.fired)
                found = [] if outcome.code in (0, 4) else [f"exit {outcome.code}, {outcome.stderr!r}"]
                if outcome.code == 4:
                    found += bakes.check_message(outcome.stderr)
                    again = farm.step(step, Fault())
                    found += [f"again: exit {again.code}, {again.stderr!r}"] * (again.code != 0)
                found += ["the bytes differ"] * (not output.exists() or output.read_bytes() != expected)
                report.record(f"{step}: {kind} {k} returns {errno.errorcode[error]}", found)
        farm.step(step, Fault())
    report.record("the output after all faults", farm.failures_of_output())
    report.record("faults fire", ["none fired"] * (fired == 0))
    print(f"{fired} calls failed")


def main():
    report = bakes.Report()
    with tempfile.TemporaryDirectory(prefix="svdag-fault-") as folder:
        farm = Farm(pathlib.Path(folder).resolve())
        check_oddities(report, farm)
        check_locks(report, farm)
        check_range_locks(report, farm)
        check_lost_calls(report, farm)
    report.finish()


if __name__ == "__main__":
    main()
