#!/usr/bin/env python3
"""Tests that no mathematical function of the C library decides a byte: their results differ between libraries and
processors. The objects that decide voxels, colours and files must not call one, and a bake of turning nodes has the same
bytes if the C library is told not to use FMA and AVX2.

Usage: mathematics_test.py BUILD_FOLDER
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
LIBRARIES = ["streaming/libsvdag_streaming.a", "io/libsvdag_io.a", "io/libsvdag_scene.a", "io/libsvdag_dag.a",
             "io/libsvdag_help.a", "io/libsvdag_scene_options.a", "builder/libsvdag_builder.a",
             "builder/libsvdag_commands.a"]
# OpenMesh's headers bring functions that no reader calls; of those that ufbx calls, sine and cosine are ours.
EXEMPT = {"openmesh.cpp.o", "ufbx_math.cpp.o"}
FUNCTION = re.compile(r"(a?(sin|cos|tan)h?|atan2|sincos|pow|exp|exp2|expm1|log|log2|log10|log1p|cbrt|hypot|[lt]gamma)[fl]?")
WITHOUT = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4"}


def calls_of(symbols):
    """Pairs of object and function, from the text of nm."""
    calls, member = set(), ""
    for line in symbols.splitlines():
        if line.endswith(":"):
            member = line[:-1]
        elif line.split()[:1] == ["U"] and FUNCTION.fullmatch(line.split()[1].split("@")[0]):
            calls.add((member, line.split()[1]))
    return calls


def run(*command, **environment):
    return subprocess.run(command, check=True, capture_output=True, text=True, env=os.environ | environment).stdout


class Mathematics(unittest.TestCase):
    def test_no_object_calls_the_c_library(self):
        for library in LIBRARIES:
            with self.subTest(library):
                symbols = run("nm", "--undefined-only", BUILD / library)
                self.assertIn("memcpy", symbols)
                self.assertEqual({call for call in calls_of(symbols) if call[0] not in EXEMPT}, set())

    def test_calls_are_found(self):
        self.assertEqual(calls_of("\na.o:\n         U pow\n         U sinf@GLIBC_2.2.5\n         U powder\n         U ldexp\n"),
                         {("a.o", "pow"), ("a.o", "sinf@GLIBC_2.2.5")})

    def test_same_bytes_without_fma(self):
        with tempfile.TemporaryDirectory(prefix="svdag-mathematics-") as folder:
            os.chdir(folder)
            run(sys.executable, "-B", ROOT / "cli/moving_scene.py", "20")
            for name, environment in (("a", {}), ("b", WITHOUT)):
                run(BUILD / "svdag", "build", "moving.gltf", "-r", "1K", "--frames", "0.1:2.5:0.3", "-q",
                    "-o", f"{name}.svdag", **environment)
            self.assertEqual(pathlib.Path("a.svdag").read_bytes(), pathlib.Path("b.svdag").read_bytes())
            os.chdir("/")

    def test_the_tunable_changes_the_c_library(self):
        if "fma" not in pathlib.Path("/proc/cpuinfo").read_text():
            self.skipTest("the processor has no FMA")
        sines = "import math; print(hash(tuple(math.sin(i / 7) + math.exp(i / 900) for i in range(10**5))))"
        self.assertNotEqual(run(sys.executable, "-c", sines), run(sys.executable, "-c", sines, **WITHOUT))


if __name__ == "__main__":
    unittest.main()
