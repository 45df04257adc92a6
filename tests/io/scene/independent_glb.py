#!/usr/bin/env python3
"""An independent GLB reader, written from the glTF 2.0 specification alone (no Draco, no sparse).

Prints the number of triangles of a GLB file and the SHA-256 of all corners as little-endian
float64, three corners of x, y, z per triangle, in stream order; or, as
`--against PROGRAM SCENE...`, compares these with what PROGRAM dumps. The C++ reader must agree bit
by bit, so this is the order of every floating-point operation (all in double, no fused operations):

  stream order   nodes depth first from the default scene, a node before its children; within a
                 node its primitives, then its triangles as section 3.7.2.1 of the specification
                 numbers the corners of lists, strips and fans
  rotation       of the quaternion (x, y, z, w), with n = ((x*x + y*y) + z*z) + w*w:
                   diagonal       (((w*w + x*x) - y*y) - z*z) / n       cyclic in x, y, z
                   off-diagonal   (2 * (x*y - w*z)) / n                 and so on
  local matrix   column c of the rotation times scale[c]; or `matrix` unchanged
  composition    parent * local, each entry (p0*l0 + p1*l1) + p2*l2, the last column then + p3
  point          ((m0*x + m1*y) + m2*z) + m3
  mirrored       by a negative determinant: the last two corners of each triangle change places
  normalised     integers divided by their largest value, at least -1 (KHR_mesh_quantization)
  morphed        p + w * t for each target of a weight that is not 0, in order
  skinned        (sum of w * joint(p)) / sum of w, by the joints of JOINTS_0, JOINTS_1, ... in order; a joint is its node's
                 world matrix * its inverse bind matrix; in the world, whatever the node
"""
import hashlib
import json
import os
import struct
import subprocess
import sys

import numpy as np

COMPONENTS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTH = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Glb:
    def __init__(self, path):
        data = open(path, "rb").read()
        magic, version, length = struct.unpack_from("<4sII", data, 0)
        assert magic == b"glTF" and version == 2 and length <= len(data)
        size, kind = struct.unpack_from("<I4s", data, 12)
        assert kind == b"JSON"
        self.doc = json.loads(data[20 : 20 + size])
        at = 20 + size
        size, kind = struct.unpack_from("<I4s", data, at)
        assert kind == b"BIN\0"
        self.binary = data[at + 8 : at + 8 + size]

    def accessor(self, index):
        a = self.doc["accessors"][index]
        assert "sparse" not in a
        kind, width = np.dtype(COMPONENTS[a["componentType"]]), WIDTH[a["type"]]
        if "bufferView" not in a:
            return np.zeros((a["count"], width), kind)
        view = self.doc["bufferViews"][a["bufferView"]]
        assert "uri" not in self.doc["buffers"][view["buffer"]]
        begin = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        stride = view.get("byteStride", kind.itemsize * width)
        return np.ndarray((a["count"], width), kind, self.binary, begin, (stride, kind.itemsize))

    def positions(self, index):
        values, a = self.accessor(index), self.doc["accessors"][index]
        if a.get("normalized"):
            largest = float(np.iinfo(values.dtype).max)
            return np.maximum(values.astype(np.float64) / largest, -1.0)
        return values.astype(np.float64)


def local_matrix(node):
    """The upper three rows of the node's matrix."""
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T[:3]
    x, y, z, w = (float(v) for v in node.get("rotation", (0, 0, 0, 1)))
    n = ((x * x + y * y) + z * z) + w * w
    rows = [
        [(((w * w + x * x) - y * y) - z * z) / n, (2 * (x * y - w * z)) / n, (2 * (x * z + w * y)) / n],
        [(2 * (x * y + w * z)) / n, (((w * w + y * y) - z * z) - x * x) / n, (2 * (y * z - w * x)) / n],
        [(2 * (x * z - w * y)) / n, (2 * (y * z + w * x)) / n, (((w * w + z * z) - x * x) - y * y) / n],
    ]
    m = np.empty((3, 4))
    m[:, :3] = np.array(rows) * np.array(node.get("scale", (1, 1, 1)), np.float64)
    m[:, 3] = node.get("translation", (0, 0, 0))
    return m


def compose(p, l):
    m = (p[:, 0:1] * l[0:1] + p[:, 1:2] * l[1:2]) + p[:, 2:3] * l[2:3]
    m[:, 3] += p[:, 3]
    return m


def transform(m, v):
    x, y, z = v[:, 0], v[:, 1], v[:, 2]
    return np.stack([((r[0] * x + r[1] * y) + r[2] * z) + r[3] for r in m], axis=1)


