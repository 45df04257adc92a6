"""Files made of triangles and voxels, at a path or in memory."""
import contextlib
import operator
import os
import pathlib
import shutil
import tempfile
from typing import Any, Callable, Dict, Iterator, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _programs, _svdag
from ._arrays import rows, triple
from ._error import Error
from ._file import File, PathLike
from ._programs import Progress

_RULES = {"conservative": 0, "thin": 1, "solid": 2, "solid-odd": 3}
_LAYOUTS = {"plain": 0, "compact": 1}
_MEMORY = "/dev/shm"  # a file system in memory, where a small result waits for no disk
_SMALL_INPUT = 1 << 26  # bytes; of a larger one the result goes to disk
_MIN_FREE = 1 << 30  # bytes
_ROWS = 1 << 20  # of points, written at once

_Mesh = Tuple[NDArray, NDArray, Optional[NDArray]]

Made = Any  #: the report as a dict or, if the path is None, a File in memory, which has the report


def _temporary_folders(input_bytes: int) -> Iterator[str]:
    with contextlib.suppress(OSError):
        if input_bytes <= _SMALL_INPUT and shutil.disk_usage(_MEMORY).free >= _MIN_FREE and os.access(_MEMORY, os.W_OK):
            yield _MEMORY
    yield tempfile.gettempdir()


def made(path: Optional[PathLike], make: Callable[[PathLike], Dict[str, Any]], input_bytes: int) -> Made:
    """make(path). Without a path: a File of what make() writes, in a file that is removed as soon as it is mapped."""
    if path is not None:
        return make(path)
    for folder in _temporary_folders(input_bytes):
        with tempfile.TemporaryDirectory(prefix="svdag-memory-", dir=folder) as temporary:
            try:
                output = os.path.join(temporary, "memory.svdag")
                report = make(output)
                file = File(output)
            except Error as error:
                if error.code == 4 and folder == _MEMORY:
                    continue  # it does not fit there
                raise without_folder(error, temporary) from None
        file.path, file.report = None, report
        return file


def folder_beside(output: PathLike, prefix: str) -> "tempfile.TemporaryDirectory[str]":
    """A temporary folder beside the output, or where temporary files are if its folder is missing."""
    folder = os.path.dirname(os.path.abspath(os.fsdecode(output)))
    return tempfile.TemporaryDirectory(prefix=prefix, dir=folder if os.path.isdir(folder) else None)


def without_folder(error: Error, folder: PathLike) -> Error:
    """An error that does not name a temporary folder."""
    return type(error)(str(error).replace(f"{folder}/", ""), error.code, error.path.replace(f"{folder}/", ""))


def _refuse_faces(faces: Any) -> None:
    """What is given where faces were expected, usually a path, must not be ignored."""
    if faces is not None:
        raise TypeError("build: faces beside an object or a mapping that has its own: name the path, path=...")


def _colours_of(mesh: Any) -> Optional[NDArray]:
    """The colours of the vertices of a mesh of trimesh or of to_mesh(), (n, 3) uint8, or None."""
    visual = getattr(mesh, "visual", None)
    colours = visual.vertex_colors if getattr(visual, "kind", None) == "vertex" else getattr(mesh, "colours", None)
    return None if colours is None else np.asarray(colours)[:, :3].astype(np.uint8, casting="safe")


def _mesh(mesh: Any, faces: Any = None) -> _Mesh:
    """Vertices, faces and colours of a pair, or of an object that has them, such as a mesh of trimesh."""
    colours = None
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        _refuse_faces(faces)
        colours = _colours_of(mesh)
        mesh, faces = mesh.vertices, mesh.faces
    elif hasattr(mesh, "geometry"):
        raise TypeError(f"build: {type(mesh).__name__} is not a mesh: give build_files() its file, or scene.to_mesh()")
    points = rows(mesh, "<f8", "vertices")
    if colours is not None and colours.shape != points.shape:
        raise ValueError(f"build: colours of the shape {colours.shape} for vertices of {points.shape}")
    return points, rows(faces, np.int64, "faces"), colours


