"""Plane polygons with holes: reading them in any form, orienting and triangulating them."""

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from typing import Any

import manifold3d
import numpy as np

from .._core import outline_triangles
from .._types import FloatArray, IndexArray
from ..errors import invalid_parameter
from .arrays import doubles

#: A sum of products of coordinates has the right sign if it exceeds this fraction of the sum of
#: their absolute values: each product has three roundings and the sum one for each doubling of
#: their number, 2**-53 each.
_SIGN_TOLERANCE = 1e-12


def contours_of(polygon: Any) -> list[FloatArray]:
    """Return the closed contours of a polygon, outer ones counter-clockwise, holes clockwise.

    Parameters
    ----------
    polygon : object
        (n, 2) points; a sequence of such contours, in any order and orientation; or an object
        with ``exterior`` and ``interiors``, with ``geoms``, or with ``to_polygons``, or a sequence
        of the first two kinds.

    Returns
    -------
    list of (n, 2) float64
        Of shapes, ``interiors`` are the holes. Of plain point lists, a contour inside an odd number
        of others is a hole.

    Raises
    ------
    InvalidMeshError
        If there is no contour, a contour has fewer than 3 points, or a coordinate is not finite.
    """
    shapes = shape_contours(polygon)
    contours = _bare_contours(polygon) if shapes is None else shapes
    if not contours and not hasattr(polygon, "outlines"):
        raise invalid_parameter(
            "The polygon is empty: it has no contour; give at least one list of (x, y) points."
        )
    return contours


def shape_contours(given: Any) -> list[FloatArray] | None:
    """Return the oriented contours of a shape or a sequence of shapes; None for other objects.

    A shape has ``exterior`` and ``interiors``, or ``geoms``, like those of shapely. The winding
    number of the contours at a point is the number of polygons that contain it, even if these
    overlap. Parts of a collection without area, such as lines, are left out.

    Raises
    ------
    InvalidMeshError
        If the shape is of a kind without area, a contour has fewer than 3 points, or a coordinate
        is not finite.
    """
    if _is_shape(given):
        return _rings([given])
    # Only sequences: a generator could not be read again.
    is_list = isinstance(given, Sequence) and not isinstance(given, (str, bytes))
    return _rings(given) if is_list and given and all(map(_is_shape, given)) else None


def triangulate(contours: Sequence[FloatArray]) -> IndexArray:
    """Return (m, 3) triangles over the contours' points, numbered through all contours.

    For any input, the directed edges that no opposite edge of another triangle cancels are exactly
    the edges of the contours; triangles overlap only if the contours cross.
    """
    edges = directed_edges(contours)
    if len(edges) > _MAX_MANIFOLD_CORNERS:
        triangles = _region_triangles(contours, edges)
    else:
        triangles = _manifold_triangles(contours)
    return triangles if _has_border(triangles, edges) else _fans(contours)


#: The largest number of corners that manifold3d triangulates. Its time grows with the square of
#: their number, and so does the time to import the needles that it makes. For many corners on one
#: line its recursion is as deep as their number.
_MAX_MANIFOLD_CORNERS = 200


def _manifold_triangles(contours: Sequence[FloatArray]) -> IndexArray:
    return np.asarray(manifold3d.triangulate(list(contours)), dtype=np.int64).reshape(-1, 3)


def _region_triangles(contours: Sequence[FloatArray], edges: IndexArray) -> IndexArray:
    """Return the triangles of contours, or of each contour by itself if they bound no region.

    A contour of many corners that crosses itself is cut in two between two corners; the halves have
    the cut as opposite edges, which cancel.
    """
    points = np.concatenate(contours)
    whole = outline_triangles(points, edges)
    if whole is not None:
        return whole
    waiting = np.split(np.arange(len(points)), np.cumsum([len(one) for one in contours])[:-1])
    done = []
    while waiting:
        piece = waiting.pop()
        triangles = _piece_triangles(points[piece])
        if triangles is None:
            middle = len(piece) // 2
            waiting += [piece[: middle + 1], np.append(piece[middle:], piece[0])]
        else:
            done.append(piece[triangles])
    return np.concatenate(done)


def _piece_triangles(corners: FloatArray) -> IndexArray | None:
    """Return the triangles of one contour; None if it crosses itself and has many corners."""
    is_turned = signed_area(corners) < 0
    contour = np.ascontiguousarray(corners[::-1]) if is_turned else corners
    if len(contour) <= _MAX_MANIFOLD_CORNERS:
        triangles = _manifold_triangles([contour])
    else:
        found = outline_triangles(contour, directed_edges([contour]))
        if found is None:
            return None
        triangles = found
    return len(contour) - 1 - triangles[:, ::-1] if is_turned else triangles


