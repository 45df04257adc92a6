#!/usr/bin/env python3
"""Independent readers of other programs' formats, written from their layouts alone.

Each read_X(path) returns a Found: the resolution, the set voxels as a sorted array of (x, y, z), and the
world coordinates (None if the file has none). Anything unexpected raises Broken: these readers are
strict, because they test a writer.

Usage: read_foreign.py FORMAT FILE prints resolution, voxels and a hash of them.
"""
import hashlib
import io
import pathlib
import re
import struct
import sys
from dataclasses import dataclass

import numpy


class Broken(Exception):
    """The file violates its format."""


def demand(condition, sentence):
    if not condition:
        raise Broken(sentence)


@dataclass
class Found:
    resolution: int
    voxels: numpy.ndarray
    corner: tuple = None  # world position of the corner of voxel (0, 0, 0)
    voxel_size: float = None


def ordered(voxels):
    voxels = numpy.asarray(voxels, "<i8").reshape(-1, 3)
    found = numpy.unique(voxels, axis=0)
    demand(len(found) == len(voxels), "a voxel is listed twice")
    return found


XYZ = numpy.array([[c >> 2, c >> 1 & 1, c & 1] for c in range(8)])  # child c = 4x + 2y + z
ZYX = XYZ[:, ::-1]  # child c = x + 2y + 4z


def children_of(masks, nodes, at, pick, order):
    """The children of a level's nodes: (node, place) for every set bit; pick(nodes, child) finds them."""
    next_nodes, next_at = [], []
    for c in range(8):
        there = (masks >> c & 1).astype(bool)
        next_nodes.append(pick(nodes[there], masks[there], c))
        next_at.append(2 * at[there] + order[c])
    return numpy.concatenate(next_nodes), numpy.concatenate(next_at)


def expand_bricks(bricks, at, order):
    """The voxels of 64-bit masks whose bit is 8 * outer + inner child."""
    voxels = []
    for bit in range(64):
        there = (bricks >> numpy.uint64(bit) & numpy.uint64(1)).astype(bool)
        voxels.append(4 * at[there] + 2 * order[bit >> 3] + order[bit & 7])
    return numpy.concatenate(voxels)


def start():
    return numpy.zeros(1, "<i8"), numpy.zeros((1, 3), "<i8")


def rank_below(masks, c):
    return numpy.array([m.bit_count() for m in range(256)])[masks & ((1 << c) - 1)]


def read_hashdag(path, order=XYZ):
    data = pathlib.Path(path).read_bytes()
    box = struct.unpack_from("<6d", data)
    levels, count = struct.unpack_from("<IQ", data, 48)
    demand(3 <= levels <= 17 and len(data) == 60 + 4 * count, "levels or size")
    words = numpy.frombuffer(data, "<u4", offset=60).astype("<i8")
    nodes, at = start()
    seen = set()
    for _ in range(levels - 2):
        seen.update(nodes.tolist())
        demand(not numpy.any(words[nodes] >> 8), "extra bits")
        nodes, at = children_of(words[nodes], nodes, at,
                                lambda n, m, c: words[n + 1 + rank_below(m, c)], order)
        demand(len(nodes) == 0 or nodes.max() + 1 < count, "a pointer leads out of the file")
    low, high = words[nodes].astype("<u8"), words[nodes + 1].astype("<u8") if len(nodes) else words[nodes].astype("<u8")
    bricks = low | high << numpy.uint64(32)
    used = sum(1 + int(words[n]).bit_count() for n in seen) + 2 * len(set(nodes.tolist()))
    demand(used == count, "words without a pointer to them")
    sides = {box[i + 3] - box[i] for i in range(3)}
    demand(max(sides) - min(sides) <= 1e-9 * max(sides), "the box is not a cube")
    return Found(2**levels, ordered(expand_bricks(bricks, at, order)), box[:3], max(sides) / 2**levels)


def set_bits(numbers):
    """The number of bits set in each u64."""
    table = numpy.array([byte.bit_count() for byte in range(256)], "<i8")
    return table[numpy.ascontiguousarray(numbers).view("u1").reshape(-1, 8)].sum(axis=1)


def read_vox_palette(path):
    """The colours of a file's voxels, in its order, and those of its palette."""
    data = pathlib.Path(path).read_bytes()
    at, numbers, palette = 20, [], None
    while at < len(data):
        name, own = struct.unpack_from("<4sI", data, at)
        body, at = data[at + 12:at + 12 + own], at + 12 + own
        if name == b"XYZI":
            numbers.append(numpy.frombuffer(body, "u1", offset=4).reshape(-1, 4)[:, 3])
        elif name == b"RGBA":
            palette = numpy.frombuffer(body, "u1").reshape(256, 4)
    demand(palette is not None and numpy.all(palette[:, 3] == 255), "an opaque palette")
    numbers = numpy.concatenate(numbers)
    demand(numpy.all(numbers > 0), "the number 0 is empty")
    return palette[numbers - 1, :3], palette[:numbers.max(), :3]


