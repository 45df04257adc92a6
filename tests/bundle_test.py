#!/usr/bin/env python3
"""Tests that the bundle (`make bundle`) is relocatable: it needs only libc from the system and bakes the same bytes.

Usage: bundle_test.py BUILD. The bundle of the finished build is installed into a temporary folder, moved, and run from
a third folder.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release").resolve()
OF_LIBC = r"(linux-vdso|.*/?ld-linux-x86-64|lib(c|m|dl|rt|pthread))\.so"


class Bundle(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="svdag-bundle-")
        root = pathlib.Path(cls.folder.name)
        subprocess.run(["cmake", "--install", BUILD, "--component", "bundle", "--strip", "--prefix", "made"], cwd=root,
                       check=True, stdout=subprocess.DEVNULL)  # a relative prefix, as in make bundle
        cls.bundle = (root / "made").rename(root / "moved")
        cls.away = root / "away"
        cls.away.mkdir()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_bundled(self, *command):
        environment = dict(os.environ, LD_LIBRARY_PATH="", LC_ALL="C")
        done = subprocess.run(command, cwd=self.away, env=environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_holds_the_programs_and_their_libraries(self):
        self.assertEqual(sorted(p.name for p in (self.bundle / "bin").iterdir()), ["svdag", "svdag-export", "svdag-import", "svdag-scene", "svdag-trace", "svdag-verify"])
        names = [p.name for p in (self.bundle / "lib").iterdir()]
        self.assertTrue([n for n in names if n.startswith("libstdc++.so")], names)
        self.assertEqual([n for n in names if re.match(OF_LIBC, n)], [])

    def test_contains_the_licences_of_its_libraries(self):
        found = {p.parent.name for p in (self.bundle / "share/doc").glob("*/copyright") if p.stat().st_size > 0}
        self.assertLessEqual({"libstdc++6", "libxxhash0", "libcli11-dev", "nlohmann-json3-dev", "libglm-dev"}, found)
        self.assertRegex(" ".join(found), r"libboost[0-9.]+-dev")

    def test_contains_its_manual(self):
        shown = self.run_bundled("man", "-M", self.bundle / "share" / "man", "svdag-build") if shutil.which("man") else \
            (self.bundle / "share/man/man1/svdag-build.1").read_text()
        self.assertIn("Bake scene files as one .svdag", shown)
        self.assertTrue((self.bundle / "share/bash-completion/completions/svdag").exists())
        self.assertTrue((self.bundle / "share/doc/svdag/docs/farm.md").exists())

    def test_only_libc_is_loaded_from_outside(self):
        for program in (self.bundle / "bin").iterdir():
            found = self.run_bundled("ldd", program).splitlines()
            self.assertGreater(len(found), 3)
            outside = [line.strip() for line in found if not re.match(OF_LIBC, line.strip())
                       and f"=> {self.bundle / 'bin'}/../lib/" not in line]
            self.assertEqual(outside, [], program.name)

    def test_bakes_the_same_bytes_and_verifies_them(self):
        programs = self.bundle / "bin"
        self.run_bundled(programs / "svdag-scene", "city", "-n", "6K", "-q", "-o", "city.ply")
        self.run_bundled(programs / "svdag", "build", "city.ply", "-r", "512", "-q", "-o", "bundled.svdag")
        subprocess.run([BUILD / "svdag", "build", "city.ply", "-r", "512", "-q", "-o", "built.svdag"], cwd=self.away, check=True)
        self.assertEqual((self.away / "bundled.svdag").read_bytes(), (self.away / "built.svdag").read_bytes())
        self.run_bundled(programs / "svdag-verify", "check", "bundled.svdag")
        self.run_bundled(programs / "svdag-trace", "bundled.svdag", "--size", "32x32", "--samples", "4")

    def test_svdag_does_not_load_libraries_of_exports(self):
        self.assertNotIn("openvdb", self.run_bundled("ldd", self.bundle / "bin" / "svdag"))
        self.assertNotIn("tbb", self.run_bundled("ldd", self.bundle / "bin" / "svdag"))

    def test_export_finds_its_program(self):
        programs = self.bundle / "bin"
        self.run_bundled(programs / "svdag-scene", "city", "-n", "6K", "-q", "-o", "export.ply")
        self.run_bundled(programs / "svdag", "build", "export.ply", "-r", "128", "-q", "-o", "export.svdag")
        self.run_bundled(programs / "svdag", "export", "export.svdag", "-q", "-o", "export.vdb")
        self.run_bundled(programs / "svdag-verify", "vdb", "export.svdag", "export.vdb")


if __name__ == "__main__":
    unittest.main()
