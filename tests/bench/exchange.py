#!/usr/bin/env python3
"""`make bench-exchange`: surfaces, points and distances, each on one processor; its table. POINTS=1000000000 needs 30 GB of disk.

Crytek Sponza (SVDAG_SCENES) as quads and distances; points of a terrain in strips, as an aircraft scans them.
"""
import argparse
import json
import os
import pathlib
import struct
import subprocess
import tempfile

import numpy as np

SCENE = "crytek_sponza.glb"
STRIP = 1 << 20  # points written at once


class Run:
    """A program on one processor: its seconds of CPU, peak memory in MiB and report."""

    def __init__(self, *words, stdin=None):
        process = subprocess.Popen(["taskset", "-c", "0", *map(str, words)], stdout=subprocess.PIPE, stdin=stdin)
        self.out = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        assert status == 0, words
        self.cpu, self.peak = usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def write_terrain(path, count):
    """A LAS of `count` points over 16K x 16K voxels of side 1, in steps of 0.01; a strip goes along y."""
    random = np.random.default_rng(1)
    header = bytearray(375)
    header[:4], header[24:26] = b"LASF", b"\1\4"
    struct.pack_into("<HI", header, 94, 375, 375)
    struct.pack_into("<BH", header, 104, 0, 20)
    struct.pack_into("<6d", header, 131, 0.01, 0.01, 0.01, 0, 0, 0)
    struct.pack_into("<Q", header, 247, count)
    with path.open("wb") as file:
        file.write(header)
        strips = -(-count // STRIP)
        for strip in range(strips):
            n = min(STRIP, count - strip * STRIP)
            x = (strip + random.random(n)) / strips * 16384
            y = np.sort(random.random(n)) * 16384
            z = 800 + 500 * np.sin(x / 1500) * np.cos(y / 2100) + 30 * np.sin(x / 60) + random.normal(0, 0.3, n)
            records = np.zeros(n, [("at", "<i4", 3), ("rest", "u1", 8)])
            records["at"] = np.stack([x, y, z], 1) * 100
            records.tofile(file)


def rows(programs, folder, points):
    run = lambda name, *words, **more: Run(programs / name, *words, **more)
    sponza = folder / "sponza.svdag"
    scene = pathlib.Path(os.environ["SVDAG_SCENES"]) / SCENE
    Run(programs / "svdag", "build", scene, "-r", "16K", "-o", sponza, "-q")
    surface = run("svdag-export", sponza, "--level", 12, "-o", folder / "s.stl", "--max-quads", "1G", "--json")
    counts = json.loads(surface.out)
    yield "surface of Sponza 4K³, million faces of voxels a second", counts["faces"] / surface.cpu / 1e6, surface.peak
    (folder / "s.stl").unlink()
    dense = run("svdag-export", sponza, "--level", 9, "--distance", 16, "-o", folder / "d.npz", "--json")
    yield "distances up to 16, million a second", json.loads(dense.out)["distances"] / dense.cpu / 1e6, dense.peak
    box = "--bounds=-2,0,-2,2,1,2"
    Run(programs / "svdag-export", sponza, box, "-o", folder / "near.npz", "-q")
    with np.load(folder / "near.npz") as part:
        random = np.random.default_rng(1)
        offsets = random.normal(size=(1_000_000, 3))
        offsets *= 8 * random.random((len(offsets), 1)) / np.linalg.norm(offsets, axis=1, keepdims=True)
        chosen = part["coordinates"][random.integers(0, len(part["coordinates"]), len(offsets))]
        np.savetxt(folder / "near.txt", part["corner"] + (chosen + 0.5 + offsets) * part["voxel_size"])
    with (folder / "near.txt").open() as text:
        near = run("svdag", "query", sponza, "--nearest", stdin=text)
    yield "`query --nearest` within 8 voxels of Sponza 16K³, million points a second", 1 / near.cpu, near.peak
    las = folder / "terrain.las"
    write_terrain(las, points)
    cloud = run("svdag-import", las, "-s", "1", "-m", "1G", "-o", folder / "cloud.svdag", "--scratch", folder, "--json")
    report = json.loads(cloud.out)
    yield f"{points / 1e6:,.0f} M points at 16K³ within 1 GiB, {report['voxels'] / 1e6:,.0f} M voxels, CPU seconds", cloud.cpu, cloud.peak


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--programs", type=pathlib.Path, required=True)
    parser.add_argument("--points", type=int, default=100_000_000)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="exchange-", dir=options.programs) as folder:
        print("| what | figure | peak memory, MiB |\n|---|--:|--:|", flush=True)
        for what, figure, peak in rows(options.programs, pathlib.Path(folder), options.points):
            print(f"| {what} | {figure:.1f} | {peak:.0f} |", flush=True)


if __name__ == "__main__":
    main()
