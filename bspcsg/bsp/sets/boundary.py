"""Read the closed boundary of a set in one, two or three dimensions as rows for the core."""

from typing import Any

import numpy as np

from ..._types import FloatArray, IndexArray
from ...errors import InvalidMeshError, invalid_parameter
from ...geometry.arrays import doubles


def boundary_arrays(facets: Any) -> tuple[int, FloatArray, IndexArray | None]:
    """Return a boundary's dimension, its rows for the core, and its triangles or None.

    In 1D and 2D a row is an end or a segment, in 3D a vertex; the triangles index the vertices.

    Raises
    ------
    InvalidMeshError
        If the array has none of the shapes (n, 2), (n, 2, 2) and (n, 3, 3), or the segments do not
        close.
    """
    array = _numbers(facets)
    if array.ndim == 2 and array.shape[1] == 2:
        return 1, interval_rows(array), None
    if array.ndim == 3 and array.shape[1:] == (2, 2):
        return 2, segment_rows(array), None
    if array.ndim == 3 and array.shape[1:] == (3, 3):
        faces = np.arange(3 * len(array), dtype=np.int64).reshape(-1, 3)
        return 3, np.ascontiguousarray(array.reshape(-1, 3)), faces
    raise InvalidMeshError(
        "A boundary must have shape (n, 2) for intervals, (n, 2, 2) for segments or (n, 3, 3)"
        f" for triangles, not {array.shape}.",
        "shape",
    )


def interval_rows(ends: FloatArray) -> FloatArray:
    """Return a row (x, side) for each end of intervals: side +1 at lower, -1 at upper ends."""
    sides = np.tile([1.0, -1.0], len(ends))
    return np.column_stack([ends.reshape(-1), sides])


def segment_rows(segments: FloatArray) -> FloatArray:
    """Return rows (x, y, x', y') of segments, after a check that the segments form closed outlines.

    Raises
    ------
    InvalidMeshError
        If the numbers of segments that begin and end at a point differ; `where` lists segments.
    """
    _check_closed(segments)
    return np.ascontiguousarray(segments.reshape(-1, 4))


def _numbers(facets: Any) -> FloatArray:
    array = doubles(facets, InvalidMeshError("A boundary must be an array of numbers.", "shape"))
    if array.size == 0:
        raise invalid_parameter(
            "The boundary has no facets, so it does not determine a set; use the empty set"
            " instead, such as Region.empty()."
        )
    return array


def _check_closed(segments: FloatArray) -> None:
    points, index = np.unique(segments.reshape(-1, 2) + 0.0, axis=0, return_inverse=True)
    balance = np.bincount(index.reshape(-1), np.tile([1, -1], len(segments)), len(points))
    if not np.isfinite(points).all() or not balance.any():
        return
    place = int(np.flatnonzero(balance)[0])
    where = np.flatnonzero(index.reshape(-1) == place) // 2
    raise InvalidMeshError(
        f"The outline is not closed at ({points[place][0]:g}, {points[place][1]:g}); as many"
        " segments must end at this point as begin there.",
        "not_closed",
        [int(k) for k in where],
    )
