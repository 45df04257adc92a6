"""Arguments as arrays and tuples of the types that the module takes."""
import operator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

_FAR = 2 ** 40  # beyond every grid


def rows(values: ArrayLike, dtype: Any, name: str) -> NDArray:
    array = np.asarray(values)
    if array.size > 0 and array.dtype.kind not in ("iu" if np.dtype(dtype).kind == "i" else "iuf"):
        raise TypeError(f"{name}: {array.dtype} is not a type of {'integers' if np.dtype(dtype).kind == 'i' else 'real numbers'}")
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name}: has the shape {array.shape}, not (n, 3)")
    return np.ascontiguousarray(array, dtype)


def points_of(values: ArrayLike) -> NDArray:
    """Rows of integers, which are voxels, or of floats, which are of the world."""
    array = np.asarray(values)
    if array.dtype == np.uint64:
        array = np.minimum(array, 2 ** 62)
    return rows(array, np.int64 if array.dtype.kind in "iu" else np.float64, "points")


def triple(values: Any, name: str, to: Any = operator.index) -> tuple:
    values = tuple(to(v) for v in values)
    if len(values) != 3:
        raise ValueError(f"{name}: has {len(values)} numbers, not 3")
    if to is operator.index:
        values = tuple(max(-_FAR, min(_FAR, v)) for v in values)
    return values
