#!/usr/bin/env python3
"""Sets every count, size and offset of every file format to 0, 1, 2^31, 2^32-1, 2^63 and 2^64-1.

Checksums are recomputed, so the field itself is tested. The program must end within 10 s with one of its exit codes
and one message, never by a signal. It may use 64 MiB, and 16 times the size of the file, more memory than for the valid
file. Each test has a small valid file per format, the fields in it, and the command that reads it. SVDAG_LONG=1 takes
every word of the binary files as a field.
"""
import json
import os
import pathlib
import re
import resource
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "formats"))
import numpy  # noqa: E402
import write_foreign  # noqa: E402

PROGRAMS = pathlib.Path(sys.argv.pop(1) if __name__ == "__main__" else ".").resolve()
CORPUS = pathlib.Path(__file__).resolve().parent.parent / "fuzz" / "corpus"
LONG = bool(os.environ.get("SVDAG_LONG"))
VALUES = [0, 1, 2**31, 2**32 - 1, 2**63, 2**64 - 1]
SECONDS = 10
MIB = 1 << 20
GUARD = 2048 * MIB  # RLIMIT_DATA: ends a huge allocation before the machine swaps


# --- Fields: functions that map a value to the bytes of the changed file.

def put(data, at, width, value):
    return data[:at] + (value & 2**(8 * width) - 1).to_bytes(width, "little") + data[at + width:]


def word(data, at, width):
    return lambda value: put(data, at, width, value)


def words(data, offsets, width=4):
    """Fields of `width` bytes; with SVDAG_LONG, every word."""
    if LONG:
        return [word(data, at, w) for w in (4, 8) for at in range(0, min(len(data) - w, 1200) + 1, 4)]
    return [word(data, at, width) for at in offsets]


def number(text, which):
    """The `which`-th number of a text."""
    at = list(re.finditer(rb"-?\d+", text))[which]
    return lambda value: text[:at.start()] + str(value).encode() + text[at.end():]


def numbers(text, *which):
    return [number(text, w) for w in which]


def varints(data, at, count):
    """`count` LEB128 numbers, starting at byte `at`."""
    fields = []
    for _ in range(count):
        end = at
        while data[end] & 0x80:
            end += 1
        fields.append(lambda value, at=at, end=end + 1: data[:at] + leb128(value & 2**32 - 1) + data[end:])
        at = end + 1
    return fields


def leb128(value):
    out = bytearray()
    while value > 0x7f:
        out.append(value & 0x7f | 0x80)
        value >>= 7
    return bytes(out) + bytes([value])


