"""make fuzz-long: 10^8 executions of every fuzzer, in sessions that can be interrupted.

A session is five minutes of one fuzzer on one core. When it succeeds, its executions are added to
build/fuzz/long/NAME.json, so the run can be stopped at any time and continues with the next call, from the same corpus.
The counts belong to the hash of a program: another build begins at zero.

A corpus grows towards long inputs, which are slow and seldom reach new code. So three sessions of four limit the
length of inputs to the median length of the seeds, and choose inputs uniformly: libFuzzer's entropic schedule slows
down as the corpus grows.

With --seconds each fuzzer runs for that time instead, whatever its count: the short run of make stress.

Usage: long_run.py [--executions N | --seconds N] [--jobs N] [--minutes N] [FUZZER...]"""
import argparse
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import threading
import time
import traceback

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = SOURCE / "build" / "fuzz"
RESULTS = BUILD / "long"
SESSION_SECONDS = 300
LIMITS = ["-rss_limit_mb=2048", "-timeout=20"]
MIN_LENGTH = 512  # bytes: the minimum of -max_len


class Fuzzer:
    def __init__(self, name):
        self.name = name
        self.program = BUILD / "tests" / (name + "_fuzz")
        self.corpus = BUILD / "corpus" / (name + "_fuzz")
        self.corpus.mkdir(parents=True, exist_ok=True)
        self.seeds = SOURCE / "tests" / "fuzz" / "corpus" / (name + "_fuzz")
        self.sessions = 0
        digest = hashlib.sha256(self.program.read_bytes()).hexdigest()
        self.results = {"program": digest, "executions": 0, "seconds": 0, "edges": 0}
        path = RESULTS / (name + ".json")
        if path.exists():
            results = json.loads(path.read_text())
            if results["program"] == digest:
                self.results = results

    def inputs(self):
        """Options that limit the inputs of the next session; every fourth has no limit but the longest seed."""
        self.sessions += 1
        if self.sessions % 4 == 1:
            return []
        sizes = sorted(seed.stat().st_size for seed in self.seeds.iterdir())
        median = sizes[len(sizes) // 2]
        return [f"-max_len={max(MIN_LENGTH, 1 << (median - 1).bit_length())}", "-entropic=0"]

    def session(self, executions, seconds):
        """Runs one session. Returns "" or the last lines of a finding."""
        words = SOURCE / "tests" / "fuzz" / (self.name + "_fuzz.dict")
        command = [self.program, self.corpus, self.seeds, *LIMITS, *self.inputs(),
                   f"-artifact_prefix={RESULTS}/{self.name}-", f"-runs={executions}", f"-max_total_time={seconds}",
                   "-print_final_stats=1"]
        if words.exists():
            command.append(f"-dict={words}")
        began = time.monotonic()
        run = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        text = run.stderr.decode(errors="replace")
        done = re.search(r"^stat::number_of_executed_units: (\d+)", text, re.MULTILINE)
        if run.returncode != 0 or not done:
            return "\n".join(text.splitlines()[-40:]) or f"exit code {run.returncode}"
        self.results["executions"] += int(done.group(1))
        self.results["seconds"] += round(time.monotonic() - began)
        self.results["edges"] = int(re.findall(r" cov: (\d+) ", text)[-1])
        self.save()
        return ""

    def save(self):
        path = RESULTS / (self.name + ".json")
        path.with_suffix(".new").write_text(json.dumps(self.results) + "\n")
        os.replace(path.with_suffix(".new"), path)


def run_on(fuzzer, executions, until):
    """Runs sessions until the number of executions, the time limit or a finding."""
    while fuzzer.results["executions"] < executions and time.monotonic() < until:
        seconds = int(min(SESSION_SECONDS, until - time.monotonic())) + 1
        finding = fuzzer.session(executions - fuzzer.results["executions"], seconds)
        if finding:
            return finding
    return ""


def run_all(waiting, jobs, run):
    """Runs the waiting fuzzers on `jobs` threads. Returns [(name, finding)]."""
    found = []
    lock = threading.Lock()

    def work():
        while True:
            with lock:
                if not waiting:
                    return
                fuzzer = waiting.pop(0)
            try:
                finding = run(fuzzer)
            except Exception:  # for example a full disk: reported, and the others continue
                finding = traceback.format_exc()
            if finding:
                found.append((fuzzer.name, finding))

    threads = [threading.Thread(target=work) for _ in range(jobs)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--executions", type=int, default=10**8, help="executions of each fuzzer (default: 10^8)")
    parser.add_argument("--seconds", type=int, help="run each fuzzer for this time instead")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="fuzzers at once (default: one per core)")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="stop after this time")
    parser.add_argument("fuzzers", nargs="*", metavar="FUZZER", help="names (default: all)")
    arguments = parser.parse_args()
    RESULTS.mkdir(parents=True, exist_ok=True)
    built = sorted(path.name[:-5] for path in (BUILD / "tests").glob("*_fuzz"))
    fuzzers = [Fuzzer(name) for name in arguments.fuzzers or built]
    until = time.monotonic() + 60 * arguments.minutes

    def run(fuzzer):
        if arguments.seconds:
            return fuzzer.session(-1, arguments.seconds)  # any number of executions
        return run_on(fuzzer, arguments.executions, until)

    found = run_all(list(fuzzers), arguments.jobs, run)
    print(f"{'fuzzer':15} {'executions':>12} {'per second':>11} {'edges':>6}")
    for fuzzer in fuzzers:
        results = fuzzer.results
        print(f"{fuzzer.name:15} {results['executions']:12,} {results['executions'] // max(1, results['seconds']):11,} "
              f"{results['edges']:6}" + ("" if results["executions"] >= arguments.executions else "  unfinished"))
    for name, finding in found:
        print(f"\n{name} found:\n{finding}")
    print(f"{len(found)} findings")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
