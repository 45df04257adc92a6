"""What NumPy and other programs hold: surfaces as arrays, point clouds that laspy reads."""
import contextlib
import os
import pathlib
import re
import tempfile
from typing import Any, Dict, Iterator, NamedTuple, Optional, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from . import _programs
from ._commands import Input, export
from ._error import Error
from ._file import PathLike
from ._make import folder_beside, without_folder

_USAGE = 2
_POINTS = 1 << 20  # of a LAZ, decompressed at once


class Mesh(NamedTuple):
    """A surface of triangles.

    vertices: (n, 3) float64, in world units.
    faces: (m, 3) int64; the corners run counterclockwise seen from outside. Faces 2k and 2k + 1 are a quad.
    colours: (n, 3) uint8 sRGB, or None.
    """
    vertices: NDArray
    faces: NDArray
    colours: Optional[NDArray]


def _read_surface(path: pathlib.Path) -> Mesh:
    """The surface that svdag-export wrote as a PLY."""
    with path.open("rb") as file:
        header = b""
        while not header.endswith(b"end_header\n"):
            header += file.readline()
        vertices, quads = (int(n) for n in re.findall(rb"element \w+ (\d+)", header))
        colour = [("colour", "u1", 3)] if b"property uchar red" in header else []
        of_vertices = np.fromfile(file, [("at", "<f8", 3), *colour], vertices)
        corners = np.fromfile(file, [("n", "u1"), ("corners", "<u4", 4)], quads)["corners"]
    return Mesh(np.ascontiguousarray(of_vertices["at"]), corners[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3).astype(np.int64),
                np.ascontiguousarray(of_vertices["colour"]) if colour else None)


def to_mesh(path: Input, **options: Any) -> Mesh:
    """The surface of the set voxels, closed and oriented, as `svdag export` writes it: vertices, faces, colours.

    options: level=9, layer="roof", bounds=(x0, y0, z0, x1, y1, z1), max_quads=10 ** 6, no_merge=True (two triangles for each face
    of a voxel, edge to edge). `trimesh.Trimesh(*svdag.to_mesh(file, level=9)[:2])`.
    """
    with tempfile.TemporaryDirectory(prefix="svdag-surface-") as temporary:
        surface = pathlib.Path(temporary) / "surface.ply"
        try:
            export(path, surface, format="ply-surface", **options)
        except Error as error:
            raise without_folder(error, temporary) from None
        return _read_surface(surface)


@contextlib.contextmanager
def _without_laz(path: PathLike, output: PathLike) -> Iterator[PathLike]:
    """The path, or that of a temporary LAS beside the output with the points of a LAZ."""
    if not os.fsdecode(path).lower().endswith(".laz"):
        yield path
        return
    try:
        import laspy
        if not laspy.LazBackend.detect_available():
            raise ImportError("no backend")
    except ImportError:
        raise Error(f"{os.fsdecode(path)}: LAZ needs laspy, which is not installed: pip install 'laspy[lazrs]'", _USAGE) from None
    with folder_beside(output, ".svdag-laz-") as temporary:
        las = os.path.join(temporary, pathlib.Path(os.fsdecode(path)).stem + ".las")
        try:
            with laspy.open(path) as compressed, laspy.open(las, "w", header=compressed.header) as out:
                for points in compressed.chunk_iterator(_POINTS):
                    out.write_points(points)
        except OSError:
            raise
        except Exception as error:  # laspy's own, and those of its decompressor
            raise Error(f"{os.fsdecode(path)}: laspy cannot read it: {error}", 3) from None
        try:
            yield las
        except Error as error:
            raise without_folder(error, temporary) from None


def import_file(path: Union[PathLike, Sequence[PathLike]], output: PathLike, **options: Any) -> Dict[str, Any]:
    """Writes the voxels of another program's file as a .svdag, as `svdag import`: .npz, .vox, .vdb, .ply, .las, ...

    Several files of points are one cloud. A .laz is decompressed by laspy, beside the output.
    """
    files = [path] if isinstance(path, (str, os.PathLike)) else list(path)
    with contextlib.ExitStack() as stack:
        read = [stack.enter_context(_without_laz(file, output)) for file in files]
        return _programs.run_json("svdag-import", *read, "-o", output, *_programs.words_of(options))
