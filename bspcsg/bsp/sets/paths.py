"""Connected paths that bound a region of the plane, closed or from infinity to infinity."""

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from ..._types import FloatArray
from ...parameters import instance_of
from .region import Region

#: A corner in exact coordinates.
_Point = tuple[Fraction, Fraction]

#: Half the side, in lattice steps, of the square that stands for infinity. As a double it still
#: fits on the lattice.
_HALF_SIDE_STEPS = 2**53 - 2


@dataclass(frozen=True, eq=False)
class BoundaryPath:
    """A connected path along a region's boundary, with the region on its left.

    Parameters
    ----------
    points : (n, 2) float64
        The corners in order, rounded. A straight line has no corners; `points` then has its point
        nearest to the origin.
    start : (2,) float64 or None
        The unit vector along which the path comes from infinity; None if the path is closed.
    end : (2,) float64 or None
        The unit vector along which the path goes to infinity; None if the path is closed.
    """

    points: FloatArray
    start: FloatArray | None = None
    end: FloatArray | None = None

    @property
    def is_closed(self) -> bool:
        """True for a closed loop, false for a path from infinity to infinity."""
        return self.start is None

    @property
    def length(self) -> float:
        """The length in model units; infinite for a path that is not closed."""
        if not self.is_closed:
            return math.inf
        steps = np.roll(self.points, -1, axis=0) - self.points
        return math.fsum(np.hypot(steps[:, 0], steps[:, 1]).tolist())


def boundary_paths(region: Region) -> tuple[BoundaryPath, ...]:
    """Return the connected paths that bound a region of the plane, bounded or not.

    Parameters
    ----------
    region : Region

    Returns
    -------
    tuple of BoundaryPath
        The closed paths, which are outlines of the region, and the paths from infinity to infinity;
        none for the empty set and the whole plane. Paths touch each other and themselves only in
        corners.

    Notes
    -----
    The border of the lattice stands for infinity: paths that leave its largest square continue
    straight.

    Examples
    --------
    >>> from bspcsg import bsp
    >>> quarter = bsp.Region.half_plane((0, -1)) & bsp.Region.half_plane((-1, 0))
    >>> (path,) = bsp.boundary_paths(quarter)
    >>> path.points.tolist(), path.start.tolist(), path.end.tolist()
    ([[0.0, 0.0]], [0.0, -1.0], [1.0, 0.0])
    """
    if instance_of(Region, region, "region").is_bounded:
        return tuple(BoundaryPath(outline.points) for outline in region.outlines)
    side = float(_HALF_SIDE_STEPS * Fraction(10) ** region.pitch)
    corners = [(-side, -side), (side, -side), (side, side), (-side, side)]
    square = Region(corners, pitch=region.pitch)
    border = abs(square.exact_outlines[0][0][0])
    loops = (region & square).exact_outlines
    return tuple(path for loop in loops for path in _without_border(loop, border))


def _without_border(loop: list[_Point], border: Fraction) -> list[BoundaryPath]:
    """Return the paths that are left of a loop after removing its edges along a square's border."""
    ends = [_is_on_border(a, b, border) for a, b in zip(loop, [*loop[1:], loop[0]], strict=True)]
    if not any(ends):
        return [BoundaryPath(_rounded(loop))]
    first = ends.index(True) + 1
    walk, along = loop[first:] + loop[:first], ends[first:] + ends[:first]
    paths, open_path = [], [walk[0]]
    for corner, leaves in zip([*walk[1:], walk[0]], along, strict=True):
        if not leaves:
            open_path.append(corner)
            continue
        if len(open_path) > 1:
            paths.append(_infinite_path(open_path))
        open_path = [corner]
    return paths


def _is_on_border(a: _Point, b: _Point, border: Fraction) -> bool:
    """Return true if an edge lies on the border of the square with half side `border`."""
    return any(abs(p) == border and p == q for p, q in zip(a, b, strict=True))


def _infinite_path(corners: list[_Point]) -> BoundaryPath:
    """Return the path from infinity to infinity along corners; the two ends stand for infinity."""
    start, end = _direction(*corners[:2]), _direction(*corners[-2:])
    inner = corners[1:-1] or [_nearest_to_origin(*corners)]
    return BoundaryPath(_rounded(inner), start, end)


def _direction(a: _Point, b: _Point) -> FloatArray:
    steps = [q - p for p, q in zip(a, b, strict=True)]
    longest = max(map(abs, steps))
    vector = np.array([float(step / longest) for step in steps])
    direction = vector / np.linalg.norm(vector)
    direction.flags.writeable = False
    return np.asarray(direction)


def _nearest_to_origin(a: _Point, b: _Point) -> _Point:
    """Return the point nearest to the origin on the line through two points."""
    (x, y), (u, v) = a, (b[0] - a[0], b[1] - a[1])
    t = (x * u + y * v) / (u * u + v * v)
    return x - t * u, y - t * v


def _rounded(points: list[_Point]) -> FloatArray:
    array = np.array([[float(x) for x in point] for point in points])
    array.flags.writeable = False
    return array
