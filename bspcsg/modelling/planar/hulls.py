"""Convex hulls in the plane."""

from collections.abc import Sequence
from math import hypot
from typing import Any, TypeAlias

import numpy as np

from ..._types import FloatArray
from ...bsp import Region
from ...bsp.trees.facets import chosen_pitch
from ...errors import InvalidMeshError, invalid_parameter
from ...geometry.arrays import doubles

#: A lattice point: x and y in lattice steps, and its number in the input.
_Corner: TypeAlias = tuple[int, int, int]

#: The error of a computed coordinate, in spacings of doubles at the largest coordinate.
_COMPUTED = 4.0


def hull_of_region(figure: Region) -> Region:
    """Return the convex hull of a region; see `Region.hull`."""
    return hull_of_figures([figure])


def hull_of_figures(figures: Sequence[Any]) -> Region:
    """Return the convex hull of all given regions and (n, 2) arrays of points."""
    clouds = [_points_of(figure) for figure in figures]
    points = np.concatenate([np.zeros((0, 2)), *clouds])
    pitches = [one.pitch for one in figures if isinstance(one, Region) and not one.is_empty]
    return hull_region(points, min(pitches, default=None))


def _points_of(figure: Any) -> FloatArray:
    if isinstance(figure, Region):
        return np.concatenate([np.zeros((0, 2)), *figure.to_polygons()])
    refusal = invalid_parameter(
        "The arguments of hull must all be regions and points in the plane, or all be solids and"
        " points in space."
    )
    points = doubles(figure, refusal)
    if points.ndim != 2 or points.shape[1] != 2:
        raise refusal
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        message = (
            f"{len(bad)} of the points have coordinates that are not finite numbers; the first is"
            f" point {bad[0]} (counted from 0)."
        )
        raise InvalidMeshError(message, "non_finite", bad[:20].tolist())
    return points


def hull_region(points: FloatArray, pitch: int | None = None) -> Region:
    """Return the convex hull of points in the plane; empty if they lie on a line up to rounding.

    The hull of the snapped points is exact. If snapping moves points, a point that lies outside
    the hull of the other points only by rounding is not a corner, as in `bspcsg.hull`.

    Parameters
    ----------
    points : (n, 2) float64
        Finite points in model units; they are snapped to the lattice first.
    pitch : int, optional
        Exponent of the lattice step; by default it is chosen to suit the points.
    """
    if len(points) < 3:
        return Region.empty()
    chosen = chosen_pitch(pitch, points)
    exact = points / 10.0**chosen
    steps = np.round(exact)
    corners = sorted({(int(x), int(y)): k for k, (x, y) in enumerate(steps.tolist())}.items())
    row = [(x, y, k) for (x, y), k in corners]
    outline = _chain(row)[:-1] + _chain(row[::-1])[:-1]
    outline = _without_flat_corners(outline, 2 * _moved_by(exact, steps))
    if len(outline) < 3:
        return Region.empty()
    return Region([points[[k for _, _, k in outline]]], pitch=chosen)


def _moved_by(exact: FloatArray, steps: FloatArray) -> float:
    """Return the largest error of a point by snapping to the lattice, in lattice steps.

    It is 0 if all points are on the lattice.
    """
    moved = float(np.hypot(*(exact - steps).T).max())
    largest = float(np.abs(steps).max())
    return moved + _COMPUTED * float(np.finfo(np.float64).eps) * largest if moved else 0.0


def _without_flat_corners(outline: list[_Corner], most: float) -> list[_Corner]:
    """Return a convex outline without corners that lie within `most` of the remaining outline.

    First, corners are chosen whose distance from the line through their neighbours exceeds `most`.
    Then corners are added that lie farther than `most` outside the outline of the chosen ones.
    """
    count = len(outline)
    if most == 0 or count < 3:
        return outline
    clear = [
        k
        for k in range(count)
        if _height(outline[k], outline[k - 1], outline[(k + 1) % count]) > most
    ]
    if len(clear) < 2:
        # Start with the first corner and the corner farthest from it.
        far = max(range(count), key=lambda k: _height(outline[k], outline[0], outline[0]))
        clear = [0, far]
    kept: list[_Corner] = []
    for start, end in zip(clear, [*clear[1:], clear[0] + count], strict=True):
        kept.append(outline[start])
        between = [outline[k % count] for k in range(start, end + 1)]
        kept += _bends(between, most)
    return kept


def _bends(chain: list[_Corner], most: float) -> list[_Corner]:
    """Return inner corners that keep a polyline, `chain`, within the distance `most`.

    It is divided at the corner farthest from its chord while that distance exceeds `most`.
    """
    kept: list[_Corner] = []
    waiting = [(0, len(chain) - 1)]
    while waiting:
        start, end = waiting.pop()
        heights = [_height(chain[k], chain[start], chain[end]) for k in range(start + 1, end)]
        if heights and max(heights) > most:
            top = start + 1 + heights.index(max(heights))
            waiting += [(top, end), (start, top)]
        elif start > 0:
            kept.append(chain[start])
    return kept


def _height(point: _Corner, start: _Corner, end: _Corner) -> float:
    """Return the distance, in lattice steps, of a point from the line through two other points.

    If the two points coincide, it is the distance from them.
    """
    x, y = point[0] - start[0], point[1] - start[1]
    along, up = end[0] - start[0], end[1] - start[1]
    length = hypot(along, up)
    return abs(x * up - y * along) / length if length else hypot(x, y)


def _chain(points: list[_Corner]) -> list[_Corner]:
    """Return the lower convex hull of points sorted by x and y, or the upper for reverse order.

    This is Andrew's monotone chain (1979); all turns are to the left.
    """
    chain: list[_Corner] = []
    for point in points:
        while len(chain) >= 2 and not _turns_left(chain[-2], chain[-1], point):
            chain.pop()
        chain.append(point)
    return chain


def _turns_left(a: _Corner, b: _Corner, c: _Corner) -> bool:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0
