#!/usr/bin/env python3
"""`make bench-plan`: compares the predictions of plans with measurements.

Each row bakes a scene as a whole and by a plan of 16 shards. The constants of builder/farm/planner/predict.cpp are
fitted to generated scenes only: --calibrate measures these and prints the constants. The shared scenes test them. The
tables are written between the markers in docs/results/farm.md; rows that are not measured again are kept in
build/bench/plan.json.
"""
import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys

import plan_fit
from bakes import GENERATED, label
from bench import OUT, RESULTS, ROOT, fill
from bench_tables import table

PAGE = RESULTS / "farm.md"
KNOWN = OUT / "plan.json"
SHARDS = 16
# Arguments of svdag-scene: flat, curved, dense and thin surfaces.
SCENES = {"atrium 1M": ["atrium", "-n", "1M", "--seed", "5"], "terrain": ["terrain"],
          "terrain 60K": ["terrain", "-n", "60K", "--yaw", "20"], "scan 300K": ["scan", "-n", "300K", "--seed", "7"],
          "hairball 200K": ["hairball", "-n", "200K"], "scan 5M": ["scan", "-n", "5M"], "scan 20M": ["scan", "-n", "20M"],
          **{name: GENERATED[name] for name in ("atrium", "city", "city, 0.5 rad", "scan", "scan 70K", "sheet")}}
CALIBRATION = [("atrium", 12), ("atrium", 14), ("atrium 1M", 12), ("city", 12), ("city", 14), ("city, 0.5 rad", 12),
               ("city, 0.5 rad", 14), ("sheet", 15), ("terrain", 13), ("terrain 60K", 12), ("terrain 60K", 14),
               ("scan", 12), ("scan 70K", 12), ("scan 70K", 14), ("scan 300K", 13), ("scan 5M", 12), ("scan 5M", 13),
               ("scan 20M", 13), ("hairball 200K", 12), ("hairball 200K", 13)]
SPILLED = ("scan 20M", 13, ("8G", "256M"))  # in memory and not
SHARED_FILES = ["crytek_sponza.glb", "lyon_city_epsg3946.glb", "samurai_monastery.obj", "stanford_dragon.ply",
                "stk_black_forest.glb", "openfoam_motorbike.obj", "openfoam_buildings.stl"]
SHARED_ROWS = [(name, log2) for name in SHARED_FILES for log2 in (12, 14)]
WORST, MEDIAN = 3, 0.3  # the targets


