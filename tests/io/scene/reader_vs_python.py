#!/usr/bin/env python3
"""Compares the triangles of the C++ readers, bit by bit, with those of independent_reader.py.

usage: reader_vs_python.py DUMP_TRIANGLES      (the program built from dump_triangles.cpp)

Odd little files are generated here; the shared scenes are taken from the folder SVDAG_SCENES.
"""
import hashlib
import os
import random
import struct
import subprocess
import sys
import tempfile

import independent_reader


def number(rng):
    """Decimal text of every length and magnitude, also subnormal or halfway between floats."""
    kind = rng.randrange(6)
    if kind == 0:
        return str(rng.randint(-99, 99))
    if kind == 1:
        return repr(rng.uniform(-1, 1) * 10.0 ** rng.randint(-30, 30))
    if kind == 2:
        return "%+.*e" % (rng.randrange(25), rng.uniform(-1, 1) * 10.0 ** rng.randint(-320, 36))
    if kind == 3:
        single = struct.unpack("<f", struct.pack("<f", rng.uniform(1, 2)))[0]
        return "%.30f" % (single + 2.0 ** -24) + rng.choice(["", "1"])
    if kind == 4:
        return "%.3f" % rng.uniform(-1000, 1000)
    return "." + str(rng.randrange(10 ** 9)) if rng.random() < 0.5 else str(rng.randrange(99)) + "."


def ring(rng, corners):
    """The corners of a convex polygon in a plane of any direction, exact in float."""
    shapes = {3: [(0, 0), (4, 1), (1, 3)], 4: [(0, 0), (4, 0), (5, 3), (1, 2)],
              5: [(0, 0), (3, -1), (5, 1), (4, 4), (1, 3)],
              6: [(0, 0), (2, 0), (4, 0), (5, 2), (3, 4), (0, 3)]}
    axes = rng.sample(range(3), 3)
    points = []
    for u, v in shapes[corners]:
        p = [0.0, 0.0, 0.0]
        p[axes[0]], p[axes[1]], p[axes[2]] = u, v, 0.25 * u - 0.5 * v
        points.append(p)
    return points[::-1] if rng.random() < 0.5 else points


def mesh(rng):
    """Vertices as text, triangles of any corners first and then convex polygons."""
    vertices = [[number(rng) for _ in range(3)] for _ in range(30)]
    faces = [rng.sample(range(30), 3) for _ in range(40)]
    for corners in (3, 4, 5, 6):
        points = ring(rng, corners)
        faces.append(list(range(len(vertices), len(vertices) + corners)))
        vertices += [[repr(x) for x in p] for p in points]
    return vertices, faces


def obj(rng, vertices, faces):
    lines, known = ["# odd", "g a b", "o c"], len(vertices)
    lines += ["v  " + "\t".join(v) + rng.choice(["", " 1.0", " 0 0 1", " # c"]) for v in vertices]
    for face in faces:
        form = rng.choice(["%d", "%d/1", "%d//1", "%d/1/1"])
        back = rng.random() < 0.5
        words = [form % (i - known if back else i + 1) for i in face]
        lines.append("f " + rng.choice([" ", "  ", " \\\n "]).join(words))
    return rng.choice(["\n", "\r\n"]).join(lines).encode()


def off(rng, vertices, faces):
    lines = [rng.choice(["OFF %d %d 0", "OFF\n# c\n%d %d 0", "COFF\n%d %d"])
             % (len(vertices), len(faces)), ""]
    lines += [" ".join(v) + rng.choice(["", " 1 0 0 1"]) for v in vertices]
    lines += [" ".join(map(str, [len(f)] + f)) + rng.choice(["", " 9 9 9"]) for f in faces]
    return "\n".join(lines).encode()


def stl(rng, vertices, faces):
    lines = ["solid a name"]
    for face in faces:
        if len(face) == 3:
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += ["  vertex " + " ".join(vertices[i]) for i in face]
            lines += ["endloop", "endfacet"]
    return rng.choice(["\n", "\r\n"]).join(lines + ["endsolid a name", ""]).encode()


def ply(rng, vertices, faces):
    """Text or binary; extra properties and elements; the types of the properties drawn."""
    form = rng.choice(["ascii", "binary_little_endian", "binary_big_endian"])
    types = {t: independent_reader.PLY_TYPES[t] for t in independent_reader.PLY_TYPES}
    real = [rng.choice(["float", "double", "float32", "float64"]) for _ in range(3)]
    length, index = rng.choice(["uchar", "int", "uint16"]), rng.choice(["int", "uint", "short"])
    columns = [("x", real[0]), ("y", real[1]), ("z", real[2]), ("q", "uchar")]
    rng.shuffle(columns)
    strips = "element tristrips 1\nproperty list int int vertex_indices\n"
    strip = [0, 1, 2, 3, -1, 4, 5, 6, 6, 7, 8, -1, 9, 10]
    parts = {
        "vertex": "element vertex %d\n" % len(vertices)
                  + "".join("property %s %s\n" % (t, n) for n, t in columns),
        "face": "element face %d\nproperty list %s %s vertex_%s\nproperty uchar flag\n"
                % (len(faces), length, index, rng.choice(["index", "indices"])),
        "tristrips": strips}
    order = list(parts)
    rng.shuffle(order)

    def put(kind, *values):
        if form == "ascii":
            return (" ".join(map(str, values)) + " ").encode()
        return struct.pack(("<" if "little" in form else ">") + str(len(values)) + kind, *values)

    def value(text, kind):
        if form == "ascii":
            return text
        return independent_reader.nearest_float(text) if kind == "f" else float(text)

    body = {"vertex": b"", "face": b"", "tristrips": put("i", len(strip)) + put("i", *strip)}
    for v in vertices:
        texts = dict(zip("xyz", v), q="7")
        for name, t in columns:
            cell = 7 if name == "q" else value(texts[name], types[t])
            body["vertex"] += put(types[t], cell)
        body["vertex"] += b"\n" if form == "ascii" else b""
    for face in faces:
        body["face"] += put(types[length], len(face)) + put(types[index], *face) + put("B", 1)
    header = "ply\nformat %s 1.0\n%send_header\n" % (form, "".join(parts[name] for name in order))
    return header.encode() + b"".join(body[name] for name in order)


def compare(dump, path):
    expected = independent_reader.digest(path)
    raw = subprocess.run([dump, path], stdout=subprocess.PIPE, check=True).stdout
    found = (len(raw) // 72, hashlib.sha256(raw).hexdigest())
    if found != expected:
        print("DIFFERS", path, "independent", expected, "ours", found)
    return found == expected


def main():
    dump = sys.argv[1]
    same = checked = 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(60):
            rng = random.Random(seed)
            vertices, faces = mesh(rng)
            for name, writer in (("obj", obj), ("off", off), ("stl", stl), ("ply", ply)):
                path = os.path.join(folder, "%d.%s" % (seed, name))
                with open(path, "wb") as file:
                    file.write(writer(rng, vertices, faces))
                same += compare(dump, path)
                checked += 1
        scenes = os.environ.get("SVDAG_SCENES")
        for name in sorted(os.listdir(scenes)) if scenes else []:
            if name[name.rfind("."):] not in independent_reader.READERS:
                continue
            try:
                same += compare(dump, os.path.join(scenes, name))
                checked += 1
            except independent_reader.ConcavePolygon:
                print(name, "has concave polygons, which the independent reader does not triangulate")
    print("%d of %d files agree%s" % (same, checked, "" if scenes else "; no shared scenes"))
    return 0 if same == checked else 1


if __name__ == "__main__":
    sys.exit(main())
