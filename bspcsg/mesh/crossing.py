"""Pairs of faces of a mesh that cross, and the depth of their crossings."""

from dataclasses import dataclass

import numpy as np

from .._types import BoolArray, FloatArray, IndexArray
from .certificate import certify

#: One face in so many is looked at, then more: a mesh that crosses itself all over has pairs as the
#: square of its faces, and a few of these tell.
_STRIDES = (64, 8, 1)


@dataclass(frozen=True, eq=False)
class Crossings:
    """Pairs of faces that cross or overlap.

    Parameters
    ----------
    pairs : (k, 2) int64
        Numbers of faces.
    are_deep : bool
        True if some faces pierce each other too deeply to be mended.
    are_all : bool
        False if there may be more pairs.
    """

    pairs: IndexArray
    are_deep: bool
    are_all: bool


def crossings(vertices: FloatArray, faces: IndexArray, deep: float) -> Crossings:
    """Return the pairs of faces that cross or overlap; only some pairs if one is deep.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int64
    deep : float
        A crossing is deep if a vertex must move farther than this to remove it.
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

    An edge keeps crossing a triangle as long as its ends do not reach the triangle and the edge
    does not reach the triangle's sides. This holds if no vertex moves farther than half of these
    distances.
    """
    found = np.zeros(len(pairs), dtype=bool)
    for triangles, others in ((pairs[:, 0], pairs[:, 1]), (pairs[:, 1], pairs[:, 0])):
        for side in range(3):
            start, end = others[:, side], others[:, side - 2]
            found |= _depth(start, end, triangles) > 2 * deep
    return found


def _depth(start: FloatArray, end: FloatArray, triangles: FloatArray) -> FloatArray:
    """Return a lower bound of the distances of crossings from the ends and sides, for edges (k, 3).

    It is negative where an edge does not cross its triangle (k, 3, 3).
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
