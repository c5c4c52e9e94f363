"""Convex hulls in the plane."""

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np

from ..._types import FloatArray
from ...bsp import Region
from ...bsp.trees.facets import chosen_pitch
from ...errors import InvalidMeshError, invalid_parameter
from ...geometry.arrays import doubles

#: A point in steps of the lattice, and its number.
_Corner: TypeAlias = tuple[int, int, int]


def hull_of_region(figure: Region) -> Region:
    """Return the convex hull of a region (see `Region.hull`)."""
    return hull_of_figures([figure])


def hull_of_figures(figures: Sequence[Any]) -> Region:
    """Return the convex hull of regions and of points of the plane, (n, 2) each."""
    clouds = [_points_of(figure) for figure in figures]
    points = np.concatenate([np.zeros((0, 2)), *clouds])
    pitches = [one.pitch for one in figures if isinstance(one, Region) and not one.is_empty]
    return hull_region(points, min(pitches, default=None))


def _points_of(figure: Any) -> FloatArray:
    if isinstance(figure, Region):
        return np.concatenate([np.zeros((0, 2)), *figure.to_polygons()])
    refusal = invalid_parameter("A hull is that of shapes and points of one dimension.")
    points = doubles(figure, refusal)
    if points.ndim != 2 or points.shape[1] != 2:
        raise refusal
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        message = f"{len(bad)} of the points are not finite, the first is number {bad[0]}."
        raise InvalidMeshError(message, "non_finite", bad[:20].tolist())
    return points


def hull_region(points: FloatArray, pitch: int | None = None) -> Region:
    """Return the convex hull of points in the plane, exactly; empty if they lie on a line.

    Parameters
    ----------
    points : (n, 2) float64
        Finite, in model units; they are snapped to the lattice first.
    pitch : int, optional
        Exponent of the lattice step; by default what suits the points.
    """
    if len(points) < 3:
        return Region.empty()
    chosen = chosen_pitch(pitch, points)
    steps = np.round(points / 10.0**chosen)
    corners = sorted({(int(x), int(y)): k for k, (x, y) in enumerate(steps.tolist())}.items())
    row = [(x, y, k) for (x, y), k in corners]
    outline = _chain(row)[:-1] + _chain(row[::-1])[:-1]
    if len(outline) < 3:
        return Region.empty()
    return Region([points[[k for _, _, k in outline]]], pitch=chosen)


def _chain(points: list[_Corner]) -> list[_Corner]:
    """Return the corners of one half of the hull, turning left (Andrew 1979)."""
    chain: list[_Corner] = []
    for point in points:
        while len(chain) >= 2 and not _turns_left(chain[-2], chain[-1], point):
            chain.pop()
        chain.append(point)
    return chain


def _turns_left(a: _Corner, b: _Corner, c: _Corner) -> bool:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0
