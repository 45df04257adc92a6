"""Sparse voxel DAGs: reads, queries, makes and verifies .svdag files.

    import svdag
    report = svdag.build(vertices, faces, "hall.svdag", resolution="1K")
    with svdag.open("hall.svdag") as hall:
        window = hall.window((0, 0, 0), (64, 64, 64))

Voxel coordinates are integers from 0 to resolution - 1, in the order x, y, z; world coordinates are those of the scene.
What fails raises svdag.Error.
"""
import functools as _functools
import json as _json
import operator as _operator
import os as _os
import pathlib as _pathlib
import tempfile as _tempfile
from typing import Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as _np
from numpy.typing import ArrayLike, NDArray

from . import _programs, _svdag
from ._error import Error
from ._programs import Progress
from .usd import build_usd

__all__ = ["Error", "File", "Hits", "Layer", "build", "build_files", "build_usd", "diff", "export", "from_array", "from_coords",
           "open", "unpack_bricks", "verify_mesh"]
__version__ = _svdag.__version__

PathLike = Union[str, _os.PathLike]
Corner = Sequence[int]
_RULES = {"conservative": 0, "thin": 1, "solid": 2, "solid-odd": 3}
_LAYOUTS = {"plain": 0, "compact": 1}
_FAR = 2 ** 40  # beyond every grid


class Layer(NamedTuple):
    """A layer of a file: `colour` is sRGB, 0 .. 255; `voxels` their number."""
    name: str
    colour: Tuple[int, int, int]
    voxels: int


class _Hits(NamedTuple):
    t: NDArray
    voxel: NDArray
    normal: NDArray
    layer: NDArray


class Hits(_Hits):
    """What n rays hit first.

    t: (n,) float64, in units of the direction's length; infinite where nothing is hit.
    voxel: (n, 3) int32; -1 where nothing is hit.
    normal: (n, 3) int8, of the face through which the ray enters the voxel; 0 where nothing is hit.
    layer: (n,) int32, the first layer that holds the voxel; -1 without one.
    colour: (n, 3) uint8, of the voxel, as File.colours() finds it at the first use.
    """
    _file: "File"

    @_functools.cached_property
    def colour(self) -> NDArray:
        return self._file.colours(self.voxel)


def _rows(values: ArrayLike, dtype: Any, name: str) -> NDArray:
    array = _np.asarray(values)
    if array.size > 0 and array.dtype.kind not in ("iu" if _np.dtype(dtype).kind == "i" else "iuf"):
        raise TypeError(f"{name}: {array.dtype} is not a type of {'integers' if _np.dtype(dtype).kind == 'i' else 'real numbers'}")
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name}: has the shape {array.shape}, not (n, 3)")
    return _np.ascontiguousarray(array, dtype)


def _points(values: ArrayLike) -> NDArray:
    """Rows of integers, which are voxels, or of floats, which are of the world."""
    array = _np.asarray(values)
    if array.dtype == _np.uint64:
        array = _np.minimum(array, 2 ** 62)
    return _rows(array, _np.int64 if array.dtype.kind in "iu" else _np.float64, "points")


def _triple(values: Any, name: str, to: Any = _operator.index) -> tuple:
    triple = tuple(to(v) for v in values)
    if len(triple) != 3:
        raise ValueError(f"{name}: has {len(triple)} numbers, not 3")
    if to is _operator.index:
        triple = tuple(max(-_FAR, min(_FAR, v)) for v in triple)
    return triple


