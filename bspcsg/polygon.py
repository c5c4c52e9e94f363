"""Plane polygons with holes: reading, orienting and triangulating them."""

from collections.abc import Sequence
from typing import Any

import manifold3d
import numpy as np

from ._types import FloatArray, IndexArray
from .errors import invalid_parameter


def contours_of(polygon: Any) -> list[FloatArray]:
    """Return the closed contours of a polygon, outer ones counter-clockwise, holes clockwise.

    Parameters
    ----------
    polygon : object
        (n, 2) points; a sequence of such contours, in any order and orientation; or an object
        with ``exterior`` and ``interiors``, with ``geoms``, or with ``to_polygons``.

    Returns
    -------
    list of (n, 2) float64
        Whether a contour is a hole follows from how many others contain it.

    Raises
    ------
    InvalidMeshError
        If there is no contour, one has fewer than 3 points, or a coordinate is not finite.
    """
    contours = [_cleaned(contour) for contour in _raw_contours(polygon)]
    if contours and hasattr(polygon, "outlines"):
        # Outlines of a region are oriented already.
        return contours
    if not contours:
        raise invalid_parameter("The polygon has no contour.")
    return [_oriented(number, contours) for number in range(len(contours))]


def triangulate(contours: Sequence[FloatArray]) -> IndexArray:
    """Return (m, 3) triangles over the contours' points, counted one contour after another.

    The directed edges that no other triangle cancels are exactly those of the contours, whatever
    the input; triangles overlap only if the contours cross.
    """
    triangles = np.asarray(manifold3d.triangulate(list(contours)), dtype=np.int64).reshape(-1, 3)
    return triangles if _has_border(triangles, contours) else _fans(contours)


def triangulate_face(corners: FloatArray) -> IndexArray:
    """Return (m, 3) triangles of one polygon in space, given by its (n, 3) corners in order."""
    if len(corners) == 3:
        return np.array([[0, 1, 2]])
    following = np.roll(corners, -1, axis=0)
    normal = np.cross(corners, following).sum(axis=0)
    axis = int(np.abs(normal).argmax())
    plane = [(1, 2), (2, 0), (0, 1)][axis]
    flat = np.ascontiguousarray(corners[:, plane])
    if normal[axis] >= 0:
        return triangulate([flat])
    # Seen from behind: triangulate the mirror image, which runs counter-clockwise.
    flat[:, 0] = -flat[:, 0]
    return triangulate([flat])


def directed_edges(contours: Sequence[FloatArray]) -> IndexArray:
    """Return the (n, 2) edges of the contours, points counted one contour after another."""
    edges = []
    start = 0
    for contour in contours:
        indices = np.arange(start, start + len(contour))
        edges.append(np.column_stack([indices, np.roll(indices, -1)]))
        start += len(contour)
    return np.concatenate(edges)


def signed_area(contour: FloatArray) -> float:
    """Return the area of a contour, negative if it runs clockwise."""
    x, y = (contour - contour[0]).T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2)


def _raw_contours(polygon: Any) -> list[Any]:
    if hasattr(polygon, "geoms"):
        return [contour for part in polygon.geoms for contour in _raw_contours(part)]
    if hasattr(polygon, "exterior"):
        rings = [polygon.exterior, *polygon.interiors]
        return [ring.coords for ring in rings]
    if hasattr(polygon, "to_polygons"):
        return list(polygon.to_polygons())
    try:
        points = list(polygon)
        # The entries of a single contour are points, whose entries are numbers.
        single = bool(points) and np.ndim(points[0][0]) == 0
    except (TypeError, IndexError) as error:
        raise invalid_parameter("A polygon is a list of points, or of contours.") from error
    return [points] if single else points


def _cleaned(contour: Any) -> FloatArray:
    try:
        points = np.asarray(contour, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise invalid_parameter("A contour must be a list of (x, y) points.") from error
    if points.ndim != 2 or points.shape[1] != 2:
        raise invalid_parameter(f"A contour must have shape (n, 2), not {points.shape}.")
    if not np.isfinite(points).all():
        raise invalid_parameter("A contour must have finite coordinates.")
    # Repeated points, such as a closing one, bound nothing.
    points = points[(points != np.roll(points, 1, axis=0)).any(axis=1)]
    if len(points) < 3:
        raise invalid_parameter("A contour needs at least 3 different points.")
    return np.ascontiguousarray(points)


def _oriented(number: int, contours: list[FloatArray]) -> FloatArray:
    contour = contours[number]
    others = contours[:number] + contours[number + 1 :]
    is_hole = sum(_contains(other, contour) for other in others) % 2 == 1
    runs_clockwise = signed_area(contour) < 0
    return contour if is_hole == runs_clockwise else np.ascontiguousarray(contour[::-1])


def _contains(outer: FloatArray, inner: FloatArray) -> bool:
    """Whether most corners and edge midpoints of `inner` are inside; some may touch `outer`."""
    probes = np.concatenate([inner, (inner + np.roll(inner, -1, axis=0)) / 2])
    return bool(np.mean([_crossings(outer, probe) % 2 for probe in probes]) > 0.5)


def _crossings(contour: FloatArray, point: FloatArray) -> int:
    """Count the edges that a ray from the point to the right crosses."""
    start, end = contour, np.roll(contour, -1, axis=0)
    spans = (start[:, 1] <= point[1]) != (end[:, 1] <= point[1])
    start, end = start[spans], end[spans]
    along = (point[1] - start[:, 1]) / (end[:, 1] - start[:, 1])
    return int((start[:, 0] + along * (end[:, 0] - start[:, 0]) > point[0]).sum())


def _has_border(triangles: IndexArray, contours: Sequence[FloatArray]) -> bool:
    """Whether the triangles' directed edges cancel to those of the contours."""
    count = sum(len(contour) for contour in contours)
    border = directed_edges(contours)
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    balance = np.concatenate([edges, border[:, ::-1]])
    forward = np.sort(balance[:, 0] * count + balance[:, 1])
    backward = np.sort(balance[:, 1] * count + balance[:, 0])
    return np.array_equal(forward, backward)


def _fans(contours: Sequence[FloatArray]) -> IndexArray:
    """Return one fan per contour, triangles outside the polygon counting negatively."""
    fans = []
    start = 0
    for contour in contours:
        rest = np.arange(start + 1, start + len(contour) - 1)
        fans.append(np.column_stack([np.full_like(rest, start), rest, rest + 1]))
        start += len(contour)
    return np.concatenate(fans)
