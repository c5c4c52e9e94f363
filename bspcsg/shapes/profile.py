"""Solids from plane polygons, extruded along the z axis or revolved around it."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from .._types import FloatArray, IndexArray, Scalar, Vector
from ..errors import invalid_parameter
from ..geometry.polygon import contours_of, directed_edges, triangulate
from ..geometry.transform import cos_sin
from ..parameters import (
    SEGMENTS,
    at_least,
    not_negative,
    number,
    positive,
    refuse_many_corners,
    sides_around,
    truth_value,
    two_values,
)
from ..solid.leaf import MeshLeaf
from ..solid.ledger import counted
from ..solid.solid import Solid, from_leaf
from .sweep import RingLayout, quad_triangles
from .twist import Rise, extruded

#: The default number of slices for a full turn of twist, equal to the default sides of a circle.
_SLICES_OF_A_TURN = 32

#: Points count as on the axis if their distance, relative to the largest coordinate, is at most
#: this. The sine of a few half turns in doubles differs from 0 by multiples of 2^-53.
_ROUNDING = 2.0**-50


@counted
def extrude(
    polygon: Any,
    h: Scalar,
    *,
    center: bool = False,
    twist: Scalar = 0.0,
    scale: Scalar | Vector = 1.0,
    slices: int | None = None,
    taper: Scalar = 0.0,
) -> Solid:
    """Return the solid that a polygon, possibly concave and with holes, sweeps along the z axis.

    Parameters
    ----------
    polygon : object
        (n, 2) points, a list of such contours, a manifold3d cross section, or a shapely polygon,
        multipolygon or collection, or a list of these. Contours may run in either direction; a
        contour inside an odd number of other contours is a hole. If contours cross each other,
        points with a positive winding number are inside.
    h : float
        Height.
    center : bool
        True if the middle is at z = 0, instead of the lower end.
    twist : float
        Rotation of the upper end about the z axis, in degrees, clockwise seen from above, as in
        OpenSCAD.
    scale : float or (2,) float
        Scale factor of the upper end, or factors along x and y; 0 makes the end a point or a line.
    slices : int, optional
        The number of parts of the height with straight walls, at least 1. By default one for each
        32nd of a turn of `twist`. Without twist, one is enough.
    taper : float
        Angle in degrees by which walls lean inwards, or outwards if it is negative; between -90 and
        90. Walls end where they meet, as in a roof, which may be lower than `h`.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range, or `taper` with `twist` or `scale` makes a wall's upper
        edge vanish; the message names the point.
    LimitError
        If the solid would have too many corners, or walls meet in a figure of more than a thousand
        corners.

    Notes
    -----
    If leaning walls meet below the upper end, the parts inside any of them are united.

    Examples
    --------
    >>> import bspcsg as csg
    >>> frame = [[(0, 0), (4, 0), (4, 4), (0, 4)], [(1, 1), (3, 1), (3, 3), (1, 3)]]
    >>> csg.extrude(frame, 2).volume
    24.0
    >>> csg.extrude([(-1, -1), (1, -1), (1, 1), (-1, 1)], 3, scale=0).volume
    4.0
    """
    rise = _rise(positive(h, "h"), center, twist, scale, slices, taper)
    contours = contours_of(polygon)
    if not contours:
        return Solid.empty()
    points = np.concatenate(contours)
    count = len(points)
    if not rise.is_upright:
        refuse_many_corners((rise.slices + 1) * count, "This extrusion")
        return extruded(contours, rise)
    levels = [
        np.column_stack([points, np.full(count, z)]) for z in (rise.base, rise.base + rise.height)
    ]
    caps = triangulate(contours)
    start, end = directed_edges(contours).T
    sides = quad_triangles(start, end, start + count, end + count)
    return _solid(np.concatenate(levels), [caps[:, ::-1], caps + count, sides])


def _rise(
    height: float,
    center: bool,
    twist: Scalar,
    scale: Scalar | Vector,
    slices: int | None,
    taper: Scalar,
) -> Rise:
    turn, lean = number(twist, "twist"), number(taper, "taper")
    if abs(lean) >= 90:
        raise invalid_parameter(f"taper must be between -90 and 90 degrees, not {lean:g}.")
    x, y = (not_negative(end, "scale") for end in two_values(scale, "scale"))
    wanted = math.ceil(abs(turn) / 360 * _SLICES_OF_A_TURN) if slices is None else slices
    count = at_least(1, max(wanted, 1) if slices is None else wanted, "slices")
    base = -height / 2 if truth_value(center, "center") else 0.0
    return Rise(height, base, turn, (x, y), count, height * math.tan(math.radians(lean)))


@counted
def revolve(polygon: Any, *, angle: Scalar = 360.0, segments: int = SEGMENTS) -> Solid:
    """Return the solid that a polygon sweeps around the z axis, starting at the x axis.

    Parameters
    ----------
    polygon : object
        A polygon as for `extrude`. Its x becomes the distance from the axis and must not be
        negative; its y becomes the height.
    angle : float
        Angle of revolution in degrees, above 0 and up to 360.
    segments : int
        The number of sides over the whole angle, each of less than a half turn: at least 3 for a
        full turn.

    Examples
    --------
    >>> import bspcsg as csg
    >>> ring = csg.revolve([(2, 0), (3, 0), (3, 1), (2, 1)], segments=64)
    >>> ring.genus
    1
    """
    turn = positive(angle, "angle")
    if turn > 360:
        raise invalid_parameter(f"angle must be at most 360 degrees, not {turn:g}.")
    full = turn == 360
    columns = sides_around(least_segments(turn), segments, "segments") + (not full)
    contours = [_with_ends_on_axis(contour) for contour in contours_of(polygon)]
    if not contours:
        return Solid.empty()
    points = np.concatenate(contours)
    refuse_many_corners(columns * len(points), "This body")
    if points[:, 0].min() < 0:
        raise invalid_parameter(
            "The polygon must not have points with x below 0, because it is revolved around the"
            " axis x = 0; move it to the right."
        )
    directions = np.array([cos_sin(turn * k / int(segments)) for k in range(columns)])
    rings = RingLayout(points, columns)
    faces = [_swept(rings, start, end, full) for start, end in directed_edges(contours)]
    if not full:
        ends = np.array([rings.ring(point) for point in range(len(points))])
        caps = triangulate(contours)
        faces += [ends[:, 0][caps], ends[:, -1][caps[:, ::-1]]]
    return _solid(rings.vertices(directions), faces)


def _with_ends_on_axis(contour: FloatArray) -> FloatArray:
    """Return a contour whose points next to the axis x = 0, up to rounding, are moved onto it."""
    far = np.abs(contour[:, 0]) > _ROUNDING * np.abs(contour).max(initial=0)
    return np.column_stack([np.where(far, contour[:, 0], 0.0), contour[:, 1]])


def least_segments(angle: float) -> int:
    """Return the least number of equal parts of an angle in degrees that are below 180 each."""
    return int(abs(angle) // 180) + 1


def _swept(rings: RingLayout, start: int, end: int, full: bool) -> IndexArray:
    """Return the triangles that the polygon's edge from `start` to `end` sweeps around the axis."""
    low, high = rings.ring(start), rings.ring(end)
    if full:
        return quad_triangles(low, np.roll(low, -1), high, np.roll(high, -1))
    return quad_triangles(low[:-1], low[1:], high[:-1], high[1:])


def _solid(vertices: FloatArray, faces: Sequence[IndexArray]) -> Solid:
    triangles = np.ascontiguousarray(np.concatenate(faces))
    return from_leaf(MeshLeaf(vertices, triangles))