class File:
    """A .svdag file, plain, compact or packed, mapped for reading. Use as a context manager, or close() it.

    Queries use all processors and release the GIL; a File may be used by several threads.
    """

    def __init__(self, path: PathLike, layers: Sequence[str] = (), level: Optional[int] = None,
                 bounds: Optional[Sequence[float]] = None):
        """Raises Error if the file cannot be read or is damaged.

        The rest selects a part, which is made a file of its own: only these layers, the coarser grid of 2^level voxels on a
        side, only the voxels in the box bounds=(x0, y0, z0, x1, y1, z1) in world units.
        """
        if isinstance(layers, str):
            layers = (layers,)
        names = [layer.encode(errors="surrogateescape") for layer in layers]
        box = None if bounds is None else tuple(float(v) for v in bounds)
        if box is not None and (len(box) != 6 or not all(box[a] <= box[a + 3] for a in range(3))):
            raise ValueError(f"bounds: {bounds!r} is not (x0, y0, z0, x1, y1, z1) with the minimum first")
        self._file: Optional[_svdag.File] = _svdag.File(_os.fsencode(path), names, level, box)
        info = self._file.info()
        self.path = _os.fsdecode(path)
        self.levels: int = info["levels"]  #: L; the grid has 2^L voxels on a side
        self.resolution: int = 2 ** self.levels  #: voxels along an axis
        self.voxel_size: float = info["voxel_size"]  #: side of a voxel, in world units
        self.origin: NDArray = _np.array(info["corner"])  #: (3,) world position of the corner of voxel (0, 0, 0)
        self.voxels: int = info["voxels"]  #: number of set voxels
        self.rule: str = info["rule"]  #: conservative, thin, solid or solid-odd
        self.layout: str = info["layout"]  #: plain or compact
        self.content_hash: str = info["content_hash"]  #: equal for files with the same voxels and grid
        self.metadata: dict = _json.loads(info["metadata"].decode(errors="replace") or "{}")
        self.layers: List[Layer] = [Layer(name.decode(errors="surrogateescape"), colour, voxels)
                                    for name, colour, voxels in info["layers"]]

    def __enter__(self) -> "File":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<svdag.File {self.path!r}: {self.resolution}^3, {self.voxels:,} voxels, rule {self.rule}>"

    def close(self) -> None:
        self._file = None

    @property
    def bounds(self) -> NDArray:
        """(2, 3) box of the grid, in world units."""
        return _np.array([self.origin, self.origin + self.resolution * self.voxel_size])

    @property
    def occupied_voxels(self) -> NDArray:
        """(2, 3) box of the set voxels, in voxels; the end is exclusive."""
        return _np.array(self._open().occupied_box())

    @property
    def occupied_bounds(self) -> NDArray:
        """(2, 3) box of the set voxels, in world units."""
        return self.origin + self.occupied_voxels * self.voxel_size

    def _open(self) -> _svdag.File:
        if self._file is None:
            raise ValueError(f"{self.path}: is closed")
        return self._file

    def _layer(self, layer: Union[None, int, str]) -> int:
        if layer is None:
            return -1
        if isinstance(layer, str):
            for number, each in enumerate(self.layers):
                if each.name == layer:
                    return number
            raise KeyError(f"{self.path}: has no layer {layer!r}")
        number = _operator.index(layer)
        if not 0 <= number < len(self.layers):
            raise IndexError(f"{self.path}: has {len(self.layers)} layers, and none of number {number}")
        return number

    def _level(self, level: Optional[int]) -> int:
        if level is None:
            return self.levels
        number = _operator.index(level)
        if not 3 <= number <= self.levels:
            raise ValueError(f"level {number} is not 3 to {self.levels}")
        return number

    def _fill(self, fill: Sequence[int]) -> tuple:
        if "colours" not in self.metadata:
            raise ValueError(f"{self.path}: has no colours: svdag colour FILE SCENE... adds them")
        colour = _triple(fill, "fill")
        if not all(0 <= c <= 255 for c in colour):
            raise ValueError(f"fill: {colour} is not three numbers from 0 to 255")
        return colour

    def _box(self, lo: Optional[Corner], hi: Optional[Corner], level: int) -> Tuple[tuple, tuple]:
        low = (0, 0, 0) if lo is None else _triple(lo, "lo")
        high = (2 ** level,) * 3 if hi is None else _triple(hi, "hi")
        return low, tuple(max(a, b) for a, b in zip(low, high))

    def _window(self, lo: Corner, hi: Corner, level: int) -> Tuple[tuple, tuple]:
        low, high = self._box(lo, hi, level)
        size = 1
        for a, b in zip(low, high):
            size *= b - a
        if size > 2 ** 44:
            raise MemoryError(f"a window of {size:,} voxels")
        return low, high

    def window(self, lo: Corner, hi: Corner, level: Optional[int] = None, layer: Union[None, int, str] = None) -> NDArray:
        """The voxels lo .. hi - 1 as a bool array in C order, axes x, y, z. What is outside of the grid is False.

        level: 3 .. levels; that of voxels by default. A coarser cube is set if any of its voxels is. lo and hi count
        cubes of this level. layer: name or number; by default all.
        """
        at = self._level(level)
        return self._open().window(*self._window(lo, hi, at), at, self._layer(layer))

    def window_colours(self, lo: Corner, hi: Corner, level: Optional[int] = None, fill: Sequence[int] = (0, 0, 0)) -> NDArray:
        """The colours of the voxels lo .. hi - 1, (x, y, z, 3) uint8 sRGB. Arguments as window() and colours()."""
        at = self._level(level)
        return self._open().window_colours(*self._window(lo, hi, at), at, self._fill(fill))

    def coords(self, lo: Optional[Corner] = None, hi: Optional[Corner] = None, level: Optional[int] = None,
               layer: Union[None, int, str] = None) -> NDArray:
        """The set voxels lo .. hi - 1 as an (n, 3) int32 array, in Morton order; by default all. Arguments as window()."""
        at = self._level(level)
        return self._open().coords(*self._box(lo, hi, at), at, self._layer(layer))

    def sphere(self, center: ArrayLike, radius: float, layer: Union[None, int, str] = None) -> NDArray:
        """The set voxels that a closed ball touches, as coords(). center and radius are in voxels: voxel k is k .. k + 1."""
        middle = _triple(_np.asarray(center, float).ravel(), "center", float)
        if not (_np.isfinite(middle).all() and 0 <= radius < _FAR):
            raise ValueError("sphere: center and radius must be finite, the radius 0 or more")
        return self._open().ball(middle, float(radius), self._layer(layer))

    def bricks(self, lo: Optional[Corner] = None, hi: Optional[Corner] = None, layer: Union[None, int, str] = None,
               chunk: int = 1 << 16) -> Iterator[Tuple[NDArray, NDArray]]:
        """Iterates over the bricks, 4 x 4 x 4 voxels, that meet a box, in Morton order, `chunk` at a time.

        Yields their corners, (n, 3) int32, and their voxels, (n,) uint64, which unpack_bricks() unpacks.
        """
        low, high = self._box(lo, hi, self.levels)
        number, first = self._layer(layer), 0
        count = _operator.index(chunk)
        if not 1 <= count <= 1 << 28:
            raise ValueError(f"chunk: {count} is not 1 to {1 << 28}")
        while True:
            corners, words = self._open().bricks(low, high, first, count, number)
            if len(words) > 0:
                yield corners, words
            if len(words) < count:
                return
            first = 1
            code = 0
            for bit in range(20):
                for axis in range(3):
                    code |= (int(corners[-1, axis]) >> (bit + 2) & 1) << (3 * bit + 2 - axis)
            first += code

    def occupied(self, points: ArrayLike, layer: Union[None, int, str] = None) -> NDArray:
        """Whether voxels are set: (n,) bool for (n, 3) points.

        Integers are voxel coordinates, floats are world coordinates. What is outside of the grid is False.
        """
        rows, file = _points(points), self._open()
        return (file.occupied_voxels if rows.dtype.kind == "i" else file.occupied_points)(rows, self._layer(layer))

    def colours(self, points: ArrayLike, level: Optional[int] = None, fill: Sequence[int] = (0, 0, 0)) -> NDArray:
        """The colours of the voxels that hold (n, 3) points, (n, 3) uint8 sRGB. Points as occupied().

        level: 3 .. levels; that of voxels by default. A coarser cube has the mean colour of its voxels; integers count cubes of
        this level. fill: what a point gets that is not in a set voxel, or in one without a colour (full cubes inside a solid).
        ValueError if the file has no colours.
        """
        at, colour = self._level(level), self._fill(fill)
        rows, file = _points(points), self._open()
        return (file.colours_voxels if rows.dtype.kind == "i" else file.colours_points)(rows, at, colour)

    def nearest(self, points: ArrayLike, max_distance: float = _np.inf,
                layer: Union[None, int, str] = None) -> Tuple[NDArray, NDArray]:
        """The set voxels nearest to (n, 3) points: voxels, (n, 3) int32, and distances, (n,) float64 in world units.

        Floats are world coordinates, integers are voxels and stand for their middles. The distance is that to the closed cube of
        the voxel, 0 inside. Of several at the same distance, the first in the order of coords(). -1 and infinite where no voxel is
        within max_distance (world units). Exact for the point rounded to 2^-23 voxel; at most 2^36 voxels from the grid's corner.
        """
        limit = float(max_distance)
        if not limit >= 0:
            raise ValueError("nearest: max_distance must be 0 or more")
        rows, file = _points(points), self._open()
        return (file.nearest_voxels if rows.dtype.kind == "i" else file.nearest_points)(rows, limit, self._layer(layer))

    def box_occupied(self, lo: Corner, hi: Corner, layer: Union[None, int, str] = None) -> bool:
        """Whether any of the voxels lo .. hi - 1 is set."""
        return self._open().box_occupied(*self._box(lo, hi, self.levels), self._layer(layer))

    def count(self, lo: Optional[Corner] = None, hi: Optional[Corner] = None, level: Optional[int] = None,
              layer: Union[None, int, str] = None) -> int:
        """The number of set voxels lo .. hi - 1. Arguments as window(); follows the DAG, not the voxels."""
        at = self._level(level)
        return self._open().count(*self._box(lo, hi, at), at, self._layer(layer))

    def trace(self, origins: ArrayLike, directions: ArrayLike, tmax: float = _np.inf,
              layer: Union[None, int, str] = None) -> Hits:
        """The first voxel along each ray, exactly, as svdag-trace finds it.

        origins, directions: (n, 3) or (3,), world coordinates; directions of any length but 0. Hits beyond tmax, in
        units of the direction's length, do not count.
        """
        o = _rows(_np.atleast_2d(origins), _np.float64, "origins")
        d = _rows(_np.atleast_2d(directions), _np.float64, "directions")
        if not tmax >= 0:
            raise ValueError("trace: tmax must be 0 or more")
        hits = Hits(*self._open().trace(o, d, min(float(tmax), 1e300), self._layer(layer)))
        hits._file = self
        return hits


