"""Exact visibility polygons in the plane, and visibility volumes in space.

The shadow of a facet is the part of its cone from the eye that lies behind its hyperplane. The eye
sees a box minus all shadows.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np

from ..._types import Scalar
from ...errors import invalid_parameter
from ...geometry.arrays import doubles
from ...geometry.hyperplane import exact_number, exact_point
from ...shapes.primitives import box as box_solid
from ...shapes.primitives import half_space
from ...solid.solid import Solid
from ..trees.facets import box_corners, chosen_pitch
from .objects import ObjectTree
from .region import Region

#: A point in exact coordinates.
_Point = list[Fraction]


def visibility_polygon(
    segments: Any, eye: Any, low: Sequence[Scalar], high: Sequence[Scalar]
) -> Region:
    """Return the part of a rectangle that an eye sees, with segments as walls.

    Parameters
    ----------
    segments : (n, 2, 2) array_like of float
        Segments may cross, touch and overlap. A segment whose line contains the eye hides nothing.
        All points are snapped to a lattice that suits their coordinates.
    eye : (2,) array_like of float
        The eye must not lie on a segment.
    low, high : (2,) array_like of float
        The minimum and the maximum corner of the rectangle.

    Raises
    ------
    InvalidParameterError
        If the eye lies on a segment, a shape is wrong, or `low` is above `high`.

    Examples
    --------
    >>> from bspcsg import bsp
    >>> bsp.visibility_polygon([[[1, -1], [1, 1]]], (0, 0), (-2, -2), (2, 2)).area
    13.0
    """
    walls, place = _exact(segments, eye, 2)
    least, most = box_corners(low, high, 2)
    points = [*walls, [place, least, most]]
    pitch = chosen_pitch(None, np.array([[float(x) for x in p] for ps in points for p in ps]))
    place = _snapped(place, pitch)
    walls = [[_snapped(corner, pitch) for corner in wall] for wall in walls]
    (x, y), (u, v) = map(float, least), map(float, most)
    shadows = []
    for a, b in walls:
        turn = _turn(place, a, b)
        if not turn:
            if _is_between(place, a, b):
                raise invalid_parameter(
                    "The eye lies on a segment, so what it sees is not defined; move the eye off"
                    " the segment."
                )
            continue
        first, last = (a, b) if turn > 0 else (b, a)
        # The shadow: left of the ray to the first end, right of the ray to the last, behind the
        # wall.
        ways = (place, first), (last, place), (last, first)
        halves = [_left_of(start, end, pitch) for start, end in ways]
        shadow = halves[0] & halves[1] & halves[2]
        shadows.append(Region._of(shadow._tree))
    return Region([(x, y), (u, y), (u, v), (x, v)], pitch=pitch) - _united(shadows)


def visibility_volume(
    triangles: Any, eye: Any, low: Sequence[Scalar], high: Sequence[Scalar]
) -> Solid:
    """Return the part of a box that an eye sees, with triangles as walls.

    Parameters
    ----------
    triangles : (n, 3, 3) array_like of float
        Triangles may cross, touch and overlap.
    eye : (3,) array_like of float
    low, high : (3,) array_like of float
        The minimum and the maximum corner of the box.

    Raises
    ------
    InvalidParameterError
        If a shape is wrong, or `low` is above `high`.

    Notes
    -----
    A triangle whose plane contains the eye hides nothing.

    Examples
    --------
    >>> from bspcsg import bsp
    >>> wall = [[[-1, -1, 1], [1, -1, 1], [1, 1, 1]], [[-1, -1, 1], [1, 1, 1], [-1, 1, 1]]]
    >>> bsp.visibility_volume(wall, (0, 0, 0), (-2, -2, -2), (2, 2, 2)).volume
    54.666666666666664
    """
    walls, place = _exact(triangles, eye, 3)
    least, most = ([float(x) for x in corner] for corner in box_corners(low, high, 3))
    sizes = [end - start for start, end in zip(least, most, strict=True)]
    seen = box_solid(sizes).translate(least)
    for corners in walls:
        normal = _normal(*corners)
        depth = _offset(normal, corners[0]) - _offset(normal, place)
        if not depth:
            continue
        ring = corners if depth > 0 else corners[::-1]
        beyond = [-n if depth > 0 else n for n in normal]
        shadow = half_space(beyond, _offset(beyond, corners[0]))
        for a, b in pairwise([*ring, ring[0]]):
            side = _normal(place, b, a)
            shadow &= half_space(side, _offset(side, place))
        seen -= shadow
    return seen


def _exact(facets: Any, eye: Any, dimension: int) -> tuple[list[list[_Point]], _Point]:
    shapes = doubles(facets, invalid_parameter("Facets must be an array of numbers."))
    if shapes.ndim != 3 or shapes.shape[1:] != (dimension, dimension):
        expected = f"(n, {dimension}, {dimension})"
        raise invalid_parameter(f"The facets must have shape {expected}, not {shapes.shape}.")
    place = exact_point(eye, dimension, "eye")
    walls = [[[exact_number(x) for x in corner] for corner in shape] for shape in shapes.tolist()]
    return walls, place


def _turn(a: _Point, b: _Point, c: _Point) -> Fraction:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _is_between(place: _Point, a: _Point, b: _Point) -> bool:
    """Return true if `place`, a point of the line through a and b, lies on their segment."""
    return all(min(p, q) <= x <= max(p, q) for x, p, q in zip(place, a, b, strict=True))


def _snapped(point: _Point, pitch: int) -> _Point:
    """Return the nearest lattice point, in model units."""
    step = Fraction(10) ** pitch
    return [round(x / step) * step for x in point]


def _left_of(start: _Point, end: _Point, pitch: int) -> ObjectTree:
    """Return the half-plane to the left of the line from `start` to `end`."""
    normal = [end[1] - start[1], start[0] - end[0]]
    return ObjectTree.half_space(normal, _offset(normal, start), pitch=pitch)


def _normal(a: _Point, b: _Point, c: _Point) -> Any:
    u, v = ([x - y for x, y in zip(p, a, strict=True)] for p in (b, c))
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


def _offset(normal: Sequence[Fraction], point: _Point) -> Any:
    """Return the exact product of a normal and a point."""
    return sum((n * x for n, x in zip(normal, point, strict=True)), Fraction(0))


def _united(regions: list[Region]) -> Region:
    """Return the union of regions: pairs of neighbours first, then pairs of results."""
    while len(regions) > 1:
        regions = [
            regions[k] | regions[k + 1] if k + 1 < len(regions) else regions[k]
            for k in range(0, len(regions), 2)
        ]
    return regions[0] if regions else Region.empty()
