#!/usr/bin/env python3
"""Tests the layering of the code: includes follow docs/ARCHITECTURE.md, type names are unique, and comments name only
files that exist. Reports the sizes of files and functions.

ALLOWED lists, per folder, the folders whose headers its files may include; a folder may always include itself.
LIBRARIES lists, per heavy library, the only files that may include it. The rules are checked on the text, because a
compiler accepts every include.
"""
import pathlib
import re
import statistics
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
STREAMING = ["streaming", "streaming/file", "streaming/memory", "streaming/process", "streaming/spill",
             "streaming/sort"]
SCENE = ["io/scene/cutouts", "io/scene/colours", "io/scene/mesh", "io/scene/polygons", "io/scene/decoders", "io/scene/readers", "io/scene/gltf/document",
         "io/scene/gltf", "io/scene"]
FORMATS = ["io/formats", "io/formats/dags", "io/formats/voxels", "io/formats/surfaces", "io/formats/points", "io/formats/vdb"]
PHASES = ["builder/octree", "builder/overlap", "builder/overlap/kernels", "builder/winding", "builder/workspace", "builder/reduce",
          "builder/descend", "builder/split", "builder/run", "builder/merge"]
DAG = ["io/dag", "io/dag/colours", "io/dag/layers", "io/dag/compact", "io/dag/pack", "io/dag/graph", "io/dag/walk", "io/dag/write"]
BAKE = STREAMING + ["io", *DAG] + SCENE + PHASES + ["builder/cache", "builder"]
VERIFY = ["verify/integrity", "verify/judge", "verify/sample", "verify/compare", "verify/colours", "verify/view", "verify/report"]
TRACE = ["verify/trace/kernel", "verify/trace", "verify/trace/judge", "verify/trace/program"]
ALLOWED = {
    "streaming": [],
    "streaming/file": ["streaming"],
    "streaming/memory": ["streaming"],
    "streaming/process": ["streaming", "streaming/file", "streaming/memory"],
    "streaming/spill": ["streaming", "streaming/file", "streaming/memory"],
    "streaming/sort": ["streaming", "streaming/memory", "streaming/process", "streaming/spill"],
    "io": ["streaming"],
    "io/values": STREAMING,
    "io/help": STREAMING + ["io", *DAG, "io/scene"],
    "io/scene/decoders": STREAMING + ["io"],
    "io/scene/cutouts": STREAMING + ["io", "io/scene/decoders"],
    "io/scene/colours": STREAMING + ["io", "io/scene/cutouts", "io/scene/decoders"],
    "io/scene/mesh": STREAMING + ["io", "io/scene/cutouts", "io/scene/colours"],
    "io/scene/polygons": STREAMING + ["io", "io/scene/cutouts", "io/scene/colours", "io/scene/mesh"],
    "io/scene/readers": STREAMING + ["io", "io/values", "io/scene/cutouts", "io/scene/colours", "io/scene/mesh", "io/scene/polygons", "io/scene/decoders"],
    "io/scene/gltf/document": STREAMING + ["io", "io/values", "io/scene/mesh", "io/scene/decoders"],
    "io/scene/gltf": STREAMING + ["io", "io/values", "io/scene/cutouts", "io/scene/colours", "io/scene/mesh", "io/scene/polygons", "io/scene/decoders", "io/scene/readers", "io/scene/gltf/document"],
    "io/scene": STREAMING + ["io", "io/values", *DAG] + SCENE,
    **{room: STREAMING + ["io", *DAG] for room in DAG},
    "io/formats": STREAMING + ["io", *DAG],
    "io/formats/dags": STREAMING + ["io", *DAG, "io/formats"],
    "io/formats/voxels": STREAMING + ["io", *DAG, "io/formats"],
    "io/formats/surfaces": STREAMING + ["io", *DAG, "io/formats"],
    "io/formats/points": STREAMING + ["io", "io/values", *DAG, "io/formats"],
    "io/formats/vdb": STREAMING + ["io", *DAG, "io/formats"],
    "builder/octree": ["streaming", "io"],
    "builder/overlap": ["streaming", "io", "builder/octree"],
    "builder/overlap/kernels": ["streaming", "io", "builder/octree", "builder/overlap"],
    "builder/winding": STREAMING + ["io", *DAG, "builder/octree", "builder/overlap"],
    "builder/workspace": STREAMING + ["io", "io/scene/mesh"],
    "builder/reduce": STREAMING + ["io", *DAG, "builder/octree", "builder/workspace"],
    "builder/descend": STREAMING + ["io", *DAG, "io/scene/cutouts", "builder/octree", "builder/overlap", "builder/overlap/kernels",
                                    "builder/winding", "builder/reduce"],
    "builder/split": STREAMING + ["io", *DAG, "io/scene/cutouts", "io/scene", "builder/octree", "builder/overlap", "builder/overlap/kernels",
                                  "builder/winding", "builder/workspace"],
    "builder/colours": STREAMING + ["io", *DAG] + SCENE + ["builder/octree", "builder/overlap", "builder/overlap/kernels",
                                                           "builder/workspace"],
    "builder/run": STREAMING + ["io", *DAG, "builder/octree"],
    "builder/merge": STREAMING + ["io", *DAG, "builder/octree", "builder/workspace", "builder/reduce",
                                  "builder/run"],
    "builder/cache": STREAMING + ["io", *DAG, "builder/octree", "builder/overlap", "builder/workspace",
                                  "builder/reduce"],
    "builder": STREAMING + ["io", *DAG, "io/scene"] + PHASES + ["builder/cache", "builder/colours"],
    "builder/bake": BAKE + ["builder/colours"],
    "builder/import": STREAMING + ["io", *DAG] + PHASES + ["builder/colours"],
    "builder/edit": STREAMING + ["io", *DAG, "builder/import", "builder/workspace"],
    "builder/farm/plan": BAKE + ["builder/bake", "builder/colours"],
    "builder/farm/planner": BAKE + ["builder/bake", "builder/colours", "builder/farm/plan"],
    "builder/farm/engines": BAKE + ["builder/bake", "builder/farm/plan"],
    "builder/commands": BAKE + ["io/help", "builder/edit", "builder/farm/plan", "builder/farm/planner", "builder/farm/engines"],
    "builder/commands/farm": BAKE + ["io/help", "builder/farm/plan", "builder/farm/planner", "builder/farm/engines", "builder/commands"],
    "builder/commands/info": BAKE + ["io/help", "builder/farm/plan", "builder/farm/planner", "builder/commands"],
    "builder/commands/export": STREAMING + ["io", "io/help", *DAG] + FORMATS,
    "builder/commands/import": STREAMING + ["io", "io/help", *DAG] + FORMATS + ["builder/run", "builder/import"],
    "verify/integrity": STREAMING + ["io", *DAG],
    "verify/judge": STREAMING + ["io", *DAG, "io/scene/cutouts"],
    "verify/sample": STREAMING + ["io", *DAG, "io/scene/cutouts", "io/scene", "verify/integrity", "verify/judge"],
    "verify/compare": STREAMING + ["io", *DAG, "io/formats", "verify/judge", "verify/sample"],
    "verify/colours": STREAMING + ["io", *DAG, "io/scene/cutouts", "io/scene/colours", "io/scene/decoders", "io/scene", "verify/judge",
                                   "verify/sample"],
    "verify/view": STREAMING + ["io", *DAG],
    "verify/report": STREAMING + ["io", *DAG, "verify/integrity", "verify/view"],
    "verify/trace/kernel": STREAMING + [*DAG],
    "verify/trace": STREAMING + ["io", *DAG, "io/help", "verify/trace/kernel"],
    "verify/trace/judge": STREAMING + ["io", "io/scene/cutouts", *DAG, "verify/trace/kernel"],
    "verify/trace/program": STREAMING + ["io", *DAG, "io/help", "verify/trace/kernel", "verify/trace"],
    "python": STREAMING + ["io", *DAG, "builder/import", "verify/trace/kernel"],
    "shaders": [],
    "verify/commands": STREAMING + ["io", *DAG, "io/scene", "io/help"] + FORMATS + VERIFY + TRACE,
}