def triangulate_face(corners: FloatArray) -> IndexArray:
    """Return (m, 3) triangles of one polygon in space, given its (n, 3) corners in order."""
    if len(corners) == 3:
        return np.array([[0, 1, 2]])
    following = np.roll(corners, -1, axis=0)
    normal = np.cross(corners, following).sum(axis=0)
    axis = int(np.abs(normal).argmax())
    plane = [(1, 2), (2, 0), (0, 1)][axis]
    flat = np.ascontiguousarray(corners[:, plane])
    if normal[axis] >= 0:
        return triangulate([flat])
    # The projection is clockwise; its mirror image is counter-clockwise.
    flat[:, 0] = -flat[:, 0]
    return triangulate([flat])


def directed_edges(contours: Sequence[FloatArray]) -> IndexArray:
    """Return the (n, 2) directed edges of contours, with points numbered through all contours."""
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


def runs_clockwise(contour: FloatArray) -> bool:
    """Return true if the area of a contour is negative, decided exactly."""
    x, y = (contour - contour[0]).T
    terms = np.concatenate([x * np.roll(y, -1), -np.roll(x, -1) * y])
    area = float(terms.sum())
    if abs(area) > _SIGN_TOLERANCE * float(np.abs(terms).sum()):
        return area < 0
    points = [(Fraction(a), Fraction(b)) for a, b in contour.tolist()]
    following = points[1:] + points[:1]
    pairs = zip(points, following, strict=True)
    return sum(a * d - c * b for (a, b), (c, d) in pairs) < 0


def _is_shape(given: Any) -> bool:
    return hasattr(given, "exterior") or hasattr(given, "geoms")


def _rings(shapes: Iterable[Any]) -> list[FloatArray]:
    contours = []
    for part in _polygonal(shapes):
        contours.append(_turned(_cleaned(part.exterior.coords), clockwise=False))
        contours += [_turned(_cleaned(ring.coords), clockwise=True) for ring in part.interiors]
    return contours


def _polygonal(shapes: Iterable[Any]) -> Iterator[Any]:
    """Yield the polygons of shapes, also those in nested collections, in order."""
    waiting = [(shape, False) for shape in shapes][::-1]
    while waiting:
        shape, inside = waiting.pop()
        if hasattr(shape, "exterior"):
            if not getattr(shape, "is_empty", False):
                yield shape
        elif hasattr(shape, "geoms"):
            mixed = inside or getattr(shape, "geom_type", "") == "GeometryCollection"
            waiting += [(part, mixed) for part in shape.geoms][::-1]
        elif not inside:
            kind = getattr(shape, "geom_type", type(shape).__name__)
            raise invalid_parameter(
                f"The shape must be a polygon, but is a {kind}, which has no area."
            )


def _turned(contour: FloatArray, *, clockwise: bool) -> FloatArray:
    same = runs_clockwise(contour) == clockwise
    return contour if same else np.ascontiguousarray(contour[::-1])


def _bare_contours(polygon: Any) -> list[FloatArray]:
    if hasattr(polygon, "to_polygons"):
        contours = [_cleaned(contour) for contour in polygon.to_polygons()]
        # Outlines of a region are already oriented.
        return contours if hasattr(polygon, "outlines") else _oriented(contours)
    try:
        points = list(polygon)
        # In a single contour the entries of an entry are numbers.
        single = bool(points) and np.ndim(points[0][0]) == 0
    except (TypeError, IndexError) as error:
        raise invalid_parameter(
            "A polygon must be a list of (x, y) points, or a list of such lists (contours)."
        ) from error
    whole = polygon if isinstance(polygon, np.ndarray) else points
    return _oriented([_cleaned(contour) for contour in ([whole] if single else points)])


def _cleaned(contour: Any) -> FloatArray:
    points = doubles(contour, invalid_parameter("A contour must be a list of (x, y) points."))
    if points.ndim != 2 or points.shape[1] != 2:
        raise invalid_parameter(f"A contour must have shape (n, 2), not {points.shape}.")
    if not np.isfinite(points).all():
        raise invalid_parameter("A contour has a coordinate that is not a finite number.")
    # Remove repeated points, such as a closing one.
    points = points[(points != np.roll(points, 1, axis=0)).any(axis=1)]
    if len(points) < 3:
        raise invalid_parameter(
            f"A contour needs at least 3 different points, but has {len(points)}."
        )
    return np.ascontiguousarray(points)


