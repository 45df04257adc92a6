#!/usr/bin/env python3
"""Reads PLY, STL, OBJ and OFF files, written from the specifications of the formats alone.

Prints the number of triangles and the SHA-256 over their corners as little-endian doubles, nine
per triangle, in the order of the file. The C++ readers are compared with it, so it shares nothing
with them: plain Python, whole files in memory, one obvious step after the other.

Rules that a format leaves open are those of the project: a convex polygon is a fan from its first
corner (a concave one is an error here); text is the nearest double, but a PLY text property
declared float is a float; in a strip -1 restarts and a repeated index makes no triangle.
"""
import hashlib
import re
import struct
import sys
from array import array
from fractions import Fraction

PLY_TYPES = {
    "char": "b", "int8": "b", "uchar": "B", "uint8": "B", "short": "h", "int16": "h",
    "ushort": "H", "uint16": "H", "int": "i", "int32": "i", "uint": "I", "uint32": "I",
    "float": "f", "float32": "f", "double": "d", "float64": "d"}


def nearest_float(text):
    """The float nearest to a decimal number (not to the double nearest to it)."""
    double = float(text)
    try:
        single = struct.unpack("<f", struct.pack("<f", double))[0]
    except OverflowError:
        return float("inf") if double > 0 else float("-inf")
    if double != double or abs(double) == float("inf") or double == single:
        return single
    # Rounding twice goes wrong only if the double is exactly between two floats.
    bits = struct.unpack("<i", struct.pack("<f", single))[0]
    other = struct.unpack("<f", struct.pack("<i", bits + (1 if abs(double) > abs(single) else -1)))[0]
    exact = Fraction(text)
    return single if abs(exact - Fraction(single)) <= abs(exact - Fraction(other)) else other


def is_convex(points):
    """Whether all turns have one sign, seen along the dominant axis of the normal."""
    n = len(points)
    normal = [0.0, 0.0, 0.0]
    for i in range(n):
        a, b = points[i], points[(i + 1) % n]
        for k in range(3):
            y, z = (k + 1) % 3, (k + 2) % 3
            normal[k] += (a[y] - b[y]) * (a[z] + b[z])
    axis = max(range(3), key=lambda k: (abs(normal[k]), -k))
    u, v = (axis + 1) % 3, (axis + 2) % 3
    signs = set()
    for i in range(n):
        a, b, c = points[i], points[(i + 1) % n], points[(i + 2) % n]
        turn = (b[u] - a[u]) * (c[v] - b[v]) - (b[v] - a[v]) * (c[u] - b[u])
        if turn != 0:
            signs.add(turn > 0)
    return len(signs) <= 1


class ConcavePolygon(ValueError):
    """A polygon that a fan does not triangulate."""


class Soup:
    def __init__(self):
        self.values = array("d")

    def polygon(self, points):
        if len(points) > 3 and not is_convex(points):
            raise ConcavePolygon
        for i in range(2, len(points)):
            for p in (points[0], points[i - 1], points[i]):
                self.values.extend(p)


def ply_header(data):
    end = re.search(rb"end_header(\r\n|\n|\r)", data)
    lines = re.split(r"\r\n|\n|\r", data[:end.start()].decode("latin-1"))
    assert lines[0] == "ply"
    form, elements = None, []
    for line in lines[1:]:
        words = line.split()
        if not words or words[0] in ("comment", "obj_info"):
            continue
        if words[0] == "format":
            form = words[1]
        elif words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[1] == "list":
            elements[-1][2].append((words[4], PLY_TYPES[words[3]], PLY_TYPES[words[2]]))
        else:
            elements[-1][2].append((words[2], PLY_TYPES[words[1]], None))
    return form, elements, data[end.end():]