# Files with a fixed list of includes: they compile for the GPU or without dependencies.
EXACT = {
    "io/dag/format.h": [],
    "io/dag/compact_view.h": ["format.h"],
    "io/dag/dag_view.h": ["compact_view.h"],
    "io/dag/colours/chunk_view.h": ["../compact_view.h"],
    "io/dag/colours/colour_view.h": ["../dag_view.h", "chunk_view.h"],
    "verify/trace/kernel/ray.h": ["io/dag/dag_view.h"],
    "verify/trace/kernel/traverse.h": ["verify/trace/kernel/ray.h"],
    "verify/trace/kernel/vector.h": ["verify/trace/kernel/traverse.h"],
    "verify/trace/kernel/camera.h": ["verify/trace/kernel/vector.h"],
    "verify/trace/kernel/surface.h": ["verify/trace/kernel/vector.h"],
    "verify/trace/kernel/sampling.h": ["verify/trace/kernel/vector.h"],
    "verify/trace/kernel/beam.h": ["verify/trace/kernel/camera.h"],
    "verify/trace/kernel/workload.h": ["verify/trace/kernel/beam.h", "verify/trace/kernel/sampling.h",
                                "verify/trace/kernel/surface.h"],
    "verify/trace/kernel/processor.h": [],
    "verify/trace/kernel/tree64_view.h": ["io/dag/dag_view.h"],
    "verify/trace/kernel/tree64.h": ["verify/trace/kernel/tree64_view.h", "streaming/memory/huge_vector.h"],
    "verify/trace/kernel/tree64.cpp": ["verify/trace/kernel/tree64.h", "verify/trace/kernel/processor.h",
                                "streaming/counts.h"],
    "verify/trace/kernel/cells64.h": ["verify/trace/kernel/ray.h", "verify/trace/kernel/tree64_view.h"],
    "verify/trace/kernel/cells64_avx2.h": ["verify/trace/kernel/cells64.h", "verify/trace/kernel/processor.h"],
    "verify/trace/kernel/walk64.h": ["verify/trace/kernel/cells64.h"],
    "verify/trace/kernel/rays.h": ["verify/trace/kernel/traverse.h", "verify/trace/kernel/tree64_view.h"],
    "verify/trace/kernel/rays.cpp": ["verify/trace/kernel/rays.h", "verify/trace/kernel/cells64_avx2.h",
                              "verify/trace/kernel/processor.h", "verify/trace/kernel/walk64.h"],
    "verify/trace/program/plain_file.h": ["io/dag/layers/layer_index.h", "io/dag/layers/layer_table.h"],
    "verify/trace/program/plain_file.cpp": ["verify/trace/program/plain_file.h", "io/dag/colours/colours_check.h", "io/dag/compact/compact_check.h", "io/dag/layers/root_views.h", "io/dag/pack/pack_format.h",
                                    "streaming/error.h", "streaming/file/file.h",
                                    "streaming/file/input_watch.h"],
    "verify/trace/program/device.h": ["verify/trace/program/plain_file.h", "verify/trace/kernel/workload.h"],
    "verify/trace/program/device.cpp": ["verify/trace/program/device.h", "verify/trace/kernel/processor.h",
                                "verify/trace/kernel/rays.h", "verify/trace/kernel/tree64.h",
                                "streaming/process/executor.h", "streaming/process/lap_timer.h",
                                "streaming/memory/memory_budget.h"],
    "verify/trace/program/cuda.cu": ["verify/trace/program/device.h", "verify/trace/kernel/tree64.h", "verify/trace/kernel/walk64.h",
                                     "streaming/error.h"],
    "verify/trace/program/without_cuda.cpp": ["verify/trace/program/device.h", "streaming/error.h"],
}

