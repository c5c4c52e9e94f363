"""Read points, segments and polygons in any form as one array of corners with offsets."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from ..._core import suited_pitch
from ..._types import FloatArray, IndexArray, MeshArrays
from ...errors import InvalidMeshError, core_errors, invalid_parameter
from ...geometry.arrays import doubles, doubles_or_none
from ...geometry.hyperplane import exact_point
from ...mesh import interop
from ...parameters import pitch_exponent, shown
from ...solid.solid import Solid

#: Corners (n, d) float64, and offsets (k + 1,) int64 at which the facets start.
Corners = tuple[FloatArray, IndexArray]

_FORMS = "(n,) points, (n, 2, 2) segments, (n, 3, 3) triangles, or a list of (k, 3) polygons"


def corners_of(facets: Any) -> Corners:
    """Return the corners of all facets in one array, and the offset at which each facet starts.

    Raises
    ------
    InvalidMeshError
        If the shape is none of those that `PartitionTree` takes.
    """
    if isinstance(facets, Sequence) and not len(facets):
        message = (
            "The list of facets is empty, so its dimension is unknown; pass an empty array of"
            " shape (0,), (0, 2, 2) or (0, 3, 3)."
        )
        raise InvalidMeshError(message, "shape")
    array = doubles_or_none(facets)
    if array is None:
        return _polygons(facets)
    if array.ndim == 1:
        return array.reshape(-1, 1), np.arange(len(array) + 1)
    is_segments = array.ndim == 3 and array.shape[1:] == (2, 2)
    is_polygons = array.ndim == 3 and array.shape[1] >= 3 and array.shape[2] == 3
    if not (is_segments or is_polygons):
        raise InvalidMeshError(
            f"Facets must be {_FORMS}, not an array of shape {array.shape}.", "shape"
        )
    count, corners, dimension = array.shape
    flat = np.ascontiguousarray(array.reshape(-1, dimension))
    return flat, np.arange(count + 1) * corners


def _polygons(facets: Any) -> Corners:
    refusal = InvalidMeshError(f"Facets must be {_FORMS}.", "shape")
    try:
        polygons = [doubles(polygon, refusal) for polygon in facets]
    except TypeError:  # an object without facets
        raise refusal from None
    if not polygons:
        raise refusal
    for number, polygon in enumerate(polygons):
        if polygon.ndim != 2 or polygon.shape[1] != 3:
            message = f"Polygon {number} must have shape (k, 3), not {polygon.shape}."
            raise InvalidMeshError(message, "shape", [number])
    lengths = [len(polygon) for polygon in polygons]
    return np.concatenate(polygons), np.concatenate([[0], np.cumsum(lengths)])


def mesh_triangles(mesh: Any) -> FloatArray:
    """Return the (n, 3, 3) triangles of any mesh object, closed or not."""
    vertices, faces = mesh_of(mesh)
    triangles: FloatArray = vertices[faces]
    return triangles


def mesh_of(mesh: Any) -> MeshArrays:
    """Return the vertices and triangles of any mesh object, closed or not."""
    if isinstance(mesh, Solid):
        mesh = mesh.to_mesh()
    vertices, faces = interop.own_arrays(*interop.arrays_from(mesh))
    if faces.size and (faces.min() < 0 or faces.max() >= len(vertices)):
        message = f"A face has a vertex index outside 0 to {len(vertices) - 1}."
        raise InvalidMeshError(message, "index_out_of_range")
    return vertices, faces


def chosen_pitch(given: Any, points: FloatArray) -> int:
    """Return the pitch that the caller gave, or else one that suits the points' coordinates."""
    return _suited_pitch(points) if given is None else pitch_exponent(given)


def _suited_pitch(points: FloatArray) -> int:
    """Return the pitch for these points: -9, or another if their coordinates require it."""
    if len(points) == 0 or not np.isfinite(points).all():
        return -9
    extent = float(np.ptp(points, axis=0).max())
    with core_errors():
        return suited_pitch(float(np.abs(points).max()), extent)


def box_corners(low: Any, high: Any, dimension: int) -> tuple[list[Fraction], list[Fraction]]:
    """Return the minimum and the maximum corner of a box as exact fractions.

    Raises
    ------
    InvalidParameterError
        If a corner has another dimension or is not finite, or `low` is above `high` on an axis.
    """
    least, most = exact_point(low, dimension, "low"), exact_point(high, dimension, "high")
    if any(start > end for start, end in zip(least, most, strict=True)):
        message = (
            f"low must not be above high along any axis, but low is {shown(low)} and high is"
            f" {shown(high)}."
        )
        raise invalid_parameter(message)
    return least, most


def vector_rows(given: Any, dimension: int, name: str) -> FloatArray:
    """Return points or directions as (n, d) float64; a single vector becomes one row.

    Raises
    ------
    InvalidParameterError
        If the shape is neither (n, d) nor (d,).
    """
    array = doubles(given, invalid_parameter(f"{name} must be an array of numbers."))
    if dimension == 1 and array.ndim <= 1:
        array = array.reshape(-1, 1)
    array = np.atleast_2d(array)
    if array.ndim != 2 or array.shape[1] != dimension:
        shape = np.shape(given)
        raise invalid_parameter(
            f"{name} must have shape (n, {dimension}) or ({dimension},), not {shape}."
        )
    return np.ascontiguousarray(array)
