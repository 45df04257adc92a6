#!/usr/bin/env python3
"""Tests that wrong counts in a header, with repaired checksums, are detected by comparing the file with its scene.

Usage: header_test.py BUILD"""
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

PROGRAMS = pathlib.Path(sys.argv.pop(1) if __name__ == "__main__" else ".").resolve()
VOXELS, LARGEST_SNAP = 120, 128  # docs/format.md, "Header"


def run(program, *arguments):
    """The exit code and the output."""
    done = subprocess.run([PROGRAMS / program, *map(str, arguments)], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


class Headers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.scene, self.file = self.folder / "a.ply", self.folder / "a.svdag"
        self.assertEqual(run("svdag-scene", "city", "-n", "1K", "-q", "-o", self.scene)[0], 0)
        self.assertEqual(run("svdag", "build", self.scene, "-r", "64", "-o", self.file, "-q")[0], 0)

    def change_field(self, at, form, change):
        data = bytearray(self.file.read_bytes())
        struct.pack_into(form, data, at, change(struct.unpack_from(form, data, at)[0]))
        self.file.write_bytes(data)
        self.assertEqual(run("tests/repair_file", "svdag", self.file)[0], 0)

    def judges(self, check=True):
        yield from [("mesh",), ("mesh", "--judge", "openvdb")]
        if check:
            yield from [("check",)]

    def expect(self, code, words, check=True):
        for command, *options in self.judges(check):
            scene = [self.scene] if command == "mesh" else []
            with self.subTest(command=command, options=options):
                found, text = run("svdag-verify", command, self.file, *scene, *options)
                self.assertEqual(found, code, text)
                self.assertIn(words, text)

    def test_a_bake_is_ok(self):
        self.expect(0, "ok")

    def test_the_number_of_voxels(self):
        self.change_field(VOXELS, "<Q", lambda voxels: voxels + 1)
        self.expect(1, "the header counts")

    def test_the_largest_snap(self):
        self.change_field(LARGEST_SNAP, "<d", lambda snap: snap / 2)
        self.expect(1, "a largest snap of", check=False)


if __name__ == "__main__":
    unittest.main()
