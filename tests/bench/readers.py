#!/usr/bin/env python3
"""Measures the scene readers: prints triangles and bytes per CPU second.

Usage: readers.py PROGRAMS (a build folder with svdag-scene and tests/bench/readers_bench). Reads the scan of
svdag-scene in four formats and, if it is set, the real scenes in the folder SVDAG_SCENES. Numbers in text files have
nine digits, as exporters write them.
"""
import os
import pathlib
import struct
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests"))
import formats_test  # noqa: E402  (the writers)

SHARED = ["stanford_dragon.ply", "openfoam_buildings.stl", "openfoam_terrain_utm.stl", "openfoam_motorbike.obj",
          "samurai_monastery.obj", "cgal_refined_elephant.off", "crytek_sponza.glb", "lyon_city_epsg3946.glb",
          "stk_black_forest.glb"]


def read_ply(path):
    """Vertices and faces of a binary PLY of triangles, as svdag-scene writes it."""
    head, body = path.read_bytes().split(b"end_header\n", 1)
    words = head.split()
    vertices, faces = (int(words[words.index(name) + 1]) for name in (b"vertex", b"face"))
    return (list(struct.iter_unpack("<3f", body[:12 * vertices])),
            [row[1:] for row in struct.iter_unpack("<B3I", body[12 * vertices:12 * vertices + 13 * faces])])


def text(values):
    return " ".join(f"{v:.9g}" for v in values)


def conversions(programs, folder):
    """The paths of the scan as PLY, STL, GLB and OBJ, written if they do not exist."""
    ply = folder / "scan.ply"
    files = [ply, *(ply.with_suffix(suffix) for suffix in (".stl", ".glb", ".obj"))]
    if not all(file.exists() for file in files):
        subprocess.run([programs / "svdag-scene", "scan", "-q", "-o", ply], check=True)
        mesh = read_ply(ply)
        formats_test.text = text
        for file, write in zip(files[1:], (formats_test.stl_binary, formats_test.glb, formats_test.obj)):
            file.write_bytes(write(*mesh))
    return files


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    folder = ROOT / "build" / "bench"
    folder.mkdir(parents=True, exist_ok=True)
    files = conversions(programs, folder)
    if "SVDAG_SCENES" in os.environ:
        files += [pathlib.Path(os.environ["SVDAG_SCENES"], name) for name in SHARED]
    subprocess.run([programs / "tests" / "bench" / "readers_bench", *files], check=True)


if __name__ == "__main__":
    main()
