"""The other programs and commands as functions: their options by keyword, their reports as dicts."""
import os
from typing import Any, Dict, Optional, Sequence, Union

from . import _programs
from ._file import File, PathLike

Input = Union[PathLike, File]


def _path(file: Input) -> PathLike:
    if not isinstance(file, File):
        return file
    if file.path is None:
        raise ValueError("a svdag.File in memory has no path: make it with one")
    return file.path


def _run(command: str, *words: Any, **options: Any) -> Dict[str, Any]:
    return _programs.run_json("svdag", command, *words, *_programs.words_of(options))


def info(path: Input, **options: Any) -> Dict[str, Any]:
    """What `svdag info --json` says of a .svdag, a .run, a plan or a scene: layers=True, parts=True, ..."""
    return _run("info", _path(path), **options)


def edit(a: Input, b: Optional[Input] = None, *, output: PathLike, **options: Any) -> Dict[str, Any]:
    """Combines two files (union=True, intersection=True or difference=True), crops or coarsens one (bounds=, level=, layer=), as
    `svdag edit`, and returns its report."""
    return _run("edit", _path(a), *([] if b is None else [_path(b)]), "-o", output, **options)


def convert(path: Input, output: PathLike, **options: Any) -> Dict[str, Any]:
    """Writes a file in another layout, or a part of it, as `svdag convert`: layout="compact", layer="roof", no_colours=True, ..."""
    return _run("convert", _path(path), "-o", output, **options)


def pack(path: Input, output: PathLike, **options: Any) -> Dict[str, Any]:
    """Compresses a file for shipping, as `svdag pack`. The name of the output ends in .pack."""
    return _run("pack", _path(path), "-o", output, **options)


def unpack(path: PathLike, output: PathLike, **options: Any) -> Dict[str, Any]:
    """Writes the file of a .pack, as `svdag unpack`."""
    return _run("unpack", path, "-o", output, **options)


def export(path: Input, output: PathLike, **options: Any) -> Dict[str, Any]:
    """Writes a file in the format of another program, by the ending of `output`, as `svdag export`."""
    return _programs.run_json("svdag-export", _path(path), "-o", output, *_programs.words_of(options))


def verify_mesh(path: Input, scenes: Union[PathLike, Sequence[PathLike]], **options: Any) -> Dict[str, Any]:
    """Judges a file against its scene by an independent voxelizer: the verdict of `svdag-verify mesh --json`.

    verdict["ok"] says whether it holds. Options as there: sample="100K", memory="1G", ...
    """
    files = [scenes] if isinstance(scenes, (str, os.PathLike)) else list(scenes)
    return _programs.run_json("svdag-verify", "mesh", _path(path), *files, *_programs.words_of(options), accept=(0, 1))


def diff(a: Input, b: Input, **options: Any) -> Dict[str, Any]:
    """Compares two files voxel by voxel: the verdict of `svdag-verify diff --json`; verdict["same"] says whether they agree."""
    return _programs.run_json("svdag-verify", "diff", _path(a), _path(b), *_programs.words_of(options), accept=(0, 1))
