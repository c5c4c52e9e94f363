"""Round holes in plane faces: plain holes, counterbores and countersinks.

A hole is a profile of (distance from the axis, depth below the face), rotated about a line
perpendicular to the face.
"""

import math
from typing import Any

import numpy as np

from ..._types import FloatArray, Scalar
from ...errors import invalid_parameter
from ...geometry.arrays import doubles
from ...operations.setops import union
from ...parameters import (
    number,
    positive,
    radius_or_half_diameter,
    refuse_many_corners,
    sides_around,
)
from ...shapes.arrays import from_arrays
from ...shapes.sweep import surface_of_revolution
from ...solid.solid import Solid
from .faces import FaceSelection, flat_face
from .plane_faces import FaceGraph, face_graph_of, flatness

#: A hole begins above its face, so that no thin skin remains: by this many times the rounding error
#: of corners or the lattice step, whichever is larger.
_BEFORE = 10


def hole(
    solid: Solid,
    face: FaceSelection,
    at: Any,
    *,
    d: Scalar | None,
    r: Scalar | None,
    depth: Scalar | None,
    segments: int,
) -> Solid:
    """Return the solid with plain round holes; see `Solid.hole`."""
    return _drilled(solid, face, at, [], _bore(r, d), depth, segments)


def counterbore(
    solid: Solid,
    face: FaceSelection,
    at: Any,
    *,
    d: Scalar | None,
    r: Scalar | None,
    head_d: Scalar | None,
    head_r: Scalar | None,
    head_depth: Scalar,
    depth: Scalar | None,
    segments: int,
) -> Solid:
    """Return the solid with counterbored holes; see `Solid.counterbore`."""
    bore, deep = _bore(r, d), positive(head_depth, "head_depth")
    head = _head(head_r, head_d, bore)
    return _drilled(solid, face, at, [(bore, deep), (head, deep), (head, 0)], bore, depth, segments)


def countersink(
    solid: Solid,
    face: FaceSelection,
    at: Any,
    *,
    d: Scalar | None,
    r: Scalar | None,
    head_d: Scalar | None,
    head_r: Scalar | None,
    angle: Scalar,
    depth: Scalar | None,
    segments: int,
) -> Solid:
    """Return the solid with countersunk holes; see `Solid.countersink`."""
    bore, opening = _bore(r, d), number(angle, "angle")
    if not 0 < opening < 180:
        raise invalid_parameter(f"angle must be between 0 and 180 degrees, not {opening:g}.")
    head = _head(head_r, head_d, bore)
    deep = (head - bore) / math.tan(math.radians(opening / 2))
    return _drilled(solid, face, at, [(bore, deep), (head, 0)], bore, depth, segments)


def _bore(r: Scalar | None, d: Scalar | None) -> float:
    return positive(radius_or_half_diameter(r, d, "A hole"), "r")


def _head(r: Scalar | None, d: Scalar | None, bore: float) -> float:
    given = d if r is None else r
    name = "head_d" if r is None else "head_r"
    if given is None or (r is not None and d is not None):
        raise invalid_parameter("Give the size of the head as exactly one of head_r and head_d.")
    head = positive(given, name) / (2 if r is None else 1)
    if head <= bore:
        raise invalid_parameter(
            f"The head must be wider than the hole, but {name} is {given:g} and the radius of the"
            f" hole is {bore:g}."
        )
    return head


def _drilled(
    solid: Solid,
    face: FaceSelection,
    at: Any,
    head: list[tuple[float, float]],
    bore: float,
    depth: Scalar | None,
    segments: int,
) -> Solid:
    """Return the solid minus holes of radius `bore` with a wider head.

    The `head` is a list of (radius, depth) from its bottom up to the face; empty for none.
    """
    around = sides_around(3, segments, "segments")
    normal, offset = flat_face(face)
    graph = face_graph_of(solid.normalized().to_mesh())
    points = _points_on(graph, normal, offset, face.middle if at is None else at)
    refuse_many_corners(len(points) * around * (len(head) + 2), "These holes")
    deepest = max((below for _, below in head), default=0.0)
    bottom = (
        _through_depth(graph, normal, points, bore) if depth is None else positive(depth, "depth")
    )
    if bottom <= deepest:
        raise invalid_parameter(
            f"depth must be greater than the depth of the head, {deepest:g}, but is {bottom:g}."
        )
    wide = head[-1][0] if head else bore
    before = _BEFORE * max(flatness(graph.vertices), 10.0**solid.pitch)
    profile = [(0, bottom), (bore, bottom), *head, (wide, -before), (0, -before)]
    tools = _turned(np.array(profile) * (1, -1), around, normal, points)
    return solid - union(tools) if tools else solid


def _through_depth(graph: FaceGraph, normal: FloatArray, points: FloatArray, bore: float) -> float:
    """Return a depth below the face at which a hole has passed the whole solid."""
    return float((points @ normal).max(initial=0) - (graph.vertices @ normal).min()) + bore


def _points_on(graph: FaceGraph, normal: FloatArray, offset: float, at: Any) -> FloatArray:
    """Return the given points as an (n, 3) array.

    Raise `InvalidParameterError` for a point that is not on a face of the solid in the plane.
    """
    refusal = invalid_parameter(
        "at must be a point of three finite numbers, or a list of such points."
    )
    points = np.atleast_2d(doubles(at, refusal))
    if points.size == 0:
        return np.zeros((0, 3))
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise refusal
    near = flatness(graph.vertices)
    corners = graph.vertices[graph.triangles]
    is_level = (np.abs(corners @ normal - offset) <= near).all(axis=1)
    level = corners[is_level & (graph.areas @ normal > 0)]
    for point in points:
        if abs(float(point @ normal) - offset) > near or not _contain(level, normal, point, near):
            place = ", ".join(f"{value:.6g}" for value in point)
            raise invalid_parameter(
                f"The solid has no face in the plane of the hole at the point ({place}); choose a"
                " point on the face that is drilled."
            )
    return points


def _contain(triangles: FloatArray, normal: FloatArray, point: FloatArray, near: float) -> bool:
    """Return True if one of several coplanar triangles contains a point, up to rounding."""
    along = np.roll(triangles, -1, axis=1) - triangles
    left = np.cross(along, point - triangles) @ normal
    return bool((left >= -near * np.linalg.norm(along, axis=2)).all(axis=1).any())


def _turned(
    profile: FloatArray, around: int, normal: FloatArray, points: FloatArray
) -> list[Solid]:
    """Return, for each point, the solid of a profile rotated about the normal through the point."""
    vertices, faces = surface_of_revolution(profile, around, closed=False)
    level = np.eye(3)[np.abs(normal).argmin()]
    first = level - (level @ normal) * normal
    first /= np.linalg.norm(first)
    placed = vertices @ np.array([first, np.cross(normal, first), normal])
    return [from_arrays(placed + point, faces) for point in points]
