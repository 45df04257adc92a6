#!/usr/bin/env python3
"""Cut-outs of shared scenes against an independent reader: every opaque point is in a set voxel, and a texel that a
voxel stands on is cut out exactly.

Usage: points_test.py PROGRAMS [POINTS]. Written from the specifications of glTF and PNG alone; alpha is evaluated here. Points
nearer than 2^-7 voxel to a face, or nearer than 1/255 to the threshold, decide nothing.
"""
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import independent_glb as independent  # noqa: E402

PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()
SCENES = os.environ.get("SVDAG_SCENES")
POINTS = int(sys.argv.pop(1)) if len(sys.argv) > 1 else 40000
FOREST = "stk_black_forest_textured.glb"
independent.WIDTH["VEC2"] = 2


def png_alpha(data):
    """The alpha channel of a PNG that is not interlaced, of 8 bits or a palette; rows from the top."""
    at, header, palette_alpha, packed = 8, None, b"", b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        elif kind == b"tRNS":
            palette_alpha = body
        elif kind == b"IDAT":
            packed += body
        at += 12 + size
    width, height, depth, colour, _, _, interlaced = header
    assert interlaced == 0 and (depth == 8 or colour == 3)
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[colour]
    raw, row_bytes = zlib.decompress(packed), (width * channels * depth + 7) // 8
    step = max(1, channels * depth // 8)
    before, rows = bytearray(row_bytes), []
    for y in range(height):
        kind, row = raw[y * (row_bytes + 1)], bytearray(raw[y * (row_bytes + 1) + 1:(y + 1) * (row_bytes + 1)])
        for i in range(row_bytes):
            left = row[i - step] if i >= step else 0
            if kind == 1:
                row[i] = row[i] + left & 255
            elif kind == 2:
                row[i] = row[i] + before[i] & 255
            elif kind == 3:
                row[i] = row[i] + (left + before[i]) // 2 & 255
            elif kind == 4:
                corner = before[i - step] if i >= step else 0
                guess = left + before[i] - corner
                a, b, c = abs(guess - left), abs(guess - before[i]), abs(guess - corner)
                row[i] = row[i] + (left if a <= b and a <= c else before[i] if b <= c else corner) & 255
        rows.append(row)
        before = row
    texels = np.array(rows, np.uint8)
    if colour == 3:
        bits = np.unpackbits(texels, axis=1).reshape(height, -1, depth)[:, :width]
        index = (bits * (1 << np.arange(depth)[::-1])).sum(axis=2)
        table = np.full(256, 255, np.uint8)
        table[:len(palette_alpha)] = np.frombuffer(palette_alpha, np.uint8)
        return table[index]
    texels = texels.reshape(height, width, channels)
    return texels[:, :, -1] if channels % 2 == 0 else np.full((height, width), 255, np.uint8)


def wrapped(i, size, mode):
    if mode == 33071:
        return np.clip(i, 0, size - 1)
    if mode == 33648:
        i = np.mod(i, 2 * size)
        return np.where(i >= size, 2 * size - 1 - i, i)
    return np.mod(i, size)


class Material:
    def __init__(self, glb, material):
        doc = glb.doc
        pbr = material.get("pbrMetallicRoughness", {})
        info = pbr.get("baseColorTexture")
        texture = doc["textures"][info["index"]]
        sampler = doc["samplers"][texture["sampler"]] if "sampler" in texture else {}
        self.wrap = sampler.get("wrapS", 10497), sampler.get("wrapT", 10497)
        self.nearest = sampler.get("magFilter") == 9728
        view = doc["bufferViews"][doc["images"][texture["source"]]["bufferView"]]
        begin = view.get("byteOffset", 0)
        image = glb.binary[begin:begin + view["byteLength"]]
        self.alpha = png_alpha(image).astype(float) if image[:4] == b"\x89PNG" else np.full((1, 1), 255.0)
        self.factor = pbr.get("baseColorFactor", (1, 1, 1, 1))[3]
        self.cutoff = 255 * material.get("alphaCutoff", 0.5)
        assert "extensions" not in info and info.get("texCoord", 0) == 0

    def texel(self, i, j):
        height, width = self.alpha.shape
        return self.alpha[wrapped(j, height, self.wrap[1]), wrapped(i, width, self.wrap[0])]

    def alpha_at(self, uv):
        u, v = uv[:, 0] * self.alpha.shape[1], uv[:, 1] * self.alpha.shape[0]
        if self.nearest:
            return self.factor * self.texel(np.floor(u).astype(int), np.floor(v).astype(int))
        i, j = np.floor(u - 0.5).astype(int), np.floor(v - 0.5).astype(int)
        x, y = u - 0.5 - i, v - 0.5 - j
        above = self.texel(i, j) * (1 - x) + self.texel(i + 1, j) * x
        below = self.texel(i, j + 1) * (1 - x) + self.texel(i + 1, j + 1) * x
        return self.factor * (above * (1 - y) + below * y)


def clip(polygon, axis, limit, sign):
    """The part of a polygon (rows of numbers) with sign * (number of the axis - limit) >= 0."""
    out = []
    for p, q in zip(polygon, polygon[1:] + polygon[:1]):
        a, b = sign * (p[axis] - limit), sign * (q[axis] - limit)
        if a >= 0:
            out.append(p)
        if a * b < 0:
            out.append(tuple(x + (y - x) * (a / (a - b)) for x, y in zip(p, q)))
    return out


def largest_alpha(material, polygon, enough):
    """The largest alpha in a polygon of the texture, in texels; or one that is enough."""
    height, width = material.alpha.shape
    shift = 0 if material.nearest else 0.5
    size = np.array([width, height])
    largest = material.alpha_at(np.array(polygon) / size).max()
    low, high = (np.floor(np.array([f(x) for x in zip(*polygon)]) - shift).astype(int) for f in (min, max))
    for j in range(low[1], high[1] + 1):
        row = clip(clip(polygon, 1, j + shift, 1), 1, j + 1 + shift, -1)
        for i in range(low[0], high[0] + 1):
            if largest >= enough:
                return largest
            part = clip(clip(row, 0, i + shift, 1), 0, i + 1 + shift, -1)
            if not part:
                continue
            if material.nearest:
                largest = max(largest, material.factor * material.texel(np.array([i]), np.array([j]))[0])
                continue
            # Bilinear, so largest on an edge: at an end, or where the parabola along it is.
            c = [float(material.factor * material.texel(np.array([i + x]), np.array([j + y]))[0])
                 for y in (0, 1) for x in (0, 1)]
            points = [(p[0] - i - 0.5, p[1] - j - 0.5) for p in part]
            for (x, y), (x2, y2) in zip(points, points[1:] + points[:1]):
                dx, dy = x2 - x, y2 - y
                b, cc, d = c[1] - c[0], c[2] - c[0], c[0] - c[1] - c[2] + c[3]
                square, slope = d * dx * dy, b * dx + cc * dy + d * (x * dy + y * dx)
                at = [0.0] + ([-slope / (2 * square)] if square < 0 and 0 < -slope / (2 * square) < 1 else [])
                largest = max([largest] + [c[0] + b * (x + t * dx) + cc * (y + t * dy) + d * (x + t * dx) * (y + t * dy)
                                           for t in at])
    return largest


def whole_triangles(glb, cut):
    """The corners (n, 3, 3) of the triangles of all other primitives."""
    found = []
    for node, world in zip(glb.doc["nodes"], independent.worlds_of(glb.doc["nodes"])):
        for primitive in glb.doc["meshes"][node["mesh"]]["primitives"] if "mesh" in node else ():
            if id(primitive) not in cut:
                points = independent.transform(world, glb.positions(primitive["attributes"]["POSITION"]))
                found.append(points[glb.accessor(primitive["indices"])[:, 0]].reshape(-1, 3, 3))
    return np.concatenate(found)


def may_meet(corners, boxes, low, high):
    """Whether one of the triangles, with their boxes, may meet a box: by its axes and their planes."""
    near = corners[((boxes[0] <= high) & (boxes[1] >= low)).all(axis=1)]
    normal = np.cross(near[:, 1] - near[:, 0], near[:, 2] - near[:, 0])
    distance = np.abs((normal * ((low + high) / 2 - near[:, 0])).sum(axis=1))
    return (distance <= np.abs(normal) @ (high - low) / 2).any()


def cut_triangles(glb, max_materials, cut=None):
    """Lists of (material, corners (n, 3, 3) in the world, coordinates (n, 3, 2)) of primitives that are cut."""
    doc, found, materials = glb.doc, [], {}
    for node, world in zip(doc["nodes"], independent.worlds_of(doc["nodes"])):
        for primitive in doc["meshes"][node["mesh"]]["primitives"] if "mesh" in node else ():
            number = primitive.get("material")
            if number is None or doc["materials"][number].get("alphaMode") != "MASK":
                continue
            if number not in materials and len(materials) == max_materials:
                continue
            if cut is not None:
                cut.add(id(primitive))
            if number not in materials:
                materials[number] = Material(glb, doc["materials"][number])
            index = glb.accessor(primitive["indices"])[:, 0]
            points = independent.transform(world, glb.positions(primitive["attributes"]["POSITION"]))
            uv = glb.accessor(primitive["attributes"]["TEXCOORD_0"]).astype(float)
            found.append((materials[number], points[index].reshape(-1, 3, 3), uv[index].reshape(-1, 3, 2)))
    return found


def run(*words, **more):
    return subprocess.run([PROGRAMS / words[0], *map(str, words[1:])], capture_output=True, text=True, check=True, **more)


def are_set(file, points):
    text = "\n".join(f"{x!r} {y!r} {z!r}" for x, y, z in points.tolist())
    return np.array([line.startswith("set") for line in run("svdag", "query", file, input=text).stdout.splitlines()])


@unittest.skipUnless(SCENES, "SVDAG_SCENES is not set")
class Points(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "a.svdag"

    def bake(self, scene, resolution, rule, *more):
        run("svdag", "build", pathlib.Path(SCENES) / scene, "-r", resolution, "--rule", rule, "-o", self.file, "-q", *more)
        return json.loads(run("svdag", "info", self.file, "--json").stdout)

    def test_every_opaque_point_is_in_a_set_voxel(self):
        rng = np.random.default_rng(7)
        parts = cut_triangles(independent.Glb(pathlib.Path(SCENES) / FOREST), 6)
        corners = np.concatenate([c for _, c, _ in parts])
        uvs = np.concatenate([u for _, _, u in parts])
        materials = [m for m, _, _ in parts]
        of = np.repeat(np.arange(len(parts)), [len(c) for _, c, _ in parts])
        for rule in ("conservative", "thin"):
            for resolution in (1024, 8192):
                info = self.bake(FOREST, resolution, rule)
                voxel, origin = info["grid"]["voxel_size"], np.array(info["grid"]["corner"])
                chosen = rng.integers(len(corners), size=POINTS)
                weights = rng.dirichlet((1, 1, 1), POINTS)
                p = (corners[chosen] * weights[:, :, None]).sum(axis=1)
                keep = np.ones(POINTS, bool)
                if rule == "thin":
                    # Moved to the nearest line of centres along the dominant axis.
                    a, b, c = (corners[chosen, k] for k in range(3))
                    normal = np.cross(b - a, c - a)
                    axis = np.abs(normal).argmax(axis=1)
                    rows = np.arange(POINTS)
                    q = (np.floor((p - origin) / voxel) + 0.5) * voxel + origin
                    moved = (q - p) * (np.arange(3) != axis[:, None])
                    with np.errstate(all="ignore"):
                        along = -(moved * normal).sum(axis=1) / normal[rows, axis]
                    p = p + moved
                    p[rows, axis] += along
                    e1, e2, d = b - a, c - a, p - a
                    g11, g12, g22 = (e1 * e1).sum(1), (e1 * e2).sum(1), (e2 * e2).sum(1)
                    with np.errstate(all="ignore"):
                        det = g11 * g22 - g12 * g12
                        s = (g22 * (d * e1).sum(1) - g12 * (d * e2).sum(1)) / det
                        t = (g11 * (d * e2).sum(1) - g12 * (d * e1).sum(1)) / det
                    weights = np.stack([1 - s - t, s, t], axis=1)
                    keep &= np.isfinite(weights).all(axis=1)
                    # Inside by so much that the snap does not move the edge over the line.
                    with np.errstate(all="ignore"):
                        heights = np.abs(det)[:, None] ** 0.5 / np.stack(
                            [((c - b) ** 2).sum(1), g22, g11], axis=1) ** 0.5
                    keep &= (weights * heights > voxel / 32).all(axis=1)
                    near = np.abs(((p - origin) / voxel)[rows, axis] % 1 - 0.5) < 0.5 - 1 / 128
                else:
                    near = (np.abs((p - origin) / voxel % 1 - 0.5) < 0.5 - 1 / 128).all(axis=1)
                keep &= near
                weights[~keep] = (1, 0, 0)
                uv = (uvs[chosen] * weights[:, :, None]).sum(axis=1)
                alpha, cutoff = np.zeros(POINTS), np.full(POINTS, 256.0)
                for k, material in enumerate(materials):
                    mine = of[chosen] == k
                    alpha[mine], cutoff[mine] = material.alpha_at(uv[mine]), material.cutoff
                # The snap moves a point by up to 2^-9 voxel: by a part of a texel only if texels are not smaller.
                opaque = keep & (alpha >= cutoff + 1)
                if rule == "thin":
                    for k, material in enumerate(materials):
                        mine = opaque & (of[chosen] == k)
                        for du, dv in ((1, 0), (-1, 0), (0, 1), (0, -1)):
                            shift = np.array([du, dv]) / material.alpha.shape[::-1]
                            opaque[mine] &= material.alpha_at(uv[mine] + shift) >= material.cutoff + 1
                self.assertGreater(opaque.sum(), POINTS / 50)
                self.assertTrue((alpha[keep] < cutoff[keep] - 1).sum() > POINTS / 20)
                wrong = np.flatnonzero(opaque)[~are_set(self.file, p[opaque])]
                self.assertEqual(len(wrong), 0, f"{rule} {resolution}: {p[wrong[:3]]}")

    def test_every_set_voxel_has_an_opaque_point(self):
        rng, cut = np.random.default_rng(8), set()
        glb = independent.Glb(pathlib.Path(SCENES) / FOREST)
        parts = cut_triangles(glb, 100, cut)
        corners = np.concatenate([c for _, c, _ in parts])
        uvs = np.concatenate([u for _, _, u in parts])
        of = np.repeat(np.arange(len(parts)), [len(c) for _, c, _ in parts])
        lows, highs = corners.min(axis=1), corners.max(axis=1)
        whole = whole_triangles(glb, cut)
        boxes = whole.min(axis=1), whole.max(axis=1)
        for resolution in (2048, 16384):
            info = self.bake(FOREST, resolution, "conservative")
            voxel, origin = info["grid"]["voxel_size"], np.array(info["grid"]["corner"])
            chosen = rng.integers(len(corners), size=max(1, POINTS // 400))
            p = (corners[chosen] * rng.dirichlet((1, 1, 1), len(chosen))[:, :, None]).sum(axis=1)
            cubes = np.unique(np.floor((p - origin) / voxel), axis=0)
            seen = {True: 0, False: 0}
            for cube, is_set in zip(cubes, are_set(self.file, (cubes + 0.5) * voxel + origin)):
                low, high = cube * voxel + origin, (cube + 1) * voxel + origin
                if may_meet(whole, boxes, low - voxel / 64, high + voxel / 64):
                    continue
                # The snap moves corners by up to 2^-24 voxel. Alpha changes by 255 in a texel at most.
                reach = voxel * 2.0 ** -16 * (1 if is_set else -1)
                largest = 0.0
                for k in np.flatnonzero(((lows <= high + reach) & (highs >= low - reach)).all(axis=1)):
                    material = parts[of[k]][0]
                    size = material.alpha.shape[::-1]
                    polygon = [(*xyz, *(uv * size)) for xyz, uv in zip(corners[k].tolist(), uvs[k])]
                    for axis in range(3):
                        polygon = clip(polygon, axis, low[axis] - reach, 1)
                        polygon = clip(polygon, axis, high[axis] + reach, -1)
                    if polygon:
                        alpha = largest_alpha(material, [q[3:] for q in polygon], material.cutoff + 1)
                        largest = max(largest, alpha - material.cutoff + 256)
                if largest == 0:
                    continue  # the triangle meets the voxel at its border only, if at all
                seen[bool(is_set)] += 1
                self.assertTrue(largest >= 255 if is_set else largest < 257, f"{resolution}: {cube}, {largest - 256}")
            self.assertGreater(min(seen.values()), 0, seen)
            print(f"{resolution}^3: {seen[True]:,} set voxels and {seen[False]:,} empty ones decided alike", file=sys.stderr)

    def test_a_voxel_on_a_transparent_texel_is_cut_out(self):
        # The quad of 128 x 128 texels, one a voxel, has 4,628 transparent ones.
        whole = self.bake("colour_chart.glb", 1024, "thin", "--no-cutouts")["voxels"]
        self.assertEqual(whole - self.bake("colour_chart.glb", 1024, "thin")["voxels"], 4628)

    def test_what_a_mask_hides_wholly_is_gone(self):
        case = pathlib.Path(__file__).resolve().parents[3] / "cases" / "gltf_mask_all_transparent.gltf"
        self.assertEqual(self.bake(case, 64, "conservative")["voxels"], 0)


if __name__ == "__main__":
    unittest.main()
