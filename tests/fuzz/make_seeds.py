#!/usr/bin/env python3
"""make_seeds.py PROGRAMS CORPUS: writes small valid files as seeds of the fuzzers.

Most are written by the programs; the journal follows builder/bake/saved_bake.cpp. The seeds are stored in
tests/fuzz/corpus: run this again when a format changes.
"""
import base64
import gzip
import io
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import zipfile
import zlib

import numpy
import pyopenvdb
import xxhash

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "io"))
import hostile_counts_test  # noqa: E402
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
import foreign_scenes  # noqa: E402


def stl(path, triangles):
    path.write_bytes(bytes(80) + struct.pack("<I", len(triangles)) + b"".join(
        bytes(12) + struct.pack("<9f", *t) + bytes(2) for t in triangles))


def record(kind, payload):
    tag = struct.pack("<II", kind, len(payload))
    return tag + struct.pack("<Q", xxhash.xxh3_64_intdigest(tag + payload)) + payload


def text(value):
    return struct.pack("<Q", len(value)) + value


def stream(number, size, blocks):
    return struct.pack("<3Q", number, size, len(blocks)) + struct.pack(f"<{len(blocks)}I", *blocks)


def journal(lattice):
    """A bake at 32^3: its triangles in two bins, winding numbers, two runs, and a process that resumed."""
    levels, all_voxels = 5, 1 << 15
    grid = struct.pack("<Ii4d3qI6q12d", lattice, levels, 0.5, 1, 2, 3, 0, 0, 0, lattice, 0, 0, 0, 32, 32, 32,
                       1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0)
    bake = struct.pack("<I", 10) + text(b"algorithm: 3\nrule: thin\n") + grid + struct.pack("<Q", 16384)
    bins = b"".join(struct.pack("<i3q2Q", 1, 0, 0, z, z * 4096, (z + 1) * 4096) + struct.pack("<Q", 9) + stream(
        1 + z, 16000 + z, [z]) for z in range(2))
    layers = struct.pack("<IQ", 0, 0)
    windings = struct.pack("<IQ", 1, 2) + struct.pack("<2Ii2Ii", 0, 0, 1, 511, 0, -2) if lattice else struct.pack("<I", 0)
    left_out = struct.pack("<18Q", *range(18))
    cut_outs = struct.pack("<Q2q", 1, 3, 2) + text(bytes((0, 128, 255, 1, 2, 200)))
    cut_outs += struct.pack("<Q4Id", 1, 0, 0, 2, 1, 127.5)
    split = (struct.pack("<Qd3Q", 18, 0.25, 0, 4, 2) + left_out + struct.pack("<3Qd2Qd", 1, 2, 3, 0.125, 1, 0, 8) + struct.pack("<Q", 2) + bins + layers
             + windings + cut_outs)
    run = struct.pack("<Q", levels - 2) + stream(3, 16, [0]) + stream(4, 32, [1]) + stream(5, 64, [2]) + stream(6, 32, [3])
    root = struct.pack("<Q", 1) + struct.pack("<QiII", 5, 1, 1, 0)
    done = struct.pack("<QQ", 7, 0) + struct.pack("<Q", 2) + struct.pack("<4Q", 0, 512, 4096, all_voxels)
    return record(1, bake) + record(2, split) + record(3, run + root + done) + record(4, b"") + record(3, run + root + done)