class Bench:
    def __init__(self, programs):
        self.programs = programs
        self.svdag = programs / "svdag"
        OUT.mkdir(parents=True, exist_ok=True)

    def scene(self, name):
        if name in SCENES:
            path = OUT / ("_".join(word.strip("-") for word in SCENES[name]) + ".ply")
            if not path.exists():
                subprocess.run([self.programs / "svdag-scene", *SCENES[name], "-q", "-o", path], check=True)
            return path
        path = pathlib.Path(os.environ.get("SVDAG_SCENES", ""), name)
        return path if "SVDAG_SCENES" in os.environ and path.exists() else None

    def row(self, name, log2, shards):
        """Measures one bake, one plan and its steps; None if the scene is missing."""
        scene = self.scene(name)
        if scene is None:
            return None
        report, dag, plan = OUT / "report.json", OUT / "bench.svdag", OUT / "bench.plan"
        subprocess.run([self.svdag, "build", scene, "-r", label(log2), "-o", dag, "-q", "--report", report], check=True)
        shutil.rmtree(plan, ignore_errors=True)
        usage = os.times().children_user + os.times().children_system
        subprocess.run([self.svdag, "plan", scene, "-r", label(log2), "-o", plan, "--shards", str(shards), "-j", "1", "-q"],
                       check=True)
        planning = os.times().children_user + os.times().children_system - usage
        subprocess.run([self.svdag, "run", plan, "-j", "2", "-q", "--keep"], check=True)
        written = json.loads((plan / "plan.json").read_text())
        same = dag.read_bytes() == (plan / written["steps"][-1]["output"]).read_bytes()
        steps = [dict(name=step["name"], predicted=step["predicted"], inputs=step.get("inputs", []),
                      triangles=step.get("triangles", 0), keys=self.keys(plan / step["output"]),
                      measured=json.loads((plan / "runs" / f"{step['name']}.json").read_text()))
                 for step in written["steps"]]
        shutil.rmtree(plan)
        dag.unlink()
        return {"scene": name, "log2": log2, "shards": shards, "report": json.loads(report.read_text()), "same": same,
                "one_bake": written["one_bake"]["cpu_seconds"], "voxelize": written["one_bake"]["voxelize_seconds"],
                "planning": planning, "steps": steps}

    def spilling(self):
        """Prints the constants of a scene that does not fit in memory, from the best of three bakes of each kind."""
        name, log2, memories = SPILLED
        scene, report = self.scene(name), OUT / "report.json"
        cpu, alone = {}, []
        for memory in memories * 3:
            subprocess.run([self.svdag, "build", scene, "-r", label(log2), "-o", OUT / "bench.svdag", "-m", memory, "-q",
                            "--report", report], check=True)
            written = json.loads(report.read_text())
            seconds = written["seconds"]
            cpu[memory] = min(cpu.get(memory, seconds["cpu"]), seconds["cpu"])
            alone.append((seconds["bounds"] + seconds["split"]) / written["triangles"])
        nanoseconds = 1e9 * (cpu[memories[1]] - cpu[memories[0]]) / written["triangles"]
        print(f"constexpr double kSpilled = {nanoseconds:.4g}e-9;\nconstexpr double kReadAlone = {1e9 * min(alone):.4g}e-9;")

    def keys(self, path):
        """The number of unique nodes and bricks in a .run or .svdag."""
        info = json.loads(subprocess.run([self.svdag, "info", "--json", path], check=True, capture_output=True).stdout)
        return sum(info["nodes"])

    def predict_again(self, row):
        """Plans the row again and replaces its predictions, for new constants; these hardly change the shards, so the
        measurements remain valid."""
        plan = OUT / "bench.plan"
        shutil.rmtree(plan, ignore_errors=True)
        subprocess.run([self.svdag, "plan", self.scene(row["scene"]), "-r", label(row["log2"]), "-o", plan, "--shards",
                        str(row["shards"]), "-q"], check=True)
        written = json.loads((plan / "plan.json").read_text())
        shutil.rmtree(plan)
        row["one_bake"], row["voxelize"] = written["one_bake"]["cpu_seconds"], written["one_bake"]["voxelize_seconds"]
        for old, new in zip(row["steps"], written["steps"], strict=True):
            old["predicted"] = new["predicted"]


def ratios(row, what, measured, kind=""):
    return [s["predicted"][what] / s["measured"][measured] for s in row["steps"] if s["name"].startswith(kind)]


def total(row, field, kind=""):
    return sum(s["measured"][field] for s in row["steps"] if s["name"].startswith(kind))


def finest_shared(rows):
    """The rows of the highest resolution of each shared scene."""
    highest = {}
    for r in rows:
        highest[r["scene"]] = max(r["log2"], highest.get(r["scene"], 0))
    return [r for r in rows if r["log2"] == highest[r["scene"]] and r["scene"] not in SCENES]


def farm_table(rows):
    lines = []
    for r in rows:
        bake = r["report"]["seconds"]["cpu"]
        farm = total(r, "cpu_seconds")
        lines.append([r["scene"], label(r["log2"]), str(r["shards"]), f"{bake:.2f}", f"{r['one_bake']:.2f}",
                      f"{r['planning']:.2f}", f"{farm:.2f}", f"{farm / bake:.2f}",
                      f"{max(s['measured']['cpu_seconds'] for s in r['steps']):.2f}",
                      f"{max(s['measured']['memory_bytes'] for s in r['steps']) / 2**20:.0f}",
                      f"{max(s['predicted']['memory_bytes'] for s in r['steps']) / 2**20:.0f}"])
    return table(["scene", "grid", "shards", "one bake, CPU s", "predicted", "planning, CPU s", "all steps, CPU s", "/ one bake",
                  "longest step", "peak MiB of a step", "planned"], lines)


