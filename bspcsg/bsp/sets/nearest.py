"""The nearest points on boundaries, segments and polygons to given points, in doubles."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._types import FloatArray
from ...errors import InvalidMeshError, core_errors, invalid_parameter
from ...mesh.distance import nearest_on_triangles
from .pieces import Pieces
from .rows import point_rows

if TYPE_CHECKING:
    from .objects import ObjectTree

#: The number of pairs of a point and a piece in one array operation, which bounds the memory.
_PAIRS_PER_BATCH = 1 << 20


def nearest_on_boundary(tree: "ObjectTree", points: Any) -> tuple[FloatArray, FloatArray]:
    """Return for each point the nearest boundary point of a set, (k, d), and the distance, (k,)."""
    array = point_rows(points, tree.dimension)
    if not np.isfinite(array).all():
        raise InvalidMeshError(
            "The points have coordinates that are not finite numbers; remove these points.",
            "non_finite",
        )
    if tree.is_empty or tree.is_full:
        raise invalid_parameter(
            "The set is empty or all of space, so it has no boundary and no nearest boundary point."
        )
    nearest = _nearest_of(tree, array)
    return nearest, np.sqrt(((nearest - array) ** 2).sum(axis=1))


def _nearest_of(tree: "ObjectTree", points: FloatArray) -> FloatArray:
    if tree.dimension == 3:
        return _nearest_on_polygons(points, tree.boundary())
    if tree.dimension == 1:
        ends = tree.boundary().vertices
        return _nearest_on_segments(points, np.stack([ends, ends], axis=1))
    with core_errors():
        return tree._tree.nearest(points)


def _nearest_on_segments(points: FloatArray, segments: FloatArray) -> FloatArray:
    """Return for each of (k, d) points the nearest point on any of (n, 2, d) segments, (k, d)."""
    start = segments[:, 0]
    along = segments[:, 1] - start
    squared = (along**2).sum(axis=1)
    length = np.where(squared > 0, squared, 1.0)

    def candidates(block: FloatArray) -> FloatArray:
        t = ((block[:, None, :] - start) * along).sum(axis=2) / length
        return np.asarray(start + np.clip(t, 0.0, 1.0)[:, :, None] * along)

    return _nearest(points, len(segments), candidates)


def _nearest_on_polygons(points: FloatArray, polygons: Pieces) -> FloatArray:
    """Return for each of (k, 3) points the nearest point on any of the convex polygons, (k, 3)."""
    triangles = np.concatenate([_fan(polygons[k]) for k in range(len(polygons))])

    def candidates(block: FloatArray) -> FloatArray:
        pairs = np.repeat(block, len(triangles), axis=0)
        copies = np.tile(triangles, (len(block), 1, 1))
        return nearest_on_triangles(pairs, copies).reshape(len(block), len(triangles), 3)

    return _nearest(points, len(triangles), candidates)


def _fan(corners: FloatArray) -> FloatArray:
    first = np.broadcast_to(corners[0], (len(corners) - 2, 3))
    return np.stack([first, corners[1:-1], corners[2:]], axis=1)


def _nearest(
    points: FloatArray, pieces: int, candidates: Callable[[FloatArray], FloatArray]
) -> FloatArray:
    """Return for each point the nearest of its candidates, computed in blocks of points.

    ``candidates(block)`` returns one candidate for each pair of a point and a piece, (b, pieces,
    d).
    """
    nearest = np.empty_like(points)
    step = max(_PAIRS_PER_BATCH // pieces, 1)
    for start in range(0, len(points), step):
        block = points[start : start + step]
        found = candidates(block)
        best = ((found - block[:, None, :]) ** 2).sum(axis=2).argmin(axis=1)
        nearest[start : start + step] = found[np.arange(len(block)), best]
    return nearest
