#!/usr/bin/env python3
"""`make bench-python`: what the Python package takes, beside trimesh and Open3D; the tables of docs/python.md.

Run by the Python of an environment with svdag, trimesh, open3d and matplotlib. SVDAG_SCENES names the shared scenes.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

import numpy as np
import svdag
from svdag import _programs

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from bench import fill  # noqa: E402
from bench_tables import table  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCENES = pathlib.Path(os.environ.get("SVDAG_SCENES") or sys.exit("SVDAG_SCENES is not set: there are no scenes to measure"))
ROUNDS = 5
PEERS = [("trimesh_fandisk.obj", 512), ("stanford_dragon.ply", 512), ("cgal_refined_elephant.off", 512)]


def seconds(work, rounds=ROUNDS):
    """The least wall and processor seconds of some rounds."""
    wall, processor = [], []
    for _ in range(rounds):
        before, used = time.perf_counter(), time.process_time()
        work()
        wall.append(time.perf_counter() - before)
        processor.append(time.process_time() - used)
    return min(wall), min(processor)


def own_bytes():
    return 1024 * int(re.search(r"RssAnon:\s+(\d+)", pathlib.Path("/proc/self/status").read_text()).group(1))


def trace_ratio(path, file):
    """Rays per second of trace() over those of svdag-trace, for the same rays."""
    size, camera = "1280x720", "-9,2,0,8,3,0.5,65"
    out = subprocess.run([_programs.program("svdag-trace"), path, "--size", size, "--camera=" + camera, "--samples", "1", "--no-beams"],
                         capture_output=True, text=True, check=True).stdout
    theirs = float(re.search(r"primary .*?([\d.]+)$", out, re.M).group(1))
    eye, target = np.array([-9, 2, 0]), np.array([8, 3, 0.5])
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, [0, 1, 0])
    right /= np.linalg.norm(right)
    slope = np.tan(np.radians(65 / 2))
    # Tiles of 8 x 8 pixels, the order in which svdag-trace traces.
    y, x = np.mgrid[0:720, 0:1280].reshape(2, 90, 8, 160, 8).swapaxes(2, 3).reshape(2, -1)
    rays = forward + ((2 * (x + .5) / 1280 - 1) * slope * 16 / 9)[:, None] * right + \
        ((1 - 2 * (y + .5) / 720) * slope)[:, None] * np.cross(right, forward)
    wall, _ = seconds(lambda: file.trace(eye, rays))
    return 1e-6 * len(rays) / wall, theirs


def figures(folder):
    random = np.random.default_rng(1)
    path = folder / "sponza.svdag"
    svdag.build_files(SCENES / "crytek_sponza.glb", path, resolution="16K")
    svdag.open(path)
    own_bytes()  # compiles its pattern
    before = own_bytes()
    file = svdag.open(path)
    opened = own_bytes() - before
    further = [svdag.open(path) for _ in range(8)]
    each = (own_bytes() - before - opened) / len(further)
    low = np.array([8192 - 128, 0, 5000])
    window = seconds(lambda: file.window(low, low + 256))
    voxels = file.coords((4000, 0, 2000), (8000, 400, 6000))
    near = voxels[random.integers(0, len(voxels), 4000000)] + random.integers(-3, 4, (4000000, 3))
    looked = seconds(lambda: file.occupied(near))
    some = near[:1000000]
    nearest = seconds(lambda: file.nearest(some))
    triangles = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]], float), np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    small = [seconds(lambda: svdag.build(*triangles, path, resolution=64), 20) for path in (None, folder / "small.svdag")]
    anywhere = random.integers(0, (16384, 6852, 10079), (4000000, 3))
    spread = seconds(lambda: file.occupied(anywhere))
    ball = seconds(lambda: file.sphere((8192, 64, 5100), 64))
    mine, theirs = trace_ratio(path, file)
    coords = random.integers(0, 1024, (10000000, 3)).astype(np.uint32)
    made = seconds(lambda: svdag.from_coords(coords, folder / "coords.svdag", resolution=1024), 3)
    surface = file.coords((0, 0, 0), (16384,) * 3, level=13)[:10000000].astype(np.uint32)
    sheet = seconds(lambda: svdag.from_coords(surface, folder / "sheet.svdag"), 3)
    return [["window of 256³", f"{1000 * window[0]:.1f} ms"],
            ["points looked up near the surface, per second and processor", f"{1e-6 * len(near) / looked[1]:.1f} M"],
            ["nearest voxels of points there", f"{1e-6 * len(some) / nearest[1]:.1f} M"],
            ["points looked up anywhere", f"{1e-6 * len(anywhere) / spread[1]:.1f} M"],
            ["voxels in a ball of 128 voxels across", f"{1000 * ball[0]:.1f} ms"],
            ["rays per second, all processors; svdag-trace", f"{mine:.2f} M; {theirs:.2f} M"],
            [f"from_coords of 10 M random voxels; {1e-6 * len(surface):.1f} M of a surface", f"{made[1]:.2f} s CPU; {sheet[1]:.2f} s CPU"],
            ["build of 4 triangles at 64³ in memory; at a path", f"{1000 * small[0][0]:.0f} ms; {1000 * small[1][0]:.0f} ms"],
            ["memory of open() beside the mapping, once; of each further file", f"{opened / 1024:.0f} KiB; {each / 1024:.0f} KiB"]]


def grid_of(voxels, origin, size, report):
    """The voxels of a peer, by integers of the grid of a file."""
    return np.unique(np.round((origin + voxels * size - report.origin) / size).astype(np.int64), axis=0)


def difference(path, theirs):
    """How many of the exact voxels a peer misses and has beside them, per million."""
    with svdag.open(path) as file:
        theirs = grid_of(*theirs, file)
        right = file.occupied(theirs).sum()
        return (f"{file.voxels:,}", f"{1e6 * (file.voxels - right) / file.voxels:,.0f}", f"{1e6 * (len(theirs) - right) / file.voxels:,.0f}")


def peers(folder):
    import open3d
    import trimesh
    rows = []
    for name, resolution in PEERS:
        mesh = trimesh.load(SCENES / name, force="mesh", process=False)
        points, faces = np.asarray(mesh.vertices, float), np.asarray(mesh.faces)
        size = float((points.max(0) - points.min(0)).max() / resolution)
        # trimesh: cells around multiples of the pitch, which is the grid of --voxel-size.
        ours = seconds(lambda: svdag.build(points, faces, folder / "a.svdag", voxel_size=size), 3)
        grid = None

        def with_trimesh():
            nonlocal grid
            grid = mesh.voxelized(size)
        theirs = seconds(with_trimesh, 1)
        indices = np.asarray(grid.points) / size
        missed = difference(folder / "a.svdag", (np.round(indices), np.full(3, -0.5 * size), size))
        rows.append([name, f"{resolution}", "trimesh voxelized", missed[0], missed[1], missed[2], f"{theirs[0]:.2f}", f"{ours[0]:.2f}"])
        soup = open3d.geometry.TriangleMesh(open3d.utility.Vector3dVector(points), open3d.utility.Vector3iVector(faces))

        def with_open3d():
            nonlocal grid
            grid = open3d.geometry.VoxelGrid.create_from_triangle_mesh(soup, size)
        theirs = seconds(with_open3d, 1)
        indices = np.array([v.grid_index for v in grid.get_voxels()])
        ours = seconds(lambda: svdag.build(points, faces, folder / "b.svdag", voxel_size=size, origin=tuple(grid.origin)), 3)
        missed = difference(folder / "b.svdag", (indices, np.asarray(grid.origin), size))
        rows.append([name, f"{resolution}", "Open3D VoxelGrid", missed[0], missed[1], missed[2], f"{theirs[0]:.2f}", f"{ours[0]:.2f}"])
    return rows


def main():
    with tempfile.TemporaryDirectory(prefix="svdag-python-") as folder:
        contents = {"python": table(["", ""], figures(pathlib.Path(folder))),
                    "peers": table(["scene", "voxels along it", "peer", "exact voxels", "missed, per million", "extra, per million",
                                    "its seconds", "svdag.build"], peers(pathlib.Path(folder)))}
    fill(ROOT / "docs" / "python.md", contents)
    print("\n".join(contents.values()))


if __name__ == "__main__":
    main()