LIBRARIES = {
    r"CLI/": r"(builder/commands(/export|/farm|/import|/info)?|verify/commands|verify/trace(/program)?)/(main|\w+_options)\.cpp|io/help/(command_line|scene_options)\.cpp|tests/(scenes/main|fuzz/\w+)\.cpp",
    r"OpenMesh/": r"io/scene/readers/openmesh\.cpp|tests/io/scene/readers/openmesh_test\.cpp",
    r"assimp/": r"io/scene/readers/assimp\.cpp",
    r"ufbx": r"io/scene/readers/fbx\.cpp",
    r"expat": r"io/scene/readers/three_mf_model\.cpp",
    r"unzip\.h": r"io/scene/decoders/zip_archive\.cpp",
    r"meshoptimizer": r"io/scene/decoders/meshopt\.cpp|tests/io/scene/gltf/gltf_meshopt_test\.cpp",
    r"zlib": r"io/formats/voxels/zip\.cpp|io/scene/decoders/gzip\.cpp|verify/view/tile_file\.cpp|tests/io/scene/(decoders/gzip_test\.cpp|(png|zip)_file\.h)",
    r"httplib": r"verify/view/server\.cpp",
    r"draco/": r"io/scene/decoders/draco\.cpp|tests/.*",
    r"vulkan/": r"examples/vulkan/compute\.h",
    r"stb_?|stb/": r"examples/vulkan/main\.cpp|verify/trace/image\.cpp|io/scene/decoders/image\.cpp|tests/(io/scene/decoders/image_test|scenes/textures)\.cpp",
    r"stxxl/": r"tests/bench/peers/stxxl\.cpp",
    r"png\.h|jpeglib\.h": r"verify/colours/image_decoders\.cpp",
    r"CGAL/": r"verify/judge/judge_cgal\.cpp|tests/bench/peers/cgal\.cpp",
    r"openvdb/": r"verify/judge/judge_vdb\.cpp|io/formats/vdb/vdb_trees\.h|io/openvdb_grids\.h",
    r"nanovdb/": r"io/formats/vdb/nvdb\.cpp|tests/io/formats/vdb/nvdb_test\.cpp",
    r"embree": r"verify/trace/judge/embree\.cpp|tests/bench/peers/embree\.cpp",
    r"hwy/": r"builder/overlap/kernels/kernel[\w-]*\.(h|cpp)",
    r"xxhash": r"streaming/file/\w+\.cpp",
    r"zstd\.h>": r"io/dag/pack/zstd\.cpp",
    r"nanobind/": r"python/module\.cpp",
    r"nlohmann/": r"io/help/manual\.cpp|io/verdict\.cpp|io/scene/.*|io/dag/\w+\.cpp|builder/.*|verify/\w+/\w+\.cpp|tests/.*",
}

