#!/usr/bin/env python3
"""`make bench-layers`: what layers and frames cost in bytes and time; the tables of docs/results/performance.md, "Layers"."""
import argparse
import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile

import numpy

from bench import PAGE, fill
from bench_tables import table

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FRAMES = 100


class Layers:
    def __init__(self, programs, folder):
        self.programs, self.folder = programs, pathlib.Path(folder)

    def run(self, program, *words):
        """(output, CPU seconds)."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([self.programs / program, *map(str, words)], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{program} {words}: {done.stderr}")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def objects(self, name, scene, resolution):
        """A row: bytes and CPU of the union alone and with a layer for each object, and what pictures cost; best of 3."""
        union, layered = self.folder / "union.svdag", self.folder / "layers.svdag"
        seconds = {"union": [], "layers": [], "plain": [], "colour": [], "open": []}
        for _ in range(3):
            seconds["union"].append(self.run("svdag", "build", scene, "-o", union, "-r", resolution, "-q")[1])
            seconds["layers"].append(self.run("svdag", "build", scene, "-o", layered, "-r", resolution, "-q", "--layers", "object")[1])
            picture = ["render", layered, "-o", self.folder / "a.png", "-q", "-j", "1", "--preset", "inside", "--size"]
            seconds["open"].append(self.run("svdag-verify", *picture, "8x8", "--mode", "colour")[1])
            for mode, key in (("primary", "plain"), ("colour", "colour")):
                seconds[key].append(self.run("svdag-verify", *picture, "1280x720", "--mode", mode)[1])
        best = {key: min(values) for key, values in seconds.items()}
        count = json.loads(self.run("svdag", "info", layered, "--json")[0])["layers"]["count"]
        a, b = union.stat().st_size, layered.stat().st_size
        return [name, f"{resolution}³", f"{count:,}", f"{a / 1e6:.2f}", f"{b / 1e6:.2f}", f"{b / a:.3f}", f"{best['layers'] / best['union']:.2f}",
                f"{best['open']:.2f}", f"{(best['plain'] - best['open']) / (best['colour'] - best['open']):.2f}"]

    def frames(self, what, write):
        """A row: bytes of one file with a layer for each frame that write(folder) writes, beside a file for each."""
        pieces = self.folder / what.replace(" ", "-")
        pieces.mkdir()
        write(pieces)
        files, both, one = sorted(pieces.glob("f_*")), self.folder / "frames.svdag", self.folder / "one.svdag"
        seconds = self.run("svdag", "build", *files, "-o", both, "-r", "2K", "-q", "--layers", "file", "--no-union")[1]
        grid = json.loads(self.run("svdag", "info", both, "--json")[0])["grid"]
        cube = ",".join(repr(v) for v in [*grid["corner"], 2048 * grid["voxel_size"]])
        total = cpu = 0
        for file in files:
            cpu += self.run("svdag", "build", file, "-o", one, "-r", "2K", "-q", f"--cube={cube}")[1]
            total += one.stat().st_size
        size = both.stat().st_size
        shutil.rmtree(pieces)
        return [what, str(FRAMES), f"{total / 1e6:.1f}", f"{size / 1e6:.1f}", f"{size / total:.3f}", f"{seconds / cpu:.2f}"]


    def scan(self, *words):
        return lambda folder: self.run("svdag-scene", "scan", "-n", "100K", "--frames", FRAMES, *words, "-q", "-o", folder / "f.ply")


def swaying(scene, tenth):
    """Writes the frames of an OFF mesh that sways as the scans of svdag-scene do (tests/scenes/moving.cpp)."""
    lines = scene.read_text().split("\n", 2)
    vertices, faces, _ = map(int, lines[1].split())
    values = lines[2].split()
    points = numpy.array(values[:3 * vertices], float).reshape(-1, 3)
    rest = numpy.array(values[3 * vertices:3 * vertices + 4 * faces]).reshape(-1, 4)
    end = "\n".join(" ".join(face) for face in rest) + "\n"
    y = points[:, 1]
    extent = numpy.abs(y).max()
    above = (y - numpy.quantile(y, 0.9)) / extent
    share = numpy.where(above > 0, above / (above + 1 / 32), 0) if tenth else 1

    def write(folder):
        for frame in range(FRAMES):
            angle = 2 * numpy.pi * (frame / FRAMES + y / (4 * extent))
            moved = points.copy()
            moved[:, 0] += extent / 16 * share * numpy.sin(angle)
            moved[:, 2] += extent / 16 * share * numpy.cos(angle)
            with open(folder / f"f_{frame:04d}.off", "w") as file:
                file.write(f"OFF\n{vertices} {faces} 0\n")
                numpy.savetxt(file, moved, "%.17g")
                file.write(end)

    return write


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--only", choices=["layers", "frames"], help="only this table")
    options = parser.parse_args()
    if "SVDAG_SCENES" not in os.environ:
        sys.exit("SVDAG_SCENES is not set: there are no scenes to measure")
    tables, scenes = {}, pathlib.Path(os.environ["SVDAG_SCENES"])
    with tempfile.TemporaryDirectory(prefix="svdag-layers-") as folder:
        layers = Layers(options.programs.resolve(), folder)
        if options.only != "frames":
            city = pathlib.Path(folder, "city.obj")
            layers.run("svdag-scene", "city", "-n", "120K", "-q", "-o", city)
            rows = [layers.objects("sponza", scenes / "crytek_sponza.glb", r) for r in ("4K", "16K", "64K")]
            tables["layers"] = table(["scene", "grid", "layers", "only the union, MB", "with layers, MB", "ratio", "CPU of the bake, ratio",
                                      "opened, s", "rays per second, ratio"], [*rows, layers.objects("city", city, "4K")])
        if options.only != "layers":
            elephant = scenes / "cgal_refined_elephant.off"
            rows = [layers.frames("all of a scan moves", layers.scan()), layers.frames("a tenth of the scan moves", layers.scan("--tenth")),
                    layers.frames("all of an elephant moves", swaying(elephant, False)),
                    layers.frames("a tenth of the elephant moves", swaying(elephant, True))]
            tables["frames"] = table(["scene", "frames", "a file each, MB", "one file, MB", "ratio", "CPU, ratio"], rows)
    fill(PAGE, tables)


if __name__ == "__main__":
    sys.exit(main())
