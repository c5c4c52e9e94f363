"""Frames along a path: the axes of a swept profile at each point."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np

from ..._types import FloatArray
from ...errors import LimitError, invalid_parameter
from ...geometry.arrays import doubles
from ...parameters import one_of

#: The rule by which a profile rotates along a path.
Frame: TypeAlias = Literal["parallel", "fixed"]

#: A path is closed if the distance of its ends, relative to its extent, is at most this.
_SAME = 1e-9

#: The cosine of 175 degrees, the largest turn of a path at a point. The mitre is then 23 times as
#: long as the profile is wide.
_SHARPEST = -0.9962

#: A direction is parallel to the z axis if the sine of their angle is below this.
_UPRIGHT = 1e-9


@dataclass(frozen=True)
class Spine:
    """A path, and the axes of a swept profile at each of its points.

    Parameters
    ----------
    points : (n, 3) float64
        The points of the path; a closed path does not repeat its first point.
    shares : (n,) float64
        The path's length up to each point, as a share of its whole length.
    right, up : (n, 3) float64
        The unit vectors of the profile's x and y axis, perpendicular to the path.
    bend : (n, 3) float64
        The unit vectors towards which the path turns, or zero where it is straight.
    stretch : (n,) float64
        The factor by which a mitre stretches the profile along `bend`.
    closed : bool
        True if the last point is joined to the first.
    """

    points: FloatArray
    shares: FloatArray
    right: FloatArray
    up: FloatArray
    bend: FloatArray
    stretch: FloatArray
    closed: bool

    def ring(self, place: int, profile: FloatArray) -> FloatArray:
        """Return the (k, 3) corners in space of a (k, 2) plane profile at path point `place`."""
        across = profile[:, :1] * self.right[place] + profile[:, 1:] * self.up[place]
        along = (across @ self.bend[place])[:, None] * self.bend[place]
        ring: FloatArray = self.points[place] + across + along * (self.stretch[place] - 1)
        return ring


def path_points(path: Any) -> tuple[FloatArray, bool]:
    """Return the points of a path without consecutive repeats, and whether it is closed.

    Raises
    ------
    InvalidParameterError
        If the path has fewer than two different points, another shape, or a coordinate that is not
        finite.
    LimitError
        If a distance of its points overflows or underflows doubles.
    """
    points = doubles(
        path, invalid_parameter("A path must be an array of points, of shape (n, 2) or (n, 3).")
    )
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise invalid_parameter(f"A path must have shape (n, 3) or (n, 2), not {points.shape}.")
    if not np.isfinite(points).all():
        raise invalid_parameter("A path has a coordinate that is not a finite number.")
    points = np.pad(points, ((0, 0), (0, 3 - points.shape[1])))
    if len(points):
        fresh = (points[1:] != points[:-1]).any(axis=1)
        points = points[np.concatenate([[True], fresh])]
    if len(points) < 2:
        raise invalid_parameter("A path needs at least two different points.")
    with np.errstate(over="ignore"):
        lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
        size = float(np.linalg.norm(np.ptp(points, axis=0)))
    if not (lengths > 0).all() or not math.isfinite(size):
        message = (
            "The points of the path are too close together, or too far apart, to compute its"
            " length in doubles."
        )
        raise LimitError(message, "too_large")
    closed = len(points) > 3 and math.dist(points[0], points[-1]) <= _SAME * size
    return (points[:-1] if closed else points), closed


def divided_path(points: FloatArray, closed: bool, slices: int) -> FloatArray:
    """Return the path with additional points, so that it has about `slices` equal parts."""
    ends = np.roll(points, -1, axis=0) if closed else points[1:]
    starts = points[: len(ends)]
    lengths = np.linalg.norm(ends - starts, axis=1)
    counts = np.maximum(np.ceil(lengths / lengths.sum() * slices - 1e-9), 1).astype(np.int64)
    owner = np.repeat(np.arange(len(starts)), counts)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
    share = (place / counts[owner])[:, None]
    inner = starts[owner] + (ends - starts)[owner] * share
    return inner if closed else np.concatenate([inner, points[-1:]])


def spine_of(points: FloatArray, closed: bool, frame: Any) -> Spine:
    """Return a path with the axes of a swept profile at each point.

    Raises
    ------
    InvalidParameterError
        If the path turns by more than 175 degrees, or is parallel to the z axis in a fixed frame;
        `where` lists the numbers of such points.
    """
    directions, lengths = _directions(points, closed)
    before = np.roll(directions, 1, axis=0) if closed else np.vstack([directions[:1], directions])
    after = directions if closed else np.vstack([directions, directions[-1:]])
    _refuse_turning_back(points, before, after)
    half = np.linalg.norm(before + after, axis=1, keepdims=True) / 2
    middle = (before + after) / (2 * half)
    bend = after - before
    width = np.linalg.norm(bend, axis=1, keepdims=True)
    bend = bend / np.where(width > 0, width, 1)
    if one_of(("fixed", "parallel"), frame, "frame") == "fixed":
        right = _horizontal_axes(points, middle)
    else:
        right = _rotation_free_axes(middle, directions, closed)
    shares = np.concatenate([[0.0], np.cumsum(lengths)])[: len(points)] / lengths.sum()
    up = np.cross(middle, right)
    return Spine(points, shares, right, up, bend, 1 / half[:, 0], closed)


def frame_rotation(spine: Spine) -> float:
    """Return the angle in radians by which a closed path rotates its frame; 0 if it is open."""
    if not spine.closed:
        return 0.0
    first = np.cross(spine.right[0], spine.up[0])
    last = np.cross(spine.right[-1], spine.up[-1])
    step, _ = _directions(spine.points[[-1, 0]], closed=False)
    arrived = _turned(_turned(spine.right[-1], last, step[0]), step[0], first)
    return math.atan2(arrived @ spine.up[0], arrived @ spine.right[0])


def _directions(points: FloatArray, closed: bool) -> tuple[FloatArray, FloatArray]:
    steps = (np.roll(points, -1, axis=0) - points) if closed else np.diff(points, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    return steps / lengths[:, None], lengths


def _refuse_turning_back(points: FloatArray, before: FloatArray, after: FloatArray) -> None:
    sharp = np.flatnonzero(np.einsum("ij,ij->i", before, after) < _SHARPEST)
    if len(sharp):
        place = ", ".join(f"{value:g}" for value in points[sharp[0]])
        message = f"The path turns back on itself at ({place}). Round this corner of the path."
        raise invalid_parameter(message, sharp.tolist())


def _horizontal_axes(points: FloatArray, middle: FloatArray) -> FloatArray:
    """Return horizontal unit vectors perpendicular to the path directions `middle`, (n, 3).

    They are the z axis times the direction (vector product), normalized.
    """
    x, y = -middle[:, 1], middle[:, 0]
    size = np.hypot(x, y)
    upright = np.flatnonzero(size < _UPRIGHT)
    if len(upright):
        place = ", ".join(f"{value:g}" for value in points[upright[0]])
        message = (
            f"The path is vertical at ({place}), where frame='fixed' does not define the"
            " orientation of the profile."
        )
        raise invalid_parameter(message + " Use frame='parallel'.", upright.tolist())
    return np.column_stack([x / size, y / size, np.zeros(len(x))])


def _rotation_free_axes(middle: FloatArray, directions: FloatArray, closed: bool) -> FloatArray:
    """Return unit vectors perpendicular to the path, (n, 3), that do not rotate about it."""
    right = np.empty_like(middle)
    right[0] = _first(middle[0])
    for k in range(1, len(middle)):
        step = directions[k - 1]
        right[k] = _turned(_turned(right[k - 1], middle[k - 1], step), step, middle[k])
    if closed:
        # Rounding errors accumulate along the path.
        right /= np.linalg.norm(right, axis=1, keepdims=True)
    return right


def _first(direction: FloatArray) -> FloatArray:
    level = np.array([-direction[1], direction[0], 0.0])
    size = float(np.linalg.norm(level))
    return level / size if size >= _UPRIGHT else np.array([1.0, 0.0, 0.0])


def _turned(vector: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Return a vector rotated by the smallest rotation that maps direction `start` to `end`.

    The vector must be perpendicular to `start`.
    """
    turned: FloatArray = vector - (vector @ end) / (1 + start @ end) * (start + end)
    return turned


#: A parameter along a path: its value at the end, or a function of the share of the path's length.
Along: TypeAlias = float | Callable[[FloatArray], Any]
