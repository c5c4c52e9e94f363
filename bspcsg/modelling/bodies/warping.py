"""Solids with corners moved by a function."""

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

from ..._types import FloatArray, IndexArray, WindingRule
from ...attributes.attributes import NORMALS
from ...errors import InvalidMeshError, invalid_parameter
from ...mesh.crossing import Crossings, crossings
from ...mesh.interop import points_array
from ...parameters import shown, winding_rule
from ...solid.ledger import counted
from ...solid.mesh_transform import AttributedMesh
from ...solid.solid import Solid, given_pitch, solid_with

#: A function that maps all corners, (n, 3) float64, to points of the same shape.
PointMap: TypeAlias = Callable[[FloatArray], Any]

#: The largest number of points, or pairs of faces, that an error lists.
_MAX_PLACES_LISTED = 20

#: A bound of the motion of a mended vertex, relative to the largest coordinate: a few roundings,
#: 2**-53 each.
_ROUNDING = 2.0**-40


@counted
def warp(solid: Solid, f: PointMap, winding: WindingRule | None = None) -> Solid:
    """Return the solid with its corners mapped by a function (see `Solid.warp`)."""
    rule = None if winding is None else winding_rule(winding)
    if not callable(f):
        raise invalid_parameter(f"f must be a function, not {shown(f)}.")
    mesh = solid.normalized().to_mesh()
    if len(mesh.faces) == 0:
        return solid
    said = None if mesh.carried is None else mesh.attributes.without(NORMALS)
    moved = AttributedMesh(_moved(f, mesh.vertices), mesh.faces, said)
    if rule is None:
        moved = _uncrossed(moved, mesh.vertices, given_pitch(solid))
    pitch = moved.pitch_in_range(given_pitch(solid))
    return solid_with(
        moved.vertices, moved.faces, moved.attributes, pitch=pitch, winding=rule or "nonzero"
    )


def _uncrossed(moved: AttributedMesh, before: FloatArray, given: int | None) -> AttributedMesh:
    """Return a mesh with its crossings by rounding mended, given its vertices before the warp.

    Raise `InvalidMeshError` for faces that cross by more than rounding.
    """
    held = moved.pitch_in_range(given)
    pitch = moved.suited_pitch() if held is None else held
    found = crossings(moved.vertices, moved.faces, _farthest(moved.vertices, pitch))
    if not len(found.pairs):
        return moved
    mended = None if found.are_deep or pitch is None else moved.mended(before, pitch)
    if mended is None or len(mended.crossing):
        raise _refusal(found, moved.vertices, moved.faces, "After f moved the corners")
    return mended.mesh


def _farthest(vertices: FloatArray, pitch: int | None) -> float:
    """Return an upper bound of a point's motion by mending, rounding and lattice snapping."""
    step = 0.0 if pitch is None else 10.0**pitch
    return float(np.abs(vertices).max()) * _ROUNDING + step


def _moved(f: PointMap, points: FloatArray) -> FloatArray:
    """Return the points mapped by `f`; raise an error for a wrong shape or a nonfinite number."""
    moved = points_array(f(points.copy()))
    if moved.shape != points.shape:
        raise invalid_parameter(
            f"f must return an array of the shape that it is given, {points.shape}, not"
            f" {moved.shape}."
        )
    bad = np.flatnonzero(~np.isfinite(moved).all(axis=1))
    if len(bad):
        place = points[bad[0]].tolist()
        message = (
            f"f must return finite numbers, but did not for {len(bad)} points, the first of"
            f" which is {place}."
        )
        raise InvalidMeshError(message, "non_finite", bad[:_MAX_PLACES_LISTED].tolist())
    return moved + 0.0


def refuse_crossings(vertices: FloatArray, faces: IndexArray, when: str) -> None:
    """Raise `InvalidMeshError` if faces cross or overlap; its message begins with `when`."""
    found = crossings(vertices, faces, 0.0)
    if len(found.pairs):
        raise _refusal(found, vertices, faces, when)


def _refusal(
    found: Crossings, vertices: FloatArray, faces: IndexArray, when: str
) -> InvalidMeshError:
    first = vertices[faces[found.pairs[0, 0]]].mean(axis=0).round(6).tolist()
    least = "" if found.are_all else "at least "
    message = (
        f"{when}, {least}{len(found.pairs)} pairs of faces cross or overlap, one of them near"
        f" {first}. Refine the solid first, or pass a winding rule to warp."
    )
    return InvalidMeshError(
        message, "self_crossing", np.unique(found.pairs[:_MAX_PLACES_LISTED]).tolist()
    )
