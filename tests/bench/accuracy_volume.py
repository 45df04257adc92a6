"""Measures volume against resolution by `svdag build`, for the three rules: the table "Volume" of docs/results/accuracy.md.

The volume of a solid rule's voxels converges to that of the points whose winding number is not 0 (or is odd); those of
the surface rules converge to 0. `volume_voxels` of a report is the signed volume of the snapped triangles, by the
divergence theorem. Where triangles wind around points more than once, the limit is a known fraction of it.
"""
import json
import os
import pathlib
import subprocess

from bakes import label
from bench_tables import table

GRIDS = range(6, 15)  # log2
SHOWN = (6, 14)
SIDES = {"conservative": ["--rule", "conservative"], "thin": ["--rule", "thin"]}


def sphere(depth, radius, vertices, faces):
    """An octahedron, each triangle divided into 4^depth on the sphere, around a point without symmetry to a grid."""
    numbers = {}

    def vertex(p):
        if p not in numbers:
            vertices.append([c + radius * x for c, x in zip((0.1234, 0.5678, 0.9101), p)])
            numbers[p] = len(vertices)
        return numbers[p]

    def middle(p, q):
        s = [a + b for a, b in zip(p, q)]
        length = sum(x * x for x in s)**0.5
        return tuple(x / length for x in s)

    def divide(a, b, c, n):
        if n == 0:
            faces.append((vertex(a), vertex(b), vertex(c)))
            return
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)):
            divide(*t, n - 1)

    for x in (1.0, -1.0):
        for y in (1.0, -1.0):
            for z in (1.0, -1.0):
                corners = [(x, 0.0, 0.0), (0.0, y, 0.0), (0.0, 0.0, z)]
                divide(*(corners if x * y * z > 0 else corners[::-1]), depth)  # outward


def write_spheres(path, *spheres):
    vertices, faces = [], []
    for depth, radius in spheres:
        sphere(depth, radius, vertices, faces)
    with open(path, "w") as file:
        file.writelines("v %r %r %r\n" % tuple(v) for v in vertices)
        file.writelines("f %d %d %d\n" % f for f in faces)
    return path


def series(folder):
    """(name, scene, options of the solid rule, limit / signed volume) of each series; real scenes where there are any."""
    nested = write_spheres(folder / "nested.obj", (7, 1.0), (7, 0.5))
    yield "sphere, 2K triangles", write_spheres(folder / "coarse.obj", (4, 1.0)), [], 1
    yield "sphere, 131K triangles", write_spheres(folder / "fine.obj", (7, 1.0)), [], 1
    yield "sphere in a sphere", nested, [], 8 / 9
    yield "the same, odd", nested, ["--inside", "odd"], 7 / 9
    if "SVDAG_SCENES" in os.environ:
        scenes = pathlib.Path(os.environ["SVDAG_SCENES"])
        yield "CGAL elephant", scenes / "cgal_refined_elephant.off", [], 1
        yield "Thingi10K 472042", scenes / "thingi10k_472042.stl", [], 1


def bake(programs, folder, scene, log2, *options):
    report = folder / "volume.json"
    subprocess.run([programs / "svdag", "build", scene, "-r", str(2**log2), "-q", "-o", folder / "volume.svdag", "--report",
                    report, *options], check=True)
    return json.loads(report.read_text())


def measure(programs, folder):
    """A row per mesh and grid: volumes of the voxels of each rule over the limit of the solid."""
    rows = []
    for name, scene, inside, share in series(folder):
        for log2 in GRIDS:
            solid = bake(programs, folder, scene, log2, "--rule", "solid", *inside)
            limit = share * solid["volume_voxels"]
            volume = {rule: bake(programs, folder, scene, log2, *options)["voxels"] / limit for rule, options in SIDES.items()}
            volume["solid"] = solid["voxels"] / limit
            volume["corrected"] = volume["solid"] - volume["conservative"] / 2
            rows.append({"mesh": name, "log2": log2, **volume})
    (folder / "volume.svdag").unlink()
    return rows


def volume_table(rows):
    return table(["mesh", "grid", "conservative", "thin", "solid − 1", "corrected − 1"],
                 [[r["mesh"], f"{label(r['log2'])}³", f"{r['conservative']:.1e}", f"{r['thin']:.1e}", f"{r['solid'] - 1:+.1e}",
                   f"{r['corrected'] - 1:+.1e}"] for r in rows if r["log2"] in SHOWN])
