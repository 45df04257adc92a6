#!/usr/bin/env python3
"""coverage.py [--seconds N] [TARGET ...]: measures the line coverage of each reader by its fuzzer.

Builds the preset `coverage` (the fuzzers with clang's source-based coverage), runs each for N seconds from its seeds
(default 60), and prints the covered lines of the fuzzed files. Functions that were never entered (writers, code for a
second file) are named instead of counted.
"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BUILD = ROOT / "build" / "coverage"
TEXT = ["io/values/text_scan.cpp", "io/values/decimal.h", "io/scene/polygons/triangulate.cpp"]
GLTF = [f"io/scene/gltf/gltf{part}.cpp" for part in ("", "_buffers", "_document", "_elements", "_json", "_kept", "_nodes", "_transform", "_uri")]
READERS = {
    "ply": ["io/scene/readers/ply.cpp", "io/values/ply_header.cpp", "io/values/ply_values.h", "io/scene/readers/ply_faces.h"],
    "stl": ["io/scene/readers/stl.cpp"],
    "obj": ["io/scene/readers/obj.cpp", "io/scene/readers/obj_plain.h", *TEXT],
    "off": ["io/scene/readers/off.cpp"],
    "gltf": GLTF,
    "draco": ["io/scene/decoders/draco.cpp"],
    "openmesh": ["io/scene/readers/openmesh.cpp"],
    "svdag": ["io/dag/check.cpp"],
    "plain_file": ["verify/trace/program/plain_file.cpp"],
    "report": ["verify/report/report_html.cpp"],
    "run": ["builder/run/run_file.cpp", "builder/run/run_check.cpp", "builder/run/run_format.cpp"],
    "journal": ["streaming/spill/journal.cpp", "streaming/spill/record.h", "builder/bake/saved_bake.cpp", "builder/split/bin_record.cpp"],
    "pack": ["builder/cache/cell_pack.cpp", "builder/cache/cell_pack_file.cpp"],
    "plan": ["builder/farm/plan/plan.cpp", "builder/farm/plan/plan_index.cpp", "builder/farm/plan/receipt.cpp"],
    "command_line": [f"builder/commands/{kind}_options.cpp" for kind in ("build", "farm", "info", "shared")],
    "batch": ["builder/commands/batch.cpp"],
    "trace_options": ["verify/trace/program/trace_options.cpp"],
    "words": ["io/units.cpp", "io/suggest.cpp"],
    "hashdag": ["io/formats/dags/hashdag.cpp"],
    "symvox": ["io/formats/dags/symvox.cpp", "io/dag/symvox_header.cpp"],
    "transform_dag": ["io/formats/dags/transform_dag.cpp"],
    "npz": ["io/formats/voxels/npz.cpp", "io/formats/voxels/zip.cpp"],
    "binvox": ["io/formats/voxels/binvox.cpp"],
    "vox": ["io/formats/voxels/vox_read.cpp"],
    "points": [f"io/formats/points/{name}.cpp" for name in ("las", "pcd", "ply_cloud", "point_grid", "xyz")],
    "vdb": ["io/formats/vdb/vdb_child.cpp", "io/formats/vdb/vdb_read.cpp", "io/formats/sent_cubes.cpp"],
}


def build(targets):
    for command in (["cmake", "--preset", "coverage", "--log-level=WARNING"],
                    ["cmake", "--build", "--preset", "coverage", "--target", *[f"{t}_fuzz" for t in targets]]):
        subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.DEVNULL,
                       env={**os.environ, "CCACHE_DISABLE": "1"})  # cached objects have the file names of other builds


def run(binary, target, seconds, profile):
    """Fuzzes, then runs the whole corpus once; returns the number of executions."""
    corpus, seeds = BUILD / "corpus" / target, ROOT / "tests" / "fuzz" / "corpus" / f"{target}_fuzz"
    dictionary = ROOT / "tests" / "fuzz" / f"{target}_fuzz.dict"
    corpus.mkdir(parents=True, exist_ok=True)
    options = [f"-dict={dictionary}"] if dictionary.exists() else []
    environment = {**os.environ, "LLVM_PROFILE_FILE": str(profile)}
    executions = 0
    for limit in ([f"-max_total_time={seconds}"] if seconds else []), ["-runs=0"]:
        if not limit:
            continue
        done = subprocess.run(["nice", "-n", "15", binary, corpus, seeds, *limit, *options, "-rss_limit_mb=2048", "-timeout=20",
                               "-print_final_stats=1", f"-artifact_prefix={BUILD}/"],
                              env=environment, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{target}: a finding\n{done.stderr[-4000:]}")
        for line in done.stderr.splitlines():
            if line.startswith("stat::number_of_executed_units:"):
                executions += int(line.split()[-1])
    return executions


def lines(binary, profile, files):
    """{file: (covered lines, lines, names of functions never entered)}; only lines of entered functions are counted,
    since the writer of a format is in the same file as its reader."""
    merged = profile.with_suffix(".profdata")
    llvm = lambda tool: shutil.which(tool) or shutil.which(f"{tool}-14") or sys.exit(f"{tool} is missing: install llvm")
    subprocess.run([llvm("llvm-profdata"), "merge", "-sparse", profile, "-o", merged], check=True)
    report = subprocess.run([llvm("llvm-cov"), "report", "-show-functions", binary, f"-instr-profile={merged}",
                             *[str(ROOT / f) for f in files]], check=True, capture_output=True, text=True).stdout
    found, file = {}, None
    for row in report.splitlines():
        words = row.split()
        if row.startswith("File '"):
            file = found[str(pathlib.Path(row[6:-2]).relative_to(ROOT))] = [0, 0, set()]
        elif len(words) >= 7 and words[0] not in ("Name", "TOTAL"):
            count, missed = int(words[4]), int(words[5])
            if missed == count:
                file[2].add(words[0].rpartition(":")[2])
            else:
                file[0] += count - missed
                file[1] += count
    return found


def readable(names):
    text = subprocess.run(["c++filt", *sorted(names)], capture_output=True, text=True).stdout if names else ""
    short = {line.partition("(anonymous namespace)::")[2] or line for line in text.splitlines()}
    return ", ".join(sorted({name.replace("svdag::", "").partition("(")[0] for name in short if "lambda" not in name}))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--binaries", type=pathlib.Path, help="folder of built fuzzers")
    parser.add_argument("targets", nargs="*", metavar="TARGET")
    arguments = parser.parse_args()
    targets = arguments.targets or list(READERS)
    BUILD.mkdir(parents=True, exist_ok=True)
    if not arguments.binaries:
        build(targets)
    print("| fuzzer | executions | file | lines covered | of | % | functions never entered |\n|---|---|---|---|---|---|---|")
    for target in targets:
        binary = (arguments.binaries or BUILD / "tests").resolve() / f"{target}_fuzz"
        profile = BUILD / f"{target}.profraw"
        executions = run(binary, target, arguments.seconds, profile)
        for file, (reached, count, never) in lines(binary, profile, READERS[target]).items():
            share = 100 * reached / max(1, count)
            print(f"| {target} | {executions:,} | `{file}` | {reached} | {count} | {share:.1f} | {readable(never)} |", flush=True)


if __name__ == "__main__":
    main()
