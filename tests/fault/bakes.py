"""Shared parts of the fault tests: small bakes, the folder of a run, the files that may remain in it, the summary.

    NAME_test.py BUILD [--long]      BUILD: folder of the built programs; SVDAG_LONG=1 is the same as --long

Constants are the guarantees of the program; change one to make a test stricter.
"""
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
from typing import NamedTuple

ARGUMENTS = [a for a in sys.argv[1:] if not a.startswith("-")]
BUILD = pathlib.Path(ARGUMENTS[0] if ARGUMENTS else "build/release").resolve()
SHIM = BUILD / "tests/libsvdag_fault_shim.so"
LONG = "--long" in sys.argv or os.environ.get("SVDAG_LONG") == "1"

OUTPUT = "out.svdag"
SCRATCH = OUTPUT + ".scratch"  # the default scratch folder of a bake
SHARED_SCRATCH = "scratch"  # the parent of scratch folders, for bakes with --scratch scratch
OF_SCRATCH = rf"{re.escape(SCRATCH)}|{SHARED_SCRATCH}/[^/]+"
# Files that a killed process may leave: its scratch folder, and the temporary name of the output between linkat and
# rename (from the start, where O_TMPFILE is missing).
LEFT_BY_KILL = [OF_SCRATCH, r"\.svdag-[0-9a-f]{16}\.tmp"]


class Bake(NamedTuple):
    """A scene of svdag-scene and the options of its bake, such as a small --memory or --scratch DIR.

    With `parts`, the tested command is the merge of their runs, which are baked with the options `grid`.
    """
    name: str
    scene: list
    options: list
    parts: int = 0
    grid: list = []

    def inputs(self):
        return ["scene.ply"] if not self.parts else [f"{i}.run" for i in range(1, self.parts + 1)]

    def command(self, *more, output=OUTPUT):
        return [BUILD / "svdag", "merge" if self.parts else "build", *self.inputs(), "-o", output, "-q",
                *self.options, *more]


# Small enough that every call can fail once; the second spills triangles, runs and maps.
SMALL = [Bake("small", ["hairball", "-n", "2K"], ["-r", "128", "-m", "256M", "-j", "2"]),
         Bake("spilling", ["hairball", "-n", "5K"], ["-r", "256", "-m", "3M", "-j", "1", "--scratch", SHARED_SCRATCH]),
         Bake("merge", ["hairball", "-n", "2K"], ["-m", "1M", "-j", "1"], 3, ["-r", "128"])]
SMALL_LONG = SMALL + [
    Bake("one thread", ["hairball", "-n", "2K"], ["-r", "128", "-m", "256M", "-j", "1"]),
    Bake("city", ["city", "-n", "60K"], ["-r", "1K", "-m", "256M", "-j", "2"]),
    Bake("hairball", ["hairball", "-n", "20K"], ["-r", "1K", "-m", "16M", "-j", "2"])]
# Small, but it spills triangles and runs and saves both for --resume.
SAVING = Bake("saving", ["hairball", "-n", "20K"], ["-r", "1K", "-m", "8M", "-j", "2", "--checkpoint", "0.001"])
# Long enough to be interrupted, with work to resume.
HALF_A_SECOND = Bake("half a second", ["hairball", "-n", "100K"], ["-r", "8K", "-m", "32M", "-j", "2"])
A_SECOND = Bake("a second", ["hairball", "-n", "100K"], ["-r", "16K", "-m", "1G", "-j", "2", "--checkpoint", "0.1"])
# Its second half is the pass that adds colours, which saves work, too.
COLOURS = Bake("colours", ["hairball", "-n", "20K"], ["-r", "2K", "-m", "32M", "-j", "2", "--colours", "--checkpoint", "0.05"])
SECONDS = Bake("some seconds", ["hairball", "-n", "1M"], ["-r", "8K", "-m", "128M", "-j", "2"])


def paint(ply):
    """Gives the vertices of a binary .ply, which have positions only, colours that are noise."""
    header, vertices = ply.read_bytes().split(b"end_header\n", 1)
    count = int(re.search(rb"element vertex (\d+)", header)[1])
    size = {b"float": 12, b"double": 24}[re.search(rb"property (\w+) x", header)[1]]
    header = re.sub(rb"(property \w+ z\n)", rb"\1property uchar red\nproperty uchar green\nproperty uchar blue\n", header)
    painted = [vertices[size * i:size * (i + 1)] + hashlib.md5(b"%d" % i).digest()[:3] for i in range(count)]
    ply.write_bytes(header + b"end_header\n" + b"".join(painted) + vertices[size * count:])