def open(path: PathLike, layers: Sequence[str] = (), level: Optional[int] = None,  # noqa: A001
         bounds: Optional[Sequence[float]] = None) -> File:
    """Opens a .svdag file, plain, compact or packed, or a part of it, as File does. A packed file, and a part, are written to
    a temporary file first."""
    return File(path, layers, level, bounds)


def unpack_bricks(bricks: ArrayLike) -> NDArray:
    """The voxels of n bricks, (n, 4, 4, 4) bool, from their words, (n,) uint64."""
    words = _np.ascontiguousarray(bricks, _np.uint64)
    x, y, z = _np.meshgrid(*[_np.arange(4)] * 3, indexing="ij")
    bit = (8 * (4 * (x >> 1) + 2 * (y >> 1) + (z >> 1)) + 4 * (x & 1) + 2 * (y & 1) + (z & 1)).astype(_np.uint64)
    return (words[:, None, None, None] >> bit & _np.uint64(1)).astype(bool)


def _mesh(mesh: Any, faces: Any = None) -> Tuple[NDArray, NDArray]:
    """Vertices and faces of a pair, or of an object that has them, such as a mesh of trimesh."""
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        mesh, faces = mesh.vertices, mesh.faces
    return _rows(mesh, "<f8", "vertices"), _rows(faces, _np.int64, "faces")


