"""Runs a program with the shim (shim.cpp) preloaded: injects one fault and returns the outcome."""
import os
import pathlib
import re
import signal
import subprocess
import tempfile
from typing import NamedTuple

TIMEOUT = 120


class Fault(NamedTuple):
    """A fault: call number `at` of a kind fails; without a kind, calls are only counted."""
    kind: str = ""
    at: int = 0
    action: str = ""  # an errno as text, "short" or "exit"
    stays: bool = False  # all later calls of the kind fail too
    no_tmpfile: bool = False  # the file system has no O_TMPFILE
    folder_sync: int = 0  # errno that every fsync of a folder returns; 0: none
    rename_twice: bool = False  # every rename succeeds but returns ENOENT
    range_locks: bool = False  # an exclusive flock needs a file open for writing, like a record lock


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
    """Runs `command` in `cwd`; calls on files below `cwd` and `folders` count. Kills it after TIMEOUT.

    `log`: path of a log of all changes in those folders (log.h)."""
    with tempfile.NamedTemporaryFile(prefix="svdag-mark-") as mark:
        program = subprocess.Popen(command, cwd=cwd, env=environment(library, [cwd, *folders], mark.name, fault, log),
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        try:
            _, stderr = program.communicate(timeout=TIMEOUT)
        except subprocess.TimeoutExpired:
            program.send_signal(signal.SIGKILL)
            stderr = program.communicate()[1] + f"timed out after {TIMEOUT} s\n".encode()
        text = pathlib.Path(mark.name).read_text()
    fired = [(kind, int(k), path) for kind, k, path in re.findall(r"^fired (\w+) (\d+) (.*)$", text, re.M)]
    counts = {kind: int(n) for kind, n in re.findall(r"^count (\w+) (\d+)$", text, re.M)}
    return Outcome(program.returncode, stderr.decode(errors="replace"), fired, counts)
