"""Hexagon bolts and nuts (ISO 4014, ISO 4032)."""

import math

from .._types import Scalar
from ..errors import invalid_parameter
from ..parameters import SEGMENTS, not_negative, positive
from ..shapes.primitives import cylinder, prism
from ..shapes.profile import revolve
from ..solid.ledger import counted
from ..solid.solid import Solid
from .metric import MetricSize, metric
from .threads import clearance_or_default, radii, rod_between, tap

#: The diameter at which the chamfer of a bolt's head begins, as a fraction of the width across
#: flats.
_CROWN = 0.95

#: The tangent of the angle of a head's chamfer.
_CROWN_SLOPE = math.tan(math.radians(30))

#: The widest part of a nut's bore, as a fraction of the nominal diameter. ISO 4032 allows at most
#: 1.08 to 1.09 for nuts of M8 and larger.
_MOUTH = 1.08


@counted
def hex_bolt(
    size: str,
    length: Scalar,
    *,
    thread: Scalar | None = None,
    clearance: Scalar | None = None,
    segments: int = SEGMENTS,
) -> Solid:
    """Return a hexagon head bolt: its head below z = 0, its shank above.

    Parameters
    ----------
    size : str
        A name from ``"M3"`` to ``"M20"``.
    length : float
        Length of the shank, without the head, in millimetres.
    thread : float, optional
        The length of the thread. By default as in ISO 4014: twice the diameter plus 6 mm, or plus
        12 or 25 mm for bolts longer than 125 or 200 mm.
    clearance : float, optional
        The reduction of all thread diameters, as for `threaded_rod`.
    segments : int
        The number of sides around the axis, at least 8.

    Raises
    ------
    InvalidParameterError
        If there is no such size, or a number is out of its range.

    Examples
    --------
    >>> import bspcsg as csg
    >>> bolt = csg.parts.hex_bolt("M8", 30)
    >>> bolt.surface_count, bolt.bounds[:, 2].tolist()
    (1, [-5.3, 30.0])
    """
    chosen, long = metric(size), positive(length, "length")
    gap = clearance_or_default(clearance, chosen)
    cut = chosen.threaded(long) if thread is None else not_negative(thread, "thread")
    if cut > long:
        raise invalid_parameter(
            f"thread, the length of the threaded part, must be at most the length {long:g} of the"
            f" bolt, not {cut:g}."
        )
    head = _hexagon(chosen.flats, chosen.head, segments, both=False).mirror((0, 0, 1))
    inner, outer = radii(chosen, gap)
    if cut == 0:
        return head | cylinder(long, outer, segments=segments)
    plain, deep = long - cut, outer - inner
    # The rod extends into the shank, or into the head, so that they are connected.
    rod = rod_between(chosen, plain - min(plain, 2 * deep) - chosen.head / 2, long, gap, segments)
    if not plain:
        return head | rod
    end = min(plain + deep, long)
    shank = [(0, 0), (outer, 0), (outer, plain), (outer - (end - plain), end), (0, end)]
    return head | rod | revolve(shank, segments=segments)


@counted
def hex_nut(size: str, *, clearance: Scalar = 0.0, segments: int = SEGMENTS) -> Solid:
    """Return a hexagon nut that stands on z = 0.

    Parameters
    ----------
    size : str
        A name from ``"M3"`` to ``"M20"``.
    clearance : float
        The increase of all thread diameters, as for `tap`.
    segments : int
        The number of sides of the bore, at least 8.

    Raises
    ------
    InvalidParameterError
        If there is no such size, or a number is out of its range.

    Notes
    -----
    The width is the nominal, and the height the greatest one of ISO 4032.

    Examples
    --------
    >>> import bspcsg as csg
    >>> nut = csg.parts.hex_nut("M8")
    >>> nut.genus, nut.bounds[:, 2].tolist()
    (1, [0.0, 6.8])
    """
    chosen = metric(size)
    more = clearance_or_default(clearance, chosen) / 2
    body = _hexagon(chosen.flats, chosen.nut, segments, both=True)
    return (
        body
        - tap(size, chosen.nut, clearance=2 * more, segments=segments)
        - _mouths(chosen, more, segments)
    )


def _mouths(size: MetricSize, more: float, segments: int) -> Solid:
    """Return the cones of 120 degrees to subtract at both ends of a nut's bore.

    `more` is the increase of radii for clearance.
    """
    wide, bore = _MOUTH * size.diameter / 2 + more, size.minor_diameter / 2 + more
    low = min((wide - bore) * _CROWN_SLOPE, size.nut / 2)
    corners = [(0, 0), (wide, 0), (wide - low / _CROWN_SLOPE, low), (0, low)]
    top = [(x, size.nut - y) for x, y in corners]
    return revolve(corners, segments=segments) | revolve(top, segments=segments)


def _hexagon(flats: float, height: float, segments: int, *, both: bool) -> Solid:
    """Return a hexagonal prism whose corners are chamfered by a cone at the top.

    If `both`, they are chamfered at the bottom, too.
    """
    crown, wide = _CROWN * flats / 2, flats
    slope = (wide - crown) * _CROWN_SLOPE
    low = [(crown, 0.0), (wide, slope)] if both else [(wide, 0.0)]
    outline = [(0.0, 0.0), *low, (wide, height - slope), (crown, height), (0.0, height)]
    return prism(6, height, flats / math.sqrt(3)) & revolve(outline, segments=segments)