def leaves(value, path=()):
    """The paths of all integers in a JSON value."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from leaves(inner, path + (key,))
    elif isinstance(value, list):
        for key, inner in enumerate(value):
            yield from leaves(inner, path + (key,))
    elif isinstance(value, int) and not isinstance(value, bool):
        yield path


def json_fields(document, write=lambda text: text):
    def field(path):
        def change(value):
            copy = json.loads(json.dumps(document))
            inner = copy
            for key in path[:-1]:
                inner = inner[key]
            inner[path[-1]] = value
            return write(json.dumps(copy).encode())
        return change
    return [field(path) for path in leaves(document)]


# --- The files.

TRIANGLE = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
PLY_HEAD = ("ply\nformat {} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 1\nproperty list uint uint vertex_indices\nend_header\n")
VOXELS = [(1, 2, 3), (5, 0, 2), (7, 7, 6), (0, 4, 1)]


def gltf():
    """A triangle with sparse positions, plain indices, two instances and an embedded buffer."""
    import base64
    data = TRIANGLE + struct.pack("<3H2xI", 0, 1, 2, 1) + struct.pack("<3f", 1, 0, 1) + struct.pack("<6f", 0, 0, 0, 3, 0, 0)
    view = [(0, 36), (36, 6), (44, 4), (48, 12), (60, 24)]
    return {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "extensionsUsed": ["EXT_mesh_gpu_instancing"],
        "nodes": [{"mesh": 0, "children": [1]},
                  {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 2}}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 4}]}],
        "buffers": [{"byteLength": len(data), "uri": "data:;base64," + base64.b64encode(data).decode()}],
        "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": size, **({"byteStride": 12} if at == 0 else {})}
                        for at, size in view],
        "accessors": [
            {"bufferView": 0, "byteOffset": 0, "componentType": 5126, "count": 3, "type": "VEC3",
             "sparse": {"count": 1, "indices": {"bufferView": 2, "byteOffset": 0, "componentType": 5125},
                        "values": {"bufferView": 3, "byteOffset": 0}}},
            {"bufferView": 1, "byteOffset": 0, "componentType": 5123, "count": 3, "type": "SCALAR"},
            {"bufferView": 4, "byteOffset": 0, "componentType": 5126, "count": 2, "type": "VEC3"}]}


def glb():
    document = gltf()
    import base64
    data = base64.b64decode(document["buffers"][0].pop("uri")[len("data:;base64,"):])
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + len(data)
    return struct.pack("<4sII", b"glTF", 2, total) + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack(
        "<I4s", len(data), b"BIN\0") + data, [4, 8, 12, 16, 20 + len(text), 24 + len(text)]


def scenes():
    """(name, file, fields) of every scene format."""
    ascii_ply = (PLY_HEAD.format("ascii") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").encode()
    yield "a.ply", ascii_ply, [number(ascii_ply, w) for w in (2, 3, 13, 14)]
    head = PLY_HEAD.format("binary_little_endian").encode()
    binary = head + TRIANGLE + struct.pack("<4I", 3, 0, 1, 2)
    yield "b.ply", binary, numbers(binary, 2, 3) + words(binary, [len(head) + 36 + 4 * i for i in range(4)])
    stl = bytes(80) + struct.pack("<I", 1) + bytes(12) + TRIANGLE + bytes(2)
    yield "a.stl", stl, words(stl, [80])
    off = b"OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    yield "a.off", off, numbers(off, 0, 1, 2, -4, -3, -2, -1)
    obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"
    negative = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n"
    yield "a.obj", obj, numbers(obj, *range(-6, 0))
    yield "b.obj", negative, numbers(negative, -3, -2, -1)
    document = gltf()
    yield "a.gltf", json.dumps(document).encode(), json_fields(document)
    data, places = glb()
    yield "a.glb", data, [word(data, at, 4) for at in places]
    for name, count in (("sequential_0", 2), ("edgebreaker_0", 0), ("edgebreaker_11", 0)):
        drc = (CORPUS / "draco_fuzz" / f"tetrahedron_{name}.drc").read_bytes()
        # After an 11-byte header: faces, points; or kind of traversal, vertices, faces, seams, symbols, splits.
        fields = varints(drc, 11, 2) if count else varints(drc, 12, 2) + varints(drc, 15, 2)
        yield f"{name}.drc", drc, fields + ([word(drc, at, 4) for at in range(11, len(drc) - 3)] if LONG else [])


def openmesh():
    """A header with the numbers of vertices, faces and edges, then chunks of 5 points, of halfedges, of vertices and of
    faces, each with a two-byte type."""
    om = (CORPUS / "openmesh_fuzz" / "double.om").read_bytes()
    halfedges = 18 + 5 * 24
    return om, words(om, [4, 8, 12, *range(halfedges + 2, 176, 4)]) + words(om, [16, halfedges, 176, 184], 2)


class Vdb:
    """Parses a .vdb of one mask grid and records the offsets of its counts, lengths and offsets."""

    def __init__(self, data):
        self.data, self.at, self.places, self.types = data, 0, [], set()
        self.skip(8)                             # magic number
        for _ in range(3):                       # versions of the format and of the library
            self.number()
        self.skip(1 + 36)                        # flag for offsets, unique name
        self.metadata()
        self.number()                            # grids
        for _ in range(3):                       # name, type, name of the grid that it instances
            self.skip(self.number())
        assert self.number(8) == self.at + 16, "the grid begins behind its offsets"
        for _ in range(2):
            self.number(8)
        self.number()                            # compression
        self.metadata()
        self.skip(self.number())                 # type of the transform
        self.skip(15 * 8)                        # its 15 doubles
        self.number()                            # buffers
        self.skip(1)                             # background
        for _ in range(2 + 3):                   # tiles and nodes of the root, origin of the first node
            self.number()
        for _ in range(2):                       # its masks: nodes, tiles
            self.number(8)
            self.skip(32**3 // 8 - 8)
        for back in (12, 8, 4):                  # origin of the last leaf
            self.places.append((len(data) - back, 4))

    def number(self, width=4):
        self.places.append((self.at, width))
        self.at += width
        return int.from_bytes(self.data[self.at - width:self.at], "little")

    def skip(self, count):
        self.at += count

    def text(self):
        length = self.number()
        self.skip(length)
        return self.data[self.at - length:self.at]

    def metadata(self):
        for _ in range(self.number()):
            before = len(self.places)
            self.text()
            kind = self.text()
            self.skip(self.number())
            if kind in self.types:               # one field per type is enough
                del self.places[before:]
            self.types.add(kind)

    def fields(self):
        return [word(self.data, at, width) for at, width in self.places]


def foreign():
    data = write_foreign.hashdag(VOXELS, 3)
    yield "a.basic_dag.dag.bin", data, words(data, [48, *range(60, len(data) - 3, 4)]) + words(data, [52], 8)
    data = write_foreign.symvox(VOXELS, 3)
    yield "a.svdag", data, words(data, range(28, len(data) - 3, 4))
    data = write_foreign.transform_dag(VOXELS, 4)
    yield "a.svo", data, words(data, [0, 4, len(data) - 12, len(data) - 8, len(data) - 4]) + words(
        data, range(8, len(data) - 20, 8), 8)
    dense = numpy.zeros((4, 4, 4), bool)
    dense[1, 2, 3] = True
    data = write_foreign.binvox(dense)
    yield "a.binvox", data, [number(data, w) for w in (1, 2, 3)] + [
        word(data, len(data) - back, 1) for back in range(1, 7)]
    data = write_foreign.vox((VOXELS, (8, 8, 8)), places=[(1, 2, 3)])
    yield "a.vox", data, words(data, range(4, min(len(data), 380) - 3, 4))
    data = write_foreign.npz(coords=numpy.array(VOXELS, "<i4"), label=numpy.array([0, 1, 1, 0], "<u2"),
                             layer_names=numpy.frombuffer(b"a\0b\0", "u1"), layer_colours=numpy.array([1, 2], "<u4"))
    directory = data.index(b"PK\1\2")
    end = data.index(b"PK\5\6")
    shape = [m for m in re.finditer(rb"\d+", data) if b"'shape'" in data[max(0, m.start() - 12):m.start()]]
    fields = [number_at(data, m) for m in shape]
    fields += [word(data, at, w) for at, w in (
        (18, 4), (22, 4), (26, 2), (28, 2), (directory + 20, 4), (directory + 24, 4), (directory + 28, 2),
        (directory + 30, 2), (directory + 42, 4), (end + 8, 2), (end + 10, 2), (end + 12, 4), (end + 16, 4))]
    yield "a.npz", data, fields


def number_at(data, match):
    """A field that keeps its width, because the length of the header precedes it."""
    width = match.end() - match.start()
    return lambda value: data[:match.start()] + str(value).encode()[:width].ljust(width, b"0") + data[match.end():]


# --- Running.

class Result:
    def __init__(self, code, text, memory):
        self.code, self.text, self.memory = code, text, memory


def run(command, cwd):
    """Exit code (negative: a signal), standard error, and peak memory in bytes."""
    def limit():
        resource.setrlimit(resource.RLIMIT_DATA, (GUARD, GUARD))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(["timeout", "-s", "KILL", str(SECONDS), *map(str, command)], cwd=cwd, preexec_fn=limit,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        return Result(process.returncode, errors.read().decode("utf-8", "replace"), usage.ru_maxrss * 1024)


class HostileCounts(unittest.TestCase):
    fields = runs = 0
    largest = 0

    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory(prefix="svdag-hostile-")
        cls.folder = pathlib.Path(cls.holder.name)
        (cls.folder / "scene.stl").write_bytes(bytes(80) + struct.pack("<I", 1) + bytes(12) + TRIANGLE + bytes(2))

    @classmethod
    def tearDownClass(cls):
        cls.holder.cleanup()
        print(f"{HostileCounts.fields} fields x {len(VALUES)} values, {HostileCounts.runs} runs; "
              f"{HostileCounts.largest / MIB:.1f} MiB at most more than for the valid file", file=sys.stderr)

    def svdag(self, *words):
        done = subprocess.run([PROGRAMS / "svdag", *map(str, words)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def judge(self, path, data, fields, command, repair=None, prepare=lambda: None,
              is_behind_checksums=lambda answer: answer.text and "checksum" not in answer.text):
        """Runs `command`, which reads `path`, with each field of `data` changed."""
        def write(content):
            prepare()
            path.write_bytes(content)
            if repair:
                subprocess.run([PROGRAMS / "tests" / "repair_file", repair, path], check=True)
        write(data)
        base = run(command, self.folder)
        self.assertEqual((base.code, base.text), (0, ""), f"{path.name}, valid")
        self.assertGreater(len(fields), 0)
        behind = 0
        for which, field in enumerate(fields):
            HostileCounts.fields += 1
            # A narrow field takes some values alike.
            contents = {field(value): value for value in reversed(VALUES)}
            contents.pop(data, None)
            for content, value in contents.items():
                write(content)
                answer = run(command, self.folder)
                behind += bool(is_behind_checksums(answer))
                self.check(f"{path.name}, field {which} = {value}", answer, base, len(data))
        self.assertGreater(behind, 0, "no changed field passed the checksums")

    def check(self, what, answer, base, size):
        HostileCounts.runs += 1
        with self.subTest(what):
            self.assertIn(answer.code, (0, 2, 3, 4, 5), answer.text)
            if answer.code != 0:
                self.assertEqual(answer.text.strip().count("\n"), 0, answer.text)
                self.assertRegex(answer.text, r"^[\w-]+: .")
            more = answer.memory - base.memory
            HostileCounts.largest = max(HostileCounts.largest, more)
            self.assertLessEqual(more, 16 * size + 64 * MIB, answer.text)

    def test_scenes(self):
        for name, data, fields in scenes():
            path = self.folder / name
            self.judge(path, data, fields, [PROGRAMS / "svdag", "build", path, "-o", "out.svdag", "-r", "8", "-q",
                                            "-j", "1", "--restart"])

    def test_hostile_scenes_of_the_corpora(self):
        base = run([PROGRAMS / "svdag", "build", "scene.stl", "-o", "out.svdag", "-r", "8", "-q"], self.folder)
        for file in sorted([*(CORPUS / "draco_fuzz").glob("hostile*"), *(CORPUS / "gltf_fuzz").glob("hostile*")]):
            answer = run([PROGRAMS / "svdag", "build", file, "-o", "out.svdag", "-r", "8", "-q"], self.folder)
            self.assertEqual(answer.code, 3, file)
            self.check(file.name, answer, base, file.stat().st_size)

    def test_foreign_formats(self):
        for name, data, fields in foreign():
            path = self.folder / name
            self.judge(path, data, fields, [PROGRAMS / "svdag", "import", path, "-o", "imported.svdag", "-q"])

    def test_openmesh(self):
        data, fields = openmesh()
        path = self.folder / "a.om"
        path.write_bytes(data)
        command = [PROGRAMS / "svdag", "build", path, "-o", "out.svdag", "-r", "8", "-q", "-j", "1", "--restart"]
        self.skip_if_rejected("cannot read", command)
        self.judge(path, data, fields, command)

    def test_vdb(self):
        self.svdag("build", "scene.stl", "-o", "grid.svdag", "-r", "16", "-q")
        path = self.folder / "a.vdb"
        self.skip_if_rejected("built without OpenVDB", [PROGRAMS / "svdag", "export", "grid.svdag", "-o", path, "-q"])
        data = path.read_bytes()
        fields = words(data, []) if LONG else Vdb(data).fields()
        self.judge(path, data, fields, [PROGRAMS / "svdag", "import", path, "-o", "imported.svdag", "-q"])

    def skip_if_rejected(self, sentence, command):
        answer = run(command, self.folder)
        if sentence in answer.text:
            self.skipTest(answer.text)

    def test_dags(self):
        self.svdag("build", "scene.stl", "-o", "own.svdag", "-r", "16", "-q")
        data = (self.folder / "own.svdag").read_bytes()
        fields = words(data, [8, 12, 16, 20, 24, 28, 88, 92, 96, 108]) + [
            word(data, at, 8) for at in [*range(120, 176 + 24 * 4, 8), 1024, 1088]]
        self.judge(self.folder / "own.svdag", data, fields, [PROGRAMS / "svdag", "info", "own.svdag"], "svdag")

    def test_runs(self):
        self.svdag("build", "scene.stl", "-o", "own.run", "-r", "16", "--part", "1/1", "-q")
        data = (self.folder / "own.run").read_bytes()
        fields = words(data, [8, 12, 16, 20, 24, 28, 88, 92, 96, 108]) + [
            word(data, at, 8) for at in [*range(120, 344, 8), *range(1024 + 64, len(data) - 7, 8 if LONG else 64)]]
        self.judge(self.folder / "own.run", data, fields,
                   [PROGRAMS / "svdag", "merge", "own.run", "-o", "merged.svdag", "-q"], "run")

    def test_packs(self):
        command = ["build", "scene.stl", "-o", "cached.svdag", "-r", "16", "--cache", "cache", "-q", "-j", "1", "--report",
                   "report.json"]
        self.svdag(*command)
        pack = next((self.folder / "cache").iterdir())
        data = pack.read_bytes()
        entry = len(data) - 8 - 48  # the last entry, followed by the checksum of the only block
        fields = [word(data, at, 8) for at in [*range(16, 16 + 21 * 8, 8), 184, 192, 256, entry + 32]]
        fields += [word(data, at, 4) for at in (8, entry + 40, entry + 44)]
        self.judge(pack, data, fields, [PROGRAMS / "svdag", *command], "pack", prepare=self.empty_cache,
                   is_behind_checksums=lambda _: '"cache_hits": 1' in (self.folder / "report.json").read_text())

    def empty_cache(self):
        for file in (self.folder / "cache").iterdir():
            file.unlink()

    def test_plans(self):
        self.svdag("plan", "scene.stl", "-o", "plan", "-r", "16", "--shards", "1", "-q")
        plan = self.folder / "plan"
        path, text = plan / "plan.json", (plan / "plan.json").read_bytes()
        command = [PROGRAMS / "svdag", "run", "plan", "--step", "shard-1", "-q"]
        def delete_runs():
            for file in (plan / "runs").glob("*"):
                file.unlink()
        self.judge(path, text, json_fields(json.loads(text)), command, "plan", prepare=delete_runs)
        index, data = plan / "index", (plan / "index").read_bytes()
        for which, at in enumerate(range(0, len(data) - 7, 8)):
            HostileCounts.fields += 1
            for value in VALUES:
                delete_runs()
                changed = put(data, at, 8, value)
                index.write_bytes(changed)
                right, hashes = re.subn(rb'"index_hash": "\w+"', b'"index_hash": "%s"' % hash_of(changed), text)
                self.assertEqual(hashes, 1)
                path.write_bytes(right)
                subprocess.run([PROGRAMS / "tests" / "repair_file", "plan", path], check=True)
                answer = run(command, self.folder)
                self.check(f"index, word {which} = {value}", answer, Result(0, "", 8 * MIB), len(data))


def hash_of(data):
    import xxhash
    return xxhash.xxh3_128_hexdigest(data).encode()


if __name__ == "__main__":
    unittest.main()