def error_row(rows, what):
    """A table row: median error and worst factor of a list of ratios."""
    errors = [abs(1 - r) for r in rows]
    worst = max(max(r, 1 / r) for r in rows)
    verdict = "yes" if statistics.median(errors) <= MEDIAN and worst <= WORST else "**no**"
    return [what, str(len(rows)), f"{statistics.median(errors):.0%}", f"{worst:.2f}", verdict]


def error_table(rows):
    lines = []
    for kind, own in (("generated", [r for r in rows if r["scene"] in SCENES]),
                      ("shared", [r for r in rows if r["scene"] not in SCENES])):
        if not own:
            continue
        lines.append(error_row([r["one_bake"] / r["report"]["seconds"]["cpu"] for r in own], f"{kind}: CPU of one bake"))
        lines.append(error_row([sum(s["predicted"]["cpu_seconds"] for s in r["steps"]) / total(r, "cpu_seconds")
                             for r in own], f"{kind}: CPU of a plan"))
        for step, title in (("shard", "CPU of a shard"), ("merge", "CPU of a merge")):
            lines.append(error_row(sum((ratios(r, "cpu_seconds", "cpu_seconds", step) for r in own), []), f"{kind}: {title}"))
        lines.append(error_row(sum((ratios(r, "output_bytes", "bytes") for r in own), []), f"{kind}: bytes that a step writes"))
        memory = sum((ratios(r, "memory_bytes", "memory_bytes") for r in own), [])
        lines.append([f"{kind}: memory, planned / peak", str(len(memory)), "–", f"least {min(memory):.2f}",
                      "yes" if min(memory) >= 1 else "**no**"])
    return table(["what", "values", "median error", "worst factor", f"≤ {MEDIAN:.0%}, ≤ {WORST}; memory ≥ 1"], lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", required=True, type=pathlib.Path)
    parser.add_argument("--only", default="", help="only scenes whose name contains this")
    parser.add_argument("--log2", type=int, help="only this resolution (14: 16K), which may be a new one")
    parser.add_argument("--shards", type=int, default=SHARDS)
    parser.add_argument("--known", action="store_true", help="measure nothing, print the stored rows")
    parser.add_argument("--predict-again", action="store_true",
                        help="measure nothing, renew predictions of the stored rows")
    parser.add_argument("--calibrate", action="store_true",
                        help="measure only the generated scenes, and print the constants")
    options = parser.parse_args()
    known = json.loads(KNOWN.read_text()) if KNOWN.exists() else {}
    bench = Bench(options.programs.resolve())
    selected = CALIBRATION + (SHARED_ROWS if not options.calibrate else [])
    if options.log2 and all(log2 != options.log2 for _, log2 in selected):
        selected = [(name, options.log2) for name in dict.fromkeys(name for name, _ in selected)]
    for name, log2 in selected if not (options.known or options.predict_again) else []:
        if options.only in name and options.log2 in (None, log2):
            row = bench.row(name, log2, options.shards)
            if row:
                known[f"{name} {log2} {options.shards}"] = row
                KNOWN.write_text(json.dumps(known))
                print(farm_table([row]).splitlines()[-1], flush=True)
    if options.predict_again:
        for row in known.values():
            bench.predict_again(row)
        KNOWN.write_text(json.dumps(known))
    rows = [known[key] for key in sorted(known, key=lambda k: (known[k]["scene"] not in SCENES, k))]
    if options.calibrate:
        plan_fit.print_constants([r for r in rows if r["scene"] in SCENES])
        if not options.known:
            bench.spilling()
        return
    contents = {"plans": farm_table(finest_shared(rows)), "predictions": error_table(rows)}
    print("\n\n".join(contents.values()))
    different = [f"{r['scene']} at {label(r['log2'])}" for r in rows if not r["same"]]
    if different:
        sys.exit(f"docs/ is not changed: the bytes of the plan differ from those of one bake for {', '.join(different)}")
    fill(PAGE, contents)


if __name__ == "__main__":
    main()