def read_hashdag_colours(path):
    """Voxels and the colour of each, as r, g, b, as HashDAG finds them: a voxel's colour is behind those of the
    voxels before it, whose numbers are in the masks of the nodes beside its path."""
    data = pathlib.Path(path).read_bytes()
    levels, count = struct.unpack_from("<IQ", data, 48)
    words = numpy.frombuffer(data, "<u4", offset=60).astype("<i8")
    demand(len(words) == count, "the number of words")
    colours = pathlib.Path(str(path).replace(".dag.bin", ".uncompressed_colors.bin")).read_bytes()
    top_levels, listed = struct.unpack_from("<IQ", colours)
    enclosed = numpy.frombuffer(colours, "<u8", listed, 12).astype("<i8")
    [number] = struct.unpack_from("<Q", colours, 12 + 8 * listed)
    demand(len(colours) == 20 + 8 * listed + 4 * number and 0 < listed <= 1 << 24, "the size of the colours")
    table = numpy.frombuffer(colours, "<u4", number, 20 + 8 * listed)
    demand(numpy.all(table >> 24 == 255), "a colour is not opaque")

    def bricks(nodes):
        return words[nodes].astype("<u8") | words[nodes + 1].astype("<u8") << numpy.uint64(32)

    def voxels_below(level, nodes):
        if level == levels - 2:
            return set_bits(bricks(nodes))
        upper = words[nodes] >> 8
        return enclosed[upper] if level < top_levels else upper

    nodes, at = start()
    before = numpy.zeros(1, "<i8")
    demand(voxels_below(0, nodes)[0] == number, "the number of voxels below the root")
    for level in range(levels - 2):
        total, found = numpy.zeros(len(nodes), "<i8"), []
        for c in range(8):
            there = (words[nodes] >> c & 1).astype(bool)
            child = words[nodes[there] + 1 + rank_below(words[nodes[there]] & 255, c)]
            found.append((child, 2 * at[there] + XYZ[c], (before + total)[there]))
            total[there] += voxels_below(level + 1, child)
        demand(numpy.array_equal(total, voxels_below(level, nodes)), "the number of voxels below a node")
        nodes, at, before = (numpy.concatenate(column) for column in zip(*found))
    masks, found = bricks(nodes), []
    for bit in range(64):
        there = (masks >> numpy.uint64(bit) & numpy.uint64(1)).astype(bool)
        earlier = set_bits(masks[there] & numpy.uint64((1 << bit) - 1))
        found.append((4 * at[there] + 2 * XYZ[bit >> 3] + XYZ[bit & 7], before[there] + earlier))
    voxels, index = (numpy.concatenate(column) for column in zip(*found))
    demand(numpy.array_equal(numpy.sort(index), numpy.arange(number)), "one colour for each voxel")
    return voxels, table[index, None] >> numpy.array([0, 8, 16], "<u4") & 255


def read_symvox(path, order=XYZ):
    data = pathlib.Path(path).read_bytes()
    low, high = struct.unpack_from("<3f", data), struct.unpack_from("<3f", data, 12)
    side, levels, node_count, first_leaf, count = struct.unpack_from("<f4I", data, 24)
    demand(len(data) == 44 + 4 * count and levels >= 3, "size or levels")
    words = numpy.frombuffer(data, "<u4", offset=44).astype("<i8")
    nodes, at = start()
    seen, end = 0, 0
    for level in range(levels - 1):
        unique = numpy.unique(nodes)
        demand(len(unique) == 0 or unique[0] == end, "a level does not follow the one before")
        seen += len(unique)
        if len(unique):
            end = int(unique[-1]) + 1 + int(words[unique[-1]]).bit_count()
        demand(not numpy.any(words[nodes] >> 8), "mirror bits")
        # Pointers are in descending order of the children: those above c come first.
        nodes, at = children_of(words[nodes], nodes, at,
                                lambda n, m, c: words[n + 1 + rank_below(m >> (c + 1), 8)], order)
        demand(len(nodes) == 0 or nodes.max() < count, "a pointer leads out of the file")
    leaves = numpy.unique(nodes)
    demand(end == first_leaf and (len(leaves) == 0 or leaves[0] == first_leaf), "first leaf")
    demand(end + len(leaves) == count and seen + len(leaves) == node_count, "number of nodes")
    voxels = [2 * at[(words[nodes] >> c & 1).astype(bool)] + order[c] for c in range(8)]
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    return Found(2**levels, ordered(numpy.concatenate(voxels)), tuple(m - side / 2 for m in middle), side / 2**levels)