def _write_ply(path: _pathlib.Path, points: NDArray, corners: NDArray) -> None:
    if len(corners) > 0 and not (corners.min() >= 0 and corners.max() < len(points)):
        raise ValueError(f"faces: an index is not 0 to {len(points) - 1}")
    if len(points) >= 2 ** 31:
        raise ValueError("vertices: 2^31 or more")
    rows = _np.empty(len(corners), [("n", "u1"), ("v", "<i4", 3)])
    rows["n"], rows["v"] = 3, corners
    with path.open("wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty double x\nproperty double y\n"
                   f"property double z\nelement face {len(rows)}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        points.tofile(file)
        rows.tofile(file)


def build(vertices: Any, faces: Optional[ArrayLike] = None, path: PathLike = "", *, progress: Optional[Progress] = None,
          **options: Any) -> Dict[str, Any]:
    """Bakes triangles as the file `path`, with the bytes that `svdag build` gives, and returns its report.

    vertices: (n, 3) real numbers; faces: (m, 3) indices of them. Or one object that has `vertices` and `faces`, as meshes of
    trimesh. Or a mapping from names to such pairs or objects, each a layer of this name.
    options: those of `svdag build`: resolution="1K" or voxel_size=0.05, rule="solid", memory="1G", layout="compact",
    bounds=(x0, y0, z0, x1, y1, z1), sandbox=True, ...
    progress: is called as progress(phase, share), with shares from 0 to 1.
    """
    if not path:
        raise ValueError("build: path is missing")
    if not isinstance(vertices, Mapping):
        meshes = {"scene": _mesh(vertices, faces)}
    else:
        meshes = {name: _mesh(*mesh) if isinstance(mesh, (tuple, list)) else _mesh(mesh) for name, mesh in vertices.items()}
        options.setdefault("layers", "file")
    if not meshes:
        raise ValueError("build: there is no mesh")
    for name in meshes:
        if name in ("", ".", "..") or "/" in name or "\0" in name or len(_os.fsencode(name)) > 255:
            raise ValueError(f"build: {name!r} cannot be the name of a layer")
    folder = _os.path.dirname(_os.path.abspath(_os.fsdecode(path)))
    with _tempfile.TemporaryDirectory(prefix=".svdag-scene-", dir=folder if _os.path.isdir(folder) else None) as temporary:
        files = [_pathlib.Path(temporary) / name for name in meshes]  # a layer has the name of its file
        for file, (points, corners) in zip(files, meshes.values()):
            _write_ply(file, points, corners)
        try:
            return build_files(files, path, progress=progress, **options)
        except Error as error:
            raise type(error)(str(error).replace(f"{temporary}/", ""), error.code,
                              error.path.replace(f"{temporary}/", "")) from None


def build_files(scenes: Union[PathLike, Sequence[PathLike]], path: PathLike, *, progress: Optional[Progress] = None,
                **options: Any) -> Dict[str, Any]:
    """Bakes scene files, which are one scene, as the file `path`, and returns the report. Options as build()."""
    files = [scenes] if isinstance(scenes, (str, _os.PathLike)) else list(scenes)
    return _programs.run_json("svdag", "build", *files, "-o", path, *_programs.words_of(options), progress=progress)


def from_coords(coords: ArrayLike, path: PathLike, *, resolution: Optional[int] = None, voxel_size: float = 1.0,
                origin: Sequence[float] = (0.0, 0.0, 0.0), rule: str = "conservative", layout: str = "plain",
                memory: int = 0) -> Dict[str, Any]:
    """Writes set voxels, (n, 3) integers in any order, as the minimal file `path`; returns counts and the content hash.

    resolution: voxels along an axis, a power of two from 8 to 2^20; by default the least that holds them. origin: world
    position of the corner of voxel (0, 0, 0). memory: bytes, by default half of the machine's.
    """
    array = _np.asarray(coords)
    if array.dtype.kind not in "iu":
        raise TypeError(f"coords: {array.dtype} is not a type of integers")
    array = array.reshape(0, 3) if array.size == 0 else array
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"coords: has the shape {array.shape}, not (n, 3)")
    low, high = (int(array.min()), int(array.max())) if array.size else (0, 0)
    if low < 0 or high >= 2 ** 20:
        raise ValueError(f"coords: {low if low < 0 else high} is not 0 to 2^20 - 1")
    side = 2 ** max(3, high.bit_length()) if resolution is None else _operator.index(resolution)
    if not 8 <= side <= 2 ** 20 or side & (side - 1):
        raise ValueError(f"resolution: {side} is not a power of two from 8 to 2^20")
    if high >= side:
        raise ValueError(f"coords: {high} is outside of a grid of {side}")
    corner = _triple(origin, "origin", float)
    if not (_np.isfinite(corner).all() and 0 < voxel_size < _np.inf):
        raise ValueError("origin and voxel_size must be finite, voxel_size more than 0")
    if rule not in _RULES or layout not in _LAYOUTS:
        raise ValueError(f"rule: one of {', '.join(_RULES)}; layout: one of {', '.join(_LAYOUTS)}")
    return _svdag.from_coords(_np.ascontiguousarray(array, _np.uint32), _os.fsencode(path), side.bit_length() - 1, corner,
                              float(voxel_size), max(0, _operator.index(memory)), _RULES[rule], _LAYOUTS[layout])


