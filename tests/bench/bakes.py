"""Scenes and bakes of `make bench`, each made once per run and cached."""
import json
import os
import pathlib
import subprocess

# Arguments of svdag-scene.
GENERATED = {"atrium": ["atrium"], "scan": ["scan"], "sheet": ["sheet"],
             "scan 70K": ["scan", "-n", "70K"], "scan 9M": ["scan", "-n", "9M"],
             "scan 100M": ["scan", "-n", "100M"], "scan 100M, shuffled": ["scan", "-n", "100M", "--shuffle"],
             "scan 1G": ["scan", "-n", "1G"], "speck": ["speck", "-n", "100M"],
             "hairball": ["hairball", "-n", "2880K"],
             "city": ["city", "-n", "120K"],
             "city, 0.5 rad": ["city", "-n", "120K", "--yaw", "28.6478897565412"]}
# Files in the folder SVDAG_SCENES.
SHARED = {"sponza": "crytek_sponza.glb", "dragon": "stanford_dragon.ply"}
PHASES = ["bounds", "split", "voxelize", "sort", "merge", "write"]
SHORT = 1.0  # seconds; shorter bakes are repeated, and the minimum is used
REPEATS = 3


def label(log2):
    """9: "512", 16: "64K"."""
    return f"{1 << log2}" if log2 < 10 else f"{1 << (log2 - 10)}K" if log2 < 20 else f"{1 << (log2 - 20)}M"


class Bakes:
    """Bakes with the programs of one folder; resolutions are `coarser` doublings lower than requested."""

    def __init__(self, programs, folder, coarser=0):
        self.programs, self.folder, self.coarser = programs, folder, coarser
        self.cached = {}
        folder.mkdir(parents=True, exist_ok=True)

    def scene(self, name):
        """The path of a scene, generated if needed; None if it is a missing shared scene."""
        if name in SHARED:
            path = pathlib.Path(os.environ.get("SVDAG_SCENES", ""), SHARED[name])
            return path if "SVDAG_SCENES" in os.environ and path.exists() else None
        path = self.generated_file(name)
        if not path.exists():
            subprocess.run([self.programs / "svdag-scene", *GENERATED[name], "-q", "-o", path], check=True)
        return path

    def generated_file(self, name):
        return self.folder / ("_".join(a.strip("-") for a in GENERATED[name]) + ".ply")

    def log2(self, log2):
        return max(3, log2 - self.coarser)

    def report(self, name, log2, *options):
        """The report of one bake, whose output is dag_file()."""
        report = self.folder / "report.json"
        subprocess.run([self.programs / "svdag", "build", self.scene(name), "-r", label(self.log2(log2)),
                        "-o", self.dag_file(), "-q", "--report", report, *options], check=True)
        return json.loads(report.read_text())

    def dag_file(self):
        return self.folder / "bench.svdag"

    def bake(self, name, log2, *options):
        """A row of bakes.csv, measured once; None if the scene is missing."""
        key = (name, self.log2(log2), options)
        if self.scene(name) is None:
            return None
        if key not in self.cached:
            reports = [self.report(name, log2, *options)]
            while len(reports) < REPEATS and reports[0]["seconds"]["total"] < SHORT:
                reports.append(self.report(name, log2, *options))
            fastest = min(reports, key=lambda report: report["seconds"]["total"])
            row = row_of(name, self.log2(log2), options, fastest)
            row["s_cpu"] = min(report["seconds"]["cpu"] for report in reports)
            self.cached[key] = row
            print(f"{name:>13} {row['resolution']:>4} {row['nodes']:>12,} nodes {row['s_total']:8.2f} s "
                  f"{row['peak_mib']:7.0f} MiB  {' '.join(options)}", flush=True)
        return self.cached[key]

    def info(self):
        """The output of `svdag info --json` for the last bake."""
        return json.loads(subprocess.run([self.programs / "svdag", "info", "--json", self.dag_file()], check=True,
                                         capture_output=True).stdout)

    def rows(self):
        return list(self.cached.values())


def row_of(name, log2, options, report):
    seconds, memo = report["seconds"], report["plane_memo"]
    return {"scene": name, "log2": log2, "resolution": label(log2), "options": " ".join(options),
            "vectors": report["vectors"], "lanes": report["lanes"], "threads": report["threads"],
            "triangles": report["triangles"], "voxels": report["voxels"], "nodes": sum(report["nodes"]),
            "bytes": report["file_bytes"], "bits_per_voxel": report["bits_per_voxel"],
            **{f"s_{phase}": seconds[phase] for phase in PHASES}, "s_total": seconds["total"],
            "s_cpu": seconds["cpu"], **{f"memo_{key}": value for key, value in memo.items()},
            "divided_16": report["cubes_divided"][log2 - 4], "peak_mib": report["memory"]["peak_resident"] / 2**20}