def worlds_of(nodes):
    """The world matrix of every node, in a scene or not."""
    parents = {c: i for i, n in enumerate(nodes) for c in n.get("children", ())}

    def world(i):
        return compose(world(parents[i]) if i in parents else np.eye(4)[:3], local_matrix(nodes[i]))
    return [world(i) for i in range(len(nodes))]


def morphed(glb, node, primitive, points):
    weights = node.get("weights", glb.doc["meshes"][node["mesh"]].get("weights", ()))
    for weight, target in zip(weights, primitive.get("targets", ())):
        if weight != 0 and "POSITION" in target:
            points = points + weight * glb.positions(target["POSITION"])
    return points


def skinned(glb, skin, primitive, points, worlds):
    joints = skin["joints"]
    binds = [np.eye(4)[:3]] * len(joints)
    if "inverseBindMatrices" in skin:
        binds = [m.reshape(4, 4).T[:3] for m in glb.accessor(skin["inverseBindMatrices"]).astype(np.float64)]
    matrices = np.array([compose(worlds[j], b) for j, b in zip(joints, binds)])
    sums, totals = np.zeros((len(points), 3)), np.zeros((len(points), 1))
    x, y, z = points[:, 0:1], points[:, 1:2], points[:, 2:3]
    for number in range(9):
        if f"JOINTS_{number}" not in primitive["attributes"]:
            break
        numbers = glb.accessor(primitive["attributes"][f"JOINTS_{number}"])
        weights = glb.positions(primitive["attributes"][f"WEIGHTS_{number}"])
        for k in range(4):
            m, w = matrices[numbers[:, k]], weights[:, k:k + 1]
            sums = sums + w * (((m[:, :, 0] * x + m[:, :, 1] * y) + m[:, :, 2] * z) + m[:, :, 3])
            totals = totals + w
    assert (totals > 0).all()
    return sums / totals


def corners(count, mode):
    """Corner numbers, three per triangle."""
    i = np.arange(max(count - 2, 0))
    if mode == 4:
        return np.arange(count)
    if mode == 5:
        return np.stack([i, i + 1 + i % 2, i + 2 - i % 2], axis=1).ravel()
    if mode == 6:
        return np.stack([i + 1, i + 2, 0 * i], axis=1).ravel()
    return np.arange(0)


def triangles(glb):
    """Yields arrays of world-space corners, (3 * triangles, 3)."""
    doc = glb.doc
    nodes = doc["nodes"]
    if "scenes" in doc:
        roots = doc["scenes"][doc.get("scene", 0)]["nodes"]
    else:
        roots = sorted(set(range(len(nodes))) - {c for n in nodes for c in n.get("children", ())})
    identity = np.eye(4)[:3]
    worlds = worlds_of(nodes)
    stack = [(r, identity) for r in reversed(roots)]
    while stack:
        index, parent = stack.pop()
        node = nodes[index]
        world = compose(parent, local_matrix(node))
        stack += [(c, world) for c in reversed(node.get("children", ()))]
        if "mesh" not in node:
            continue
        for primitive in doc["meshes"][node["mesh"]]["primitives"]:
            points = morphed(glb, node, primitive, glb.positions(primitive["attributes"]["POSITION"]))
            is_skinned = "skin" in node and "JOINTS_0" in primitive["attributes"]
            if is_skinned:
                points = skinned(glb, doc["skins"][node["skin"]], primitive, points, worlds)
            else:
                points = transform(world, points)
            if "indices" in primitive:
                points = points[glb.accessor(primitive["indices"])[:, 0]]
            points = points[corners(len(points), primitive.get("mode", 4))]
            if not is_skinned and np.linalg.det(world[:, :3]) < 0:
                points = points.reshape(-1, 3, 3)[:, [0, 2, 1]].reshape(-1, 3)
            yield points


def summary(path):
    digest, count = hashlib.sha256(), 0
    for points in triangles(Glb(path)):
        digest.update(np.ascontiguousarray(points, "<f8").tobytes())
        count += len(points) // 3
    return count, digest.hexdigest()


def compare(program, names):
    """Whether `program`, which dumps the corners of a scene, agrees on the shared scenes."""
    folder = os.environ.get("SVDAG_SCENES")
    if folder is None:
        print("SVDAG_SCENES is not set")
        return 77
    for name in names:
        path = os.path.join(folder, name)
        dump = subprocess.run([program, path], check=True, capture_output=True).stdout
        ours, theirs = summary(path), (len(dump) // 72, hashlib.sha256(dump).hexdigest())
        print(name, ours, "same" if ours == theirs else f"DIFFERS from {theirs}")
        if ours != theirs:
            return 1
    return 0


if __name__ == "__main__":
    if sys.argv[1] == "--against":
        sys.exit(compare(sys.argv[2], sys.argv[3:]))
    print(*summary(sys.argv[1]))