# Matches text that is not code: comments, strings, directives.
NOT_CODE = re.compile(r'''//[^\n]*|/\*.*?\*/|R"([^(\s]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|'''
                      r'''(?<!\w)'(?:\\.|[^'\\\n])+'|^[ \t]*#(?:\\\n|[^\n])*''', re.S | re.M)
NAMESPACE = re.compile(r"(?:.* )?namespace ?([\w:]*)")
TYPE = re.compile(r"(?:template ?<.*> ?)?(?:enum class|enum struct|enum|struct|class|union) "
                  r"(?:alignas ?\([^)]*\) |\[\[.*?\]\] )*([\w:]+(?: ?<.*>)?)(?: final)?(?: ?:[^:].*)?")

COMMENT = {".h": r"//[^\n]*", ".py": r'#[^\n]*|"""(?:.*?)"""', ".sh": r"#[^\n]*", ".md": r".*"}
COMMENT[".cpp"] = COMMENT[".cu"] = COMMENT[".glsl"] = COMMENT[".comp"] = COMMENT[".h"]
FILE_NAME = re.compile(r"(?<![\w./*{}$<>-])(?:[\w-]+/)+[\w-]+\.(?:h|cpp|cu|py|sh|md)\b(?![/\w])")


def folder_of(path):
    parent = str(pathlib.PurePosixPath(path).parent)
    return parent if parent in ALLOWED else None