def read_transform_dag(path, order=ZYX):
    stream = io.BytesIO(pathlib.Path(path).read_bytes())

    def take(layout):
        return struct.unpack("<" + layout, stream.read(struct.calcsize("<" + layout)))

    def numbers(count, kind):
        data = stream.read(min(count * int(kind[2]), 2**30))
        demand(len(data) == count * int(kind[2]), "the file is too short")
        return numpy.frombuffer(data, kind)

    demand(take("II") == (72198382, 2), "magic or version")
    levels = []
    for _ in range(min(take("Q")[0], 64)):
        levels.append(numbers(take("Q")[0] * 8, "<u4").reshape(-1, 8))
    leaves = numbers(take("Q")[0], "<u8")
    resolution, root_level, kind = take("III")
    demand(stream.read() == b"", "bytes behind the end")
    demand(kind == 1 and root_level == len(levels) - 1 and resolution == 2**root_level, "footer")
    demand(not any(len(level) for level in levels[:3]), "levels 0 to 2")
    demand(len(levels[-1]) == 1, "one root")
    nodes, at = start()
    for i in range(root_level, 2, -1):
        table = levels[i].astype("<i8")
        demand(set(nodes.tolist()) == set(range(len(table))), "nodes without a pointer to them")
        masks = sum((table[nodes, c] != 0xffffffff).astype("<i8") << c for c in range(8))
        nodes, at = children_of(masks, nodes, at, lambda n, m, c: table[n, c], order)
    demand(set(nodes.tolist()) == set(range(len(leaves))), "leaves without a pointer to them")
    return Found(resolution, ordered(expand_bricks(leaves[nodes], at, order)))


def read_octree(path, order=ZYX):
    lines = pathlib.Path(path).read_text().split("\n")
    demand(lines[0] == "#octreeheader 1" and lines[4:] == ["END", ""], "header")
    header = dict(line.split(" ") for line in lines[1:4])
    demand(sorted(header) == ["gridlength", "n_data", "n_nodes"], "header fields")
    resolution, count = int(header["gridlength"]), int(header["n_nodes"])
    records = numpy.fromfile(f"{path}nodes", numpy.dtype([("data", "<u8"), ("base", "<u8"), ("offset", "i1", 8)]))
    demand(len(records) == count, "n_nodes")
    data = numpy.fromfile(f"{path}data", numpy.dtype([("morton", "<u8"), ("colour", "<f4", 3), ("normal", "<f4", 3)]))
    demand(len(data) == int(header["n_data"]) and not data[0].tobytes().strip(b"\0"), "n_data or entry 0")
    nodes, at = numpy.array([count - 1]), numpy.zeros((1, 3), "<i8")
    for _ in range(resolution.bit_length() - 1):
        demand(not numpy.any(records["data"][nodes]), "an inner node with data")
        offsets = records["offset"][nodes].astype("<i8")
        masks = sum((offsets[:, c] != -1).astype("<i8") << c for c in range(8))
        below, at = children_of(
            masks, numpy.arange(len(nodes)), at,
            lambda i, m, c: records["base"][nodes[i]].astype("<i8") + offsets[i, c], order)
        demand(len(below) == 0 or (below.min() >= 0 and below.max() < nodes.max()), "a child behind its parent")
        nodes = below
    demand(numpy.all(records["data"][nodes] == 1), "a voxel without data")
    demand(numpy.all(records["offset"][nodes] == -1), "a voxel with children")
    return Found(resolution, ordered(at))


def read_npz(path):
    with numpy.load(path) as arrays:
        demand(sorted(arrays.files) == ["coordinates", "corner", "resolution", "voxel_size"], "arrays")
        voxels = arrays["coordinates"]
        demand(voxels.dtype == numpy.dtype("<i4") and voxels.shape[1:] == (3,), "type or shape")
        return Found(int(arrays["resolution"]), ordered(voxels), tuple(arrays["corner"].tolist()), float(arrays["voxel_size"]))


