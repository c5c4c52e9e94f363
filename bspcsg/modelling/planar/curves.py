"""Points along curves, for outlines and paths."""

import math
from typing import Any

import numpy as np

from ..._types import FloatArray, Scalar, Vector
from ...bsp.sets.plane_queries import vector2
from ...errors import invalid_parameter
from ...geometry.arrays import doubles
from ...geometry.transform import cos_sin
from ...parameters import number, positive, refuse_many_corners

#: The largest number of control points of a Bézier curve. With more, rounding errors of its points
#: become visible by cancellation.
_MAX_CONTROL_POINTS = 32


def arc(
    center: Vector, r: Scalar, start: Scalar, stop: Scalar, *, tolerance: Scalar = 0.01
) -> FloatArray:
    """Return points along an arc of a circle, including both ends.

    Parameters
    ----------
    center : (2,) float
    r : float
    start, stop : float
        Angles in degrees, counter-clockwise from the x axis. The arc runs clockwise if `stop` is
        less than `start`, and may be longer than a full circle.
    tolerance : float
        The largest distance between a chord and the arc, in model units.

    Returns
    -------
    (n, 2) float64
        Points at equal angles.

    Raises
    ------
    InvalidParameterError
        If a number is not finite, or the radius or the tolerance is not above 0.
    LimitError
        If the arc would have too many points.

    Examples
    --------
    >>> import bspcsg as csg
    >>> import numpy as np
    >>> slot = np.concatenate([csg.arc((0, 0), 2, 90, 270), csg.arc((9, 0), 2, -90, 90)])
    >>> round(csg.Region(slot).area)
    48
    """
    radius, chord = positive(r, "r"), positive(tolerance, "tolerance")
    first, last = number(start, "start"), number(stop, "stop")
    widest = 2 * math.acos(max(1 - chord / radius, -0.5))
    # `widest` is 0 if the tolerance is below the precision of doubles, relative to the radius.
    turn = abs(math.radians(last - first))
    steps = turn / widest if widest else math.inf
    refuse_many_corners(steps, "This arc")
    angles = np.linspace(first, last, max(math.ceil(steps), 1) + 1)
    middle = np.array(vector2(center, "center"))
    return np.asarray(middle + radius * _directions(angles))


def _directions(angles: FloatArray) -> FloatArray:
    """Return points of the unit circle, (n, 2), at angles in degrees; exact at multiples of 90."""
    turns = np.radians(angles)
    points = np.column_stack([np.cos(turns), np.sin(turns)])
    for at in np.flatnonzero(np.fmod(angles, 90) == 0):
        points[at] = cos_sin(float(angles[at]))
    return points


def bezier(points: Any, *, tolerance: Scalar = 0.01) -> FloatArray:
    """Return points along a Bézier curve, including both ends.

    Parameters
    ----------
    points : (k, d) array_like of float
        Control points in the plane or in space: three make a quadratic, four a cubic curve.
    tolerance : float
        The largest distance between a chord and the curve, in model units.

    Returns
    -------
    (n, d) float64
        Points at equal steps of the curve's parameter.

    Raises
    ------
    InvalidParameterError
        If there are fewer than two control points or more than 32, or a number is not finite.
    LimitError
        If the curve would have too many points.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.bezier([(0, 0), (1, 2), (2, 0)], tolerance=0.3).tolist()
    [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]
    """
    controls = _controls(points)
    chord = positive(tolerance, "tolerance")
    degree = len(controls) - 1
    with np.errstate(over="ignore"):
        bend = np.linalg.norm(np.diff(controls, n=2, axis=0), axis=1).max(initial=0.0)
    # The second derivative is at most degree (degree - 1) bend. The distance between a chord of
    # parameter step h and the curve is at most h² / 8 times that.
    steps = math.sqrt(degree * (degree - 1) / 8) * math.sqrt(bend / chord)
    refuse_many_corners(steps, "This curve")
    return bezier_points(controls, max(math.ceil(steps), 1))


def bezier_points(controls: FloatArray, steps: int) -> FloatArray:
    """Return (steps + 1, d) points of a Bézier curve at equal steps of its parameter."""
    t = np.linspace(0, 1, steps + 1)
    degree = len(controls) - 1
    shares = [math.comb(degree, k) * t**k * (1 - t) ** (degree - k) for k in range(degree + 1)]
    return np.asarray(np.column_stack(shares) @ controls)


def _controls(points: Any) -> FloatArray:
    array = doubles(
        points, invalid_parameter("The control points of a curve must be an array of numbers.")
    )
    if (
        array.ndim != 2
        or array.shape[1] not in (2, 3)
        or not 2 <= len(array) <= _MAX_CONTROL_POINTS
    ):
        raise invalid_parameter(
            "The control points of a curve must have shape (k, 2) or (k, 3) with k from 2 to"
            f" {_MAX_CONTROL_POINTS}, not {array.shape}."
        )
    if not np.isfinite(array).all():
        raise invalid_parameter("A control point has a coordinate that is not a finite number.")
    return array