def forbidden_includes(path, text):
    """Messages about the forbidden includes of one file."""
    found = []
    folder = folder_of(path)
    if folder is None and not path.startswith(("tests/", "examples/")):
        found.append(f"{path}: the folder is not in ALLOWED")
    for line in text.splitlines():
        include = re.match(r'\s*#\s*include\s*(["<])([^">]+)[">]', line)
        if not include:
            continue
        quoted, target = include.group(1) == '"', include.group(2)
        for library, owners in LIBRARIES.items():
            if re.match(library, target) and not re.fullmatch(owners, path):
                found.append(f"{path}: <{target}> may be included by {owners} only")
        if folder is None or not (quoted or folder_of(target)):
            continue
        if path in EXACT:
            if target not in EXACT[path]:
                found.append(f"{path}: may not include {target}")
        elif folder_of(target) is None:
            found.append(f"{path}: {target} is not in a folder of ALLOWED")
        elif folder_of(target) != folder and folder_of(target) not in ALLOWED[folder]:
            found.append(f"{path}: {folder} may not include {folder_of(target)} ({target})")
    return found


def sources():
    for top in ["streaming", "io", "builder", "verify", "python", "shaders", "examples", "tests"]:
        for path in sorted((ROOT / top).rglob("*")):
            if path.suffix in (".h", ".cpp", ".cu", ".glsl", ".comp"):
                yield str(path.relative_to(ROOT)), path.read_text()


def functions(text):
    """(first line, number of lines) of every function body at namespace or class scope.

    Relies on the layout of clang-format: a function begins with a line that ends in ") {" (or ") const {" etc.) and
    ends with a brace in the same column. Control statements are skipped.
    """
    lines = text.splitlines()
    for i, line in enumerate(lines):
        if not re.search(r"\)[\w\s>:&*-]*\{$", line):
            continue
        start = i
        while start > 0 and lines[start].startswith("    ") and not lines[start - 1].rstrip().endswith((";", "{", "}")):
            start -= 1
        indent = len(lines[start]) - len(lines[start].lstrip())
        if re.match(r"\s*(\}? ?else|if|for|while|switch|do|catch|const auto|auto|return)\b", lines[start]):
            continue
        for j in range(i + 1, len(lines)):
            if re.match(r" {0,%d}\}" % indent, lines[j]):
                if lines[j].startswith(" " * indent):  # else a lambda argument, and the enclosing function ends here
                    yield start + 1, j - start + 1
                break


def types(text):
    """(line, name) of every type defined in a named namespace."""
    code = NOT_CODE.sub(lambda found: re.sub(r"[^\n]", " ", found.group()), text)
    scopes, begin = [], 0  # scopes: the name of a namespace, None for any other brace
    for found in re.finditer(r"[{};]", code):
        head = " ".join(code[begin:found.start()].split())
        begin = found.end()
        if found.group() == "{":
            named = TYPE.fullmatch(head)
            if named and all(scopes):
                yield code.count("\n", 0, found.start()) + 1, "::".join([*scopes, named.group(1)])
            space = NAMESPACE.fullmatch(head)
            scopes.append(space.group(1) if space else None)
        elif found.group() == "}":
            scopes.pop()


def defined_twice(files):
    """{name: [path:line]} of types with more than one definition; without_X.cpp counts as X.cpp, which it replaces."""
    places = {}
    for path, text in files:
        for line, name in types(text):
            places.setdefault(name, {}).setdefault(path.replace("/without_", "/"), f"{path}:{line}")
    return {name: list(at.values()) for name, at in places.items() if len(at) > 1}


def missing_files(path, text):
    """Missing files named in the comments of a source, or in a page: neither relative to the root nor to its folder."""
    comments = re.findall(COMMENT[pathlib.PurePosixPath(path).suffix], text, re.S)
    return [f"{path}: {name}" for comment in comments for name in FILE_NAME.findall(comment)
            if not ((ROOT / name).exists() or ((ROOT / path).parent / name).exists() or "NAME" in name)]


