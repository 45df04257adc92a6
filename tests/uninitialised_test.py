#!/usr/bin/env python3
"""Tests that no program uses or writes uninitialised bytes: small inputs to every command under valgrind's memcheck.

The address sanitizer does not detect them; in output files they would make equal plans differ. Not covered: CGAL's
judge, which needs rounding modes that valgrind does not emulate, and the limited child that decodes OpenVDB, whose
memory limit valgrind exceeds.
Usage: uninitialised_test.py BUILD
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

BUILD = pathlib.Path(sys.argv[1]).resolve()
CORPUS = pathlib.Path(__file__).resolve().parent / "fuzz/corpus"
FOUND = 99
# --trace-children: svdag export and import are separate programs.
MEMCHECK = ["valgrind", "-q", "--trace-children=yes", f"--error-exitcode={FOUND}", "--num-callers=20"]
# Run in order: later commands read the outputs of earlier ones.
COMMANDS = """
svdag-scene hairball -n 2K -q -o s.ply
svdag build s.ply -r 128 -j 2 -q -o a.svdag --report r.json
svdag build s.ply -r 128 --rule thin -j 1 -q -o t.svdag
svdag build s.ply -r 256 -m 3M -j 1 -q -o b.svdag --cache c --checkpoint 0.001
svdag build s.ply -r 256 -m 3M -j 1 -q -o b.svdag --cache c
svdag plan s.ply -r 128 --shards 2 -q -o p
svdag run p --step shard-1 -q
svdag run p --step shard-2 -q
svdag merge p/runs/shard-1.run p/runs/shard-2.run -q -o m.svdag
svdag info a.svdag
svdag info s.ply
svdag-verify check a.svdag
svdag-verify diff a.svdag m.svdag
svdag-verify mesh a.svdag s.ply
svdag-verify mesh t.svdag s.ply
svdag-verify trace a.svdag s.ply --rays 500
svdag-verify render a.svdag --size 64x64 -o p.png
svdag-verify report a.svdag r.json -o r.html
svdag-trace a.svdag --size 32x32 --samples 4 --rounds 1
svdag export a.svdag -q -o x.vdb
svdag export a.svdag -q -o x.nvdb
svdag export a.svdag -q -o x.npz
svdag export a.svdag -q -o x.vox
svdag export a.svdag -q -o x.binvox
svdag export a.svdag -q --format symvox -o x.symvox
svdag export a.svdag -q --format transform-dag -o x.svo
svdag export a.svdag -q --format octree -o x.octree
svdag export a.svdag -q --format ply -o x.ply
svdag import x.npz -q -o npz.svdag
svdag import x.vox -q -o vox.svdag
svdag import x.binvox -q -o binvox.svdag
svdag import x.symvox -q -o symvox.svdag
svdag import x.svo -q -o svo.svdag
""".strip().splitlines()


def under_memcheck(command, folder):
    """The failure of `command` under memcheck; "" if it succeeded."""
    done = subprocess.run([*MEMCHECK, *command], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode == 0:
        return ""
    return f"{pathlib.Path(command[0]).name} {' '.join(map(str, command[1:]))}: exit {done.returncode}\n{done.stderr[:4000]}"


def main():
    if shutil.which("valgrind") is None:
        print("valgrind is not on PATH (make deps installs it).\n0 passed, 0 failed, 1 skipped")
        return 0
    with tempfile.TemporaryDirectory(prefix="svdag-memcheck-") as folder, ThreadPoolExecutor() as pool:
        # The fuzz targets, on their corpora.
        readers = [pool.submit(under_memcheck, [program, CORPUS / program.name], folder)
                   for program in sorted((BUILD / "tests").glob("*_fuzz"))]
        found = []
        for line in COMMANDS:
            program, *words = line.split()
            found.append(under_memcheck([BUILD / program, *words], folder))
        found += [each.result() for each in readers]
        assert len(readers) >= 20
    for text in filter(None, found):
        print(text)
    failed = sum(map(bool, found))
    print(f"{len(found) - failed} passed, {failed} failed, 0 skipped")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
