"""make fuzz-long: 10^8 executions of every fuzzer, in pieces that a night can be made of.

A piece is five minutes of one fuzzer on one core; its executions are added to build/fuzz/long/NAME.json
when it has ended well, so the run can be stopped at any time and continues with the next call, from the
corpus it had. What was counted belongs to the bytes of one program: another build begins at nothing.

A corpus grows towards long inputs, which take time and seldom reach more. So three pieces of four take inputs that
are no longer than half of the seeds are, and choose among them without a count of how rare their features are, which
takes the longer the larger a corpus is.

With --seconds each fuzzer runs so long instead, whatever was counted: the short run of make stress.

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
KEPT = BUILD / "long"
PIECE_SECONDS = 300
LIMITS = ["-rss_limit_mb=2048", "-timeout=20"]
LEAST_LENGTH = 512  # bytes that every piece allows


class Fuzzer:
    def __init__(self, name):
        self.name = name
        self.program = BUILD / "tests" / (name + "_fuzz")
        self.corpus = BUILD / "corpus" / (name + "_fuzz")
        self.corpus.mkdir(parents=True, exist_ok=True)
        self.seeds = SOURCE / "tests" / "fuzz" / "corpus" / (name + "_fuzz")
        self.pieces = 0
        digest = hashlib.sha256(self.program.read_bytes()).hexdigest()
        self.kept = {"program": digest, "executions": 0, "seconds": 0, "edges": 0}
        path = KEPT / (name + ".json")
        if path.exists():
            kept = json.loads(path.read_text())
            if kept["program"] == digest:
                self.kept = kept

    def inputs(self):
        """Options of the next piece for the length of its inputs: none (up to the longest seed's), or shorter."""
        self.pieces += 1
        if self.pieces % 4 == 1:
            return []
        sizes = sorted(seed.stat().st_size for seed in self.seeds.iterdir())
        half = sizes[len(sizes) // 2]
        return [f"-max_len={max(LEAST_LENGTH, 1 << (half - 1).bit_length())}", "-entropic=0"]

    def piece(self, executions, seconds):
        """Runs one piece. Returns what it found: "" or its last lines."""
        words = SOURCE / "tests" / "fuzz" / (self.name + "_fuzz.dict")
        command = [self.program, self.corpus, self.seeds, *LIMITS, *self.inputs(),
                   f"-artifact_prefix={KEPT}/{self.name}-", f"-runs={executions}", f"-max_total_time={seconds}",
                   "-print_final_stats=1"]
        if words.exists():
            command.append(f"-dict={words}")
        began = time.monotonic()
        run = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        text = run.stderr.decode(errors="replace")
        done = re.search(r"^stat::number_of_executed_units: (\d+)", text, re.MULTILINE)
        if run.returncode != 0 or not done:
            return "\n".join(text.splitlines()[-40:]) or f"exit code {run.returncode}"
        self.kept["executions"] += int(done.group(1))
        self.kept["seconds"] += round(time.monotonic() - began)
        self.kept["edges"] = int(re.findall(r" cov: (\d+) ", text)[-1])
        self.keep()
        return ""

    def keep(self):
        path = KEPT / (self.name + ".json")
        path.with_suffix(".new").write_text(json.dumps(self.kept) + "\n")
        os.replace(path.with_suffix(".new"), path)


def run_on(fuzzer, executions, until):
    """Piece after piece, until there are so many executions or something is found."""
    while fuzzer.kept["executions"] < executions and time.monotonic() < until:
        seconds = int(min(PIECE_SECONDS, until - time.monotonic())) + 1
        finding = fuzzer.piece(executions - fuzzer.kept["executions"], seconds)
        if finding:
            return finding
    return ""


def run_all(waiting, jobs, run):
    """Every core takes the next fuzzer. Returns (name, finding) of those that found."""
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
            except Exception:  # a full disk, say: nothing was found out, and the others go on
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
    parser.add_argument("--executions", type=int, default=10**8, help="of each fuzzer (10^8)")
    parser.add_argument("--seconds", type=int, help="run each fuzzer so long instead")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="fuzzers at a time (a core each)")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="stop after so many")
    parser.add_argument("fuzzers", nargs="*", metavar="FUZZER", help="their names (all)")
    arguments = parser.parse_args()
    KEPT.mkdir(parents=True, exist_ok=True)
    built = sorted(path.name[:-5] for path in (BUILD / "tests").glob("*_fuzz"))
    fuzzers = [Fuzzer(name) for name in arguments.fuzzers or built]
    until = time.monotonic() + 60 * arguments.minutes

    def run(fuzzer):
        if arguments.seconds:
            return fuzzer.piece(-1, arguments.seconds)  # any number of executions
        return run_on(fuzzer, arguments.executions, until)

    found = run_all(list(fuzzers), arguments.jobs, run)
    print(f"{'fuzzer':15} {'executions':>12} {'per second':>11} {'edges':>6}")
    for fuzzer in fuzzers:
        kept = fuzzer.kept
        print(f"{fuzzer.name:15} {kept['executions']:12,} {kept['executions'] // max(1, kept['seconds']):11,} "
              f"{kept['edges']:6}" + ("" if kept["executions"] >= arguments.executions else "  not all yet"))
    for name, finding in found:
        print(f"\n{name} found:\n{finding}")
    print(f"{len(found)} findings")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
