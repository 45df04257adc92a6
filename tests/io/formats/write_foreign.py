"""Writers of other programs' formats, from their layouts alone, as input of imports.

They use features that our exports do not: trees without sharing, depth-first order, empty nodes, repeated
voxels, models without a scene graph. Voxels are sequences of (x, y, z).
"""
import io
import struct
import zipfile

import numpy


def tree(voxels, levels):
    """{child: subtree} down to single voxels, children numbered c = 4x + 2y + z."""
    root = {}
    for x, y, z in voxels:
        node = root
        for k in range(levels - 1, -1, -1):
            node = node.setdefault(4 * (x >> k & 1) + 2 * (y >> k & 1) + (z >> k & 1), {})
    return root


def hashdag(voxels, levels, low=(0, 0, 0), side=1.0, empty_nodes=False):
    """Depth-first, nothing shared; empty_nodes: with nodes without voxels."""
    words = []

    def put(node, depth):
        at = len(words)
        if depth == levels - 2:
            mask = sum(1 << (8 * outer + inner) for outer, block in node.items() for inner in block)
            words.extend([mask & 0xffffffff, mask >> 32])
            return at
        children = dict(node)
        if empty_nodes and 5 not in children:
            children[5] = {}
        mask = sum(1 << c for c in children)
        words.append(mask | 0xabc << 8)  # the upper bits belong to colours
        words.extend([0] * len(children))
        for i, c in enumerate(sorted(children)):
            words[at + 1 + i] = put(children[c], depth + 1)
        return at

    put(tree(voxels, levels), 0)
    high = [a + side for a in low]
    return struct.pack("<6dIQ", *low, *high, levels, len(words)) + struct.pack(f"<{len(words)}I", *words)


def hashdag_colours(colours, top_levels=2, enclosed=(7, 1 << 40, 0)):
    """colours: (r, g, b) of each voxel, depth first. The counts of voxels below nodes are made up."""
    return struct.pack("<IQ", top_levels, len(enclosed)) + struct.pack(f"<{len(enclosed)}Q", *enclosed) + struct.pack(
        "<Q", len(colours)) + b"".join(bytes((*colour, 255)) for colour in colours)


def by_level(voxels, levels):
    """Lists of nodes per depth; a node is {child: position in the next list}, without sharing."""
    lists = [[] for _ in range(levels + 1)]

    def put(node, depth):
        entry = {}
        at = len(lists[depth])
        lists[depth].append(entry)
        for c in sorted(node):
            entry[c] = put(node[c], depth + 1)
        return at

    put(tree(voxels, levels), 0)
    return lists


def symvox(voxels, levels, centre=(0.5, 0.5, 0.5), side=1.0):
    """Level by level; 'first leaf' is the number of words, as in one writer."""
    lists = by_level(voxels, levels)
    starts, at = [], 0
    for depth in range(levels):
        starts.append([])
        for node in lists[depth]:
            starts[-1].append(at)
            at += 1 + (len(node) if depth < levels - 1 else 0)
    words = []
    for depth in range(levels):
        for node in lists[depth]:
            words.append(sum(1 << c for c in node))
            if depth < levels - 1:
                words.extend(starts[depth + 1][node[c]] for c in sorted(node, reverse=True))
    box = [c - side / 4 for c in centre] + [c + side / 8 + side / 8 for c in centre]  # smaller than the cube
    nodes = sum(map(len, lists[:levels]))
    return struct.pack("<7f4I", *box, side, levels, nodes, len(words), len(words)) + struct.pack(f"<{len(words)}I", *words)


def mirrored(c):
    return c >> 2 | c & 2 | (c & 1) << 2


def transform_dag(voxels, levels):
    """A tree (type 0)."""
    lists = by_level(voxels, levels)
    out = [struct.pack("<IIQ", 72198382, 2, levels + 1), struct.pack("<3Q", 0, 0, 0)]
    for depth in range(levels - 3, -1, -1):
        out.append(struct.pack("<Q", len(lists[depth])))
        for node in lists[depth]:
            out.append(struct.pack("<8I", *[node.get(mirrored(t), 0xffffffff) for t in range(8)]))
    leaves = [sum(1 << (8 * mirrored(outer) + mirrored(inner)) for outer, block in brick.items() for inner in lists[levels - 1][block])
              for brick in lists[levels - 2]]
    out.append(struct.pack(f"<Q{len(leaves)}Q", len(leaves), *leaves))
    return b"".join(out) + struct.pack("<III", 2**levels, levels, 0)


