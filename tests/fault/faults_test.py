#!/usr/bin/env python3
"""Tests failing system calls: every file operation of a bake fails once, with every possible error.

An interrupted call or a short transfer has no effect. An error gives exit code 4 (3 for the scene or a run) and one
message. The output is the old file or the complete new one, and no other file remains. Only a killed process, or one
whose message mentions --resume, may leave its scratch folder; the next bake reuses it or reports it.
"""
import errno
import os
import pathlib
import re
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor

import bakes
import shim
from shim import Fault

KINDS = ["open", "read", "write", "fsync", "close", "rename", "link", "unlink", "truncate", "mkdir", "lock", "mode"]
CAN_BE_FULL = {"open", "write", "fsync", "close", "rename", "link", "truncate", "mkdir"}
CAN_BE_DENIED = {"open", "rename", "link", "mkdir"}
CAN_BE_INTERRUPTED = {"open", "read", "write", "fsync", "close", "truncate", "lock"}
CAN_BE_SHORT = {"read", "write"}
INTERRUPTED = str(errno.EINTR)


def actions(kind):
    """(the action of the failing call, whether all later calls fail too) for a kind of call."""
    yield "exit", False
    errors = [errno.EIO] + [errno.ENOSPC] * (kind in CAN_BE_FULL)
    if bakes.LONG:
        errors += [errno.EDQUOT] * (kind in CAN_BE_FULL) + [errno.EACCES] * (kind in CAN_BE_DENIED)
    for error in errors:
        yield from ((str(error), False), (str(error), True))
    if kind in CAN_BE_INTERRUPTED:
        yield INTERRUPTED, False
    if kind in CAN_BE_SHORT:
        yield "short", False


def faults(counts, no_tmpfile):
    return [Fault(kind, k, action, stays, no_tmpfile) for kind in KINDS for k in range(1, counts[kind] + 1)
            for action, stays in actions(kind)]


def is_scratch(path, folder):
    return re.match(rf"{re.escape(str(folder))}/({bakes.OF_SCRATCH})(/.*)?( \(deleted\))?$", path) is not None


def codes_of_call(fault, path, folder):
    """The allowed exit codes after one failed call on a file."""
    if fault.action == "short" or (fault.action == INTERRUPTED and fault.kind != "fsync"):
        return {0}
    if fault.kind == "close" and (bakes.is_input(path) or path in [str(folder), str(folder / bakes.SHARED_SCRATCH)]):
        return {0}  # closing a file that was only read loses nothing
    if fault.kind == "unlink" or (fault.kind == "close" and is_scratch(path, folder)):
        return {0, 4}  # the file is no longer needed
    # An I/O error may be temporary, for inputs too: farms repeat a step after 4, but not after 3.
    return {3} if bakes.is_input(path) and fault.action != str(errno.EIO) else {4}


def expected_codes(fault, paths, folder):
    """The allowed exit codes: those of the first fatal call."""
    if fault.action == "exit":
        return {137}
    codes = [codes_of_call(fault, path, folder) for path in paths]
    return next((c for c in codes if c != {0}), {0})


def is_clean_up(fault, outcome, folder):
    """Whether the last sync failed: that of the emptied scratch folder, after the output is complete."""
    return (fault.kind == "fsync" and fault.action != "exit" and outcome.counts["fsync"] == fault.at and
            outcome.counts["rename"] == 1 and all(is_scratch(path, folder) for _, _, path in outcome.fired))


def allowed_states(fault, outcome):
    """The allowed states of the output: new exactly if the rename was done."""
    if fault.action == "exit":
        return {"old", "new"}
    renamed = outcome.counts.get("rename", 0) > (fault.kind == "rename")
    return {"new"} if outcome.code == 0 or renamed else {"old"}


