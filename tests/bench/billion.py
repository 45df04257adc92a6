#!/usr/bin/env python3
"""`make bench-billion`: bakes a scan of a billion triangles at 64K³ with 4 GiB, on a small disk.

The dry run's prediction is compared with the bake, the progress line's remaining time with the time that really remained; a
second bake is killed twice and resumed to the same bytes; 100,000 bricks are judged. The figures are written to
build/bench/billion.json and between the markers in docs/results/performance.md. 60 GB of disk must be free; an hour or two.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import time

from bakes import Bakes, label
from bench import OUT, PAGE, ROOT, fill
from bench_tables import table
from out_of_core import MARGIN, bytes_of, run_watched

RESULTS = OUT / "billion.json"
SCENE, LOG2, MEMORY = "scan 1G", 16, "4G"
BRICKS = 100_000
SHARDS = 16
GB = 1e9
LEFT = re.compile(rb" ([\d:]+)  about ([\d:]+) left")
OBSERVED = 0.1, 0.9  # shares of the time in which the remaining time is compared
STEPS = ["predict", "bake", "judge", "kill", "farm"]


def seconds_of(clock):
    total = 0
    for part in clock.split(b":"):
        total = 60 * total + int(part)
    return total


class Disk:
    """The fullest that a file system became, over its state at the start."""

    def __init__(self, folder):
        self.folder, self.most = folder, 0
        self.before = shutil.disk_usage(folder).used

    def poll(self):
        self.most = max(self.most, shutil.disk_usage(self.folder).used - self.before)


class Bench:
    def __init__(self, programs, memory):
        self.bakes = Bakes(programs, OUT)
        self.programs, self.memory = programs, memory
        self.scene = self.bakes.scene(SCENE)
        self.dag, self.report = self.bakes.dag_file(), OUT / "report.json"

    def command(self, *options):
        return [self.programs / "svdag", "build", self.scene, "-r", label(LOG2), "-o", self.dag, "-m", self.memory, *options]

    def predict(self):
        return json.loads(subprocess.run(self.command("--dry-run", "--json"), check=True, capture_output=True).stdout)

    def bake(self):
        """The figures of one bake, and what the progress line said: (elapsed, remaining) in seconds."""
        disk, lines = Disk(OUT), []

        def watch(program):
            while text := program.stderr.read1(1 << 16):
                lines.extend((seconds_of(a), seconds_of(b)) for a, b in LEFT.findall(text))
                disk.poll()

        _, cpu, peak, usage = self.watched(self.command("--restart", "--progress", "--report", self.report), watch,
                                           stderr=subprocess.PIPE, stdout=subprocess.DEVNULL)
        report = json.loads(self.report.read_text())
        scratch = report["scratch"]
        return {"seconds": report["seconds"], "cpu": cpu, "triangles": report["triangles"],
                "own": max(peak.own, 1024 * usage.ru_maxrss - peak.of_files),
                "scratch": scratch, "file": report["file_bytes"], "scene": self.scene.stat().st_size,
                "disk": disk.most + self.scene.stat().st_size, "read": (peak.read - scratch["read"]) / self.scene.stat().st_size,
                "hash": report["content_hash"], "progress": lines}

    def watched(self, command, watch=None, **streams):
        """(seconds, CPU seconds, Peak, rusage) of a command that must succeed."""
        begin = time.monotonic()
        code, peak, usage = run_watched(command, watch, **streams)
        if code != 0:
            sys.exit(f"{command[0].name} {command[1]} failed with exit code {code}")
        return time.monotonic() - begin, usage.ru_utime + usage.ru_stime, peak, usage

    def step(self, *words):
        """(seconds, CPU seconds, bytes read) of a command of svdag."""
        seconds, cpu, peak, _ = self.watched([self.programs / "svdag", *words, "-q"])
        return seconds, cpu, peak.read

    def farm(self):
        """What a plan of SHARDS shards, each of its steps, and the last merge take."""
        plan = OUT / "bench.plan"
        shutil.rmtree(plan, ignore_errors=True)
        planning = self.step("plan", self.scene, "-r", label(LOG2), "-m", self.memory, "-o", plan, "--shards", str(SHARDS))
        written = json.loads((plan / "plan.json").read_text())
        steps = {step["name"]: self.step("run", plan, "--step", step["name"], "--keep") for step in written["steps"]}
        stored = [(plan / step["output"]).stat().st_size for step in written["steps"]]
        info = subprocess.run([self.programs / "svdag", "info", "--json", plan / written["steps"][-1]["output"]], check=True,
                              capture_output=True).stdout
        shutil.rmtree(plan)
        return {"planning": planning, "steps": steps, "stored": stored, "hash": json.loads(info)["content_hash"]}

    def judge(self):
        out = subprocess.run([self.programs / "svdag-verify", "mesh", "--sample", str(BRICKS), self.dag, self.scene, "--json"],
                             capture_output=True).stdout
        return json.loads(out)

    def bake_killed(self, seconds):
        """The content hash of a bake that is killed after a third of `seconds`, and again after another."""
        start = "--restart"
        for _ in range(2):
            program = subprocess.Popen(self.command(start, "-q"))
            time.sleep(seconds / 3)
            assert program.poll() is None, "the bake ended before it was killed"
            program.kill()
            program.wait()
            start = "--resume"
        begin = time.monotonic()
        subprocess.run(self.command("--resume", "-q", "--report", self.report), check=True)
        report = json.loads(self.report.read_text())
        assert report["resumed"]
        return {"hash": report["content_hash"], "last": time.monotonic() - begin}


def worst_remaining(bake):
    """The largest error of the remaining time, as a share of the time that remained."""
    total = bake["seconds"]["total"]
    inside = [(t, left) for t, left in bake["progress"] if OBSERVED[0] * total <= t <= OBSERVED[1] * total]
    return max(abs(left / (total - t) - 1) for t, left in inside)


def rows(results):
    if "bake" not in results:
        return []
    bake, dry = results["bake"], results.get("prediction")
    seconds, limit = bake["seconds"], bytes_of(MEMORY) + MARGIN
    disk = bake["scratch"]["peak"] + bake["file"]
    out = [["wall, s", "2,700", f"{seconds['total']:,.0f}"],
           ["– bounds, split, voxelize, sort, merge, write", "",
            ", ".join(f"{seconds[phase]:,.0f}" for phase in ("bounds", "split", "voxelize", "sort", "merge", "write"))],
           ["CPU, s", "", f"{bake['cpu']:,.0f}"],
           ["peak, MiB", f"{limit >> 20:,}", f"{bake['own'] / 2**20:,.0f}"],
           ["scratch, GB (bytes a triangle)", "", f"{bake['scratch']['peak'] / GB:.1f} ({bake['scratch']['peak'] / bake['triangles']:.1f})"],
           ["output, GB", "", f"{bake['file'] / GB:.2f}"],
           ["disk in all with the scene, GB", "60", f"{bake['disk'] / GB:.1f}"],
           ["the scene was read, times", "2.2", f"{bake['read']:.2f}"]]
    if bake["progress"]:
        out.append(["largest error of the remaining time after a tenth", "25 %", f"{worst_remaining(bake):.0%}"])
    if dry is not None:
        pairs = [(dry["cpu_seconds"], bake["cpu"]), (dry["seconds"], seconds["total"]), (dry["expected_memory_bytes"], bake["own"]),
                 (dry["output_bytes"] + dry["scratch_bytes"], disk)]
        out.append(["predicted / taken: CPU, wall, memory, disk", "±30 %", ", ".join(f"{p / taken:.2f}" for p, taken in pairs)])
    if "judged" in results:
        judged = results["judged"]
        out.append([f"wrong of {judged['bricks']:,} drawn bricks", "0", f"{judged['wrong_bricks']}"])
    if "farm" in results:
        farm, scene = results["farm"], bake["scene"]
        steps = farm["steps"].values()
        reads = [step[2] for name, step in farm["steps"].items() if name.startswith("shard")]
        out += [[f"{SHARDS} shards: read / scene", "1.3", f"{sum(reads) / scene:.2f}"],
                ["– the most that a shard reads, stores, GB", "", f"{max(reads) / GB:.2f}, {max(farm['stored'][:-1]) / GB:.2f}"],
                ["– planning, all steps, the last merge, CPU s", "",
                 f"{farm['planning'][1]:,.0f}, {sum(s[1] for s in steps):,.0f}, {list(steps)[-1][1]:,.0f}"],
                ["– CPU of all / one bake", "1.15", f"{(farm['planning'][1] + sum(s[1] for s in steps)) / bake['cpu']:.2f}"],
                ["– bytes", "same", "same" if farm["hash"] == bake["hash"] else "**other**"]]
    if "killed" in results:
        out.append(["killed twice and resumed", "same bytes", "same" if results["killed"]["hash"] == bake["hash"] else "**other**"])
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--steps", nargs="*", choices=STEPS, default=STEPS, help="the others keep their results")
    parser.add_argument("--json-only", action="store_true", help="do not change docs/")
    options = parser.parse_args()
    bench = Bench(options.programs.resolve(), MEMORY)
    results = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    steps = {"predict": ("prediction", bench.predict), "bake": ("bake", bench.bake), "judge": ("judged", bench.judge),
             "kill": ("killed", lambda: bench.bake_killed(results["bake"]["seconds"]["total"])),
             "farm": ("farm", bench.farm)}
    for step in options.steps:
        name, run = steps[step]
        results[name] = run()
        RESULTS.write_text(json.dumps(results, indent=1))
        print(step, {key: value for key, value in results[name].items() if key != "progress"}, flush=True)
    text = table(["figure", "at most", "now"], rows(results))
    print(text)
    if not options.json_only:
        fill(PAGE, {"billion": text})


if __name__ == "__main__":
    main()
