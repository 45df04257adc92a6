#!/usr/bin/env python3
"""Golden command-line tests, as data (the idea of zstd's cli-tests).

A test is a shell script NAME.sh in this folder. It runs under `sh -e` in an empty folder with the
built programs on PATH. Files of the same name hold the expected results:

    NAME.exit                        the exit code; 0 if the file is missing
    NAME.stdout, NAME.stderr         the exact output; empty if the file is missing
    NAME.stdout.glob, .stderr.glob   a shell pattern per line; a line "..." matches any number of lines

--update records the current exit codes and exact outputs; it never changes a .glob file.
"""
import argparse
import difflib
import fnmatch
import os
import pathlib
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

HERE = pathlib.Path(__file__).resolve().parent
TIMEOUT = 300


def matches(patterns, lines):
    """Whether `lines` match `patterns`; "..." matches any number of lines."""
    if not patterns:
        return not lines
    if patterns[0] == "...":
        return any(matches(patterns[1:], lines[i:]) for i in range(len(lines) + 1))
    return bool(lines) and fnmatch.fnmatchcase(lines[0], patterns[0]) and matches(patterns[1:], lines[1:])


def run_script(script, programs):
    environment = {k: v for k, v in os.environ.items() if k != "COLUMNS"}  # without it, help is wrapped at 80 columns
    environment |= dict(PATH=f"{programs}:/usr/bin:/bin", LC_ALL="C", TESTS=str(HERE))
    with tempfile.TemporaryDirectory(prefix="svdag-cli-") as folder:
        try:
            done = subprocess.run(["sh", "-e", script], cwd=folder, env=environment, timeout=TIMEOUT,
                                  stdin=subprocess.DEVNULL, capture_output=True)
        except subprocess.TimeoutExpired:
            return 124, "", f"timed out after {TIMEOUT} s\n"
    return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")


def differences(script, code, outputs):
    """Messages about all differences of one run from the expected results."""
    found = [] if code != 127 else ["a program is missing"]
    exit_file = script.with_suffix(".exit")
    expected = int(exit_file.read_text()) if exit_file.exists() else 0
    if code != expected:
        found.append(f"exit code {code}, expected {expected}")
    for stream, text in outputs.items():
        golden, glob = script.with_suffix(f".{stream}"), script.with_suffix(f".{stream}.glob")
        if glob.exists():
            if not matches(glob.read_text().splitlines(), text.splitlines()):
                found.append(f"{stream} does not match {glob.name}:\n{text}")
            continue
        expected_text = golden.read_text() if golden.exists() else ""
        if text != expected_text:
            found += ["\n".join(difflib.unified_diff(expected_text.splitlines(), text.splitlines(),
                                                          f"expected {stream}", stream, lineterm=""))
                           or f"{stream} differs in its last newline"]
    return found


def update(script, code, outputs):
    exit_file = script.with_suffix(".exit")
    exit_file.unlink(missing_ok=True)
    if code != 0:
        exit_file.write_text(f"{code}\n")
    for stream, text in outputs.items():
        golden = script.with_suffix(f".{stream}")
        if script.with_suffix(f".{stream}.glob").exists():
            continue
        golden.unlink(missing_ok=True)
        if text:
            golden.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", required=True, type=pathlib.Path, help="folder of the built programs")
    parser.add_argument("--update", action="store_true", help="record the current exit codes and outputs")
    parser.add_argument("names", nargs="*", help="only these tests (default: all)")
    options = parser.parse_args()
    programs = options.programs.resolve()
    scripts = [s for s in sorted(HERE.glob("*.sh")) if not options.names or s.stem in options.names]
    if not scripts:
        sys.exit("no test has one of these names")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = list(pool.map(lambda script: run_script(script, programs), scripts))
    failed = 0
    for script, (code, out, err) in zip(scripts, runs):
        outputs = {"stdout": out, "stderr": err}
        if options.update and code != 127:
            update(script, code, outputs)
        found = differences(script, code, outputs)
        failed += bool(found)
        if found:
            print(f"FAILED {script.stem}\n" + "\n".join(found) + "\n")
    print(f"{len(scripts) - failed} passed, {failed} failed, 0 skipped")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
