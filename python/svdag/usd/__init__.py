"""Bakes USD stages: svdag-usd and svdag.build_usd(). A stage becomes a GLB in scratch, and `svdag build` bakes that.

Needs usd-core, the extra [usd] of the package.
"""
import argparse
import contextlib
import os
import pathlib
import signal
import subprocess
import sys
from typing import Any, Dict, List, Optional, Sequence

from .. import _programs
from .._error import Error

PURPOSES = ("default", "render", "proxy", "guide")
_USAGE = 2


def write_glb(stage: Any, glb: Any, **options: Any) -> Dict[str, Any]:
    try:
        from . import stage as converter
    except ImportError as error:
        if not (error.name or "").startswith("pxr"):
            raise
        raise Error("USD needs usd-core, which is not installed: pip install usd-core", _USAGE) from None
    return converter.write_glb(stage, glb, **options)


@contextlib.contextmanager
def scene_of(stage, out, scratch, keep):
    """The path for the GLB: `keep`, or in a folder beside the scratch folder, which is removed in the end. It is the same each
    time, and so are its bytes: --resume finds the scene of the bake that was stopped."""
    if keep:
        yield pathlib.Path(keep)
        return
    folder = pathlib.Path(f"{os.fspath(scratch or os.fspath(out) + '.scratch')}.usd")
    glb = folder / (pathlib.Path(stage).stem + ".glb")
    try:
        try:
            folder.mkdir(exist_ok=True)
        except OSError as error:
            raise Error(f"{folder}: cannot be created: {error.strerror}", 4, str(folder)) from None
        yield glb
    finally:
        with contextlib.suppress(OSError):
            glb.unlink(missing_ok=True)
            folder.rmdir()


def convert(stage, glb, **options):
    """Writes the GLB by one rename, so that a bake never reads half of it."""
    if glb.exists() and os.path.exists(stage) and os.path.samefile(stage, glb):
        raise Error(f"{glb}: is the stage, which is not overwritten", _USAGE, str(glb))
    part = glb.with_name(f".{glb.name}.{os.getpid()}")
    try:
        summary = write_glb(stage, part, **options)
        os.replace(part, glb)
        return summary
    except OSError as error:
        raise Error(f"{glb}: {error.strerror}", 4, str(glb)) from None
    finally:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)


def parse_variant(text):
    """PRIM:SET=NAME"""
    prim, colon, rest = text.partition(":")
    name, equals, value = rest.partition("=")
    if not (colon and equals and prim and name):
        raise Error(f"--variant {text}: is not PRIM:SET=NAME", _USAGE)
    return prim, name, value


def check_purposes(purposes):
    for purpose in purposes:
        if purpose not in PURPOSES:
            raise Error(f"--purpose {purpose}: is not one of {', '.join(PURPOSES)}", _USAGE)


def build_usd(stage: Any, path: Any, *, time: Optional[float] = None, purposes: Sequence[str] = ("default", "render"),
              variants: Sequence[str] = (), keep: Any = None, progress: Optional[_programs.Progress] = None,
              **options: Any) -> Dict[str, Any]:
    """Bakes a USD stage as the file `path` and returns the report; report["usd"] has counts of the stage.

    variants: texts "PRIM:SET=NAME". keep: also keeps the GLB, under this name. options: as build(); lengths are in metres.
    """
    check_purposes(purposes)
    options.setdefault("units", "m")
    with scene_of(stage, path, options.get("scratch"), keep) as glb:
        summary = convert(stage, glb, time=time, purposes=tuple(purposes), variants=[parse_variant(v) for v in variants],
                          skip_invalid=bool(options.get("skip_invalid")))
        report = _programs.run_json("svdag", "build", glb, "-o", path, *_programs.words_of(options), progress=progress)
    return {**report, "usd": summary}


def describe(summary):
    """One line: what the stage holds, what is left out, what is taken otherwise."""
    def listed(counts):
        return ", ".join(f"{what} ({n:,})" if n else what for what, n in counts.items())
    line = (f"{summary['meshes']:,} meshes in {summary['instances']:,} places, {summary['triangles']:,} triangles, "
            f"units of {summary['metres_per_unit']:g} m, {summary['up_axis']} up")
    if summary["left_out"]:
        line += f"; left out: {listed(summary['left_out'])}"
    if summary["notes"]:
        line += f"; note: {listed(summary['notes'])}"
    return line


def run_build(words):
    """Exit code of svdag. Ctrl-C reaches it from the terminal; a SIGTERM is passed on."""
    with subprocess.Popen([_programs.program("svdag"), "build", *words]) as process:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, lambda *_: process.terminate())
        code = process.wait()
    return code if code >= 0 else 128 - code


def option(words, name):
    """The value of --NAME among options of svdag build, or None."""
    for i, word in enumerate(words):
        if word.startswith(f"--{name}="):
            return word.partition("=")[2]
        if word == f"--{name}":
            return words[i + 1] if i + 1 < len(words) else ""
    return None


def run(arguments: List[str]) -> int:
    at = arguments.index("--") if "--" in arguments else len(arguments)
    own, build = arguments[:at], arguments[at + 1:]
    parser = argparse.ArgumentParser(
        prog="svdag-usd", allow_abbrev=False, usage="svdag-usd STAGE -o OUT [OPTIONS] -- OPTIONS OF svdag build",
        description="Bake a USD stage as one .svdag, in metres with y up.",
        epilog="example: svdag-usd kitchen.usdz -o kitchen.svdag -- -s 1cm --layers material")
    parser.add_argument("stage", metavar="STAGE", help="a .usd, .usda, .usdc or .usdz file")
    parser.add_argument("-o", "--output", metavar="OUT", required=True, help="the .svdag to write")
    parser.add_argument("--time", type=float, metavar="T", help="time code at which attributes are read (default: the default time)")
    parser.add_argument("--purpose", action="append", metavar="NAME",
                        help="bake prims of this purpose: default, render, proxy or guide; may be repeated (default: default and "
                             "render)")
    parser.add_argument("--variant", action="append", default=[], metavar="PRIM:SET=NAME",
                        help="select a variant; may be repeated")
    parser.add_argument("--keep", metavar="FILE.glb", help="keep the GLB that is baked, for svdag plan or svdag-verify mesh")
    options = parser.parse_args(own)
    purposes = options.purpose or ["default", "render"]
    check_purposes(purposes)
    if option(build, "units") is None:
        build = ["--units=m", *build]
    with scene_of(options.stage, options.output, option(build, "scratch"), options.keep) as glb:
        summary = convert(options.stage, glb, time=options.time, purposes=tuple(purposes),
                          variants=[parse_variant(v) for v in options.variant], skip_invalid="--skip-invalid" in build)
        if not {"-q", "--quiet"} & set(build):
            print(f"{options.stage}: {describe(summary)}", file=sys.stderr)
        return run_build([os.fspath(glb), "-o", options.output, *build])


def main() -> None:
    """The command line svdag-usd."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))  # what was begun is removed
    try:
        sys.exit(run(sys.argv[1:]))
    except Error as error:
        print(f"svdag-usd: {error}", file=sys.stderr)
        sys.exit(error.code)
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)