def write_ply(path: pathlib.Path, points: NDArray, corners: NDArray, colours: Optional[NDArray] = None) -> None:
    if len(corners) > 0 and not (corners.min() >= 0 and corners.max() < len(points)):
        raise ValueError(f"faces: an index is not 0 to {len(points) - 1}")
    if len(points) >= 2 ** 31:
        raise ValueError("vertices: 2^31 or more")
    records = np.empty(len(corners), [("n", "u1"), ("v", "<i4", 3)])
    records["n"], records["v"] = 3, corners
    channels = ""
    if colours is not None:
        channels = "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        coloured = np.empty(len(points), [("at", "<f8", 3), ("colour", "u1", 3)])
        coloured["at"], coloured["colour"] = points, colours
        points = coloured
    with path.open("wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty double x\nproperty double y\n"
                   f"property double z\n{channels}element face {len(records)}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        points.tofile(file)
        records.tofile(file)


def build(vertices: Any, faces: Optional[ArrayLike] = None, path: Optional[PathLike] = None, *, progress: Optional[Progress] = None,
          **options: Any) -> Made:
    """Bakes triangles as the file `path`, with the bytes that `svdag build` gives, and returns its report.

    vertices: (n, 3) real numbers; faces: (m, 3) indices of them. Or one object that has `vertices` and `faces`, as meshes of
    trimesh and of to_mesh(), whose colours of vertices colours=True bakes. Or a mapping from names to such pairs or objects, each a
    layer of this name.
    path: None makes a File in memory instead, whose `report` is the report.
    options: those of `svdag build`: resolution="1K" or voxel_size=0.05, rule="solid", memory="1G", layout="compact",
    bounds=(x0, y0, z0, x1, y1, z1), sandbox=True, ...
    progress: is called as progress(phase, share), with shares from 0 to 1.
    """
    if path is None and isinstance(faces, (str, os.PathLike)):
        faces, path = None, faces
    if not isinstance(vertices, Mapping):
        meshes = {"scene": _mesh(vertices, faces)}
    else:
        _refuse_faces(faces)
        meshes = {name: _mesh(*mesh) if isinstance(mesh, (tuple, list)) and not hasattr(mesh, "vertices") else _mesh(mesh)
                  for name, mesh in vertices.items()}
        options.setdefault("layers", "file")
    if not meshes:
        raise ValueError("build: the mapping has no mesh")
    for name in meshes:
        if name in ("", ".", "..") or "/" in name or "\0" in name or len(os.fsencode(name)) > 255:
            raise ValueError(f"build: {name!r} cannot be the name of a layer")

    def bake(output: PathLike) -> Dict[str, Any]:
        with folder_beside(output, ".svdag-scene-") as temporary:
            files = [pathlib.Path(temporary) / name for name in meshes]  # a layer has the name of its file
            for file, mesh in zip(files, meshes.values()):
                write_ply(file, *mesh)
            try:
                return build_files(files, output, progress=progress, **options)
            except Error as error:
                raise without_folder(error, temporary) from None
    _scratch_on_disk(path, options)
    return made(path, bake, sum(points.nbytes + corners.nbytes for points, corners, _ in meshes.values()))


def build_files(scenes: Union[PathLike, Sequence[PathLike]], path: Optional[PathLike] = None, *,
                progress: Optional[Progress] = None, **options: Any) -> Made:
    """Bakes scene files, which are one scene, as the file `path`, and returns the report. Path and options as build()."""
    files = [scenes] if isinstance(scenes, (str, os.PathLike)) else list(scenes)

    def bake(output: PathLike) -> Dict[str, Any]:
        return _programs.run_json("svdag", "build", *files, "-o", output, *_programs.words_of(options), progress=progress)
    _scratch_on_disk(path, options)
    return made(path, bake, sum(os.path.getsize(file) for file in files if os.path.isfile(file)))


def _scratch_on_disk(path: Optional[PathLike], options: Dict[str, Any]) -> None:
    """Data of a bake that does not fit in memory is not spilled to memory."""
    if path is None:
        options.setdefault("scratch", tempfile.gettempdir())


def from_coords(coords: ArrayLike, path: Optional[PathLike] = None, *, resolution: Optional[int] = None, voxel_size: float = 1.0,
                origin: Sequence[float] = (0.0, 0.0, 0.0), rule: str = "conservative", layout: str = "plain",
                memory: int = 0) -> Made:
    """Writes set voxels, (n, 3) integers in any order, as the minimal file `path`; returns counts and the content hash. None: in memory, as build().

    resolution: voxels along an axis, a power of two from 8 to 2^20; by default the least that holds them. origin: world
    position of the corner of voxel (0, 0, 0). memory: bytes, by default half of the machine's.
    """
    array = np.asarray(coords)
    if array.dtype.kind not in "iu":
        raise TypeError(f"coords: {array.dtype} is not a type of integers")
    array = array.reshape(0, 3) if array.size == 0 else array
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"coords: has the shape {array.shape}, not (n, 3)")
    low, high = (int(array.min()), int(array.max())) if array.size else (0, 0)
    if low < 0 or high >= 2 ** 20:
        raise ValueError(f"coords: {low if low < 0 else high} is not 0 to 2^20 - 1")
    side = 2 ** max(3, high.bit_length()) if resolution is None else operator.index(resolution)
    if not 8 <= side <= 2 ** 20 or side & (side - 1):
        raise ValueError(f"resolution: {side} is not a power of two from 8 to 2^20")
    if high >= side:
        raise ValueError(f"coords: {high} is outside of a grid of {side}")
    corner = triple(origin, "origin", float)
    if not (np.isfinite(corner).all() and 0 < voxel_size < np.inf):
        raise ValueError("origin and voxel_size must be finite, voxel_size more than 0")
    if rule not in _RULES or layout not in _LAYOUTS:
        raise ValueError(f"rule: one of {', '.join(_RULES)}; layout: one of {', '.join(_LAYOUTS)}")
    voxels = np.ascontiguousarray(array, np.uint32)
    scratch = "" if path is not None else tempfile.gettempdir()

    def write(output: PathLike) -> Dict[str, Any]:
        return _svdag.from_coords(voxels, os.fsencode(output), side.bit_length() - 1, corner, float(voxel_size),
                                  max(0, operator.index(memory)), _RULES[rule], _LAYOUTS[layout], os.fsencode(scratch))
    return made(path, write, voxels.nbytes)


