"""Runs a program with the shim under it (shim.cpp): one fault, and what came of it."""
import os
import pathlib
import re
import signal
import subprocess
import tempfile
from typing import NamedTuple

TIMEOUT = 120


class Fault(NamedTuple):
    """The k-th call of a kind fails; without a kind the calls are only counted."""
    kind: str = ""
    at: int = 0
    action: str = ""  # the number of an errno, "short" or "exit"
    stays: bool = False
    no_tmpfile: bool = False  # the file system has no O_TMPFILE
    folder_sync: int = 0  # the number of an errno: what every fsync of a folder says
    rename_twice: bool = False  # every rename is done, and then returns ENOENT
    range_locks: bool = False  # flock needs what a record lock needs: to exclude, a file open for writing


class Outcome(NamedTuple):
    code: int
    stderr: str
    fired: list  # of (kind, k, path)
    counts: dict  # of calls by kind; empty if the process was killed


def environment(library, folders, mark, fault, log=""):
    return dict(os.environ, SVDAG_FAULT_LOG=str(log), LC_ALL="C", LD_PRELOAD=str(library), SVDAG_FAULT_MARK=str(mark),
                SVDAG_FAULT_UNDER=":".join(str(pathlib.Path(f).resolve()) for f in folders),
                SVDAG_FAULT_KIND=fault.kind, SVDAG_FAULT_AT=str(fault.at), SVDAG_FAULT_DO=fault.action,
                SVDAG_FAULT_STAYS=str(int(fault.stays)), SVDAG_FAULT_NO_TMPFILE=str(int(fault.no_tmpfile)),
                SVDAG_FAULT_FOLDER_SYNC=str(fault.folder_sync), SVDAG_FAULT_RENAME_TWICE=str(int(fault.rename_twice)),
                SVDAG_FAULT_RANGE_LOCKS=str(int(fault.range_locks)))


def run(library, command, cwd, fault, folders=(), log=""):
    """Runs `command` in `cwd`; calls below `cwd` and the `folders` count. A program that hangs is killed.

    `log`: a file that gets all that changes those folders (log.h)."""
    with tempfile.NamedTemporaryFile(prefix="svdag-mark-") as mark:
        program = subprocess.Popen(command, cwd=cwd, env=environment(library, [cwd, *folders], mark.name, fault, log),
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        try:
            _, stderr = program.communicate(timeout=TIMEOUT)
        except subprocess.TimeoutExpired:
            program.send_signal(signal.SIGKILL)
            stderr = program.communicate()[1] + f"did not end within {TIMEOUT} s\n".encode()
        text = pathlib.Path(mark.name).read_text()
    fired = [(kind, int(k), path) for kind, k, path in re.findall(r"^fired (\w+) (\d+) (.*)$", text, re.M)]
    counts = {kind: int(n) for kind, n in re.findall(r"^count (\w+) (\d+)$", text, re.M)}
    return Outcome(program.returncode, stderr.decode(errors="replace"), fired, counts)