def from_array(array: ArrayLike, path: PathLike, *, threshold: Optional[float] = None, **options: Any) -> Dict[str, Any]:
    """Writes the voxels where a 3-dimensional array, axes x, y, z, is True, or not 0, or more than `threshold`.

    threshold: must be given for floats and negative integers, since distances, densities and labels mean different things.
    Options as from_coords().
    """
    voxels = _np.asarray(array)
    if threshold is not None:
        voxels = voxels > threshold
    elif voxels.dtype.kind not in "biu" or (voxels.dtype.kind == "i" and voxels.size > 0 and voxels.min() < 0):
        raise TypeError(f"array: {voxels.dtype} {'with negative numbers ' if voxels.dtype.kind == 'i' else ''}needs a threshold")
    if voxels.ndim != 3:
        raise ValueError(f"array: has {voxels.ndim} dimensions, not 3")
    if max(voxels.shape, default=0) > 2 ** 20:
        raise ValueError("array: an axis is longer than 2^20")
    return from_coords(_np.argwhere(voxels), path, **options)


def verify_mesh(path: PathLike, scenes: Union[PathLike, Sequence[PathLike]], **options: Any) -> Dict[str, Any]:
    """Judges a file against its scene by an independent voxelizer: the verdict of `svdag-verify mesh --json`.

    verdict["ok"] says whether it holds. Options as there: sample="100K", memory="1G", ...
    """
    files = [scenes] if isinstance(scenes, (str, _os.PathLike)) else list(scenes)
    return _programs.run_json("svdag-verify", "mesh", path, *files, *_programs.words_of(options), accept=(0, 1))


def diff(a: PathLike, b: PathLike, **options: Any) -> Dict[str, Any]:
    """Compares two files voxel by voxel: the verdict of `svdag-verify diff --json`; verdict["same"] says whether they agree."""
    return _programs.run_json("svdag-verify", "diff", a, b, *_programs.words_of(options), accept=(0, 1))


def export(path: PathLike, output: PathLike, **options: Any) -> None:
    """Writes a file in the format of another program, by the ending of `output`, as `svdag export` does."""
    _programs.run("svdag-export", path, "-o", output, *_programs.words_of(options))