def from_points(points: ArrayLike, path: Optional[PathLike] = None, *, colours: Optional[ArrayLike] = None, **options: Any) -> Made:
    """Writes the voxels that hold points, (n, 3) real numbers, as `svdag import` does, and returns its report. None: in memory, as build().

    colours: (n, 3) uint8, of which a voxel has the mean. options: those of `svdag import`: voxel_size=0.05 or resolution="4K",
    min_points=2, memory="1G", layout="compact", ...
    """
    array = rows(points, "<f8", "points")
    fields, channels = [("point", "<f8", 3)], ""
    if colours is not None:
        colours = np.asarray(colours)
        if colours.dtype != np.uint8 or colours.shape != array.shape:
            raise ValueError(f"colours: {colours.dtype} of the shape {colours.shape}, not uint8 of {array.shape}")
        fields.append(("colour", "u1", 3))
        channels = "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))

    def write(output: PathLike) -> Dict[str, Any]:
        with folder_beside(output, ".svdag-points-") as temporary:
            cloud = pathlib.Path(temporary) / "points.ply"
            with cloud.open("wb") as file:
                file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(array)}\nproperty double x\n"
                           f"property double y\nproperty double z\n{channels}end_header\n".encode())
                for begin in range(0, len(array), _ROWS):
                    part = np.empty(min(_ROWS, len(array) - begin), fields)
                    part["point"] = array[begin:begin + _ROWS]
                    if colours is not None:
                        part["colour"] = colours[begin:begin + _ROWS]
                    part.tofile(file)
            try:
                return _programs.run_json("svdag", "import", cloud, "-o", output, "--format=ply", *_programs.words_of(options))
            except Error as error:
                raise without_folder(error, temporary) from None
    _scratch_on_disk(path, options)
    return made(path, write, array.nbytes)


def from_array(array: ArrayLike, path: Optional[PathLike] = None, *, threshold: Optional[float] = None, **options: Any) -> Made:
    """Writes the voxels where a 3-dimensional array, axes x, y, z, is True, or not 0, or more than `threshold`.

    threshold: must be given for floats and negative integers, since distances, densities and labels mean different things.
    Options as from_coords().
    """
    voxels = np.asarray(array)
    if threshold is not None:
        voxels = voxels > threshold
    elif voxels.dtype.kind not in "biu" or (voxels.dtype.kind == "i" and voxels.size > 0 and voxels.min() < 0):
        raise TypeError(f"array: {voxels.dtype} {'with negative numbers ' if voxels.dtype.kind == 'i' else ''}needs a threshold")
    if voxels.ndim != 3:
        raise ValueError(f"array: has {voxels.ndim} dimensions, not 3")
    if max(voxels.shape, default=0) > 2 ** 20:
        raise ValueError("array: an axis is longer than 2^20")
    return from_coords(np.argwhere(voxels), path, **options)
