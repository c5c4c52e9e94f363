"""Metric screw threads (ISO 68-1), each as one mesh that winds about the axis.

The profile of one pitch is a polyline of radii and heights. Its copies along a helix form the wall:
each turn begins where the previous turn ends, so that nothing overlaps.
"""

import math

import numpy as np

from .._types import FloatArray, IndexArray, Scalar
from ..errors import invalid_parameter
from ..parameters import SEGMENTS, not_negative, positive, refuse_many_corners, sides_around
from ..shapes.arrays import from_arrays
from ..shapes.primitives import box
from ..shapes.profile import revolve
from ..shapes.sweep import unit_circle
from ..solid.ledger import counted
from ..solid.solid import Solid
from .metric import MetricSize, metric

#: The tangent of the angle between a flank and the plane perpendicular to the axis.
_FLANK = math.tan(math.radians(30))


@counted
def threaded_rod(
    size: str, length: Scalar, *, clearance: Scalar | None = None, segments: int = SEGMENTS
) -> Solid:
    """Return a rod with a metric external thread from z = 0 upwards, with both ends chamfered.

    Parameters
    ----------
    size : str
        A name from ``"M3"`` to ``"M20"``; the pitch is coarse.
    length : float
        The length of the rod, in millimetres.
    clearance : float, optional
        The reduction of all diameters from the nominal profile, in millimetres. By default the
        allowance of tolerance 6g, from 0.02 to 0.042; 3D printers need 0.2 to 0.4.
    segments : int
        The number of sides around the axis, at least 8.

    Raises
    ------
    InvalidParameterError
        If there is no such size, or a number is out of its range.

    Notes
    -----
    Crests are an eighth of the thread's pitch wide. Roots are a sixth of it wide and as deep as the
    standard's round root. All threads have the same phase: a nut fits its rod if it is translated
    along z by multiples of the pitch, or by other lengths if it is also rotated.

    Examples
    --------
    >>> import bspcsg as csg
    >>> rod = csg.parts.threaded_rod("M6", 20)
    >>> rod.surface_count, rod.bounds[:, 2].tolist()
    (1, [0.0, 20.0])
    """
    chosen, long = metric(size), positive(length, "length")
    return rod_between(chosen, 0.0, long, clearance_or_default(clearance, chosen), segments)


@counted
def tap(size: str, length: Scalar, *, clearance: Scalar = 0.0, segments: int = SEGMENTS) -> Solid:
    """Return the solid to subtract for a metric internal thread, from z = 0 upwards.

    Parameters
    ----------
    size : str
        A name from ``"M3"`` to ``"M20"``; the pitch is coarse.
    length : float
        The length of the thread, in millimetres.
    clearance : float
        The increase of all diameters over the nominal profile; 3D printers need 0.2 to 0.4.
    segments : int
        The number of sides around the axis, at least 8.

    Raises
    ------
    InvalidParameterError
        If there is no such size, or a number is out of its range.

    Examples
    --------
    >>> import bspcsg as csg
    >>> plate = csg.box(20, 20, 6) - csg.parts.tap("M6", 6).translate(10, 10, 0)
    >>> plate.genus
    1
    """
    chosen, long = metric(size), positive(length, "length")
    more = clearance_or_default(clearance, chosen) / 2
    inner, outer = chosen.minor_diameter / 2 + more, chosen.diameter / 2 + more
    thread = _thread(chosen, (inner, outer), (0.0, long), segments)
    return thread & box(4 * outer, 4 * outer, long).translate(-2 * outer, -2 * outer, 0)


