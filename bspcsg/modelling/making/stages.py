"""The order in which convex and concave edges that meet are blended.

Where one edge of its kind ends between two of the other kind, it comes first: the two then run on
along the end of its new surface, all of one kind. What is chosen is found again on the solid that
each stage leaves.
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
    """Return those of the chosen edges before which no others have to be blended.

    Parameters
    ----------
    skeleton : Skeleton
    chosen : (k,) int64

    Raises
    ------
    InvalidParameterError
        If edges of both kinds meet otherwise than one between two, or wait for each other.
    """
    own = set(chosen.tolist())
    before = {
        edge: first
        for vertex in np.unique(skeleton.ends[chosen]).tolist()
        if (first := _between_two(skeleton, own, vertex)) is not None
        for edge in skeleton.edges_at(vertex)
        if edge in own and edge != first
    }
    # Corners of one kind come at once, for they are part of a ball; else as few edges as can.
    free = own - _with_their_like(skeleton, own, set(before)) or set(before.values()) - set(before)
    if own and not free:
        vertex = int(skeleton.ends[min(before), 0])
        raise refused(skeleton, vertex, "convex and concave edges wait for each other")
    return np.array(sorted(free), dtype=np.int64)


def _between_two(skeleton: Skeleton, chosen: set[int], vertex: int) -> int | None:
    """Return the chosen edge that ends between two of the other kind, of which one is chosen."""
    edges = skeleton.edges_at(vertex)
    kinds = {bool(skeleton.is_convex[edge]) for edge in edges if edge in chosen}
    if len(kinds) < 2:
        return None
    if len(edges) != 3:
        reason = "convex and concave edges meet, and more than three; take one kind first"
        raise refused(skeleton, vertex, reason)
    convex = [edge for edge in edges if skeleton.is_convex[edge]]
    concave = [edge for edge in edges if not skeleton.is_convex[edge]]
    return convex[0] if len(convex) == 1 else concave[0]


def _with_their_like(skeleton: Skeleton, chosen: set[int], waiting: set[int]) -> set[int]:
    """Return the edges that wait, and all of their kind that they are connected with."""
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
    """Return the edges, after a stage, of those that are still to be blended.

    Parameters
    ----------
    skeleton : Skeleton
        Before the stage.
    rest : (k,) int64
        Edges of it.
    after : Skeleton
    ends : dict of int to (n, 3) float64
        The corners of the new surface where it ends on each face between two of `rest`.
    reach : float
        The most that new surfaces make an edge longer.

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
            reason = "an edge is gone once others are blended; take one kind first"
            raise refused(skeleton, vertex, reason)
        is_meant |= parts
    for face, corners in ends.items():
        is_meant |= _run_along(skeleton.normals[face], corners, after, near)
    return np.flatnonzero(is_meant & ~_are_even(after))


def _are_even(skeleton: Skeleton) -> BoolArray:
    """Say at which edges the two faces go on in one plane, but for what rounding does."""
    normals = skeleton.normals[skeleton.sides]
    return np.asarray(np.linalg.norm(normals[:, 1] - normals[:, 0], axis=1) <= _EVEN)


def _lie_on(skeleton: Skeleton, edge: int, after: Skeleton, near: float, reach: float) -> BoolArray:
    """Say which edges have a part in common with one of before."""
    start, along = skeleton.vertices[skeleton.ends[edge, 0]], skeleton.directions[edge]
    length = float(np.linalg.norm(skeleton.vectors[edge]))
    away = after.vertices[after.ends] - start
    ahead = away @ along
    beside = np.linalg.norm(away - ahead[..., None] * along, axis=2)
    is_there = (beside <= near) & (ahead >= -reach - near) & (ahead <= length + reach + near)
    in_common = np.minimum(ahead.max(axis=1), length) - np.maximum(ahead.min(axis=1), 0)
    return np.asarray(is_there.all(axis=1) & (in_common > near))


def _run_along(normal: FloatArray, corners: FloatArray, after: Skeleton, near: float) -> BoolArray:
    """Say which edges of a face run between some points."""
    on_face = (after.normals[after.sides] @ normal >= _ALONG).any(axis=1)
    gaps = np.linalg.norm(after.vertices[after.ends][:, :, None] - corners, axis=3)
    return np.asarray(on_face & (gaps.min(axis=2, initial=np.inf) <= near).all(axis=1))


def refused(skeleton: Skeleton, vertex: int, reason: str) -> InvalidParameterError:
    """Return the error for a corner that has no blend."""
    point = ", ".join(f"{value:.6g}" for value in skeleton.vertices[vertex])
    return invalid_parameter(f"At ({point}) {reason}.", [vertex])