def failures_of_next_bake(fixture, folder):
    """Failures unless the next bake finishes, or reports the unfinished one and finishes with --restart."""
    command = fixture.bake.command()
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode == 2 and re.search(bakes.OF_SCRATCH, done.stderr) and not bakes.check_message(done.stderr):
        done = subprocess.run([*command, "--restart"], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        return [f"the next bake: exit {done.returncode}, {done.stderr!r}"]
    left = bakes.leftovers(folder, bakes.LEFT_BY_KILL) + bakes.remaining_scratch(folder)
    return left + ([] if fixture.state(folder) == "new" else [f"after the next bake the output is {fixture.state(folder)}"])


def failures_of(fixture, folder, fault, outcome):
    if not outcome.fired:  # timing may avoid the call; the bake must then succeed
        saved = outcome.code == 0 and outcome.counts[fault.kind] < fault.at
        return [] if saved and fixture.state(folder) == "new" else ["the fault did not fire"]
    found = []
    codes, states = expected_codes(fault, [f[2] for f in outcome.fired], folder), allowed_states(fault, outcome)
    if is_clean_up(fault, outcome, folder):
        codes = {0}
    if outcome.code not in codes:
        found.append(f"exit {outcome.code}, expected {sorted(codes)}; {outcome.stderr!r}")
    elif outcome.code in (3, 4):
        found += bakes.check_message(outcome.stderr)
    if fixture.state(folder) not in states:
        found.append(f"the output is {fixture.state(folder)}, expected {sorted(states)}")
    killed = fault.action == "exit"
    kept = outcome.code == 4 and "--resume" in outcome.stderr
    cleaned = outcome.counts.get("mkdir", 0) > 0  # the removal of the scratch files is synced once, even after a failure
    if fault.kind == "fsync" and not killed and outcome.counts["fsync"] > fault.at + cleaned:
        found.append("a file was synced after a failed fsync")
    may_stay = bakes.LEFT_BY_KILL if killed or fault.kind == "unlink" else [bakes.OF_SCRATCH] * kept
    found += bakes.leftovers(folder, may_stay)
    return found + (failures_of_next_bake(fixture, folder) if killed or kept else [])


def run_one(fixture, fault):
    folder = fixture.new_folder()
    outcome = shim.run(bakes.SHIM, fixture.bake.command(), folder, fault)
    found = failures_of(fixture, folder, fault, outcome)
    shutil.rmtree(folder)
    way = fault.action if not fault.action.isdigit() else errno.errorcode[int(fault.action)]
    path = pathlib.Path(outcome.fired[0][2]).name if outcome.fired else "nothing"
    return (f"{fixture.bake.name}{', no O_TMPFILE' * fault.no_tmpfile}: {fault.kind} {fault.at} of {path} "
            f"{way}{' from then on' * fault.stays}"), found, bool(outcome.fired)


def run_all(report, fixture, no_tmpfile, pool):
    folder = fixture.new_folder()
    counted = shim.run(bakes.SHIM, fixture.bake.command(), folder, Fault(no_tmpfile=no_tmpfile))
    # Every bake makes these calls: if one is not counted, the shim does not work.
    missing = [k for k in ("open", "read", "write", "fsync", "close", "rename") if counted.counts.get(k, 0) == 0]
    report.record(f"{fixture.bake.name}: calls are counted", [f"no {k}" for k in missing])
    fired = 0
    planned = faults(counted.counts, no_tmpfile)
    for name, failures, did_fire in pool.map(lambda fault: run_one(fixture, fault), planned):
        report.record(name, failures)
        fired += did_fire
    missed = [f"only {fired} of {len(planned)}"] * (fired < 0.9 * len(planned))
    report.record(f"{fixture.bake.name}: faults fire", missed)
    calls = ", ".join(f"{n} {kind}" for kind, n in counted.counts.items() if n > 0)
    print(f"{fixture.bake.name}{', no O_TMPFILE' * no_tmpfile}: {calls}; {fired} faults")


def main():
    report = bakes.Report()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for bake in bakes.SMALL_LONG if bakes.LONG else bakes.SMALL:
            with bakes.BakeFixture(bake) as fixture:
                run_all(report, fixture, False, pool)
                if bake is bakes.SMALL[0] or bakes.LONG:
                    run_all(report, fixture, True, pool)
    report.finish()


if __name__ == "__main__":
    main()