class Arrow(unittest.TestCase):
    def test_every_include_is_allowed(self):
        self.assertEqual([b for path, text in sources() for b in forbidden_includes(path, text)], [])

    def test_forbidden_includes_are_found(self):
        for path, include in [("streaming/file/file.cpp", '"io/grid.h"'),
                              ("io/grid.cpp", '"io/dag/format.h"'),
                              ("io/scene/readers/ply.cpp", '"io/dag/dag_view.h"'),
                              ("io/scene/readers/ply.cpp", '"io/formats/voxels/vox.h"'),
                              ("io/formats/vox.cpp", '"io/scene/scene.h"'),
                              ("builder/bake/bake.cpp", '"verify/judge/clip_judge.h"'),
                              ("builder/bake/bake.cpp", '"tests/scenes/mesh.h"'),
                              ("builder/overlap/exact.cpp", '"builder/descend/descend.h"'),
                              ("verify/judge/clip_judge.cpp", '"builder/overlap/overlap.h"'),
                              ("verify/judge/clip_judge.cpp", '<builder/overlap/overlap.h>'),
                              ("verify/trace/kernel/traverse.h", '"io/grid.h"'),
                              ("io/dag/dag_view.h", '"streaming/error.h"'),
                              ("builder/bake/bake.cpp", "<CLI/CLI.hpp>"),
                              ("builder/commands/build.cpp", "<CLI/CLI.hpp>"),
                              ("io/help/help_text.cpp", "<CLI/CLI.hpp>"),
                              ("io/scene/readers/ply.cpp", "<OpenMesh/Core/IO/MeshIO.hh>"),
                              ("io/scene/gltf/gltf.cpp", "<draco/compression/decode.h>"),
                              ("verify/sample/compare.cpp", "<CGAL/Exact_predicates_exact_constructions_kernel.h>"),
                              ("verify/sample/compare.cpp", "<openvdb/openvdb.h>"),
                              ("verify/trace/cpu.cpp", "<stb/stb_image_write.h>"),
                              ("verify/trace/cpu.cpp", "<embree3/rtcore.h>")]:
            self.assertEqual(len(forbidden_includes(path, f"#pragma once\n#include {include}\n")), 1, (path, include))

    def test_allowed_includes_are_accepted(self):
        for path, include in [("io/grid.cpp", '"io/grid.h"'), ("io/grid.cpp", "<vector>"),
                              ("builder/bake/bake.cpp", '"io/scene/scene.h"'),
                              ("verify/trace/kernel/ray.h", '"io/dag/dag_view.h"'),
                              ("builder/commands/build_options.cpp", "<CLI/CLI.hpp>"),
                              ("tests/builder/build_test.cpp", '"verify/judge/clip_judge.h"')]:
            self.assertEqual(forbidden_includes(path, f"#include {include}\n"), [], (path, include))

    def test_sources_are_found(self):
        self.assertGreater(len(list(sources())), 40)


class Sizes(unittest.TestCase):
    """Sizes are reported, not limited: one clear file of 400 lines is better than three fragments."""

    def test_sizes_are_reported(self):
        sizes = {path: len(text.splitlines()) for path, text in sources()}
        longest = max(sizes, key=sizes.get)
        print(f"{len(sizes)} files, median {statistics.median(sizes.values()):.0f} lines, "
              f"longest {sizes[longest]} ({longest})", file=sys.stderr)
        sizes = {(path, line): n for path, text in sources() for line, n in functions(text)}
        self.assertGreater(len(sizes), 100)
        (path, line), longest = max(sizes.items(), key=lambda item: item[1])
        print(f"{len(sizes)} functions, median {statistics.median(sizes.values()):.0f} lines, 99th percentile "
              f"{statistics.quantiles(sizes.values(), n=100)[98]:.0f}, longest {longest} ({path}:{line})",
              file=sys.stderr)

    def test_a_long_function_is_measured(self):
        body = "  step();\n" * 71
        text = f"namespace a {{\nvoid f(int x,\n       int y) {{\n  if (x) {{\n{body}  }}\n}}\n}}\n"
        self.assertEqual([n for _, n in functions(text)], [76])
        self.assertEqual([n for _, n in functions(f"TEST(A, B) {{\n{body}}}\n")], [73])


