"""Triangles between consecutive rings of corners, and the solids that they bound."""

import numpy as np

from ..._types import FloatArray, IndexArray
from ...mesh.weld import welded
from ...solid.solid import Solid

#: The relative difference of lengths below which two diagonals count as equal.
_EQUAL = 1e-5


def walls(rings: FloatArray, edges: IndexArray) -> IndexArray:
    """Return triangles between consecutive rings; shorter diagonals divide the quadrilaterals.

    Parameters
    ----------
    rings : (m, k, 3) float64
    edges : (e, 2) int64
        Edges of each ring, as pairs of corners. Seen from the last ring, the inside is on the left.

    Returns
    -------
    (2 e (m - 1), 3) int64
        Triangles as corner numbers: corner c of ring r has number ``r * k + c``.
    """
    start, end = edges.T
    low, high = rings[:-1], rings[1:]
    rise = np.linalg.norm(high[:, end] - low[:, start], axis=2)
    fall = np.linalg.norm(high[:, start] - low[:, end], axis=2)
    rising = rise <= fall + _EQUAL * rise
    base = (np.arange(len(low)) * rings.shape[1])[:, None]
    a, b = start + base, end + base
    c, d = a + rings.shape[1], b + rings.shape[1]
    first = np.stack([a, b, np.where(rising, d, c)], axis=2)
    second = np.stack([np.where(rising, a, b), d, c], axis=2)
    return np.concatenate([first.reshape(-1, 3), second.reshape(-1, 3)])


def solid_of(vertices: FloatArray, faces: IndexArray) -> Solid:
    """Return the solid of a closed mesh, whose corners may coincide and whose faces may cross."""
    points, same = welded(np.ascontiguousarray(vertices))
    triangles = same[faces]
    proper = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    kept = np.ascontiguousarray(triangles[proper])
    return Solid(points, kept) if len(kept) else Solid.empty()
