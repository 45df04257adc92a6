#!/usr/bin/env python3
"""Every call of a bake on its files fails once, in every way it can: the verdict is always right.

An interrupted call or a short transfer changes nothing. An error is exit 4 (3 for the scene, or a run) and one sentence.
The output name holds the old file or the complete new one, and nothing else is left, whatever happens;
a killed process, and one that says so, may leave its scratch folder, which the next bake takes over or speaks of.
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


def ways(kind):
    """(what the call says, whether all later ones say so, too) for a kind of call."""
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
            for action, stays in ways(kind)]


def is_scratch(path, folder):
    return re.match(rf"{re.escape(str(folder))}/({bakes.OF_SCRATCH})(/.*)?( \(deleted\))?$", path) is not None


def codes_of_call(fault, path, folder):
    """The exit codes that one failed call of a file allows."""
    if fault.action == "short" or (fault.action == INTERRUPTED and fault.kind != "fsync"):
        return {0}
    if fault.kind == "close" and (bakes.is_input(path) or path in [str(folder), str(folder / bakes.SHARED_SCRATCH)]):
        return {0}  # what was only read loses nothing when it is closed
    if fault.kind == "unlink" or (fault.kind == "close" and is_scratch(path, folder)):
        return {0, 4}  # the file is no longer needed
    # A disk that does not answer may do so later, whatever is on it: farms try 4 again, and never 3.
    return {3} if bakes.is_input(path) and fault.action != str(errno.EIO) else {4}


def expected_codes(fault, paths, folder):
    """The first call that is fatal decides."""
    if fault.action == "exit":
        return {137}
    codes = [codes_of_call(fault, path, folder) for path in paths]
    return next((c for c in codes if c != {0}), {0})


def is_clean_up(fault, outcome, folder):
    """The last sync of all is that of the emptied scratch folder; the output is complete by then."""
    return (fault.kind == "fsync" and fault.action != "exit" and outcome.counts["fsync"] == fault.at and
            outcome.counts["rename"] == 1 and all(is_scratch(path, folder) for _, _, path in outcome.fired))


def allowed_states(fault, outcome):
    """The new file is there after its rename, and only then."""
    if fault.action == "exit":
        return {"old", "new"}
    renamed = outcome.counts.get("rename", 0) > (fault.kind == "rename")
    return {"new"} if outcome.code == 0 or renamed else {"old"}


def complaints_about_the_next(kitchen, folder):
    """After a kill: the next bake finishes, or says what it found and obeys --restart."""
    command = kitchen.bake.command()
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode == 2 and re.search(bakes.OF_SCRATCH, done.stderr) and not bakes.sentences(done.stderr):
        done = subprocess.run([*command, "--restart"], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        return [f"the next bake: exit {done.returncode}, {done.stderr!r}"]
    left = bakes.leftovers(folder, bakes.LEFT_BY_KILL) + bakes.scratch_left(folder)
    return left + ([] if kitchen.state(folder) == "new" else [f"the next bake gave {kitchen.state(folder)}"])


def complaints_about(kitchen, folder, fault, outcome):
    if not outcome.fired:  # threads and timing may save a call, but then all is well
        saved = outcome.code == 0 and outcome.counts[fault.kind] < fault.at
        return [] if saved and kitchen.state(folder) == "new" else ["the fault did not fire"]
    found = []
    codes, states = expected_codes(fault, [f[2] for f in outcome.fired], folder), allowed_states(fault, outcome)
    if is_clean_up(fault, outcome, folder):
        codes = {0}
    if outcome.code not in codes:
        found.append(f"exit {outcome.code}, expected {sorted(codes)}; {outcome.stderr!r}")
    elif outcome.code in (3, 4):
        found += bakes.sentences(outcome.stderr)
    if kitchen.state(folder) not in states:
        found.append(f"the output is {kitchen.state(folder)}, expected {sorted(states)}")
    killed = fault.action == "exit"
    kept = outcome.code == 4 and "--resume" in outcome.stderr
    cleaned = outcome.counts.get("mkdir", 0) > 0  # that its files are gone is synced, once, whatever failed
    if fault.kind == "fsync" and not killed and outcome.counts["fsync"] > fault.at + cleaned:
        found.append("something was synced after an fsync that failed")
    may_stay = bakes.LEFT_BY_KILL if killed or fault.kind == "unlink" else [bakes.OF_SCRATCH] * kept
    found += bakes.leftovers(folder, may_stay)
    return found + (complaints_about_the_next(kitchen, folder) if killed or kept else [])


def run_one(kitchen, fault):
    folder = kitchen.table()
    outcome = shim.run(bakes.SHIM, kitchen.bake.command(), folder, fault)
    found = complaints_about(kitchen, folder, fault, outcome)
    shutil.rmtree(folder)
    way = fault.action if not fault.action.isdigit() else errno.errorcode[int(fault.action)]
    path = pathlib.Path(outcome.fired[0][2]).name if outcome.fired else "nothing"
    return (f"{kitchen.bake.name}{', no O_TMPFILE' * fault.no_tmpfile}: {fault.kind} {fault.at} of {path} "
            f"{way}{' from then on' * fault.stays}"), found, bool(outcome.fired)


def run_all(report, kitchen, no_tmpfile, pool):
    folder = kitchen.table()
    counted = shim.run(bakes.SHIM, kitchen.bake.command(), folder, Fault(no_tmpfile=no_tmpfile))
    # The calls that no bake does without: if they are not seen, the shim is blind.
    blind = [k for k in ("open", "read", "write", "fsync", "close", "rename") if counted.counts.get(k, 0) == 0]
    report.judge(f"{kitchen.bake.name}: calls are seen", [f"no {k}" for k in blind])
    fired = 0
    planned = faults(counted.counts, no_tmpfile)
    for name, complaints, did_fire in pool.map(lambda fault: run_one(kitchen, fault), planned):
        report.judge(name, complaints)
        fired += did_fire
    missed = [f"only {fired} of {len(planned)}"] * (fired < 0.9 * len(planned))
    report.judge(f"{kitchen.bake.name}: faults fire", missed)
    calls = ", ".join(f"{n} {kind}" for kind, n in counted.counts.items() if n > 0)
    print(f"{kitchen.bake.name}{', no O_TMPFILE' * no_tmpfile}: {calls}; {fired} faults")


def main():
    report = bakes.Report()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for bake in bakes.SMALL_LONG if bakes.LONG else bakes.SMALL:
            with bakes.Kitchen(bake) as kitchen:
                run_all(report, kitchen, False, pool)
                if bake is bakes.SMALL[0] or bakes.LONG:
                    run_all(report, kitchen, True, pool)
    report.finish()


if __name__ == "__main__":
    main()