class BakeFixture:
    """A scene, an old output and the bytes of an undisturbed bake; each test runs in a copy of its folder."""

    def __init__(self, bake):
        self.bake = bake
        self.folder = tempfile.TemporaryDirectory(prefix="svdag-fault-")
        self.root = pathlib.Path(self.folder.name).resolve()
        self.scene = self.root / "scene.ply"
        self.make_scratch(self.root)
        subprocess.run([BUILD / "svdag-scene", *bake.scene, "-q", "-o", self.scene], check=True)
        if "--colours" in bake.options:
            paint(self.scene)
        for i, run in enumerate(bake.inputs() if bake.parts else (), 1):
            subprocess.run([BUILD / "svdag", "build", "scene.ply", "-o", run, "-q", *bake.grid, "--part",
                            f"{i}/{bake.parts}"], cwd=self.root, check=True)
        self.old = self.bytes_of([BUILD / "svdag", "build", "scene.ply", "-o", OUTPUT, "-q", "-r", "8"])
        self.new = self.bytes_of(bake.command())
        assert self.old != self.new

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.folder.cleanup()

    def bytes_of(self, command):
        subprocess.run(command, cwd=self.root, check=True)
        data = (self.root / OUTPUT).read_bytes()
        (self.root / OUTPUT).unlink()
        return data

    def make_scratch(self, folder):
        """Creates the folder of --scratch, if the options have it."""
        if "--scratch" in self.bake.options:
            (folder / self.bake.options[self.bake.options.index("--scratch") + 1]).mkdir()

    def new_folder(self):
        """A new folder with the scene, or the runs, and the old output."""
        folder = pathlib.Path(tempfile.mkdtemp(prefix="table-", dir=self.root))
        for name in self.bake.inputs():
            shutil.copy(self.root / name, folder)
        self.make_scratch(folder)
        (folder / OUTPUT).write_bytes(self.old)
        return folder

    def state(self, folder, output=OUTPUT):
        """The state of the output: "old", "new", "nothing" or "a damaged file"."""
        path = folder / output
        data = path.read_bytes() if path.exists() else None
        return "nothing" if data is None else {self.old: "old", self.new: "new"}.get(data, "a damaged file")


def is_input(path):
    return re.fullmatch(r"scene\.ply|\d\.run", pathlib.Path(path).name) is not None


def others(folder):
    """The names of all other files than inputs and output, and of the files in the shared scratch folder."""
    names = {p.name for p in folder.iterdir() if not is_input(p)} - {OUTPUT, SHARED_SCRATCH}
    shared = folder / SHARED_SCRATCH
    return sorted(names | {f"{SHARED_SCRATCH}/{p.name}" for p in (shared.iterdir() if shared.exists() else ())})


def leftovers(folder, allowed=()):
    """Failures: files that should not remain."""
    return [f"{name} remains" for name in others(folder) if not any(re.fullmatch(a, name) for a in allowed)]


def remaining_scratch(folder):
    """Failures: scratch folders that remain after a finished bake."""
    return [f"{name} remains after the bake" for name in others(folder) if re.fullmatch(OF_SCRATCH, name)]


def check_message(stderr):
    """A failure unless `stderr` is one message of one line."""
    if re.fullmatch(r"svdag: [^\n]+\n", stderr) and not re.search("internal error|report this", stderr):
        return []
    return [f"printed {stderr!r}, not one message"]


class Report:
    """Counts the results and prints the summary line that run_tests.py reads."""

    def __init__(self):
        self.passed = self.failed = self.skipped = 0

    def record(self, name, failures):
        self.passed += not failures
        self.failed += bool(failures)
        if failures:
            print(f"FAILED {name}: {'; '.join(failures)}", flush=True)

    def skip(self, reason):
        self.skipped += 1
        print(f"skipped: {reason}")

    def finish(self):
        print(f"{self.passed} passed, {self.failed} failed, {self.skipped} skipped")
        sys.exit(self.failed > 0)
