#!/usr/bin/env python3
"""Tests that --sandbox gives the same bytes, messages and exit codes."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()
CORPUS = pathlib.Path(__file__).resolve().parent.parent.parent / "fuzz" / "corpus"
FILES = sorted(f for name in ("draco_fuzz", "openmesh_fuzz", "gltf_fuzz") for f in (CORPUS / name).glob("*.*"))


class Sandbox(unittest.TestCase):
    def build(self, folder, scene, *options):
        output = pathlib.Path(folder) / "out.svdag"
        output.unlink(missing_ok=True)
        done = subprocess.run([PROGRAMS / "svdag", "build", scene, "-o", output, "-r", "64", "-q", *options],
                              capture_output=True, text=True, timeout=60)
        return done.returncode, done.stderr, output.read_bytes() if output.exists() else b""

    def test_scenes_give_the_same_bytes_or_the_same_error(self):
        baked = refused = 0
        with tempfile.TemporaryDirectory(prefix="svdag-sandbox-") as folder:
            for scene in FILES:
                with self.subTest(scene=scene.name):
                    plain = self.build(folder, scene)
                    self.assertEqual(self.build(folder, scene, "--sandbox"), plain)
                    self.assertIn(plain[0], (0, 3))
                    baked += plain[0] == 0
                    refused += plain[0] == 3
        self.assertGreater(baked, 3)
        self.assertGreater(refused, 3)

    def test_info_reads_in_it_too(self):
        scene = CORPUS / "draco_fuzz" / "tetrahedron_sequential_11.drc"
        answers = [subprocess.run([PROGRAMS / "svdag", "info", scene, *options], capture_output=True, text=True)
                   for options in ([], ["--sandbox"])]
        self.assertEqual(answers[0].stdout, answers[1].stdout)
        self.assertIn("4 triangles", answers[0].stdout)


if __name__ == "__main__":
    unittest.main()