def posed():
    """A triangle with a skin, a morph target, and an animation of each interpolation."""
    parts, views, accessors = b"", [], []

    def accessor(values, kind, form="f", code=5126):
        nonlocal parts
        data = struct.pack(f"<{len(values)}{form}", *values)
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[kind]
        views.append({"buffer": 0, "byteOffset": len(parts), "byteLength": len(data)})
        accessors.append({"bufferView": len(views) - 1, "componentType": code, "count": len(values) // width, "type": kind})
        parts += data.ljust(-(-len(data) // 4) * 4, b"\0")
        return len(accessors) - 1

    primitive = {"attributes": {"POSITION": accessor([0, 0, 0, 1, 0, 0, 0, 1, 0], "VEC3"),
                                "JOINTS_0": accessor([0, 1, 0, 0] * 3, "VEC4", "B", 5121),
                                "WEIGHTS_0": accessor([0.5, 0.5, 0, 0] * 3, "VEC4")},
                 "targets": [{"POSITION": accessor([0, 0, 1] * 3, "VEC3")}]}
    times = accessor([0, 1], "SCALAR")
    samplers = [(accessor([0, 0, 0, 1, 0, 0, 1, 0], "VEC4"), "LINEAR"), (accessor([1, 2, 3] * 6, "VEC3"), "CUBICSPLINE"),
                (accessor([0.25, 0.75], "SCALAR"), "STEP")]
    channels = [(1, "rotation"), (2, "translation"), (0, "weights")]
    bind = accessor([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] * 2, "MAT4")
    return json.dumps({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1]}], "meshes": [{"primitives": [primitive], "weights": [0.5]}],
        "nodes": [{"mesh": 0, "skin": 0}, {"children": [2]}, {"translation": [1, 2, 3]}],
        "skins": [{"joints": [1, 2], "inverseBindMatrices": bind}],
        "animations": [{"name": "a", "samplers": [{"input": times, "output": o, "interpolation": i} for o, i in samplers],
                        "channels": [{"sampler": i, "target": {"node": n, "path": p}} for i, (n, p) in enumerate(channels)]}],
        "buffers": [{"byteLength": len(parts), "uri": "data:;base64," + base64.b64encode(parts).decode()}],
        "bufferViews": views, "accessors": accessors}).encode()


def scenes(corpus):
    """glTF files with every kind of element: sparse, instances, small integers, Draco."""
    document = hostile_counts_test.gltf()
    yield "sparse_instances.gltf", json.dumps(document).encode()
    yield "sparse_instances.glb", hostile_counts_test.glb()[0]
    yield "posed.gltf", posed()
    for code, form, low, high in ((5120, "b", -128, 127), (5121, "B", 0, 255), (5122, "h", -32768, 32767), (5123, "H", 0, 65535)):
        size = struct.calcsize(form)
        corners = b"".join(struct.pack(f"<3{form}", *p).ljust(4 * size, b"\0") for p in (
            (low, 0, 0), (high, 0, 1), (0, high, 0), (1, 2, 3)))
        data = corners + struct.pack("<8I", 0, 1, 2, 3, 2, 1, 0, 0) + struct.pack("<4h", 0, 0, 32767, 0) + struct.pack("<4b", 0, 0, 127, 0)
        at = len(corners)
        views = [(0, at, 4 * size), (at, 32, 0), (at + 32, 8, 0), (at + 40, 4, 0)]
        yield f"integers_{code}.gltf", json.dumps({
            "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "extensionsRequired": ["KHR_mesh_quantization"],
            "nodes": [{"name": "a", "rotation": [0, 0, 0.6, 0.8], "scale": [1, 2, 3], "translation": [4, 5, 6], "children": [1]},
                      {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1],
                       "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"ROTATION": 2 if size == 2 else 3}}}}],
            "meshes": [{"name": "m", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 5 if size == 1 else 6},
                                                    {"attributes": {"POSITION": 0}, "mode": 5}]}],
            "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
            "bufferViews": [{"buffer": 0, "byteOffset": begin, "byteLength": length, **({"byteStride": stride} if stride else {})}
                            for begin, length, stride in views],
            "accessors": [{"bufferView": 0, "componentType": code, "count": 4, "type": "VEC3", "normalized": code % 2 == 0},
                          {"bufferView": 1, "componentType": 5125, "count": 6, "type": "SCALAR"},
                          {"bufferView": 2, "componentType": 5122, "count": 1, "type": "VEC4", "normalized": True},
                          {"bufferView": 3, "componentType": 5120, "count": 1, "type": "VEC4", "normalized": True}]}).encode()
    for kind in ("edgebreaker_11", "sequential_0"):
        data = (corpus / "draco_fuzz" / f"tetrahedron_{kind}.drc").read_bytes()
        yield f"draco_{kind}.gltf", json.dumps({
            "asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1]}], "extensionsRequired": ["KHR_draco_mesh_compression"],
            "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [1, 0, 0]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "extensions": {
                "KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}}]}],
            "buffers": [{"byteLength": len(data), "uri": "data:;base64," + base64.b64encode(data).decode()}],
            "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
            "accessors": [{"componentType": 5126, "count": 4, "type": "VEC3"}]}).encode()