class Comments(unittest.TestCase):
    def test_files_named_in_comments_and_pages_exist(self):
        scripts = [p for kind in ("*.py", "*.sh") for p in (ROOT / "tests").rglob(kind) if p.name != "arrow_test.py"]
        pages = [ROOT / "README.md", ROOT / "CHANGELOG.md", *(ROOT / "docs").rglob("*.md"), *(ROOT / "builder").glob("*.md"),
                 *(ROOT / "verify").rglob("*.md")]
        files = [*sources(), *((str(p.relative_to(ROOT)), p.read_text()) for p in scripts + pages)]
        self.assertEqual([name for path, text in files for name in missing_files(path, text)], [])

    def test_names_of_missing_files_are_found(self):
        for path, text in [("io/a.h", "int a;  // as io/gird.h says\n"), ("docs/a.md", "see `io/gird.h`, `io/grid.h`"),
                           ("tests/a.py", '"""Beside\nio/gird.h."""\n'), ("tests/a.sh", "true  # io/gird.h\n")]:
            self.assertEqual(missing_files(path, text), [f"{path}: io/gird.h"])
        for path, text in [("io/a.h", '#include "io/gird.h"  // io/grid.h\n'), ("docs/a.md", "https://b.org/io/gird.h"),
                           ("tests/a.py", 'open("io/gird.h")\n'), ("tests/a.sh", "cat io/gird.h\n")]:
            self.assertEqual(missing_files(path, text), [])


class OneDefinition(unittest.TestCase):
    """Two types with one name in a program break the one-definition rule: the linker keeps the functions of one."""

    def test_type_names_are_unique(self):
        self.assertGreater(len([name for _, text in sources() for name in types(text)]), 400)
        self.assertEqual(defined_twice(sources()), {})

    def test_every_form_of_type_is_found(self):
        for text, expected in [("struct A { int b; };", ["A"]),
                               ("template <class T, int N>\nclass A final\n    : public B<T> {\n};", ["A"]),
                               ("template <> struct hash<A> {};", ["hash<A>"]),
                               ("enum class A : uint8_t { kB };", ["A"]),
                               ("namespace a {\nnamespace b::c { struct A {}; }\nstruct B::C {};\n}",
                                ["a::b::c::A", "a::B::C"]),
                               ("struct A;\nclass B;\nenum class C : int;", []),
                               ("namespace a { namespace { struct A {}; } }", []),
                               ("struct A { struct B {}; };\nvoid f() { struct C {}; }", ["A"]),
                               ("struct A f(int b) { return {}; }", []),
                               ("// struct A {\n/* struct B { */ #define C struct D {\nauto c = \"struct E {\";", [])]:
            self.assertEqual([name for _, name in types(text)], expected, text)

    def test_duplicate_types_are_found(self):
        a, b = "namespace svdag {\nstruct Cube { int x; };\n}\n", "namespace svdag {\n\nclass Cube {\n};\n}\n"
        self.assertEqual(defined_twice([("io/a.h", a), ("verify/b.cpp", b)]),
                         {"svdag::Cube": ["io/a.h:2", "verify/b.cpp:3"]})
        self.assertEqual(defined_twice([("io/a.h", a), ("verify/b.cpp", b.replace("svdag", ""))]), {})
        self.assertEqual(defined_twice([("io/a.h", a), ("verify/b.cpp", "namespace svdag { struct Cube; }")]), {})
        self.assertEqual(defined_twice([("io/vdb.cpp", a), ("io/without_vdb.cpp", b)]), {})


if __name__ == "__main__":
    unittest.main()
