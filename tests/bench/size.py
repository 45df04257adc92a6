#!/usr/bin/env python3
"""`make bench-size`: bytes of each layout and of packed files, and rays per second: tables of docs/results/performance.md.

The columns of other programs are recorded: SVDAG-Compression (`.ssvdag`, Villanueva et al. 2017) and the tools of
transform-aware DAGs (`tdag16`, Molenaar and Eisemann 2025), given the same voxels, exported by `svdag export`.
"""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

from bench import PAGE, fill
from bench_tables import table

RAYS = ["primary", "shadow", "soft", "ao"]
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SHARED = {"dragon": "stanford_dragon.ply", "sponza": "crytek_sponza.glb", "lyon": "lyon_city_epsg3946.glb"}
GENERATED = {"hairball 1M": ["hairball", "-n", "1M"]}
PEERS = {("dragon", "4K"): (8.95, 8.43), ("dragon", "8K"): (30.51, 25.25), ("sponza", "4K"): (5.42, 5.09),
         ("sponza", "8K"): (15.74, 14.14), ("hairball 1M", "4K"): (23.22, 21.01), ("hairball 1M", "8K"): (74.75, 67.81)}
LARGE = [(name, "16K") for name in ("sponza", "dragon", "lyon")] + [("sponza", "64K")]


class Sizes:
    def __init__(self, programs, folder):
        self.programs, self.folder = programs, pathlib.Path(folder)

    def run(self, program, *words):
        done = subprocess.run([self.programs / program, *map(str, words)], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{program} {words}: {done.stderr}")
        return done.stdout

    def scene(self, name):
        if name in SHARED:
            return pathlib.Path(os.environ["SVDAG_SCENES"], SHARED[name])
        path = self.folder / f"{name}.ply"
        if not path.exists():
            self.run("svdag-scene", *GENERATED[name], "-o", path, "-q")
        return path

    def bake(self, name, resolution):
        """Paths by layout."""
        paths = {layout: self.folder / f"{layout}.svdag" for layout in ("plain", "compact")}
        self.run("svdag", "build", self.scene(name), "-o", paths["plain"], "-r", resolution, "-q", "--restart")
        self.run("svdag", "convert", paths["plain"], "-o", paths["compact"], "--layout", "compact", "-q")
        return paths

    def packed(self, plain):
        """MB packed at the default level and at 19, and MB of plain per CPU second packed and unpacked, one thread."""
        pack, again = self.folder / "a.pack", self.folder / "again.svdag"
        self.run("svdag", "pack", plain, "-o", pack, "--level", "19", "-q")
        smallest = megabytes(pack)
        speeds = {"pack": 0, "unpack": 0}
        for _ in range(3):
            for command, source, target in (("pack", plain, pack), ("unpack", pack, again)):
                before = resource.getrusage(resource.RUSAGE_CHILDREN)
                self.run("svdag", command, source, "-o", target, "-j", "1", "-q")
                after = resource.getrusage(resource.RUSAGE_CHILDREN)
                seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
                speeds[command] = max(speeds[command], megabytes(plain) / seconds)
        if again.read_bytes() != plain.read_bytes():
            sys.exit(f"{plain}: unpacked to other bytes")
        return megabytes(pack), smallest, speeds["pack"], speeds["unpack"]

    def vdb(self, plain):
        """MB of the same voxels as an OpenVDB grid of type bool."""
        path = self.folder / "a.vdb"
        self.run("svdag", "export", plain, "-o", path, "-q")
        size = megabytes(path)
        path.unlink()
        return size

    def rays(self, paths):
        """{workload: MRays/s of each path}, taken in turns; exits if the hits differ."""
        speeds = {}
        for _ in range(3):
            results = set()
            for at, path in enumerate(paths):
                done = json.loads(self.run("svdag-trace", path, "--preset", "inside", "--size", "640x360", "--samples", "8",
                                           "--rounds", "3", "-j", "1", "--json"))
                results.add(done["results"])
                for w in done["workloads"]:
                    best = speeds.setdefault(w["workload"], [0] * len(paths))
                    best[at] = max(best[at], w["rays"] / w["seconds"] / 1e6)
            if len(results) != 1:
                sys.exit(f"{paths}: different hits")
        return speeds


def megabytes(path):
    return path.stat().st_size / 1e6


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    options = parser.parse_args()
    if "SVDAG_SCENES" not in os.environ:
        sys.exit("SVDAG_SCENES is not set: there are no scenes to measure")
    peers, large, traced = [], [], []
    with tempfile.TemporaryDirectory(prefix="svdag-size-") as folder:
        sizes = Sizes(options.programs.resolve(), folder)
        for name, resolution in [*PEERS, *LARGE]:
            paths = sizes.bake(name, resolution)
            plain, compact = megabytes(paths["plain"]), megabytes(paths["compact"])
            if (name, resolution) in PEERS:
                others = PEERS[name, resolution]
                vdb = f"{sizes.vdb(paths['plain']):.2f}" if resolution == "4K" else "–"
                peers.append([name, f"{resolution}³", f"{plain:.2f}", f"{compact:.2f}", f"{others[0]:.2f}", f"{others[1]:.2f}",
                              f"{compact / min(others):.3f}", vdb])
            else:
                packed, smallest, packs, unpacks = sizes.packed(paths["plain"])
                large.append([name, f"{resolution}³", f"{plain:.1f}", f"{compact:.1f}", f"{compact / plain:.3f}",
                              f"{packed / plain:.3f}", f"{smallest / plain:.3f}", f"{packs:.0f}", f"{unpacks:.0f}"])
            if (name, resolution) in (("sponza", "16K"), ("sponza", "64K"), ("dragon", "8K")):
                rays = sizes.rays([paths["plain"], paths["compact"]])
                traced.append([name, f"{resolution}³", *[f"{rays[kind][0]:.2f}" for kind in RAYS],
                               *[f"{rays[kind][1] / rays[kind][0]:.2f}" for kind in RAYS]])
            print(f"{name} {resolution}: {plain:.2f} {compact:.2f} MB", flush=True)
    fill(PAGE, {
        "layouts": table(["scene", "grid", "plain, MB", "compact, MB", "compact / plain", "packed / plain", "at level 19",
                          "pack, MB/s", "unpack, MB/s"], large),
        "layouts and peers": table(["scene", "grid", "plain, MB", "compact, MB", ".ssvdag, MB", "tdag16, MB",
                                    "compact / smaller of them", ".vdb, MB"], peers),
        "layouts traced": table(["scene", "grid", *RAYS, *[f"{kind}, ratio" for kind in RAYS]], traced)})


if __name__ == "__main__":
    sys.exit(main())