def plys():
    """PLY files with every number type as coordinates, in both byte orders."""
    types = [("char", "b"), ("uchar", "B"), ("short", "h"), ("ushort", "H"), ("int", "i"), ("uint", "I"), ("float", "f"), ("double", "d")]
    for order, name in (("<", "little"), (">", "big")):
        for first in (0, 3, 5):
            (x, fx), (y, fy), (z, fz) = types[first:first + 3]
            head = (f"ply\nformat binary_{name}_endian 1.0\nelement vertex 3\nproperty {x} x\nproperty {y} y\nproperty {z} z\n"
                    f"element face 1\nproperty list {'ushort' if first else 'uchar'} {'uint' if first == 3 else 'short'} vertex_index\n"
                    "end_header\n")
            body = b"".join(struct.pack(order + fx + fy + fz, *p) for p in ((0, 0, 0), (9, 0, 1), (0, 7, 2)))
            face = struct.pack(order + ("H" if first else "B") + ("3I" if first == 3 else "3h"), 3, 0, 1, 2)
            yield f"types_{name}_{first}.ply", head.encode() + body + face


def images():
    """PNGs of each kind, one of them interlaced, and a JPEG."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    def png(depth, kind, row, more=b"", interlaced=0):
        rows = b"\0" + row if interlaced else 2 * (b"\1" + row)
        return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", 1 if interlaced else 2, 1 if interlaced else 2,
                                                                  depth, kind, 0, 0, interlaced))
                + more + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))

    yield "grey.png", png(1, 0, b"\x80")
    yield "rgb.png", png(8, 2, bytes(range(6)))
    yield "palette.png", png(4, 3, b"\1", chunk(b"PLTE", bytes(range(6))) + chunk(b"tRNS", b"\x80"))
    yield "grey_alpha.png", png(16, 4, bytes(range(8)))
    yield "interlaced.png", png(8, 6, bytes(range(4)), b"", 1)
    # A baseline JPEG of 8 x 8 texels: one component, tables of one code each.
    yield "grey.jpg", (b"\xff\xd8" + b"\xff\xdb\0\x43\0" + 64 * b"\1" + b"\xff\xc0\0\x0b\x08\0\x08\0\x08\1\1\x11\0"
                       + b"".join(b"\xff\xc4\0\x14" + bytes([table]) + b"\1" + bytes(16) for table in (0, 16))
                       + b"\xff\xda\0\x08\1\1\0\0\x3f\0" + b"\x3f" + b"\xff\xd9")


def gzips():
    """Stored, fixed and dynamic blocks, all fields of a header, two members, and bytes behind them."""
    text = b"solid a\nendsolid a\n" * 9
    for level in (0, 1, 9):
        yield f"level_{level}.gz", gzip.compress(text, level, mtime=0)
    named = io.BytesIO()
    with gzip.GzipFile("a.stl", "wb", 9, named, mtime=1) as file:
        file.write(text)
    yield "members.gz", named.getvalue() + gzip.compress(b"", mtime=0) + b"\0\0"
    body = zlib.compress(text, 9)[2:-4]
    fields = b"\x1f\x8b\x08\x1e\0\0\0\0\0\3" + b"\2\0ab" + b"name\0" + b"comment\0"
    fields += struct.pack("<H", zlib.crc32(fields) & 0xffff)
    yield "fields.gz", fields + body + struct.pack("<II", zlib.crc32(text), len(text))


def npzs():
    """Voxels with a placement of every supported number type, and of some unsupported ones; with labels."""
    layers = {"layer_names": numpy.frombuffer(b"a\0\xff\0", "u1"), "layer_colours": numpy.array([1, 0xffffff], "<u4"),
              "layer_kind": numpy.frombuffer(b"file\0", "u1")}
    rows, solid = numpy.array([[1, 2, 3], [0, 7, 4]]), numpy.zeros((2, 3, 4), bool)
    solid[1, 2, 0] = True
    for name, arrays in (
            ("place_f8", {"coordinates": rows.astype("<i4"), "resolution": numpy.int64(16), "corner": numpy.array([-1, 0.5, 3.25]),
                          "voxel_size": numpy.float64(0.125)}),
            ("place_f4", {"resolution": numpy.float32(32), "corner": numpy.array([1, 2, 3], "<f4"), "voxel_size": numpy.float32(0.5),
                          "coordinates": rows.astype("<u2")}),
            ("place_integers", {"voxels": solid, "resolution": numpy.uint8(4), "corner": numpy.array([-1, -2, -3], "<i2"),
                                "voxel_size": numpy.array([2], "<u4")}),
            ("place_wrong", {"coordinates": rows, "resolution": numpy.array([8, 8]), "corner": numpy.array(["a", "b", "c"])}),
            ("place_beyond", {"coordinates": rows, "resolution": numpy.float64(1.5e9)}),
            ("labels", {"coordinates": rows, "label": numpy.array([1, 0], "<u2"), **layers}),
            ("label_beyond", {"coordinates": rows, "label": numpy.array([1, 2], "u1"), **layers,
                              "layer_names": numpy.array(["a", "\u20ac\U0001f600"]), "layer_kind": numpy.array(b"object")}),
            ("labels_alone", {"coordinates": rows, "label": numpy.array([-1, 2**40])})):
        data = io.BytesIO()
        with zipfile.ZipFile(data, "w") as archive:
            for key, array in arrays.items():
                values = io.BytesIO()
                numpy.save(values, array)
                archive.writestr(zipfile.ZipInfo(key + ".npy"), values.getvalue())
        yield name + ".npz", data.getvalue()


def vdbs(folder):
    """OpenVDB grids: one leaf, a tile, values, vectors; two in a file, two that share a tree."""
    bools = pyopenvdb.BoolGrid()
    bools.name = "b"
    bools.fill((0, 0, 0), (2, 1, 0), True, True)
    values = pyopenvdb.FloatGrid()
    values.name, values.background = "f", 3.0
    accessor = values.getAccessor()
    for x in range(5):
        accessor.setValueOn((x, 2, 3), x - 2.0)
    tile = pyopenvdb.FloatGrid()
    tile.name, tile.background = "t", 1.0
    tile.fill((0, 0, 0), (127, 127, 127), 0.25, True)
    full = pyopenvdb.BoolGrid()
    full.fill((0, 0, 0), (127, 127, 127), True, True)
    instance = bools.copy()
    instance.name = "i"
    for name, grids in (("bool", [bools]), ("float", [values]), ("tile", [tile]), ("bool_tile", [full]), ("two", [bools, values]),
                        ("instance", [instance, bools]), ("vectors", [pyopenvdb.Vec3SGrid()])):
        pyopenvdb.write(str(folder / "a.vdb"), grids=grids)
        data = (folder / "a.vdb").read_bytes()
        yield name + ".vdb", data + bytes(len(data) % 2)
        if name in ("two", "instance"):  # an odd number of bytes selects grid "b"
            yield name + "_named.vdb", data + bytes(1 - len(data) % 2)
        if name == "bool":               # as written to a stream
            yield name + "_streamed.vdb", data[:20] + b"\0" + data[21:]


def reports(text):
    """Of a bake: as it was, and with all that makes a note on the page; HASH is repaired by the fuzzer."""
    report = json.loads(text) | {"content_hash": "HASH"}
    yield "two_32.json", json.dumps(report).encode()
    counts = {key: 1 for key in report if key.startswith("triangles_")}
    plane_memo = {"asked": 9, "answered": 7, "hits": 5, "computed": 3}
    yield "notes.json", json.dumps(report | counts | {"resumed": True, "quantisation_voxels": 0.75, "cache_hits": 1,
                                                      "plane_memo": plane_memo, "output": "a/<q>&\"\x01.svdag"}).encode()


def main(programs, corpus):
    programs, corpus = pathlib.Path(programs).resolve(), pathlib.Path(corpus).resolve()
    with tempfile.TemporaryDirectory(prefix="svdag-seeds-") as name:
        folder = pathlib.Path(name)

        def svdag(*words):
            subprocess.run([programs / "svdag", *map(str, words), "-q"], cwd=folder, check=True)

        def keep(target, name, data):
            (corpus / f"{target}_fuzz").mkdir(parents=True, exist_ok=True)
            (corpus / f"{target}_fuzz" / name).write_bytes(data)

        stl(folder / "one.stl", [(0, 0, 0, 1, 0, 0, 0, 1, 0)])
        stl(folder / "two.stl", [(0, 0, 0, 9, 0, 1, 0, 7, 0), (0, 5, 8, 3, 3, 3, 9, 9, 1)])
        for scene, grid in (("one.stl", ["-r", "8"]), ("two.stl", ["-r", "32"]), ("two.stl", ["-s", "0.4", "--rule", "thin"])):
            kind = f"{scene[:3]}_{grid[1]}"
            svdag("build", scene, "-o", "a.svdag", *grid)
            for reader in ("svdag", "plain_file"):
                keep(reader, f"{kind}.svdag", (folder / "a.svdag").read_bytes())
            svdag("convert", "a.svdag", "-o", "compact.svdag", "--layout", "compact")
            svdag("pack", "a.svdag", "-o", "a.pack")
            keep("packed", f"{kind}.pack", (folder / "a.pack").read_bytes())
            for reader in ("svdag", "plain_file"):
                keep(reader, f"compact_{kind}.svdag", (folder / "compact.svdag").read_bytes())
            for layout, level, error in (("a", 3, 9), ("compact", 2, 0)):
                subprocess.run([programs / "tests/paint_dag", f"{layout}.svdag", "painted.svdag", str(level), str(error)], cwd=folder, check=True)
                for reader in ("svdag", "plain_file"):
                    keep(reader, f"painted_{layout}_{kind}.svdag", (folder / "painted.svdag").read_bytes())
            svdag("build", scene, "-o", "a.run", *grid, "--part", "1/1")
            keep("run", f"{kind}.run", (folder / "a.run").read_bytes())
            if grid[1] != "8":
                svdag("build", scene, "-o", "part.run", *grid, "--part", "2/3")
                keep("run", f"{kind}_part.run", (folder / "part.run").read_bytes())
            svdag("build", scene, "-o", "b.svdag", *grid, "--cache", f"cache_{kind}", "-j", "1")
            for pack in (folder / f"cache_{kind}").iterdir():
                keep("pack", f"{kind}.cells", pack.read_bytes())
            svdag("plan", scene, "-o", f"plan_{kind}", *grid, "--shards", "1" if grid[1] == "8" else "2")
            plan = folder / f"plan_{kind}"
            svdag("run", plan, "--step", "shard-1")
            parts = [plan / "plan.json", plan / "index", plan / "runs" / "shard-1.json"]
            keep("plan", f"{kind}.plan", b"\n---\n".join(part.read_bytes().replace(str(folder).encode(), b"/work")
                                                     for part in parts))
        layered = ["one.stl", "two.stl", "-r", "16", "--layers", "file"]
        for union in ([], ["--no-union"]):
            kind = "layers" + "".join(union)
            svdag("build", *layered, *union, "-o", "a.svdag")
            svdag("convert", "a.svdag", "-o", "compact.svdag", "--layout", "compact")
            svdag("pack", "a.svdag", "-o", "a.pack")
            keep("packed", f"{kind}.pack", (folder / "a.pack").read_bytes())
            subprocess.run([programs / "svdag-verify", "view", "a.svdag", "--to", kind, "-q"], cwd=folder, check=True)
            tile = (folder / kind / "tiles" / "1").read_bytes()
            keep("tile", f"{kind}.tile", tile)
            keep("tile", f"{kind}.words", gzip.decompress(tile))
            for reader in ("svdag", "plain_file"):
                keep(reader, f"{kind}.svdag", (folder / "a.svdag").read_bytes())
                keep(reader, f"compact_{kind}.svdag", (folder / "compact.svdag").read_bytes())
            svdag("build", *layered, *union, "-o", "a.run", "--part", "2/3")
            keep("run", f"{kind}.run", (folder / "a.run").read_bytes())
        svdag("build", "two.stl", "-o", "a.svdag", "-r", "32", "--exclude", "<q>", "--allow-empty", "--report", "r.json")
        for name, data in reports((folder / "r.json").read_text()):
            keep("report", name, data)
        for name, data in scenes(corpus):
            keep("gltf", name, data)
        svdag("build", "one.stl", "-o", "a.svdag", "-r", "16")
        svdag("export", "a.svdag", "-o", "mask.vdb")
        keep("vdb", "mask.vdb", (folder / "mask.vdb").read_bytes())
        for name, data in vdbs(folder):
            keep("vdb", name, data)
        for name, data in plys():
            keep("ply", name, data)
        for name, data in npzs():
            keep("npz", name, data)
        for name, data in gzips():
            keep("gzip", name, data)
        for name, data in images():
            keep("image", name, data)
        subprocess.run([sys.executable, "-B", pathlib.Path(__file__).resolve().parent.parent / "cli/cut_scene.py", "4"], cwd=folder, check=True)
        keep("gltf", "cut.glb", (folder / "cut.glb").read_bytes())
        foreign_scenes.main(str(folder / "s"))
        for number, name in enumerate(("s.3ds", "s.dae")):
            keep("assimp", name, bytes([number]) + (folder / name).read_bytes())
        keep("fbx", "s_z.fbx", (folder / "s_z.fbx").read_bytes())
        keep("three_mf", "s.3mf", (folder / "s.3mf").read_bytes())
        keep("obj", "long_numbers.obj", b"v 0.12345678901234567 -12345678.87654321 1e-7\nv 1234567890.123456789 .5 -0\n"
             b"v 0.000000000000000001234 99999999999999999999 1.5E+3\nf 1 2 3\n")
    for lattice in (0, 1):
        keep("journal", f"lattice_{lattice}.journal", journal(lattice))


if __name__ == "__main__":
    main(*sys.argv[1:])
