#!/usr/bin/env python3
"""Tests the development files of `cmake --install` in other projects, and the Debian packages.

BUILD is the folder of a finished build; all other files are in a temporary folder.
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

BUILD = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release").resolve()
READER = pathlib.Path(__file__).resolve().parent / "reader"
ROOT = READER.parents[2]


def run(*command, folder=None):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, f"{command}: {done.stdout}{done.stderr}"
    return done.stdout


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="svdag-package-")
        cls.root = pathlib.Path(cls.folder.name)
        run(BUILD / "svdag-scene", "city", "-n", "6K", "-q", "-o", cls.root / "city.ply")
        cls.file = cls.root / "city.svdag"
        run(BUILD / "svdag", "build", cls.root / "city.ply", "-r", "256", "-q", "-o", cls.file)
        info = json.loads(run(BUILD / "svdag", "info", "--json", cls.file))
        cls.counts = [str(info["resolution"]), str(info["voxels"])]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def install(self):
        prefix = self.root / "prefix"
        for component in ("programs", "development"):
            run("cmake", "--install", BUILD, "--component", component, "--prefix", prefix)
        return prefix

    def test_another_project_reads_a_file_with_find_package(self):
        prefix, build = self.install(), self.root / "reader"
        run("cmake", "-G", "Ninja", "-S", READER, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}")
        run("cmake", "--build", build)
        self.assertEqual(run(build / "count_voxels", self.file).split(), self.counts)
        info = json.loads(run(BUILD / "svdag", "info", "--json", self.file))
        x, y, z = info["grid"]["corner"]
        size, n = info["grid"]["voxel_size"], info["resolution"]
        above = [str(x + (n / 2 + 0.5) * size), str(y + 2 * n * size), str(z + (n / 2 + 0.5) * size)]
        ray = run(build / "cast_ray", self.file, *above, "0", "-1", "0")
        found = re.fullmatch(r"voxel (\d+) (\d+) (\d+) at t = (\S+), point (\S+) (\S+) (\S+)\n", ray)
        self.assertTrue(found, ray)
        voxel = [int(v) for v in found.groups()[:3]]
        self.assertEqual((voxel[0], voxel[2]), (n // 2, n // 2))
        self.assertAlmostEqual(float(found.group(4)), (2 * n - voxel[1] - 1) * size, delta=1e-4 * n * size)
        centre = " ".join(str(c + (v + 0.5) * size) for c, v in zip((x, y, z), voxel))
        queried = subprocess.run([BUILD / "svdag", "query", self.file], input=centre, capture_output=True, text=True)
        self.assertIn("set", queried.stdout)
        self.assertNotIn("empty", queried.stdout)

    def test_the_view_needs_a_compiler_and_nothing_else(self):
        program, prefix = self.root / "mapped", self.install()
        run("g++", "-std=c++17", "-O1", f"-I{prefix}/include", READER / "mapped.cpp", "-o", program)
        self.assertEqual(run(program, self.file).split(), self.counts)

    def test_a_truncated_file_is_an_error_of_the_view(self):
        program, prefix = self.root / "truncated", self.install()
        run("g++", "-std=c++17", "-O1", f"-I{prefix}/include", READER / "mapped.cpp", "-o", program)
        compact, part = self.root / "compact.svdag", self.root / "part.svdag"
        run(BUILD / "svdag", "convert", self.file, "--layout", "compact", "-q", "-o", compact)
        self.assertEqual(run(program, compact).split(), self.counts)
        for data in (self.file.read_bytes(), compact.read_bytes()):
            for size in (0, 8, 1023, 1024, 4096, len(data) // 2, len(data) - 8):
                part.write_bytes(data[:size])
                done = subprocess.run([program, part], capture_output=True, text=True)
                expected = "is shorter than a header" if size < 1024 else "is truncated"
                self.assertEqual((done.returncode, done.stderr.strip()), (3, expected), size)
            short = bytearray(data)  # of the length that the header says, but its sections are beyond
            short[168:176] = struct.pack("<Q", 2048)
            part.write_bytes(short[:2048])
            done = subprocess.run([program, part], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr.strip()), (3, "has a section outside of the file"))

    def test_the_program_of_the_engine_page_runs(self):
        prefix, source, build = self.install(), self.root / "engine", self.root / "engine_build"
        source.mkdir()
        page = (ROOT / "docs" / "engine.md").read_text()
        (source / "engine.cpp").write_text(re.search(r"^```cpp\n(.*?)^```$", page, re.M | re.S)[1])
        (source / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(engine LANGUAGES CXX)\n"
                                               + re.search(r"^```cmake\n(.*?)^```$", page, re.M | re.S)[1])
        run("cmake", "-G", "Ninja", "-S", source, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}")
        run("cmake", "--build", build)
        (self.root / "red.mtl").write_text("newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n")
        (self.root / "red.obj").write_text("mtllib red.mtl\nv 0 0 0\nv 0 0 9\nv 9 0 0\nv 9 0 9\nv 0 3 0\nv 0 3 9\nv 4 3 0\n"
                                           "usemtl blue\nf 1 2 3\nf 2 4 3\nusemtl red\nf 5 6 7\n")
        run(BUILD / "svdag", "build", self.root / "red.obj", "-r", "64", "-q", "--colours", "--layers", "material",
            "-o", self.root / "red.svdag")
        self.assertRegex(run(build / "engine", self.root / "red.svdag", "1", "9", "1"), r"^red, #ff0000, 5\.9\d* below\n$")
        self.assertRegex(run(build / "engine", self.root / "red.svdag", "8", "9", "1"), r"^blue, #0000ff, 8\.[89]\d* below\n$")
        run(BUILD / "svdag", "build", self.root / "red.obj", "-r", "64", "-q", "-o", self.root / "plain.svdag")
        self.assertRegex(run(build / "engine", self.root / "plain.svdag", "1", "9", "1"), r"^no layer, 5\.9\d* below\n$")
        done = subprocess.run([build / "engine", self.root / "none.svdag", "1", "9", "1"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (1, ""))

    def test_view_and_format_side_by_side_need_no_include_path(self):
        prefix, alone = self.install(), self.root / "side_by_side"
        alone.mkdir()
        for header in ("dag_view.h", "compact_view.h", "format.h"):
            (alone / header).write_text((prefix / "include" / "svdag" / "io" / "dag" / header).read_text())
        source = (READER / "mapped.cpp").read_text().replace("<svdag/io/dag/dag_view.h>", '"dag_view.h"')
        (alone / "mapped.cpp").write_text(source)
        run("g++", "-std=c++17", "-O1", alone / "mapped.cpp", "-o", alone / "mapped")
        self.assertEqual(run(alone / "mapped", self.file).split(), self.counts)

    def test_every_header_compiles_alone(self):
        include, source = self.install() / "include" / "svdag", self.root / "alone.cpp"
        headers = sorted(path.relative_to(include.parent) for path in include.rglob("*.h"))
        self.assertGreater(len(headers), 30)
        for header in headers:
            source.write_text(f'#include "{header}"\n')
            run("g++", "-std=c++20", "-fsyntax-only", f"-I{include.parent}", source)

    def test_find_package_without_REQUIRED_does_not_fail(self):
        source, prefix = self.root / "optional", self.install()
        source.mkdir()
        (source / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(optional LANGUAGES CXX)\n"
                                               "find_package(svdag QUIET)\nmessage(STATUS \"found ${svdag_FOUND}\")\n")
        configure = ["cmake", "-S", source, "-B", self.root / "optional_build", f"-DCMAKE_PREFIX_PATH={prefix}"]
        without_xxhash = ["env", "PKG_CONFIG_LIBDIR=/nonexistent"]
        self.assertIn("found 0", run(*without_xxhash, *configure))
        self.assertIn("found 1", run(*configure))

    def test_installed_programs_run(self):
        program = self.install() / "bin" / "svdag-verify"
        self.assertIn("ok", run(program, "check", self.file))

    def test_a_project_that_contains_this_one_finds_its_headers(self):
        source, build = self.root / "holder", self.root / "holder_build"
        source.mkdir()
        (source / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(holder LANGUAGES CXX)\n"
            f"add_subdirectory({ROOT} svdag)\nadd_executable(mapped {READER}/mapped.cpp)\n"
            "target_link_libraries(mapped PRIVATE svdag_dag_view)\n")
        without = [f"-DSVDAG_{option}=OFF" for option in ("DRACO", "OPENMESH", "CGAL", "OPENVDB", "EMBREE")]
        run("cmake", "-G", "Ninja", "-S", source, "-B", build, *without)
        run("cmake", "--build", build, "--target", "mapped")
        self.assertEqual(run(build / "mapped", self.file).split(), self.counts)
        self.assertFalse((build / "CPackConfig.cmake").exists(), "packaging is the other project's")

    def test_debian_packages_have_complete_dependencies(self):
        run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", self.root / "deb")
        packages = {p.name.split("_")[0]: p for p in (self.root / "deb").glob("*.deb")}
        self.assertEqual(sorted(packages), ["libsvdag-dev", "svdag"])
        needs = run("dpkg-deb", "-f", packages["svdag"], "Depends")
        for library in ("libc6", "libstdc++6", "libxxhash0"):
            self.assertRegex(needs, rf"\b{re.escape(library)}\b")
        for name, package in packages.items():
            for file in ("copyright", "changelog.gz"):
                self.assertIn(f"./usr/share/doc/{name}/{file}\n", run("dpkg-deb", "-c", package))
            version = run("dpkg-deb", "-f", package, "Version").strip()
            self.assertTrue((ROOT / "debian" / "changelog").read_text().startswith(f"svdag ({version}) "))
            synopsis = run("dpkg-deb", "-f", package, "Description").splitlines()[0]
            self.assertIn({"svdag": "builder", "libsvdag-dev": "reader"}[name], synopsis)
        held = run("dpkg-deb", "-c", packages["svdag"])
        for program in ("svdag-verify", "svdag-scene"):
            self.assertIn(f"./usr/bin/{program}\n", held)
        for path in ("doc/svdag/docs/farm.md", "man/man1/svdag-build.1.gz", "man/man7/svdag-grid.7.gz", "bash-completion/completions/svdag",
                     "zsh/vendor-completions/_svdag", "fish/vendor_completions.d/svdag.fish"):
            self.assertIn(f"./usr/share/{path}\n", held)
        self.require_links(held)
        held = run("dpkg-deb", "-c", packages["libsvdag-dev"])
        self.assertIn("./usr/lib/cmake", held.replace("/x86_64-linux-gnu", ""))
        for path in ("format.md", "engine.md", "examples/reader/CMakeLists.txt", "examples/reader/cast_ray.cpp", "examples/vulkan/main.cpp"):
            self.assertIn(f"./usr/share/doc/libsvdag-dev/{path}\n", held)
        self.assertIn("./usr/include/svdag/shaders/svdag.glsl\n", held)

    def require_links(self, held):
        """Links in packaged pages lead to files of the package, except for links to sources."""
        folder = "./usr/share/doc/svdag/"
        pages = [pathlib.Path(page) for page in re.findall(rf"{folder}(\S+\.md)\n", held)]
        self.assertGreater(len(pages), 12)
        links = {os.path.normpath(page.parent / link) for page in pages
                 for link in re.findall(r"\]\(([^)#]+)[^)]*\)", (ROOT / page).read_text()) if not link.startswith("http")}
        self.assertEqual({link for link in links if folder + link + "\n" not in held}, {"Makefile"})


if __name__ == "__main__":
    unittest.main()
