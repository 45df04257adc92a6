#!/usr/bin/env python3
"""Runs the commands of README.md and docs/commands.md, the program of README.md and the messages of docs/limits.md;
checks links and pictures.

Each command of a ```sh block is run, in order, in one folder per page; the comment "# exit N" names an exit code
other than 0. The test generates small scenes with the names that the pages use, and reduces grids and pictures
(shrink()). A block after a line "<!-- not run: WHY -->" is skipped.
"""
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest

import numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release").resolve()
SCENES = {"city.ply": "city", "hall.ply": "atrium", "props.ply": "speck", "scan.ply": "scan"}
TRIANGLES = {"city": "6K", "atrium": "90K", "speck": "2K", "scan": "20K"}
PICTURE_BYTES, ALL_PICTURES_BYTES = 400_000, 2_000_000


def blocks(page):
    """(line number, text) of the ```sh blocks to run."""
    text = page.read_text()
    for found in re.finditer(r"(<!-- not run: .+? -->\n)?^```sh\n(.*?)^```$", text, re.M | re.S):
        if not found.group(1):
            yield text.count("\n", 0, found.start(2)) + 1, found.group(2)


def commands(page):
    """(line number, command); open quotes and a backslash at the end continue on the next line."""
    for number, text in blocks(page):
        command, first = "", number
        for line in text.splitlines():
            command += line
            quotes = re.sub(r"\s#.*$", "", command, flags=re.S).count("'")
            if line.endswith("\\") or quotes % 2:
                command += "\n"
            elif command.strip():
                yield first, command
                command = ""
            if not command:
                first = number + 1
            number += 1


def shrink(command):
    """The command with smaller grids (above 1K) and pictures (of no given size), to save time; the viewer as a folder."""
    command = re.sub(r"-r (?:[2-9]|\d\d+)K", "-r 512", command)
    command = re.sub(r"(svdag-verify view [\w.]+)(?!.*--to)", r"\1 --to page", command)
    return re.sub(r"(svdag-verify (?:render|report) )(?!.*--size)", r"\1--size 64x36 ", command)


def write_glb(ply, path):
    """Converts a binary PLY of svdag-scene to a GLB with one mesh."""
    head, body = ply.read_bytes().split(b"end_header\n", 1)
    vertices, faces = (int(n) for n in re.findall(rb"element \w+ (\d+)", head))
    indices = numpy.frombuffer(body, [("n", "u1"), ("v", "<i4", 3)], faces, vertices * 12)["v"]
    points = numpy.frombuffer(body, "<f4", vertices * 3).reshape(-1, 3)
    data = points.tobytes() + indices.astype("<u4").tobytes()
    bounds = {"min": points.min(0).tolist(), "max": points.max(0).tolist()}
    text = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "buffers": [{"byteLength": len(data)}],
        "bufferViews": [{"buffer": 0, "byteLength": vertices * 12},
                        {"buffer": 0, "byteOffset": vertices * 12, "byteLength": faces * 12}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": vertices, "type": "VEC3", **bounds},
                      {"bufferView": 1, "componentType": 5125, "count": faces * 3, "type": "SCALAR"}]}).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A) + text +
                     struct.pack("<II", len(data), 0x004E4942) + data)


def run(command, folder):
    return subprocess.run(["sh", "-e", "-c", command], cwd=folder, env=dict(os.environ, PATH=f"{BUILD}:/usr/bin:/bin", LC_ALL="C"),
                          timeout=120, stdin=subprocess.DEVNULL, capture_output=True, text=True)


class Documents(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="svdag-docs-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def make_scenes(self):
        for name, kind in SCENES.items():
            subprocess.run([BUILD / "svdag-scene", kind, "-n", TRIANGLES[kind], "-q", "-o", self.folder / name], check=True)
        write_glb(self.folder / "city.ply", self.folder / "city.glb")

    def run_page(self, page):
        self.make_scenes()
        ran = 0
        for line, command in commands(page):
            expected = re.search(r"# exit (\d+)", command)
            with self.subTest(f"{page.name}:{line}: {command}"):
                done = run(shrink(command), self.folder)
                self.assertEqual(done.returncode, int(expected.group(1)) if expected else 0, done.stdout + done.stderr)
            ran += 1
        return ran

    def test_limits_are_reported_as_the_page_says(self):
        page = ROOT / "docs" / "limits.md"
        self.make_scenes()
        for _, command in commands(page):
            self.assertEqual(run(command, self.folder).returncode, 0, command)
        rows = re.findall(r"^\| .+? \| `(svdag .+?)` \| `(.+?)` \| (\d) \|$", page.read_text(), re.M)
        self.assertGreater(len(rows), 7)
        for command, message, code in rows:
            with self.subTest(command):
                done = run(command, self.folder)
                self.assertEqual(done.returncode, int(code), done.stderr)
                self.assertRegex(done.stderr, "^svdag: (.*: )?" + re.escape(message).replace("…", ".+") + "$")

    def test_commands_of_the_tour_run(self):
        self.assertGreater(self.run_page(ROOT / "docs" / "commands.md"), 30)

    def test_commands_of_the_readme_run(self):
        self.assertGreater(self.run_page(ROOT / "README.md"), 5)

    def test_the_reader_of_the_readme_compiles_and_reads(self):
        source = re.search(r"^```cpp\n(.*?)^```$", (ROOT / "README.md").read_text(), re.M | re.S)[1]
        (self.folder / "svdag").symlink_to(ROOT)
        (self.folder / "ramp.obj").write_text("v 0 0 0\nv 0 0 9\nv 9 7 0\nv 9 7 9\nf 1 2 3\nf 2 4 3\n")
        (self.folder / "read.cpp").write_text(source)
        done = run("g++ -std=c++17 -I. read.cpp -o read; svdag build ramp.obj -o ramp.svdag -r 64 -q; ./read ramp.svdag", self.folder)
        self.assertAlmostEqual(int(done.stdout), 32 * 7 / 9, delta=1)

    def test_the_tour_uses_every_command(self):
        tour = " ".join(command for _, command in commands(ROOT / "docs" / "commands.md"))
        for program in ("svdag", "svdag-verify"):
            help_text = subprocess.run([BUILD / program, "--help"], capture_output=True, text=True, check=True).stdout
            names = re.findall(r"^  ([a-z]+) {2,}", re.search(r"^Commands:\n(.+?)\n\n", help_text, re.M | re.S)[1], re.M)
            self.assertGreater(len(names), 5)
            missing = [name for name in names if f"{program} {name} " not in tour and name != "help"]
            self.assertEqual(missing, [], program)

    def test_links_are_valid(self):
        for page in [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]:
            for link in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text()):
                if not link.startswith("http"):
                    self.assertTrue((page.parent / link).exists(), f"{page.name}: {link}")

    def test_the_index_names_every_page(self):
        index = (ROOT / "docs" / "README.md").read_text()
        for page in (ROOT / "docs").glob("*.md"):
            if page.name != "README.md":
                self.assertIn(f"({page.name})", index)

    def test_pictures_are_small(self):
        sizes = {p.name: p.stat().st_size for p in (ROOT / "docs" / "images").iterdir()}
        self.assertEqual([name for name, size in sizes.items() if size > PICTURE_BYTES], [])
        self.assertLess(sum(sizes.values()), ALL_PICTURES_BYTES)


if __name__ == "__main__":
    unittest.main()