def npz(**arrays):
    stream = io.BytesIO()
    numpy.savez(stream, **arrays)
    return stream.getvalue()


def npz_commented(**arrays):
    """An archive without 64-bit sizes, with a comment after the directory."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED) as archive:
        archive.comment = b"made elsewhere"
        for name, array in arrays.items():
            piece = io.BytesIO()
            numpy.save(piece, array)
            archive.writestr(f"{name}.npy", piece.getvalue())
    return stream.getvalue()


def binvox(dense, translate=(0, 0, 0), scale=1.0):
    """`dense` is indexed x, y, z."""
    x, y, z = dense.shape
    flat = dense.transpose(0, 2, 1).reshape(-1).astype("u1")
    runs, at = bytearray(), 0
    while at < len(flat):
        end = at + 1
        while end < len(flat) and flat[end] == flat[at] and end - at < 100:  # shorter runs than ours
            end += 1
        runs += bytes([flat[at], end - at])
        at = end
    head = f"#binvox 1\ndim {x} {z} {y}\ntranslate {translate[0]} {translate[1]} {translate[2]}\nscale {scale}\ndata\n"
    return head.encode() + bytes(runs)


def chunk(name, body, inner=b""):
    return struct.pack("<4sII", name, len(body), len(inner)) + body + inner


def dictionary(**entries):
    out = struct.pack("<I", len(entries))
    for pair in entries.items():
        for text in pair:
            out += struct.pack("<I", len(text)) + text.encode()
    return out


def vox_model(voxels, size):
    return chunk(b"SIZE", struct.pack("<3I", *size)) + chunk(
        b"XYZI", struct.pack("<I", len(voxels)) + b"".join(bytes([*map(int, v), 79][:4]) for v in voxels))


def vox(*models, places=None, hidden=(), hidden_layers=(), turns=None, hidden_shapes=(), frames=1, pack=True,
        palette=bytes(1024)):
    """models: (voxels, size), colour 79 unless voxels have a fourth number; places: the translation _t of each, or None: no scene graph; each model has its own
    layer; turns: {index into places: byte _r}; hidden, hidden_layers, hidden_shapes: indices into places; frames: number of models per shape,
    its own first; pack: writes the number of models, which without a scene graph makes them frames of an animation; palette: None: no
    chunk."""
    body = chunk(b"PACK", struct.pack("<I", len(models))) if pack else b""
    body += b"".join(vox_model(*m) for m in models)
    if places is not None:
        none = dictionary()
        body += chunk(b"nTRN", struct.pack("<I", 0) + none + struct.pack("<Iiii", 1, -1, -1, 1) + none)
        body += chunk(b"nGRP", struct.pack("<I", 1) + none + struct.pack(f"<I{len(places)}I", len(places), *[
            2 + 2 * i for i in range(len(places))]))
        for i, place in enumerate(places):
            attributes = dictionary(_name="part", **({"_hidden": "1"} if i in hidden else {}))
            body += chunk(b"nTRN", struct.pack("<I", 2 + 2 * i) + attributes + struct.pack(
                "<Iiii", 3 + 2 * i, -1, i, 1) + dictionary(_r=str((turns or {}).get(i, 4)), _t="{} {} {}".format(*place)))
            shown = b"".join(struct.pack("<I", (i + f) % len(models)) + dictionary(_f=str(f)) for f in range(frames))
            body += chunk(b"nSHP", struct.pack("<I", 3 + 2 * i) + (
                dictionary(_hidden="1") if i in hidden_shapes else none) + struct.pack("<I", frames) + shown)
        for i in range(len(places)):
            layer = dictionary(_name="layer", _hidden="1" if i in hidden_layers else "0")
            body += chunk(b"LAYR", struct.pack("<I", i) + layer + struct.pack("<i", -1))
    body += chunk(b"RGBA", palette) if palette is not None else b""
    return b"VOX " + struct.pack("<I", 200) + chunk(b"MAIN", b"", body)