def _oriented(contours: list[FloatArray]) -> list[FloatArray]:
    """Return the contours, clockwise if inside an odd number of others, else counter-clockwise."""
    depths = [0] * len(contours)
    for outer, inner in _overlapping_boxes(contours):
        depths[inner] += _contains(contours[outer], contours[inner])
        depths[outer] += _contains(contours[inner], contours[outer])
    pairs = zip(contours, depths, strict=True)
    return [_turned(contour, clockwise=depth % 2 == 1) for contour, depth in pairs]


def _overlapping_boxes(contours: list[FloatArray]) -> Iterator[tuple[int, int]]:
    """Yield the pairs of contours whose bounding boxes have area in common, by a sweep along x."""
    if not contours:
        return
    low = np.array([contour.min(axis=0) for contour in contours])
    high = np.array([contour.max(axis=0) for contour in contours])
    order = np.argsort(low[:, 0], kind="stable")
    starts = low[order, 0]
    for place, one in enumerate(order.tolist()):
        later = order[place + 1 : np.searchsorted(starts, high[one, 0])]
        met = (low[later, 1] < high[one, 1]) & (high[later, 1] > low[one, 1])
        yield from ((one, other) for other in later[met].tolist())


def _contains(outer: FloatArray, inner: FloatArray) -> bool:
    """Return true if more than half of `inner`'s corners and edge midpoints are inside `outer`."""
    probes = np.concatenate([inner, (inner + np.roll(inner, -1, axis=0)) / 2])
    is_near = ((probes >= outer.min(axis=0)) & (probes <= outer.max(axis=0))).all(axis=1)
    if 2 * is_near.sum() <= len(probes):
        return False
    together = max(1, _PAIRS_PER_BATCH // len(outer))
    near = probes[is_near]
    parts = [near[start : start + together] for start in range(0, len(near), together)]
    inside = sum(int((_crossings(outer, part) % 2).sum()) for part in parts)
    return 2 * inside > len(probes)


#: The number of pairs of a point and an edge in one array operation, which bounds the memory.
_PAIRS_PER_BATCH = 1 << 16


def _crossings(contour: FloatArray, points: FloatArray) -> IndexArray:
    """Return for each point the number of edges that a ray in the direction of +x crosses."""
    start, end = contour, np.roll(contour, -1, axis=0)
    y = points[:, 1:]
    point, edge = np.nonzero((start[:, 1] <= y) != (end[:, 1] <= y))
    start, end = start[edge], end[edge]
    along = (points[point, 1] - start[:, 1]) / (end[:, 1] - start[:, 1])
    crossed = start[:, 0] + along * (end[:, 0] - start[:, 0]) > points[point, 0]
    return np.bincount(point[crossed], minlength=len(points))


def _has_border(triangles: IndexArray, border: IndexArray) -> bool:
    """Return true if the triangles' directed edges cancel to exactly the edges of `border`."""
    count = len(border)
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    balance = np.concatenate([edges, border[:, ::-1]])
    forward = np.sort(balance[:, 0] * count + balance[:, 1])
    backward = np.sort(balance[:, 1] * count + balance[:, 0])
    return np.array_equal(forward, backward)


def _fans(contours: Sequence[FloatArray]) -> IndexArray:
    """Return one fan of triangles for each contour; triangles outside the polygon are clockwise."""
    fans = []
    start = 0
    for contour in contours:
        rest = np.arange(start + 1, start + len(contour) - 1)
        fans.append(np.column_stack([np.full_like(rest, start), rest, rest + 1]))
        start += len(contour)
    return np.concatenate(fans)


def convex_corners(edges: Sequence[FloatArray]) -> FloatArray:
    """Return the corners of a convex polygon, counterclockwise, given its edges in any order.

    Parameters
    ----------
    edges : sequence of (2, 2) float64
        Each edge from one corner to the next, counterclockwise; without edges there are no corners.
    """
    if not len(edges):
        return np.zeros((0, 2))
    ends = np.stack(edges)
    along = ends[:, 1] - ends[:, 0]
    order = np.argsort(np.arctan2(along[:, 1], along[:, 0]), kind="stable")
    return np.asarray(ends[order, 0])
