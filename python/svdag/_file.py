"""Files opened for reading, and their queries."""
import functools
import json
import operator
import os
from typing import Any, Iterator, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _svdag
from ._arrays import points_of, rows, triple

PathLike = Union[str, os.PathLike]
Corner = Sequence[int]


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

    @functools.cached_property
    def colour(self) -> NDArray:
        return self._file.colours(self.voxel)


class File:
    """A .svdag file, plain, compact or packed, mapped for reading. Use as a context manager, or close() it.

    Queries release the GIL; a File may be used by several threads. threads= of a query: by default all processors. A File is pickled
    by its path.
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
        self._file: Optional[_svdag.File] = _svdag.File(os.fsencode(path), names, level, box)
        info = self._file.info()
        self.path: Optional[str] = os.fsdecode(path)  #: None: in memory
        self.report: Optional[dict] = None  #: of a file in memory: that of what made it
        self._opened = os.path.abspath(self.path), tuple(layers), level, box
        self.levels: int = info["levels"]  #: L; the grid has 2^L voxels on a side
        self.resolution: int = 2 ** self.levels  #: voxels along an axis
        self.voxel_size: float = info["voxel_size"]  #: side of a voxel, in world units
        self.origin: NDArray = np.array(info["corner"])  #: (3,) world position of the corner of voxel (0, 0, 0)
        self.voxels: int = info["voxels"]  #: number of set voxels
        self.rule: str = info["rule"]  #: conservative, thin, solid, solid-odd or points
        self.layout: str = info["layout"]  #: plain or compact
        self.content_hash: str = info["content_hash"]  #: equal for files with the same voxels and grid
        self.metadata: dict = json.loads(info["metadata"].decode(errors="replace") or "{}")
        self.layers: List[Layer] = [Layer(name.decode(errors="surrogateescape"), colour, voxels)
                                    for name, colour, voxels in info["layers"]]

    def __enter__(self) -> "File":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<svdag.File {self._name()}: {self.resolution}^3, {self.voxels:,} voxels, rule {self.rule}>"

    def close(self) -> None:
        self._file = None

    def __reduce__(self) -> Any:
        """Pickled by path: the other process opens the file again."""
        self._open()
        if self.path is None:
            raise TypeError("a svdag.File in memory cannot be pickled: make it with a path")
        return File, self._opened

    @property
    def bounds(self) -> NDArray:
        """(2, 3) box of the grid, in world units."""
        return np.array([self.origin, self.origin + self.resolution * self.voxel_size])

    @property
    def occupied_voxels(self) -> NDArray:
        """(2, 3) box of the set voxels, in voxels; the end is exclusive."""
        return np.array(self._open().occupied_box())

    @property
    def occupied_bounds(self) -> NDArray:
        """(2, 3) box of the set voxels, in world units."""
        return self.origin + self.occupied_voxels * self.voxel_size

    def _name(self) -> str:
        return "in memory" if self.path is None else self.path

    def _open(self) -> _svdag.File:
        if self._file is None:
            raise ValueError(f"{self._name()}: is closed")
        return self._file

    def _layer(self, layer: Union[None, int, str]) -> int:
        if layer is None:
            return -1
        if isinstance(layer, str):
            for number, each in enumerate(self.layers):
                if each.name == layer:
                    return number
            raise KeyError(f"{self._name()}: has no layer {layer!r}")
        number = operator.index(layer)
        if not 0 <= number < len(self.layers):
            raise IndexError(f"{self._name()}: has {len(self.layers)} layers, and none of number {number}")
        return number

    def _level(self, level: Optional[int]) -> int:
        if level is None:
            return self.levels
        number = operator.index(level)
        if not 3 <= number <= self.levels:
            raise ValueError(f"level {number} is not 3 to {self.levels}")
        return number

    @staticmethod
    def _threads(threads: Optional[int]) -> int:
        count = 0 if threads is None else operator.index(threads)
        if not (threads is None or 1 <= count <= 1024):
            raise ValueError(f"threads: {count} is not 1 to 1024")
        return count

    def _fill(self, fill: Sequence[int]) -> tuple:
        if "colours" not in self.metadata:
            raise ValueError(f"{self._name()}: has no colours: svdag colour FILE SCENE... adds them")
        colour = triple(fill, "fill")
        if not all(0 <= c <= 255 for c in colour):
            raise ValueError(f"fill: {colour} is not three numbers from 0 to 255")
        return colour

    def _box(self, lo: Optional[Corner], hi: Optional[Corner], level: int) -> Tuple[tuple, tuple]:
        low = (0, 0, 0) if lo is None else triple(lo, "lo")
        high = (2 ** level,) * 3 if hi is None else triple(hi, "hi")
        return low, tuple(max(a, b) for a, b in zip(low, high))

    def _window(self, lo: Corner, hi: Corner, level: int) -> Tuple[tuple, tuple]:
        low, high = self._box(lo, hi, level)
        size = 1
        for a, b in zip(low, high):
            size *= b - a
        if size > 2 ** 44:
            raise MemoryError(f"a window of {size:,} voxels")
        return low, high

    def window(self, lo: Corner, hi: Corner, level: Optional[int] = None, layer: Union[None, int, str] = None, *,
               threads: Optional[int] = None) -> NDArray:
        """The voxels lo .. hi - 1 as a bool array in C order, axes x, y, z. What is outside of the grid is False.

        level: 3 .. levels; that of voxels by default. A coarser cube is set if any of its voxels is. lo and hi count
        cubes of this level. layer: name or number; by default all.
        """
        at = self._level(level)
        return self._open().window(*self._window(lo, hi, at), at, self._layer(layer), self._threads(threads))

    def window_colours(self, lo: Corner, hi: Corner, level: Optional[int] = None, fill: Sequence[int] = (0, 0, 0), *,
                       threads: Optional[int] = None) -> NDArray:
        """The colours of the voxels lo .. hi - 1, (x, y, z, 3) uint8 sRGB. Arguments as window() and colours()."""
        at = self._level(level)
        return self._open().window_colours(*self._window(lo, hi, at), at, self._fill(fill), self._threads(threads))

    def coords(self, lo: Optional[Corner] = None, hi: Optional[Corner] = None, level: Optional[int] = None,
               layer: Union[None, int, str] = None) -> NDArray:
        """The set voxels lo .. hi - 1 as an (n, 3) int32 array, in Morton order; by default all. Arguments as window()."""
        at = self._level(level)
        return self._open().coords(*self._box(lo, hi, at), at, self._layer(layer))

    def centres(self, lo: Optional[Corner] = None, hi: Optional[Corner] = None, level: Optional[int] = None,
                layer: Union[None, int, str] = None) -> NDArray:
        """The middles of the voxels that coords() lists, in world units: (n, 3) float64."""
        side = self.resolution * self.voxel_size / 2 ** self._level(level)
        return self.origin + (self.coords(lo, hi, level, layer) + 0.5) * side

    def sphere(self, center: ArrayLike, radius: float, layer: Union[None, int, str] = None) -> NDArray:
        """The set voxels that a closed ball touches, as coords(). center and radius are in voxels: voxel k is k .. k + 1."""
        middle = triple(np.asarray(center, float).ravel(), "center", float)
        if not (np.isfinite(middle).all() and 0 <= radius < 2 ** 40):
            raise ValueError("sphere: center and radius must be finite, the radius 0 or more")
        return self._open().ball(middle, float(radius), self._layer(layer))

    def bricks(self, lo: Optional[Corner] = None, hi: Optional[Corner] = None, layer: Union[None, int, str] = None,
               chunk: int = 1 << 16) -> Iterator[Tuple[NDArray, NDArray]]:
        """Iterates over the bricks, 4 x 4 x 4 voxels, that meet a box, in Morton order, `chunk` at a time.

        Yields their corners, (n, 3) int32, and their voxels, (n,) uint64, which unpack_bricks() unpacks.
        """
        low, high = self._box(lo, hi, self.levels)
        number, first = self._layer(layer), 0
        count = operator.index(chunk)
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

    def occupied(self, points: ArrayLike, layer: Union[None, int, str] = None, *, threads: Optional[int] = None) -> NDArray:
        """Whether voxels are set: (n,) bool for (n, 3) points.

        Integers are voxel coordinates, floats are world coordinates. What is outside of the grid is False.
        """
        given, file = points_of(points), self._open()
        return (file.occupied_voxels if given.dtype.kind == "i" else file.occupied_points)(given, self._layer(layer),
                                                                                                self._threads(threads))

    def colours(self, points: ArrayLike, level: Optional[int] = None, fill: Sequence[int] = (0, 0, 0), *,
                threads: Optional[int] = None) -> NDArray:
        """The colours of the voxels that hold (n, 3) points, (n, 3) uint8 sRGB. Points as occupied().

        level: 3 .. levels; that of voxels by default. A coarser cube has the mean colour of its voxels; integers count cubes of
        this level. fill: what a point gets that is not in a set voxel, or in one without a colour (full cubes inside a solid).
        ValueError if the file has no colours.
        """
        at, colour = self._level(level), self._fill(fill)
        given, file = points_of(points), self._open()
        return (file.colours_voxels if given.dtype.kind == "i" else file.colours_points)(given, at, colour, self._threads(threads))

    def nearest(self, points: ArrayLike, max_distance: float = np.inf,
                layer: Union[None, int, str] = None, *, threads: Optional[int] = None) -> Tuple[NDArray, NDArray]:
        """The set voxels nearest to (n, 3) points: voxels, (n, 3) int32, and distances, (n,) float64 in world units.

        Floats are world coordinates, integers are the middles of voxels. The distance is that to the closed cube of
        the voxel, 0 inside. Of several at the same distance, the first in the order of coords(). -1 and infinite where no voxel is
        within max_distance (world units). Exact for the point rounded to 2^-23 voxel; at most 2^36 voxels from the grid's corner.
        """
        limit = float(max_distance)
        if not limit >= 0:
            raise ValueError("nearest: max_distance must be 0 or more")
        given, file = points_of(points), self._open()
        return (file.nearest_voxels if given.dtype.kind == "i" else file.nearest_points)(given, limit, self._layer(layer),
                                                                                              self._threads(threads))

    def box_occupied(self, lo: Corner, hi: Corner, layer: Union[None, int, str] = None) -> bool:
        """Whether any of the voxels lo .. hi - 1 is set."""
        return self._open().box_occupied(*self._box(lo, hi, self.levels), self._layer(layer))

    def count(self, lo: Optional[Corner] = None, hi: Optional[Corner] = None, level: Optional[int] = None,
              layer: Union[None, int, str] = None) -> int:
        """The number of set voxels lo .. hi - 1. Arguments as window(); follows the DAG, not the voxels."""
        at = self._level(level)
        return self._open().count(*self._box(lo, hi, at), at, self._layer(layer))

    def trace(self, origins: ArrayLike, directions: ArrayLike, tmax: float = np.inf,
              layer: Union[None, int, str] = None, *, threads: Optional[int] = None) -> Hits:
        """The first voxel along each ray, exactly, as svdag-trace finds it.

        origins, directions: (n, 3) or (3,), world coordinates; directions of any length but 0. Hits beyond tmax, in
        units of the direction's length, do not count.
        """
        o = rows(np.atleast_2d(origins), np.float64, "origins")
        d = rows(np.atleast_2d(directions), np.float64, "directions")
        if not tmax >= 0:
            raise ValueError("trace: tmax must be 0 or more")
        hits = Hits(*self._open().trace(o, d, min(float(tmax), 1e300), self._layer(layer), self._threads(threads)))
        hits._file = self
        return hits


def open(path: PathLike, layers: Sequence[str] = (), level: Optional[int] = None,  # noqa: A001
         bounds: Optional[Sequence[float]] = None) -> File:
    """Opens a .svdag file, plain, compact or packed, or a part of it, as File does. A packed file, and a part, are written to
    a temporary file first."""
    return File(path, layers, level, bounds)


def unpack_bricks(bricks: ArrayLike) -> NDArray:
    """The voxels of n bricks, (n, 4, 4, 4) bool, from their words, (n,) uint64."""
    words = np.ascontiguousarray(bricks, np.uint64)
    x, y, z = np.meshgrid(*[np.arange(4)] * 3, indexing="ij")
    bit = (8 * (4 * (x >> 1) + 2 * (y >> 1) + (z >> 1)) + 4 * (x & 1) + 2 * (y & 1) + (z & 1)).astype(np.uint64)
    return (words[:, None, None, None] >> bit & np.uint64(1)).astype(bool)
