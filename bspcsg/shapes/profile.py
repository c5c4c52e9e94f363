"""Solids from plane polygons: extruded along z or revolved around it."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from .._types import FloatArray, IndexArray, Scalar
from ..errors import invalid_parameter
from ..geometry.polygon import contours_of, directed_edges, triangulate
from ..geometry.transform import cos_sin
from ..parameters import positive, refuse_many_corners, sides_around
from ..solid.counting import counted
from ..solid.leaf import MeshLeaf
from ..solid.solid import Solid, from_leaf
from .sweep import RingLayout, strip


@counted
def extrude(polygon: Any, h: Scalar, *, center: bool = False) -> Solid:
    """Return the upright prism over a polygon, which may be concave and have holes.

    Parameters
    ----------
    polygon : object
        (n, 2) points, a list of such contours, a manifold3d cross section, or a shapely polygon,
        multipolygon or collection, or a list of these. Contours may run either way round; one that
        lies inside an odd number of others is a hole. Where contours cross each other, positive
        winding counts as inside.
    h : float
        Height.
    center : bool
        Whether the middle is at z = 0, instead of the lower end.

    Examples
    --------
    >>> import bspcsg as b
    >>> frame = [[(0, 0), (4, 0), (4, 4), (0, 4)], [(1, 1), (3, 1), (3, 3), (1, 3)]]
    >>> b.extrude(frame, 2).volume
    24.0
    """
    height = positive(h, "h")
    contours = contours_of(polygon)
    points = np.concatenate(contours)
    count = len(points)
    base = -height / 2 if center else 0.0
    levels = [np.column_stack([points, np.full(count, z)]) for z in (base, base + height)]
    caps = triangulate(contours)
    start, end = directed_edges(contours).T
    sides = strip(start, end, start + count, end + count)
    return _solid(np.concatenate(levels), [caps[:, ::-1], caps + count, sides])


@counted
def revolve(polygon: Any, *, angle: Scalar = 360.0, segments: int = 32) -> Solid:
    """Return the solid that a polygon sweeps around the z axis, from the x axis on.

    Parameters
    ----------
    polygon : object
        As for `extrude`; x becomes the distance from the axis and must not be negative, y becomes
        the height.
    angle : float
        In degrees, above 0 and up to 360.
    segments : int
        Sides around, at least 3 for a full turn.

    Examples
    --------
    >>> import bspcsg as b
    >>> ring = b.revolve([(2, 0), (3, 0), (3, 1), (2, 1)], segments=64)
    >>> ring.genus
    1
    """
    turn = positive(angle, "angle")
    if turn > 360:
        raise invalid_parameter(f"angle must not exceed 360, not {turn:g}.")
    full = turn == 360
    columns = sides_around(3 if full else 1, segments, "segments") + (not full)
    contours = contours_of(polygon)
    points = np.concatenate(contours)
    refuse_many_corners(columns * len(points), "This body")
    if points[:, 0].min() < 0:
        raise invalid_parameter("A revolved polygon must not cross the axis: x below 0.")
    directions = np.array([cos_sin(turn * k / int(segments)) for k in range(columns)])
    rings = RingLayout(points, columns)
    faces = [_swept(rings, start, end, full) for start, end in directed_edges(contours)]
    if not full:
        ends = np.array([rings.ring(point) for point in range(len(points))])
        caps = triangulate(contours)
        faces += [ends[:, 0][caps], ends[:, -1][caps[:, ::-1]]]
    return _solid(rings.vertices(directions), faces)


def _swept(rings: RingLayout, start: int, end: int, full: bool) -> IndexArray:
    """Return the band that one edge of the polygon sweeps."""
    low, high = rings.ring(start), rings.ring(end)
    if full:
        return strip(low, np.roll(low, -1), high, np.roll(high, -1))
    return strip(low[:-1], low[1:], high[:-1], high[1:])


def _solid(vertices: FloatArray, faces: Sequence[IndexArray]) -> Solid:
    triangles = np.ascontiguousarray(np.concatenate(faces))
    return from_leaf(MeshLeaf(vertices, triangles))
