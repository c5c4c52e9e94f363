"""The search for pairs of faces of a mesh that cross, and a bound of how deep they cross."""

from dataclasses import dataclass

import numpy as np

from .._types import BoolArray, FloatArray, IndexArray
from .certificate import certify

#: Every 64th face is checked first, then every 8th, then all: in a mesh that crosses itself
#: everywhere, the number of pairs grows with the square of its faces, and a sample is enough.
_STRIDES = (64, 8, 1)


@dataclass(frozen=True, eq=False)
class Crossings:
    """The pairs of faces of a mesh that cross or overlap.

    Parameters
    ----------
    pairs : (k, 2) int64
        Numbers of faces.
    are_deep : bool
        True if at least one pair crosses too deeply to be mended.
    are_all : bool
        False if only a sample of the faces was checked, so that there may be more pairs.
    """

    pairs: IndexArray
    are_deep: bool
    are_all: bool


def crossings(vertices: FloatArray, faces: IndexArray, deep: float) -> Crossings:
    """Return the pairs of faces that cross or overlap; stop early if a deep crossing is found.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int64
    deep : float
        A crossing is deep if a vertex must move farther than this distance to remove it.
    """
    for stride in _STRIDES:
        found = certify(vertices, faces[::stride]).crossings
        pairs = stride * np.array(found, dtype=np.int64).reshape(-1, 2)
        are_deep = bool(_pierce(vertices[faces[pairs]], deep).any())
        if are_deep:
            break
    return Crossings(pairs, are_deep, stride == 1)


def _pierce(pairs: FloatArray, deep: float) -> BoolArray:
    """Say which pairs of triangles, (k, 2, 3, 3), cross unless a vertex moves farther than `deep`.

    An edge crosses a triangle as long as its ends do not reach the triangle's plane and the edge
    does not reach the triangle's sides: that is, if no vertex moves farther than half of these
    distances.
    """
    found = np.zeros(len(pairs), dtype=bool)
    for triangles, others in ((pairs[:, 0], pairs[:, 1]), (pairs[:, 1], pairs[:, 0])):
        for side in range(3):
            start, end = others[:, side], others[:, side - 2]
            found |= _depth(start, end, triangles) > 2 * deep
    return found


def _depth(start: FloatArray, end: FloatArray, triangles: FloatArray) -> FloatArray:
    """Return for k edges and k triangles how deep each edge crosses its triangle, at least.

    This is a lower bound of the distances of the edge's ends from the triangle's plane, and of the
    edge from the triangle's sides. It is negative if the edge does not cross the triangle.
    """
    sides = np.roll(triangles, -1, axis=1) - triangles
    along = end - start
    to_start = start - triangles[:, 0]
    # Products of lengths instead of areas give smaller distances, and avoid tiny divisors.
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        turns = np.einsum(
            "kij,kij->ki", np.cross(sides, along[:, None]), start[:, None] - triangles
        )
        turns /= np.linalg.norm(sides, axis=2) * np.linalg.norm(along, axis=1)[:, None]
        normal = np.cross(sides[:, 0], sides[:, 1])
        normal /= np.prod(np.linalg.norm(sides[:, :2], axis=2), axis=1)[:, None]
    heights = np.stack(
        [(normal * to_start).sum(axis=1), -(normal * (to_start + along)).sum(axis=1)]
    )
    within = np.maximum(turns.min(axis=1), -turns.max(axis=1))
    across = np.maximum(heights.min(axis=0), -heights.max(axis=0))
    found: FloatArray = np.nan_to_num(np.minimum(within, across), nan=-1.0)
    return found