def rod_between(
    size: MetricSize, low: float, high: float, clearance: float, segments: int
) -> Solid:
    """Return a rod with an external thread from z = low to z = high, with both ends chamfered."""
    inner, outer = radii(size, clearance)
    deep = outer - inner
    # The envelope is wider than the thread, so that the thread itself bounds the crests.
    wide, slope = outer + deep, 2 * deep
    ends = [
        (0, low),
        (inner, low),
        (wide, low + slope),
        (wide, high - slope),
        (inner, high),
        (0, high),
    ]
    if high - low <= 2 * slope:
        middle, reach = (low + high) / 2, inner + (high - low) / 2
        ends = [(0, low), (inner, low), (reach, middle), (inner, high), (0, high)]
    thread = _thread(size, (inner, outer), (low, high), segments)
    return thread & revolve(ends, segments=segments)


def radii(size: MetricSize, clearance: float) -> tuple[float, float]:
    """Return the radii of the root and the crest of an external thread, less half the clearance."""
    return (size.root_diameter - clearance) / 2, (size.diameter - clearance) / 2


def clearance_or_default(clearance: Scalar | None, size: MetricSize) -> float:
    """Return a checked clearance of diameters; if None is given, the allowance of tolerance 6g."""
    if clearance is None:
        return size.allowance
    given = not_negative(clearance, "clearance")
    if given >= size.pitch:
        raise invalid_parameter(
            f"clearance must be smaller than the pitch {size.pitch:g} of the thread, but is"
            f" {given:g}."
        )
    return given


def _thread(
    size: MetricSize, ends: tuple[float, float], reach: tuple[float, float], segments: int
) -> Solid:
    """Return a thread between the two radii `ends`, which extends past the two heights `reach`."""
    around = sides_around(8, segments, "segments")
    pitch, (inner, outer) = size.pitch, ends
    first = math.floor(reach[0] / pitch) - 2
    turns = math.ceil(reach[1] / pitch) + 2 - first
    refuse_many_corners(turns * around * 4, "This thread")
    crest = pitch / 16
    foot = crest + (outer - inner) * _FLANK
    profile = np.array([(outer, -crest), (outer, crest), (inner, foot), (inner, pitch - foot)])
    vertices, faces = _wound(profile, pitch, turns, around)
    return from_arrays(vertices + (0, 0, first * pitch), faces)


def _wound(
    profile: FloatArray, pitch: float, turns: int, around: int
) -> tuple[FloatArray, IndexArray]:
    """Return the mesh of a profile that winds about the axis, with both ends closed by fans.

    With k corners in the profile, corner c of step i has number ``i * k + c`` before unused corners
    are removed. The last corner of a step is joined to the first corner one turn later.
    """
    count, steps = len(profile), turns * around + 1
    circle = unit_circle(around)[np.arange(steps) % around]
    radius, height = profile.T
    rise = height + (np.arange(steps) * (pitch / around))[:, None]
    points = np.dstack([circle[:, :1] * radius, circle[:, 1:] * radius, rise]).reshape(-1, 3)
    after = np.append(np.arange(1, count), around * count)
    low = np.arange((steps - around - 1) * count).reshape(-1, count)
    high = low - np.arange(count) + after
    walls = [
        np.stack([low, low + count, high + count], axis=2),
        np.stack([low, high + count, high], axis=2),
    ]
    # The border of each end is one turn of the helix and the profile back to its beginning.
    helix = np.arange(around + 1) * count
    rim = np.append(helix, np.arange(count - 1, 0, -1))
    last = (steps - around - 1) * count
    foot, top = len(points), len(points) + 1
    fans = [
        np.column_stack([np.roll(rim, -1), rim, np.full(len(rim), foot)]),
        np.column_stack([rim, np.roll(rim, -1), np.full(len(rim), top - last)]) + last,
    ]
    middle = (height[0] + pitch / 2, height[0] + pitch / 2 + last / count * (pitch / around))
    points = np.concatenate([points, [(0, 0, middle[0]), (0, 0, middle[1])]])
    faces = np.concatenate([*(wall.reshape(-1, 3) for wall in walls), *fans])
    used, names = np.unique(faces, return_inverse=True)
    return points[used], names.reshape(-1, 3)
