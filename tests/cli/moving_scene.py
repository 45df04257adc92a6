#!/usr/bin/env python3
"""Writes moving.gltf: a wave of 2 N^2 triangles that turns by slerp, with a box beside it that moves in another animation."""
import base64
import json
import struct
import sys

N = int(sys.argv[1])


def main():
    data, views, accessors = b"", [], []

    def accessor(values, kind, code="f", component=5126):
        nonlocal data
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[kind]
        packed = struct.pack(f"<{len(values)}{code}", *values)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(values) // width,
                          "type": kind})
        data += packed
        return len(accessors) - 1

    def mesh(points, triangles):
        return {"primitives": [{"attributes": {"POSITION": accessor(sum(points, ()), "VEC3")},
                                "indices": accessor(sum(triangles, ()), "SCALAR", "I", 5125)}]}

    wave = [(x / N, (x * (N - x) * y % 7) / 50, y / N) for y in range(N + 1) for x in range(N + 1)]
    corners = [x + y * (N + 1) for y in range(N) for x in range(N)]
    halves = [(a, a + N + 1, a + 1) for a in corners] + [(a + 1, a + N + 1, a + N + 2) for a in corners]
    box = [(x / 4, y / 4, z / 4) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6),
             (0, 6, 4), (1, 5, 7), (1, 7, 3)]
    meshes = [mesh(wave, halves), mesh(box, faces)]
    turns = [(0, 0, 0, 1), (0.36, 0.48, 0.0, 0.8), (-0.6, 0, 0.64, 0.48)]  # unit quaternions
    animations = []
    for name, node, path, values, kind in (("turn", 0, "rotation", turns, "VEC4"),
                                           (None, 1, "translation", [(0, 1, 0), (1, 1, 0), (1, 2, 1)], "VEC3")):
        sampler = {"input": accessor([0.0, 1.0, 2.5], "SCALAR"), "output": accessor(sum(values, ()), kind)}
        animations.append({"samplers": [sampler], **({"name": name} if name else {}),
                           "channels": [{"sampler": 0, "target": {"node": node, "path": path}}]})
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    json.dump({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1]}],
               "nodes": [{"name": "wave", "mesh": 0}, {"name": "box", "mesh": 1}], "meshes": meshes,
               "animations": animations, "buffers": [{"byteLength": len(data), "uri": uri}], "bufferViews": views,
               "accessors": accessors}, open("moving.gltf", "w"))


main()
