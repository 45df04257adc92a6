#!/usr/bin/env python3
"""Builds the programs, runs the tests tier by tier, and prints the seconds of each tier and one total.

`make test` runs the tests of the release build. `make test-sanitized` (--sanitized) runs those that instrument programs:
the unit tests under ASan and UBSan, the release build under Valgrind and against a build without optimisation.

Tests are ctest entries with the label of their tier. Their counts are read from GoogleTest's JSON and from the
summary lines of the Python tests; a program that ends without counts is one failure. SVDAG_SCENES names the folder of
shared real scenes; it is a failure if the folder does not exist.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import time
import xml.etree.ElementTree as xml

ROOT = pathlib.Path(__file__).resolve().parent.parent
# (preset, [(name of the tier, label)])
RELEASE = [("release", [("unit", "unit"), ("command line", "cli"), ("numerical stress", "stress"), ("shared scenes", "shared"),
                        ("faults", "fault")])]
SANITIZED = [("asan-ubsan", [("sanitizers", "unit")]), ("release", [("Valgrind and -O0", "dynamic")])]


class Counts:
    def __init__(self, passed=0, failed=0, skipped=0):
        self.passed, self.failed, self.skipped = passed, failed, skipped

    def __add__(self, other):
        return Counts(self.passed + other.passed, self.failed + other.failed, self.skipped + other.skipped)

    def __str__(self):
        return f"{self.passed} passed, {self.failed} failed, {self.skipped} skipped"


def counts_of_gtest(path):
    report = json.loads(path.read_text())
    tests = [test for suite in report["testsuites"] for test in suite["testsuite"]]
    skipped = sum(test["result"] == "SKIPPED" for test in tests)
    failed = sum("failures" in test for test in tests)
    return Counts(len(tests) - skipped - failed, failed, skipped)


def counts_of_text(text):
    """The counts of a summary line, of this project's scripts or of unittest; zeros without one."""
    found = re.findall(r"^(\d+) passed, (\d+) failed, (\d+) skipped$", text, re.M)
    if found:
        return Counts(*map(int, found[-1]))
    ran = re.search(r"^Ran (\d+) tests? in", text, re.M)
    if not ran:
        return Counts()
    bad = sum(int(n) for n in re.findall(r"(?:failures|errors)=(\d+)", text))
    skipped = sum(int(n) for n in re.findall(r"skipped=(\d+)", text))
    return Counts(int(ran.group(1)) - bad - skipped, bad, skipped)


def is_skipped(case):
    """Whether the program returned SKIP_RETURN_CODE: it cannot run here."""
    skipped = case.find("skipped")
    return skipped is not None and skipped.get("message", "").startswith("SKIP_RETURN_CODE")


def counts_of_case(case, results):
    if is_skipped(case):
        return Counts(skipped=1)
    gtest = results / f"{case.get('name')}.json"
    counts = counts_of_gtest(gtest) if gtest.exists() else counts_of_text(case.findtext("system-out") or "")
    passed = case.get("status") == "run"
    if passed and str(counts) == str(Counts()):
        return Counts(passed=1)
    return counts if passed or counts.failed else counts + Counts(failed=1)


def print_failure(case):
    """Prints the output of a failed test, without the lines about passed ones."""
    print(f"--- {case.get('name')} failed:")
    for line in (case.findtext("system-out") or "").splitlines():
        if not re.match(r"\[( RUN |       OK |  SKIPPED |-----)|.*: Skipped$|SVDAG_SCENES is not set$|$", line):
            print(line)


def stream(command, pattern, environment):
    """Runs a command and prints its progress: `pattern` matches (done, total) in a line of its output, a line is printed
    at every tenth of the way. Returns its exit code and output."""
    start, tenths, output = time.monotonic(), 0, []
    with subprocess.Popen(command, cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True) as process:
        for line in process.stdout:
            output.append(line)
            step = re.match(pattern, line)
            if step and int(step[2]) >= 10 and 10 * int(step[1]) // int(step[2]) > tenths:
                tenths = 10 * int(step[1]) // int(step[2])
                print(f"  {step[1]} of {step[2]}, {time.monotonic() - start:.0f} s", flush=True)
    return process.returncode, "".join(output)


def build(preset, environment):
    start = time.monotonic()
    for command in (["cmake", "--preset", preset, "--log-level=WARNING"], ["cmake", "--build", "--preset", preset]):
        code, output = stream(command, r"\[(\d+)/(\d+)\]", environment)
        if code != 0:
            sys.exit(f"{output}\nthe build of {preset} failed")
    return time.monotonic() - start


def run(preset, label, environment):
    """Runs the tests of one label: (counts, seconds)."""
    folder = ROOT / "build" / preset
    results = folder / "results" / label
    subprocess.run(["rm", "-rf", results])
    results.mkdir(parents=True)
    start = time.monotonic()
    stream(["ctest", "--test-dir", folder, "-L", f"^{label}$", "-j", str(os.cpu_count()), "--output-junit",
            results / "ctest.xml", "--test-output-size-passed", "1000000", "--test-output-size-failed", "1000000"],
           r"\s*(\d+)/(\d+) Test ", dict(environment, GTEST_OUTPUT=f"json:{results}/"))
    seconds = time.monotonic() - start
    cases = list(xml.parse(results / "ctest.xml").getroot().iter("testcase"))
    if not cases:
        print(f"--- no test of {preset} is labelled {label}")
    counts = Counts(failed=int(not cases))
    for case in cases:
        counts += counts_of_case(case, results)
        if is_skipped(case):
            print(f"--- {case.get('name')} cannot run here")
        elif case.get("status") != "run":
            print_failure(case)
    return counts, seconds


def print_tier(tier, seconds, counts=""):
    print(f"{tier:<17} {seconds:6.0f} s  {counts}", flush=True)


def main():
    environment = dict(os.environ)
    scenes = environment.get("SVDAG_SCENES")
    if scenes is not None and not os.path.isdir(scenes):
        print(f"SVDAG_SCENES: {scenes} is not a folder: unset it or set it to the folder of the shared scenes")
        print("0 passed, 1 failed, 0 skipped")
        return 1
    sanitized = sys.argv[1:] == ["--sanitized"]
    if sanitized:
        environment.pop("SVDAG_SCENES", None)  # real scenes are too slow under ASan
    total = Counts()
    for preset, tiers in SANITIZED if sanitized else RELEASE:
        print(f"building {preset}", flush=True)
        print_tier(f"build {preset}", build(preset, environment))
        for tier, label in tiers:
            print(f"running {tier}", flush=True)
            counts, seconds = run(preset, label, environment)
            print_tier(tier, seconds, counts)
            total += counts
    if scenes is None and not sanitized:
        print("SVDAG_SCENES is not set: tests of real scenes were skipped")
    print(total)
    return total.failed > 0


if __name__ == "__main__":
    sys.exit(main())
