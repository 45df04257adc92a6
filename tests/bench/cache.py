#!/usr/bin/env python3
"""`make bench-cache`: measures bakes with --cache after one object of a scene has moved: the table "Cells baked before"
of docs/results/performance.md.

The ten smallest objects of Crytek Sponza (SVDAG_SCENES) are moved in turn, by half a unit of their node, on a fixed
grid. The bytes of each bake are compared with those of a bake without a cache.
"""
import argparse
import json
import os
import pathlib
import shutil
import statistics
import struct
import subprocess
import sys

from bench import OUT, PAGE, ROOT, fill, processor

BOUNDS = "--bounds=-12.5,-1,-8,12,9.5,7.5"  # the scene and a margin to move objects
MOVE = [0.5, 0.25, 0.125]


class Glb:
    def __init__(self, path):
        data = path.read_bytes()
        size = struct.unpack_from("<I", data, 12)[0]
        self.json, self.rest = json.loads(data[20:20 + size]), data[20 + size:]

    def indices(self, node):
        mesh = self.json["meshes"][node["mesh"]]
        return sum(self.json["accessors"][p["indices"]]["count"] for p in mesh["primitives"])

    def objects(self):
        """The numbers of the nodes with a mesh, by increasing size."""
        nodes = self.json["nodes"]
        return sorted((i for i, node in enumerate(nodes) if "mesh" in node), key=lambda i: self.indices(nodes[i]))

    def write_moved(self, path, number):
        moved = json.loads(json.dumps(self.json))
        moved["nodes"][number]["translation"] = MOVE
        text = json.dumps(moved).encode()
        text += b" " * (-len(text) % 4)
        body = struct.pack("<II", len(text), 0x4E4F534A) + text + self.rest
        path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(body)) + body)


def bake(options, scene, output, *more):
    report = OUT / "cache.json"
    subprocess.run([options.programs / "svdag", "build", scene, "-o", output, "-r", options.resolution, BOUNDS, "-q",
                    "--report", report, *more], check=True)
    return json.loads(report.read_text())


def row(name, full, again):
    share = again["seconds"]["cpu"] / full["seconds"]["cpu"]
    return (f"| {name} | {again['cells']:,} | {again['cache_hits']:,} | {full['seconds']['cpu']:.2f} | "
            f"{again['seconds']['cpu']:.2f} | {100 * share:.1f} % |"), share


def bake_with_cache(options, scene, name, fresh, output, folder):
    """The report of a bake with the cache. Fails if its bytes differ from those of the bake without one."""
    report = bake(options, scene, output, "--cache", folder)
    if fresh.read_bytes() != output.read_bytes():
        sys.exit(f"{name}: the bytes differ with the cache")
    return report


def measure(options, scene):
    folder = OUT / "cells"
    shutil.rmtree(folder, ignore_errors=True)
    glb, moved, fresh, output = Glb(scene), OUT / "moved.glb", OUT / "fresh.svdag", OUT / "cached.svdag"
    full = bake(options, scene, fresh)
    rows = [row(name, full, bake_with_cache(options, scene, name, fresh, output, folder))[0]
            for name in ("empty cache", "nothing moved")]
    shares = []
    for number in glb.objects()[:options.objects]:
        glb.write_moved(moved, number)
        name = f"`{glb.json['nodes'][number]['name']}` moved"
        full = bake(options, moved, fresh)
        text, share = row(name, full, bake_with_cache(options, moved, name, fresh, output, folder))
        rows.append(text)
        shares.append(share)
        print(text, flush=True)
    for path in (moved, fresh, output):
        path.unlink()
    shutil.rmtree(folder)
    return rows, statistics.median(shares)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--resolution", default="16K")
    parser.add_argument("--objects", type=int, default=10)
    parser.add_argument("--keep-page", action="store_true", help="do not change docs/")
    options = parser.parse_args()
    scene = pathlib.Path(os.environ.get("SVDAG_SCENES", ""), "crytek_sponza.glb")
    if not scene.exists():
        sys.exit("SVDAG_SCENES is not a folder with crytek_sponza.glb")
    OUT.mkdir(parents=True, exist_ok=True)
    rows, median = measure(options, scene)
    table = "\n".join(["| scene | cells | found | CPU s without | CPU s with | share |", "|---|--:|--:|--:|--:|--:|",
                       *rows[:2]])
    content = f"{processor()}, {options.resolution}³.\n\n{table}\n\nMedian of the shares after an object has moved: {100 * median:.1f} %."
    print(content)
    if not options.keep_page:
        fill(PAGE, {"cells": content})


if __name__ == "__main__":
    main()
