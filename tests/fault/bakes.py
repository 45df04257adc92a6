"""What the fault tests share: small bakes, the folder of one run, what may be left in it, the summary.

    NAME_test.py BUILD [--long]      BUILD: folder of the built programs; SVDAG_LONG=1 is --long

Constants in capitals hold what the program promises; a test is made stricter by changing one of them.
"""
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
SCRATCH = OUTPUT + ".scratch"  # a bake's own folder beside the output
SHARED_SCRATCH = "scratch"  # the folder of bakes whose options say --scratch scratch
OF_SCRATCH = rf"{re.escape(SCRATCH)}|{SHARED_SCRATCH}/[^/]+"
# What a process that was killed may leave: its scratch folder, and the name that a finished file has between
# linkat and rename (from the start, where O_TMPFILE is missing).
LEFT_BY_KILL = [OF_SCRATCH, r"\.svdag-[0-9a-f]{16}\.tmp"]


class Bake(NamedTuple):
    """A scene of svdag-scene and the options of its bake (here go --memory small, --scratch DIR).

    With parts, it is the merge of their runs that is disturbed; `grid` is how those are baked.
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


# Small enough that every call can fail once; the second has triangles, runs and maps to spill.
SMALL = [Bake("small", ["hairball", "-n", "2K"], ["-r", "128", "-m", "256M", "-j", "2"]),
         Bake("spilling", ["hairball", "-n", "5K"], ["-r", "256", "-m", "3M", "-j", "1", "--scratch", SHARED_SCRATCH]),
         Bake("merge", ["hairball", "-n", "2K"], ["-m", "1M", "-j", "1"], 3, ["-r", "128"])]
SMALL_LONG = SMALL + [
    Bake("one thread", ["hairball", "-n", "2K"], ["-r", "128", "-m", "256M", "-j", "1"]),
    Bake("city", ["city", "-n", "60K"], ["-r", "1K", "-m", "256M", "-j", "2"]),
    Bake("hairball", ["hairball", "-n", "20K"], ["-r", "1K", "-m", "16M", "-j", "2"])]
# Small, and yet it spills triangles and runs and saves both for --resume.
SAVING = Bake("saving", ["hairball", "-n", "20K"], ["-r", "1K", "-m", "8M", "-j", "2", "--checkpoint", "0.001"])
# Long enough to be caught in the middle, and with work to resume.
HALF_A_SECOND = Bake("half a second", ["hairball", "-n", "100K"], ["-r", "8K", "-m", "32M", "-j", "2"])
A_SECOND = Bake("a second", ["hairball", "-n", "100K"], ["-r", "16K", "-m", "1G", "-j", "2", "--checkpoint", "0.1"])
SECONDS = Bake("some seconds", ["hairball", "-n", "1M"], ["-r", "8K", "-m", "128M", "-j", "2"])


class Kitchen:
    """A scene, an old file and the bytes that an undisturbed bake gives; copies of it are where bakes run."""

    def __init__(self, bake):
        self.bake = bake
        self.folder = tempfile.TemporaryDirectory(prefix="svdag-fault-")
        self.root = pathlib.Path(self.folder.name).resolve()
        self.scene = self.root / "scene.ply"
        self.lay(self.root)
        subprocess.run([BUILD / "svdag-scene", *bake.scene, "-q", "-o", self.scene], check=True)
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

    def lay(self, folder):
        """The folder that the options name."""
        if "--scratch" in self.bake.options:
            (folder / self.bake.options[self.bake.options.index("--scratch") + 1]).mkdir()

    def table(self):
        """A fresh folder with the scene, or the runs, and the old file."""
        folder = pathlib.Path(tempfile.mkdtemp(prefix="table-", dir=self.root))
        for name in self.bake.inputs():
            shutil.copy(self.root / name, folder)
        self.lay(folder)
        (folder / OUTPUT).write_bytes(self.old)
        return folder

    def state(self, folder, output=OUTPUT):
        """What the output name holds: "old", "new", or what is wrong with it."""
        path = folder / output
        data = path.read_bytes() if path.exists() else None
        return "nothing" if data is None else {self.old: "old", self.new: "new"}.get(data, "a damaged file")


def is_input(path):
    return re.fullmatch(r"scene\.ply|\d\.run", pathlib.Path(path).name) is not None


def others(folder):
    """Names of what is neither input nor output; for the shared scratch folder, of what is in it."""
    names = {p.name for p in folder.iterdir() if not is_input(p)} - {OUTPUT, SHARED_SCRATCH}
    shared = folder / SHARED_SCRATCH
    return sorted(names | {f"{SHARED_SCRATCH}/{p.name}" for p in (shared.iterdir() if shared.exists() else ())})


def leftovers(folder, allowed=()):
    """Complaints about files that should not be there."""
    return [f"{name} was left" for name in others(folder) if not any(re.fullmatch(a, name) for a in allowed)]


def scratch_left(folder):
    """Complaints about scratch folders that outlived a finished bake."""
    return [f"{name} outlived the bake" for name in others(folder) if re.fullmatch(OF_SCRATCH, name)]


def sentences(stderr):
    """Complaints unless `stderr` is one sentence of the program."""
    if re.fullmatch(r"svdag: [^\n]+\n", stderr) and not re.search("internal error|report this", stderr):
        return []
    return [f"said {stderr!r}, not one sentence"]


class Report:
    """Counts and the last line that run_tests.py reads."""

    def __init__(self):
        self.passed = self.failed = self.skipped = 0

    def judge(self, name, complaints):
        self.passed += not complaints
        self.failed += bool(complaints)
        if complaints:
            print(f"FAILED {name}: {'; '.join(complaints)}", flush=True)

    def skip(self, reason):
        self.skipped += 1
        print(f"skipped: {reason}")

    def finish(self):
        print(f"{self.passed} passed, {self.failed} failed, {self.skipped} skipped")
        sys.exit(self.failed > 0)
