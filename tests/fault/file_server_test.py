#!/usr/bin/env python3
"""A plan on a file server, its scratch on a local disk: what NFS says and local disks do not, and the right verdict.

No O_TMPFILE; folders that cannot be synced; a rename that is done, sent again, and then said to have failed; no locks,
or such as need a file that is open for writing; files that the server has replaced (ESTALE), a server that does not
answer (ETIMEDOUT).
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
STEPS = [["build", "--shard", "1"], ["build", "--shard", "2"], ["merge", "--step", "merge-1"]]


class Farm:
    """A plan of two shards in `served`, whose every call counts, and a folder for scratch that is local."""

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
        for path in [*(self.served / "plan" / "runs").iterdir(), self.served / "plan" / "scene.svdag", *self.local.iterdir()]:
            shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)

    def step(self, step, fault, local_scratch=True):
        scratch = ["--scratch", self.local] if local_scratch else []
        return shim.run(bakes.SHIM, [SVDAG, step[0], "plan", *step[1:], "-q", "-m", "3M", *scratch], self.served, fault)

    def complaints(self, fault):
        """All steps with the fault: each must be done, and the file be that of one bake."""
        self.clear()
        found = []
        for step in STEPS:
            outcome = self.step(step, fault)
            if outcome.code != 0:
                found.append(f"{step}: exit {outcome.code}, {outcome.stderr!r}")
        return found + self.complaints_about_file()

    def complaints_about_file(self):
        output = self.served / "plan" / "scene.svdag"
        same = output.exists() and output.read_bytes() == self.bytes
        left = [p.name for p in (self.served / "plan" / "runs").iterdir() if p.suffix not in (".run", ".json")]
        return ([] if same else ["not the bytes of one bake"]) + [f"{name} was left" for name in left]


def judge_oddities(report, farm):
    report.judge("no O_TMPFILE", farm.complaints(Fault(no_tmpfile=True)))
    for error in (errno.EINVAL, errno.EOPNOTSUPP):
        report.judge(f"no fsync of folders: {errno.errorcode[error]}", farm.complaints(Fault(folder_sync=error)))
    report.judge("renames sent twice", farm.complaints(Fault(no_tmpfile=True, rename_twice=True)))


def judge_locks(report, farm):
    none = Fault("lock", 1, str(errno.ENOLCK), True)
    report.judge("no locks, local scratch", farm.complaints(none))
    farm.clear()
    outcome = farm.step(STEPS[0], none, local_scratch=False)
    said = [] if outcome.code == 4 and "--scratch" in outcome.stderr else [f"exit {outcome.code}, {outcome.stderr!r}"]
    report.judge("no locks, scratch on the server", said + bakes.sentences(outcome.stderr))


def judge_range_locks(report, farm):
    """Scratch on the server, a step that another process does: no process of ours begins it meanwhile."""
    farm.clear()
    runs = farm.served / "plan" / "runs"
    scratch = runs / "shard-1.run.scratch"
    scratch.mkdir(mode=0o700)
    with open(scratch / "owner", "w") as owner:
        fcntl.flock(owner, fcntl.LOCK_EX)
        ours = threading.Thread(target=give_back_after, args=(owner, runs / "shard-2.json"))
        ours.start()
        outcome = shim.run(bakes.SHIM, [SVDAG, "run", "plan", "-j", "1", "-q"], farm.served, Fault(range_locks=True))
        ours.join()
    found = [] if outcome.code == 0 else [f"exit {outcome.code}, {outcome.stderr!r}"]
    said = (farm.served / "plan" / "logs" / "shard-1.log").read_text()
    report.judge("locks as of NFS", found + [said] * (said != "") + farm.complaints_about_file())


def give_back_after(lock, receipt):
    """What another process does, until the receipt is there."""
    patience = time.monotonic() + 60
    while not receipt.exists() and time.monotonic() < patience:
        time.sleep(0.02)
    fcntl.flock(lock, fcntl.LOCK_UN)


def judge_losses(report, farm):
    """Each open and read of the server's files fails once: exit 4, and the step done again gives the file."""
    fired = 0
    farm.complaints(Fault())
    for number, step in enumerate(STEPS):
        farm.clear()
        for before in STEPS[:number]:
            farm.step(before, Fault())
        counts = farm.step(step, Fault()).counts
        output = farm.served / "plan" / (f"runs/shard-{number + 1}.run" if number < 2 else "scene.svdag")
        expected = output.read_bytes()
        for kind in ("open", "read"):
            for k in range(1, counts[kind] + 1):
                error = errno.ESTALE if k % 2 else errno.ETIMEDOUT
                for path in [output, *farm.served.glob(f"plan/runs/{step[-1] if number == 2 else f'shard-{number + 1}'}.*")]:
                    path.unlink(missing_ok=True)
                outcome = farm.step(step, Fault(kind, k, str(error)))
                fired += bool(outcome.fired)
                found = [] if outcome.code in (0, 4) else [f"exit {outcome.code}, {outcome.stderr!r}"]
                if outcome.code == 4:
                    found += bakes.sentences(outcome.stderr)
                    again = farm.step(step, Fault())
                    found += [f"again: exit {again.code}, {again.stderr!r}"] * (again.code != 0)
                found += ["other bytes"] * (not output.exists() or output.read_bytes() != expected)
                report.judge(f"{step}: {kind} {k} says {errno.errorcode[error]}", found)
        farm.step(step, Fault())
    report.judge("after all that", farm.complaints_about_file())
    report.judge("faults fire", ["none did"] * (fired == 0))
    print(f"{fired} calls were answered as by a file server in trouble")


def main():
    report = bakes.Report()
    with tempfile.TemporaryDirectory(prefix="svdag-fault-") as folder:
        farm = Farm(pathlib.Path(folder).resolve())
        judge_oddities(report, farm)
        judge_locks(report, farm)
        judge_range_locks(report, farm)
        judge_losses(report, farm)
    report.finish()


if __name__ == "__main__":
    main()
