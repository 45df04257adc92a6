#!/usr/bin/env python3
"""Tests that the same mesh in every scene format bakes to the same bytes.

Usage: formats_test.py PROGRAMS. Coordinates are float32 values, which every format represents exactly; text is
written with 17 digits.
"""
import pathlib
import random
import struct
import subprocess
import sys
import tempfile


def make_mesh():
    """A bumpy height field of triangles: (vertices with float32 values, faces)."""
    rng = random.Random(5)
    n = 24
    vertices = [tuple(struct.unpack("<3f", struct.pack("<3f", x / 7 - 1.3, y / 9 + 0.1, rng.uniform(-0.4, 0.4))))
                for x in range(n) for y in range(n)]
    faces = []
    for x in range(n - 1):
        for y in range(n - 1):
            a, b, c, d = x * n + y, (x + 1) * n + y, (x + 1) * n + y + 1, x * n + y + 1
            faces += [(a, b, c), (a, c, d)]
    return vertices, faces


def text(values):
    return " ".join(f"{v:.17g}" for v in values)


def ply_ascii(v, f):
    head = ("ply\nformat ascii 1.0\n"
            f"element vertex {len(v)}\nproperty double x\nproperty double y\nproperty double z\n"
            f"element face {len(f)}\nproperty list uchar int vertex_indices\nend_header\n")
    return (head + "".join(text(p) + "\n" for p in v) + "".join("3 %d %d %d\n" % t for t in f)).encode()


def ply_binary(v, f, order, name):
    head = (f"ply\nformat binary_{name}_endian 1.0\n"
            f"element vertex {len(v)}\nproperty float x\nproperty float y\nproperty float z\n"
            f"element face {len(f)}\nproperty list uchar uint vertex_indices\nend_header\n").encode()
    return head + b"".join(struct.pack(order + "3f", *p) for p in v) + b"".join(
        struct.pack(order + "B3I", 3, *t) for t in f)


def stl_ascii(v, f):
    facets = "".join("facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {text(v[i])}\n" for i in t) +
                     "endloop\nendfacet\n" for t in f)
    return f"solid mesh\n{facets}endsolid mesh\n".encode()


def stl_binary(v, f):
    return bytes(80) + struct.pack("<I", len(f)) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *v[a], *v[b], *v[c], 0) for a, b, c in f)


def obj(v, f):
    return ("".join(f"v {text(p)}\n" for p in v) +
            "".join("f %d %d %d\n" % (a + 1, b + 1, c + 1) for a, b, c in f)).encode()


def off(v, f):
    return (f"OFF\n{len(v)} {len(f)} 0\n" + "".join(text(p) + "\n" for p in v) +
            "".join("3 %d %d %d\n" % t for t in f)).encode()


def glb(v, f):
    positions = b"".join(struct.pack("<3f", *p) for p in v)
    indices = b"".join(struct.pack("<3I", *t) for t in f)
    json = ('{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],'
            '"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],'
            f'"buffers":[{{"byteLength":{len(positions) + len(indices)}}}],'
            f'"bufferViews":[{{"buffer":0,"byteLength":{len(positions)}}},'
            f'{{"buffer":0,"byteOffset":{len(positions)},"byteLength":{len(indices)}}}],'
            f'"accessors":[{{"bufferView":0,"componentType":5126,"count":{len(v)},"type":"VEC3"}},'
            f'{{"bufferView":1,"componentType":5125,"count":{3 * len(f)},"type":"SCALAR"}}]}}').encode()
    json += b" " * (-len(json) % 4)
    body = positions + indices
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(json) + len(body)) +
            struct.pack("<I4s", len(json), b"JSON") + json + struct.pack("<I4s", len(body), b"BIN\0") + body)


def main():
    program = pathlib.Path(sys.argv[1]).resolve() / "svdag"
    v, f = make_mesh()
    files = {"text.ply": ply_ascii(v, f), "little.ply": ply_binary(v, f, "<", "little"),
             "big.ply": ply_binary(v, f, ">", "big"), "text.stl": stl_ascii(v, f), "binary.stl": stl_binary(v, f),
             "mesh.obj": obj(v, f), "mesh.off": off(v, f), "mesh.glb": glb(v, f)}
    with tempfile.TemporaryDirectory(prefix="svdag-formats-") as folder:
        dags = {}
        for name, content in files.items():
            scene, dag = pathlib.Path(folder, name), pathlib.Path(folder, name + ".svdag")
            scene.write_bytes(content)
            subprocess.run([program, "build", scene, "-o", dag, "-r", "512", "-q"], check=True)
            dags[name] = dag.read_bytes()
    reference = dags["binary.stl"]
    different = [name for name, dag in dags.items() if dag != reference]
    for name in different:
        print(f"{name}: the bytes differ from those of binary.stl")
    print(f"{len(dags) - len(different)} passed, {len(different)} failed, 0 skipped")
    return len(reference) < 10000 or bool(different)


if __name__ == "__main__":
    sys.exit(main())
