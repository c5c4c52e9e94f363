"""The order in which convex and concave edges that meet are blended.

If an edge ends between two edges of the other kind, it comes first: the two then continue along the
end of its new surface, all of one kind. After each stage, the remaining selected edges are found
again on the new solid.
"""

from collections.abc import Mapping

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray
from ...errors import InvalidParameterError, invalid_parameter
from .skeleton import Skeleton, flatness

#: Faces of one plane have normals whose cosine is at least this.
_ALONG = 1 - 1e-12

#: Unit normals that differ by no more are of one plane: a fillet of 360 chords bends by 0.017 at
#: each, and so little that rounding is seen has no blend.
_EVEN = 1e-4

#: Points are the same that are as near as corners of two faces between the same planes may be.
_SAME = 4


def ready(skeleton: Skeleton, chosen: IndexArray) -> IndexArray:
    """Return the selected edges that can be blended now, before all others.

    Parameters
    ----------
    skeleton : Skeleton
    chosen : (k,) int64

    Raises
    ------
    InvalidParameterError
        If edges of both kinds meet in another way than one between two, or wait for each other.
    """
    own = set(chosen.tolist())
    before = {
        edge: first
        for vertex in np.unique(skeleton.ends[chosen]).tolist()
        if (first := _between_two(skeleton, own, vertex)) is not None
        for edge in skeleton.edges_at(vertex)
        if edge in own and edge != first
    }
    # Edges that share a corner of one kind come together, since it becomes part of a ball;
    # otherwise take as few edges as possible.
    free = own - _with_their_like(skeleton, own, set(before)) or set(before.values()) - set(before)
    if own and not free:
        vertex = int(skeleton.ends[min(before), 0])
        raise refused(
            skeleton,
            vertex,
            "convex and concave edges meet in a cycle, so no order of blending works; blend"
            " the convex and the concave edges in separate calls",
        )
    return np.array(sorted(free), dtype=np.int64)


def _between_two(skeleton: Skeleton, chosen: set[int], vertex: int) -> int | None:
    """Return the selected edge that ends between two of the other kind, one of them selected."""
    edges = skeleton.edges_at(vertex)
    kinds = {bool(skeleton.is_convex[edge]) for edge in edges if edge in chosen}
    if len(kinds) < 2:
        return None
    if len(edges) != 3:
        reason = (
            "more than three convex and concave edges meet; blend the convex and the concave"
            " edges in separate calls"
        )
        raise refused(skeleton, vertex, reason)
    convex = [edge for edge in edges if skeleton.is_convex[edge]]
    concave = [edge for edge in edges if not skeleton.is_convex[edge]]
    return convex[0] if len(convex) == 1 else concave[0]


def _with_their_like(skeleton: Skeleton, chosen: set[int], waiting: set[int]) -> set[int]:
    """Return the waiting edges, and all edges of their kind connected with them."""
    found, ahead = set(waiting), list(waiting)
    while ahead:
        edge = ahead.pop()
        for vertex in skeleton.ends[edge].tolist():
            for other in skeleton.edges_at(vertex):
                is_like = skeleton.is_convex[other] == skeleton.is_convex[edge]
                if is_like and other in chosen and other not in found:
                    found.add(other)
                    ahead.append(other)
    return found


def carried(
    skeleton: Skeleton,
    rest: IndexArray,
    after: Skeleton,
    ends: Mapping[int, FloatArray],
    reach: float,
) -> IndexArray:
    """Return the edges of the new solid that correspond to those still to be blended.

    Parameters
    ----------
    skeleton : Skeleton
        Before the stage.
    rest : (k,) int64
        Edges of that skeleton.
    after : Skeleton
    ends : dict of int to (n, 3) float64
        The end corners of the new surfaces on each face between two edges of `rest`.
    reach : float
        The largest amount by which new surfaces lengthen an edge.

    Returns
    -------
    (m,) int64

    Raises
    ------
    InvalidParameterError
        If nothing is left of an edge.
    """
    near = _SAME * flatness(skeleton.vertices)
    is_meant = np.zeros(len(after.ends), dtype=np.bool_)
    for edge in rest.tolist():
        parts = _lie_on(skeleton, edge, after, near, reach)
        if not parts.any():
            vertex = int(skeleton.ends[edge, 0])
            reason = (
                "an edge vanishes when others are blended; blend the convex and the concave edges"
                " in separate calls"
            )
            raise refused(skeleton, vertex, reason)
        is_meant |= parts
    for face, corners in ends.items():
        is_meant |= _run_along(skeleton.normals[face], corners, after, near)
    return np.flatnonzero(is_meant & ~_are_even(after))


def _are_even(skeleton: Skeleton) -> BoolArray:
    """Say at which edges the two faces are coplanar up to rounding."""
    normals = skeleton.normals[skeleton.sides]
    return np.asarray(np.linalg.norm(normals[:, 1] - normals[:, 0], axis=1) <= _EVEN)


def _lie_on(skeleton: Skeleton, edge: int, after: Skeleton, near: float, reach: float) -> BoolArray:
    """Say which edges overlap an edge of the previous solid."""
    start, along = skeleton.vertices[skeleton.ends[edge, 0]], skeleton.directions[edge]
    length = float(np.linalg.norm(skeleton.vectors[edge]))
    away = after.vertices[after.ends] - start
    ahead = away @ along
    beside = np.linalg.norm(away - ahead[..., None] * along, axis=2)
    is_there = (beside <= near) & (ahead >= -reach - near) & (ahead <= length + reach + near)
    in_common = np.minimum(ahead.max(axis=1), length) - np.maximum(ahead.min(axis=1), 0)
    return np.asarray(is_there.all(axis=1) & (in_common > near))


def _run_along(normal: FloatArray, corners: FloatArray, after: Skeleton, near: float) -> BoolArray:
    """Say which edges of a face run between given points."""
    on_face = (after.normals[after.sides] @ normal >= _ALONG).any(axis=1)
    gaps = np.linalg.norm(after.vertices[after.ends][:, :, None] - corners, axis=3)
    return np.asarray(on_face & (gaps.min(axis=2, initial=np.inf) <= near).all(axis=1))


def refused(skeleton: Skeleton, vertex: int, reason: str) -> InvalidParameterError:
    """Return the error for a corner that has no blend."""
    point = ", ".join(f"{value:.6g}" for value in skeleton.vertices[vertex])
    return invalid_parameter(f"At ({point}) {reason}.", [vertex])
