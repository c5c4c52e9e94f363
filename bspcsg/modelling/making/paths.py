"""Paths as arrays of points: helices and splines."""

import math
from typing import Any

import numpy as np

from ..._types import FloatArray, Scalar
from ...errors import LimitError, deprecated, invalid_parameter
from ...geometry.arrays import doubles
from ...geometry.transform import cos_sin
from ...parameters import SEGMENTS, number, positive, refuse_many_corners, sides_around, truth_value


def helix(
    r: Scalar,
    lead: Scalar | None = None,
    turns: Scalar | None = None,
    *,
    r2: Scalar | None = None,
    segments: int = SEGMENTS,
    pitch: Scalar | None = None,
) -> FloatArray:
    """Return points of a helix about the z axis, from (r, 0, 0) upwards.

    Parameters
    ----------
    r : float
        Radius at the start, in model units.
    lead : float
        Height of one turn; 0 makes a circle or a flat spiral.
    turns : float
        Number of turns. Positive: counter-clockwise seen from above, a right-handed thread;
        negative: clockwise.
    r2 : float, optional
        Radius at the end, for a helix on a cone; by default `r`.
    segments : int
        Number of points per turn, at least 3.
    pitch : float, optional
        The former name of `lead`; deprecated, since elsewhere a pitch is a lattice exponent.

    Returns
    -------
    (n, 3) float64

    Raises
    ------
    InvalidParameterError
        If a number is out of its range.
    LimitError
        If there would be too many points.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.helix(10, 2, turns=3, segments=24).shape
    (73, 3)
    """
    if pitch is not None:
        deprecated("pitch of bspcsg.helix", "lead")
        lead = pitch
    start, rise, rounds = positive(r, "r"), number(lead, "lead"), number(turns, "turns")
    end = start if r2 is None else positive(r2, "r2")
    around = sides_around(3, segments, "segments")
    if rounds == 0:
        raise invalid_parameter("turns must not be 0.")
    refuse_many_corners(math.ceil(min(abs(rounds) * around, 1e18)), "This helix")
    steps = max(math.ceil(abs(rounds) * around - 1e-9), 1)
    shares = np.arange(steps + 1) / steps
    directions = np.array([cos_sin(360 * rounds * share) for share in shares])
    radii = start + (end - start) * shares
    return np.column_stack([directions * radii[:, None], rise * abs(rounds) * shares])


def spline(points: Any, *, segments: int = 16, closed: bool = False) -> FloatArray:
    """Return points of a smooth curve (a Catmull-Rom spline) through given points.

    Parameters
    ----------
    points : (n, 2) or (n, 3) array_like of float
        At least 2 points, or 3 for a closed curve; consecutive points must differ.
    segments : int
        Number of chords between consecutive given points.
    closed : bool
        True if the curve returns smoothly to its first point, which is then also the last point of
        the result.

    Returns
    -------
    (m, 2) or (m, 3) float64

    Raises
    ------
    InvalidParameterError
        If there are too few points, or two consecutive points are equal (`where` is the number of
        the first of them).
    LimitError
        If there would be too many points, or their distances overflow or underflow doubles.

    Notes
    -----
    A centripetal Catmull-Rom curve: it has no loops between points, and each point affects it only
    nearby. Yuksel, Schaefer, Keyser 2011, "Parameterization and applications of Catmull-Rom
    curves".

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.spline([(0, 0, 0), (10, 0, 5), (20, 0, 0)], segments=8).shape
    (17, 3)
    """
    chords, is_ring = sides_around(1, segments, "segments"), truth_value(closed, "closed")
    given = doubles(
        points, invalid_parameter("points must be an array of numbers of shape (n, 2) or (n, 3).")
    )
    if given.ndim != 2 or given.shape[1] not in (2, 3) or len(given) < 2 + is_ring:
        raise invalid_parameter(
            f"A spline needs at least {2 + is_ring} points of two or three numbers each."
        )
    if not np.isfinite(given).all():
        raise invalid_parameter(
            "A point of the spline has a coordinate that is not a finite number."
        )
    refuse_many_corners(len(given) * chords, "This spline")
    with np.errstate(all="ignore"):
        curve = _catmull_rom(_with_neighbours(given, is_ring), chords)
    if not np.isfinite(curve).all():
        message = (
            "The points of the spline are too close together, or too far apart, to compute the"
            " curve in doubles."
        )
        raise LimitError(message, "too_large")
    return curve


def _with_neighbours(given: FloatArray, closed: bool) -> FloatArray:
    """Return the given points plus one point before and one after, to define the end tangents.

    For a closed curve, the first point is repeated at the end, too.
    """
    ring = np.concatenate([given, given[:1]]) if closed else given
    same = np.flatnonzero((ring[1:] == ring[:-1]).all(axis=1))
    if len(same):
        message = f"Points {same[0]} and {same[0] + 1} of the spline are equal; remove one of them."
        raise invalid_parameter(message, [int(same[0])])
    if closed:
        return np.concatenate([given[-1:], ring, given[1:2]])
    return np.concatenate([2 * ring[:1] - ring[1:2], ring, 2 * ring[-1:] - ring[-2:-1]])


def _catmull_rom(knots: FloatArray, chords: int) -> FloatArray:
    """Return points of the centripetal Catmull-Rom curve from the second to the last but one knot.

    There are `chords` equal parameter steps between consecutive knots.
    """
    gaps = np.sqrt(np.linalg.norm(np.diff(knots, axis=0), axis=1))[:, None]
    before, own, after = gaps[:-2], gaps[1:-1], gaps[2:]
    a, b, c, d = knots[:-3], knots[1:-2], knots[2:-1], knots[3:]
    leaving = (b - a) / before - (c - a) / (before + own) + (c - b) / own
    arriving = (c - b) / own - (d - b) / (own + after) + (d - c) / after
    share = (np.arange(chords) / chords)[None, :, None]
    m, n = (part[:, None] for part in (leaving * own, arriving * own))
    b, c = b[:, None], c[:, None]
    curve = (
        (2 * share**3 - 3 * share**2 + 1) * b
        + (share**3 - 2 * share**2 + share) * m
        + (3 * share**2 - 2 * share**3) * c
        + (share**3 - share**2) * n
    )
    return np.concatenate([curve.reshape(-1, knots.shape[1]), knots[-2:-1]])
