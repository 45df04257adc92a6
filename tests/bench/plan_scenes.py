"""The generated scenes for the calibration of plans: flat, curved, dense, thin and instanced surfaces.

Most are made by svdag-scene. Two are composed of instances, as scenes of artists are, which svdag-scene does not make.
"""
import subprocess

import numpy

from bakes import GENERATED

# Arguments of svdag-scene.
OWN = {"atrium 1M": ["atrium", "-n", "1M", "--seed", "5"], "terrain": ["terrain"],
       "terrain 60K": ["terrain", "-n", "60K", "--yaw", "20"], "scan 300K": ["scan", "-n", "300K", "--seed", "7"],
       "hairball 200K": ["hairball", "-n", "200K"]}
SINGLE = {**OWN, **{name: GENERATED[name] for name in ("atrium", "city", "city, 0.5 rad", "scan", "scan 70K", "sheet")}}
COMPOSED = ("forest", "tiles")
CALIBRATION = [("atrium", 12), ("atrium", 14), ("atrium 1M", 12), ("city", 12), ("city", 14), ("city, 0.5 rad", 12),
               ("city, 0.5 rad", 14), ("sheet", 15), ("terrain", 13), ("terrain 60K", 12), ("terrain 60K", 14),
               ("scan", 12), ("scan 70K", 12), ("scan 70K", 14), ("scan 300K", 13), ("hairball 200K", 12),
               ("hairball 200K", 13), ("forest", 12), ("forest", 14), ("tiles", 12), ("tiles", 14)]
NAMES = {name for name, _ in CALIBRATION}

FACE = numpy.dtype([("count", "u1"), ("corners", "<i4", 3)])


def generate(programs, arguments, path):
    if not path.exists():
        subprocess.run([programs / "svdag-scene", *arguments, "-q", "-o", path], check=True)
    return path


def read(path):
    """(vertices, faces) of a PLY file of svdag-scene."""
    data = path.read_bytes()
    begin = data.index(b"end_header\n") + len("end_header\n")
    counts = {line.split()[1]: int(line.split()[2]) for line in data[:begin].decode().splitlines()
              if line.startswith("element")}
    vertices = numpy.frombuffer(data, "<f4", 3 * counts["vertex"], begin).reshape(-1, 3)
    faces = numpy.frombuffer(data, FACE, counts["face"], begin + vertices.nbytes)
    return vertices.astype(float), faces["corners"]


def write(path, vertices, faces):
    rows = numpy.empty(len(faces), FACE)
    rows["count"], rows["corners"] = 3, faces
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}",
             *(f"property float {axis}" for axis in "xyz"), f"element face {len(faces)}",
             "property list uchar int vertex_indices", "end_header\n"]
    path.write_bytes("\n".join(lines).encode() + vertices.astype("<f4").tobytes() + rows.tobytes())


def copies(mesh, transforms):
    """A copy of `mesh` for each (matrix, shift) of `transforms`."""
    vertices, faces = mesh
    return (numpy.concatenate([vertices @ matrix.T + shift for matrix, shift in transforms]),
            numpy.concatenate([faces + i * len(vertices) for i in range(len(transforms))]))


def turn(angle):
    c, s = numpy.cos(angle), numpy.sin(angle)
    return numpy.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def forest(programs, folder):
    """Three hundred rotated bushes of thin triangles on a terrain."""
    ground = read(generate(programs, OWN["terrain 60K"], folder / "terrain_ground.ply"))
    bush, faces = read(generate(programs, ["hairball", "-n", "3K"], folder / "hairball_n_3K.ply"))
    low, high = bush.min(0), bush.max(0)
    size = 0.04 * (ground[0].max(0) - ground[0].min(0)).max()
    random = numpy.random.default_rng(1)
    transforms = [(turn(random.uniform(0, 6.28)) * size * random.choice([1, 1, 0.8]),
               ground[0][random.integers(len(ground[0]))]) for _ in range(300)]
    bushes = copies(((bush - (low + high) / 2) / (high - low).max(), faces), transforms)
    return (numpy.concatenate([ground[0], bushes[0]]), numpy.concatenate([ground[1], bushes[1] + len(ground[0])]))


def tiles(programs, folder):
    """Five times five copies of a small city."""
    city = read(generate(programs, ["city", "-n", "20K", "--seed", "4"], folder / "city_block.ply"))
    step = 1.05 * (city[0].max(0) - city[0].min(0))
    return copies(city, [(numpy.eye(3), step * (x, 0, z)) for x in range(5) for z in range(5)])


def scene(name, programs, folder):
    """The path of the scene, generated if it does not exist."""
    if name in SINGLE:
        return generate(programs, SINGLE[name], folder / ("_".join(a.strip("-") for a in SINGLE[name]) + ".ply"))
    path = folder / f"{name}.ply"
    if not path.exists():
        write(path, *{"forest": forest, "tiles": tiles}[name](programs, folder))
    return path
