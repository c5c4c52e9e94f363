"""The order in which convex and concave edges that meet are blended.

If a convex edge ends between two concave edges, or vice versa, it is blended first: the two others
then continue along the end of its blend. After each stage, the remaining selected edges are found
on the new solid.
"""

from collections.abc import Mapping

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray
from ...errors import InvalidParameterError, invalid_parameter
from .plane_faces import FaceGraph, flatness

#: Faces count as parallel if the cosine of the angle between their normals is at least this.
_ALONG = 1 - 1e-12

#: Two adjacent faces count as coplanar if their unit normals differ by no more. Neighbouring chords
#: of a fillet of 360 chords differ by 0.017.
_EVEN = 1e-4

#: Points count as equal if their distance is at most this many times the flatness of the graph.
_SAME = 4


def next_edges(graph: FaceGraph, chosen: IndexArray) -> IndexArray:
    """Return the selected edges that are blended in the next stage.

    Parameters
    ----------
    graph : FaceGraph
    chosen : (k,) int64

    Raises
    ------
    InvalidParameterError
        If convex and concave edges meet at a corner of more than three edges, or each of several
        edges would have to be blended before another.
    """
    own = set(chosen.tolist())
    before = {
        edge: first
        for vertex in np.unique(graph.ends[chosen]).tolist()
        if (first := _between_two(graph, own, vertex)) is not None
        for edge in graph.edges_at(vertex)
        if edge in own and edge != first
    }
    # Blend connected edges of one kind together, since their common corner becomes part of a ball.
    # If there are none to blend now, take as few edges as possible.
    free = own - _with_their_like(graph, own, set(before)) or set(before.values()) - set(before)
    if own and not free:
        vertex = int(graph.ends[min(before), 0])
        raise corner_error(
            graph,
            vertex,
            "convex and concave edges meet in a cycle, so no order of blending works; blend"
            " the convex and the concave edges in separate calls",
        )
    return np.array(sorted(free), dtype=np.int64)


def _between_two(graph: FaceGraph, chosen: set[int], vertex: int) -> int | None:
    """Return the edge at a vertex that ends between two edges of the other kind.

    The kinds are convex and concave. None means that all selected edges there are of one kind.
    """
    edges = graph.edges_at(vertex)
    kinds = {bool(graph.is_convex[edge]) for edge in edges if edge in chosen}
    if len(kinds) < 2:
        return None
    if len(edges) != 3:
        reason = (
            "more than three convex and concave edges meet; blend the convex and the concave"
            " edges in separate calls"
        )
        raise corner_error(graph, vertex, reason)
    convex = [edge for edge in edges if graph.is_convex[edge]]
    concave = [edge for edge in edges if not graph.is_convex[edge]]
    return convex[0] if len(convex) == 1 else concave[0]


def _with_their_like(graph: FaceGraph, chosen: set[int], waiting: set[int]) -> set[int]:
    """Return edges that must wait, and all chosen edges connected to them of the same kind.

    The kinds are convex and concave. An edge waits if another edge must be blended before it.
    """
    found, ahead = set(waiting), list(waiting)
    while ahead:
        edge = ahead.pop()
        for vertex in graph.ends[edge].tolist():
            for other in graph.edges_at(vertex):
                is_like = graph.is_convex[other] == graph.is_convex[edge]
                if is_like and other in chosen and other not in found:
                    found.add(other)
                    ahead.append(other)
    return found


def corresponding_edges(
    graph: FaceGraph,
    rest: IndexArray,
    after: FaceGraph,
    ends: Mapping[int, FloatArray],
    reach: float,
) -> IndexArray:
    """Return the edges of the new solid that correspond to edges still to be blended.

    Parameters
    ----------
    graph : FaceGraph
        The face graph of the solid before the stage.
    rest : (k,) int64
        The edges of that face graph that are still to be blended.
    after : FaceGraph
        The face graph of the new solid.
    ends : dict of int to (n, 3) float64
        For each face between two edges of `rest`, the corners of blends that end on it.
    reach : float
        The largest length by which a blend can lengthen an edge.

    Returns
    -------
    (m,) int64

    Raises
    ------
    InvalidParameterError
        If no part of an edge of `rest` remains.
    """
    near = _SAME * flatness(graph.vertices)
    is_meant = np.zeros(len(after.ends), dtype=np.bool_)
    for edge in rest.tolist():
        parts = _lie_on(graph, edge, after, near, reach)
        if not parts.any():
            vertex = int(graph.ends[edge, 0])
            reason = (
                "an edge vanishes when others are blended; blend the convex and the concave edges"
                " in separate calls"
            )
            raise corner_error(graph, vertex, reason)
        is_meant |= parts
    for face, corners in ends.items():
        is_meant |= _run_along(graph.normals[face], corners, after, near)
    return np.flatnonzero(is_meant & ~_are_even(after))


def _are_even(graph: FaceGraph) -> BoolArray:
    """Return a mask, (e,), of the edges whose two faces are coplanar up to rounding."""
    normals = graph.normals[graph.sides]
    return np.asarray(np.linalg.norm(normals[:, 1] - normals[:, 0], axis=1) <= _EVEN)


def _lie_on(graph: FaceGraph, edge: int, after: FaceGraph, near: float, reach: float) -> BoolArray:
    """Return a mask of the edges of the new solid that overlap an edge of the previous solid."""
    start, along = graph.vertices[graph.ends[edge, 0]], graph.directions[edge]
    length = float(np.linalg.norm(graph.vectors[edge]))
    away = after.vertices[after.ends] - start
    ahead = away @ along
    beside = np.linalg.norm(away - ahead[..., None] * along, axis=2)
    is_there = (beside <= near) & (ahead >= -reach - near) & (ahead <= length + reach + near)
    in_common = np.minimum(ahead.max(axis=1), length) - np.maximum(ahead.min(axis=1), 0)
    return np.asarray(is_there.all(axis=1) & (in_common > near))


def _run_along(normal: FloatArray, corners: FloatArray, after: FaceGraph, near: float) -> BoolArray:
    """Return a mask of the edges that join two of the points `corners` on a face with a normal."""
    on_face = (after.normals[after.sides] @ normal >= _ALONG).any(axis=1)
    gaps = np.linalg.norm(after.vertices[after.ends][:, :, None] - corners, axis=3)
    return np.asarray(on_face & (gaps.min(axis=2, initial=np.inf) <= near).all(axis=1))


def corner_error(graph: FaceGraph, vertex: int, reason: str) -> InvalidParameterError:
    """Return the error that a corner cannot be blended, for the given reason."""
    point = ", ".join(f"{value:.6g}" for value in graph.vertices[vertex])
    return invalid_parameter(f"At ({point}) {reason}.", [vertex])
