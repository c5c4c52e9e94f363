"""Figures with rounded or chamfered corners."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from ..._types import BoolArray, FloatArray, Scalar
from ...bsp import Region
from ...errors import InvalidParameterError, invalid_parameter
from ...geometry.arrays import axes_of
from ...parameters import function_of, positive, refuse_many_corners, sides_around

#: The least turn, in degrees, at which a corner is rounded or cut. Smaller turns belong to curves.
_SMOOTH = 30 + 1e-6

#: The relative error of an edge's length by rounding.
_SAME = 1e-9

#: The share of a chord by which rounding may lengthen an arc.
_PART = 1e-6

#: The choice of corners: a function of (n, 2) points that returns (n,) truth values; None for all.
Corners: TypeAlias = Callable[[FloatArray], Any] | None


@dataclass(frozen=True)
class _Cut:
    """The replacement of a corner: an arc or a straight line.

    Parameters
    ----------
    size : float
        The radius of the arc, or the distance from the corner to the line's ends.
    around : int
        The number of sides of a full circle; 0 for a straight line.
    """

    size: float
    around: int

    def setbacks(self, turns: FloatArray) -> FloatArray:
        """Return how far from each corner the cut meets its edges, given the turns in radians."""
        round_: FloatArray = self.size * np.tan(np.abs(turns) / 2)
        return round_ if self.around else np.full(len(turns), self.size)

    def points(self, corner: FloatArray, ahead: FloatArray, turn: float) -> FloatArray:
        """Return the points, (k, 2), that replace a corner.

        `ahead` is the unit vector of the edge that ends at the corner, `turn` the angle to the next
        edge, in radians.
        """
        if not self.around:
            after = _turned(ahead, np.array([turn]))[0]
            return np.array([corner - self.size * ahead, corner + self.size * after])
        steps = max(math.ceil(self.around * abs(turn) / math.tau - _PART), 1)
        spoke = np.array([ahead[1], -ahead[0]]) * math.copysign(self.size, turn)
        start = corner - self.size * math.tan(abs(turn) / 2) * ahead
        return start - spoke + _turned(spoke, np.linspace(0, turn, steps + 1))


def fillet_region(figure: Region, r: Scalar, corners: Corners, segments: int) -> Region:
    """Return a region whose corners are rounded with radius `r`; see `Region.fillet`."""
    around = sides_around(4, segments, "segments")
    return _recut(figure, _Cut(positive(r, "r"), around), corners)


def chamfer_region(figure: Region, size: Scalar, corners: Corners) -> Region:
    """Return a region whose corners are cut off at distance `size`; see `Region.chamfer`."""
    return _recut(figure, _Cut(positive(size, "size"), 0), corners)


def _recut(figure: Region, cut: _Cut, corners: Corners) -> Region:
    if corners is not None:
        function_of(corners, "corners")
    if not figure.is_bounded and (~figure).is_bounded:
        return ~_recut(~figure, cut, corners)
    loops = figure.to_polygons()
    refuse_many_corners(sum(map(len, loops)) * max(cut.around, 2), "This region")
    return _without_crossings(figure, [_recut_loop(points, cut, corners) for points in loops])


def _recut_loop(points: FloatArray, cut: _Cut, corners: Corners) -> FloatArray:
    steps = np.roll(points, -1, axis=0) - points
    lengths = np.linalg.norm(steps, axis=1)
    ahead = np.roll(steps / lengths[:, None], 1, axis=0)
    after = np.roll(ahead, -1, axis=0)
    across = ahead[:, 0] * after[:, 1] - ahead[:, 1] * after[:, 0]
    turns = np.arctan2(across, (ahead * after).sum(axis=1))
    chosen = (np.abs(turns) > math.radians(_SMOOTH)) & _selected(corners, points)
    reach = np.where(chosen, cut.setbacks(turns), 0.0)
    for k in np.flatnonzero(reach + np.roll(reach, -1) > lengths * (1 + _SAME)):
        raise _no_room(points[k] if chosen[k] else points[(k + 1) % len(points)])
    parts = [
        cut.points(points[k], ahead[k], float(turns[k])) if chosen[k] else points[[k]]
        for k in range(len(points))
    ]
    return np.concatenate(parts)


def _turned(vector: FloatArray, angles: FloatArray) -> FloatArray:
    """Return a plane vector rotated by each of n angles in radians, (n, 2)."""
    x, y = vector
    cosines, sines = np.cos(angles), np.sin(angles)
    return np.column_stack([x * cosines - y * sines, x * sines + y * cosines])


def _selected(corners: Corners, points: FloatArray) -> BoolArray:
    if corners is None:
        return np.ones(len(points), dtype=np.bool_)
    answer = corners(points.copy())
    found = np.asarray(None if axes_of(answer) is None else answer)
    if found.dtype != np.bool_ or found.shape != (len(points),):
        raise invalid_parameter(
            f"The function corners must return one bool for each of {len(points)} points, not"
            f" {found.dtype} of shape {found.shape}."
        )
    return found


def _without_crossings(figure: Region, loops: list[FloatArray]) -> Region:
    """Return the region that new outlines bound; raise an error if outlines cross."""
    made = Region(loops, pitch=figure.pitch)
    # Where outlines cross, winding numbers are not only 0 and 1. Snapping alone causes such areas
    # of at most one lattice step times the length of the outlines.
    crossed = made ^ Region(loops, winding="even-odd", pitch=figure.pitch)
    length = math.fsum(outline.length for outline in made.outlines)
    if crossed.area > length * 10.0**figure.pitch:
        raise invalid_parameter(
            "The rounded or chamfered corners would cross another outline of the region. Choose a"
            " smaller size."
        )
    return made


def _no_room(corner: FloatArray) -> InvalidParameterError:
    place = ", ".join(f"{value:.6g}" for value in corner)
    return invalid_parameter(
        f"The edges at the corner ({place}) are too short for this size. Choose a smaller"
        " size, or fewer corners."
    )
