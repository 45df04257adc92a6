"""Sparse voxel DAGs: reads, queries, makes and verifies .svdag files.

    import svdag
    report = svdag.build(vertices, faces, "hall.svdag", resolution="1K")
    with svdag.open("hall.svdag") as hall:
        window = hall.window((0, 0, 0), (64, 64, 64))

Voxel coordinates are integers from 0 to resolution - 1, in the order x, y, z; world coordinates are those of the scene.
What fails raises svdag.Error.
"""
from . import _svdag
from ._commands import convert, diff, edit, export, info, pack, unpack, verify_mesh
from ._error import Error
from ._exchange import Mesh, import_file, to_mesh
from ._file import File, Hits, Layer, open, unpack_bricks  # noqa: A004
from ._make import build, build_files, from_array, from_coords, from_points
from .usd import build_usd

__all__ = ["Error", "File", "Hits", "Layer", "Mesh", "build", "build_files", "build_usd", "convert", "diff", "edit", "export",
           "from_array", "from_coords", "from_points", "import_file", "info", "open", "pack", "to_mesh", "unpack",
           "unpack_bricks", "verify_mesh"]
__version__ = _svdag.__version__