def ply_values(form, body):
    """A function that gives the next `count` values of a type."""
    if form == "ascii":
        words = iter(body.split())

        def next_values(kind, count):
            texts = [next(words).decode() for _ in range(count)]
            convert = nearest_float if kind == "f" else float if kind == "d" else (
                lambda text: int(text) if re.fullmatch(r"[-+]?\d+", text) else float(text))
            return [convert(text) for text in texts]
    else:
        order = {"binary_little_endian": "<", "binary_big_endian": ">"}[form]
        place = [0]

        def next_values(kind, count):
            layout = order + str(count) + kind
            values = struct.unpack_from(layout, body, place[0])
            place[0] += struct.calcsize(layout)
            return values
    return next_values


def read_ply(data, soup):
    form, elements, body = ply_header(data)
    next_values = ply_values(form, body)
    rows = {}
    for name, count, properties in elements:
        rows[name] = []
        for _ in range(count):
            row = {}
            for key, kind, length in properties:
                values = next_values(kind, next_values(length, 1)[0] if length else 1)
                row[key] = values if length else values[0]
            rows[name].append(row)
    points = [(r["x"], r["y"], r["z"]) for r in rows["vertex"]]
    for name, _, _ in elements:
        for row in rows[name] if name in ("face", "tristrips") else []:
            indices = row.get("vertex_indices", row.get("vertex_index"))
            if name == "face":
                assert all(i >= 0 for i in indices)
                soup.polygon([points[i] for i in indices])
                continue
            strip = []
            for i in indices:
                strip = [] if i == -1 else strip + [i]
                if len(strip) >= 3 and len(set(strip[-3:])) == 3:
                    a, b, c = strip[-3:]
                    a, b = (b, a) if len(strip) % 2 == 0 else (a, b)
                    soup.polygon([points[a], points[b], points[c]])


def read_stl(data, soup):
    if len(data) >= 84 and len(data) == 84 + 50 * struct.unpack_from("<I", data, 80)[0]:
        for record in struct.iter_unpack("<12fH", data[84:]):
            soup.values.extend(record[3:12])
        return
    corners = [tuple(float(x) for x in line.split()[1:4])
               for line in re.split(r"\r\n|\n|\r", data.decode("latin-1"))
               if line.split()[:1] and line.split()[0].lower() == "vertex"]
    assert len(corners) % 3 == 0
    for i in range(0, len(corners), 3):
        soup.polygon(corners[i:i + 3])


def read_obj(data, soup):
    points = []
    text = re.sub(r"\\(\r\n|\n|\r)", " ", data.decode("latin-1"))
    for line in re.split(r"\r\n|\n|\r", text):
        words = line.split("#")[0].split()
        if words[:1] == ["v"]:
            points.append(tuple(float(x) for x in words[1:4]))
        elif words[:1] == ["f"]:
            indices = [int(word.split("/")[0]) for word in words[1:]]
            assert all(i != 0 for i in indices)
            soup.polygon([points[i - 1 if i > 0 else i] for i in indices])


def read_off(data, soup):
    lines = [line.split("#")[0].split() for line in data.decode("latin-1").splitlines()]
    lines = [words for words in lines if words]
    head = lines.pop(0)
    assert re.fullmatch(r"(ST)?C?N?OFF", head[0])
    counts = head[1:] or lines.pop(0)
    vertices, faces = int(counts[0]), int(counts[1])
    points = [tuple(float(x) for x in words[:3]) for words in lines[:vertices]]
    for words in lines[vertices:vertices + faces]:
        n = int(words[0])
        soup.polygon([points[int(i)] for i in words[1:n + 1]])


READERS = {".ply": read_ply, ".stl": read_stl, ".obj": read_obj, ".off": read_off}


def triangles(path):
    """The corners of the triangles of a scene file, nine doubles each."""
    with open(path, "rb") as file:
        data = file.read()
    soup = Soup()
    READERS[path[path.rfind("."):].lower()](data, soup)
    return soup.values


def digest(path):
    """(number of triangles, SHA-256 of their corners) of a scene file."""
    values = triangles(path)
    if sys.byteorder == "big":
        values.byteswap()
    return len(values) // 9, hashlib.sha256(values.tobytes()).hexdigest()


if __name__ == "__main__":
    for name in sys.argv[1:]:
        print(*digest(name), name)