def read_binvox(path):
    stream = io.BytesIO(pathlib.Path(path).read_bytes())
    demand(stream.readline() == b"#binvox 1\n", "magic")
    fields = {}
    while (line := stream.readline()) != b"data\n":
        demand(line.endswith(b"\n"), "header")
        key, *values = line.split()
        fields[key.decode()] = [float(v) for v in values]
    demand(sorted(fields) == ["dim", "scale", "translate"], "header fields")
    sides = [int(v) for v in fields["dim"]]
    demand(len(sides) == 3 and len(set(sides)) == 1, "no cube")
    runs = numpy.frombuffer(stream.read(), "u1").reshape(-1, 2)
    demand(set(runs[:, 0].tolist()) <= {0, 1} and not numpy.any(runs[:, 1] == 0), "runs")
    dense = numpy.repeat(runs[:, 0], runs[:, 1])
    demand(len(dense) == sides[0]**3, "number of voxels")
    # index = x * width * height + z * width + y
    x, z, y = numpy.nonzero(dense.reshape(sides))
    return Found(sides[0], ordered(numpy.stack([x, y, z], 1)), tuple(fields["translate"]), fields["scale"][0] / sides[0])


def read_vox(path):
    data = pathlib.Path(path).read_bytes()
    demand(data[:8] == b"VOX \x96\0\0\0", "magic or version")
    name, own, inner = struct.unpack_from("<4sII", data, 8)
    demand((name, own, inner) == (b"MAIN", 0, len(data) - 20), "MAIN")
    at, sizes, models, nodes = 20, [], [], {}
    while at < len(data):
        name, own, inner = struct.unpack_from("<4sII", data, at)
        body, at = data[at + 12:at + 12 + own], at + 12 + own
        demand(inner == 0 and len(body) == own, "chunk")
        if name == b"SIZE":
            sizes.append(struct.unpack("<3I", body))
        elif name == b"XYZI":
            demand(struct.unpack_from("<I", body)[0] * 4 + 4 == own, "XYZI")
            models.append(numpy.frombuffer(body, "u1", offset=4).reshape(-1, 4).astype("<i8"))
        else:
            nodes[struct.unpack_from("<I", body)[0]] = (name, body[4:])
    demand(len(sizes) == len(models) and all(1 <= s <= 256 for size in sizes for s in size), "SIZE")
    voxels = [numpy.zeros((0, 3), "<i8")]

    def dictionary(body):
        n, = struct.unpack_from("<I", body)
        body, entries = body[4:], {}
        for _ in range(n):
            pair = []
            for _ in range(2):
                length, = struct.unpack_from("<I", body)
                pair.append(body[4:4 + length].decode())
                body = body[4 + length:]
            entries[pair[0]] = pair[1]
        return entries, body

    def place(number, offset):
        name, body = nodes.pop(number)
        _, body = dictionary(body)
        if name == b"nTRN":
            child, reserved, _, frames = struct.unpack_from("<Iiii", body)
            demand((reserved, frames) == (-1, 1), "nTRN")
            frame, rest = dictionary(body[16:])
            demand(rest == b"" and set(frame) <= {"_t"}, "nTRN frame")
            shift = [int(v) for v in frame.get("_t", "0 0 0").split()]
            place(child, [a + b for a, b in zip(offset, shift)])
        elif name == b"nGRP":
            n, *children = struct.unpack(f"<{len(body) // 4}I", body)
            demand(n == len(children), "nGRP")
            for child in children:
                place(child, offset)
        else:
            demand(name == b"nSHP" and struct.unpack_from("<I", body)[0] == 1 and len(body) == 12, "nSHP")
            model, = struct.unpack_from("<I", body, 4)
            found = models[model][:, :3]
            demand(bool(numpy.all(found < sizes[model])) and bool(numpy.all(models[model][:, 3] > 0)), "XYZI range")
            # A model is placed by the position of its voxel size // 2.
            voxels.append(found - [s // 2 for s in sizes[model]] + offset)

    place(0, [0, 0, 0])
    demand(not nodes, "nodes without a position")
    x, y, z = numpy.concatenate(voxels).T
    return Found(None, ordered(numpy.stack([x, z, -1 - y], 1)))  # z is up: y comes from z


def read_ply(path):
    data = pathlib.Path(path).read_bytes()
    head, _, body = data.partition(b"end_header\n")
    text = re.sub(r"comment .*\n", "", head.decode())
    match = re.fullmatch(r"ply\nformat binary_little_endian 1\.0\nelement vertex (\d+)\n"
                         r"property double x\nproperty double y\nproperty double z\n", text)
    demand(match is not None and len(body) == 24 * int(match[1]), "header or size")
    return numpy.frombuffer(body, "<f8").reshape(-1, 3)


READERS = {"hashdag": read_hashdag, "symvox": read_symvox, "transform-dag": read_transform_dag, "octree": read_octree,
           "npz": read_npz, "binvox": read_binvox, "vox": read_vox}


if __name__ == "__main__":
    found = READERS[sys.argv[1]](sys.argv[2])
    print(found.resolution, len(found.voxels), hashlib.sha256(found.voxels.astype("<u4").tobytes()).hexdigest())
