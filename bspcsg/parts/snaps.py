"""Snap fits: a cantilever hook, and its socket."""

import math

import numpy as np

from .._types import FloatArray, Scalar
from ..bsp import Region
from ..errors import invalid_parameter
from ..parameters import not_negative, number, positive
from ..solid.ledger import counted
from ..solid.solid import Solid

#: The length of the flat land between catch and entrance slope, as a fraction of the thickness.
_LAND = 0.2

#: The least thickness and the least undercut of a hook, as a fraction of its length.
_MIN_RATIO = 1e-3


@counted
def snap_hook(
    length: Scalar,
    width: Scalar,
    thickness: Scalar,
    undercut: Scalar,
    *,
    entrance: Scalar = 30.0,
    retention: Scalar = 90.0,
) -> Solid:
    """Return a cantilever hook that stands on z = 0, with its catch towards positive x.

    Parameters
    ----------
    length : float
        Distance from the foot to the catch.
    width : float
        Extent along y, with the middle at y = 0.
    thickness : float
        Thickness of the beam, along x from 0.
    undercut : float
        The distance by which the catch protrudes from the beam, and by which the beam bends when it
        is pushed in.
    entrance : float
        Angle in degrees between the beam and the slope at the tip, from 10 to 60.
    retention : float
        Angle in degrees between the catch and the beam, from 30 to 90. With 90 the hook locks
        permanently; with less it releases when pulled.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range.

    Notes
    -----
    `snap_strain` returns the strain of the beam when it is pushed in.

    Examples
    --------
    >>> import bspcsg as csg
    >>> hook = csg.parts.snap_hook(12, 6, 2, 1)
    >>> wall = csg.box(10, 12, 18).translate(-4, -6, 5)
    >>> socket = csg.parts.snap_socket(12, 6, 2, 1, clearance=0.2)
    >>> (wall - socket).isdisjoint(hook), (wall - socket).isdisjoint(hook.translate(0, 0, -0.5))
    (True, False)
    """
    nose = _nose(length, thickness, undercut, entrance, retention)
    beam = [(0.0, nose[-1, 1]), (0.0, 0.0), (nose[0, 0], 0.0)]
    return _upright(Region(np.concatenate([nose, beam])), positive(width, "width"))


@counted
def snap_socket(
    length: Scalar,
    width: Scalar,
    thickness: Scalar,
    undercut: Scalar,
    *,
    entrance: Scalar = 30.0,
    retention: Scalar = 90.0,
    clearance: Scalar = 0.2,
) -> Solid:
    """Return the solid to subtract from a wall, so that a hook of these dimensions snaps in.

    It begins at z = 0, leaves the beam room to bend away from the catch, and ends above the hook's
    tip by the clearance.

    Parameters
    ----------
    length, width, thickness, undercut, entrance, retention : float
        The dimensions of the hook, as for `snap_hook`.
    clearance : float
        The distance between hook and wall on all sides.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.parts.snap_socket(12, 6, 2, 1).surface_count
    1
    """
    nose = _nose(length, thickness, undercut, entrance, retention)
    gap, wide = not_negative(clearance, "clearance"), positive(width, "width")
    if gap >= nose[0, 1]:
        raise invalid_parameter(
            f"clearance must be smaller than the length {nose[0, 1]:g}, but is {gap:g}."
        )
    catch, tip = nose[1], nose[-1, 1] + gap
    bent = -(catch[0] - nose[0, 0]) - gap
    channel = [(bent, 0.0), (nose[0, 0] + gap, 0.0), (nose[0, 0] + gap, tip), (bent, tip)]
    lean = (catch[1] - nose[0, 1]) / (catch[0] - nose[0, 0])
    low, out = nose[0, 1] - gap * math.hypot(1, lean), catch[0] + gap
    window = [
        (0.0, low),
        (nose[0, 0], low),
        (out, low + lean * (out - nose[0, 0])),
        (out, tip),
        (0.0, tip),
    ]
    return _upright(Region(channel) | Region(window), wide + 2 * gap)


def snap_strain(length: Scalar, thickness: Scalar, undercut: Scalar) -> float:
    """Return the strain of a hook's beam when it is pushed in, as a fraction.

    For a beam of constant thickness bent at its end: ``1.5 * thickness * undercut / length**2``
    (Bayer MaterialScience, Snap-Fit Joints for Plastics). Plastics allow about 0.02 to 0.07.

    Parameters
    ----------
    length, thickness, undercut : float
        The dimensions of the hook, as for `snap_hook`.

    Examples
    --------
    >>> import bspcsg as csg
    >>> round(csg.parts.snap_strain(12, 2, 1), 4)
    0.0208
    """
    long, thick = positive(length, "length"), positive(thickness, "thickness")
    return 1.5 * (thick / long) * (positive(undercut, "undercut") / long)


def _nose(
    length: Scalar, thickness: Scalar, undercut: Scalar, entrance: Scalar, retention: Scalar
) -> FloatArray:
    """Return the outline of a hook from the inner end of the catch up to the tip, (5, 2)."""
    long, thick = positive(length, "length"), positive(thickness, "thickness")
    out, slide, hold = (
        positive(undercut, "undercut"),
        number(entrance, "entrance"),
        number(retention, "retention"),
    )
    if max(out, thick) > long or min(out, thick) < _MIN_RATIO * long:
        raise invalid_parameter(
            f"thickness and undercut must be between {_MIN_RATIO:g} and 1 times the length"
            f" {long:g}, but are {thick:g} and {out:g}."
        )
    if not 10 <= slide <= 60:
        raise invalid_parameter(f"entrance must be from 10 to 60 degrees, not {slide:g}.")
    if not 30 <= hold <= 90:
        raise invalid_parameter(f"retention must be from 30 to 90 degrees, not {hold:g}.")
    rise = 0.0 if hold == 90 else out / math.tan(math.radians(hold))
    land = long + rise + _LAND * thick
    tip = land + (out + thick / 2) / math.tan(math.radians(slide))
    return np.array(
        [(thick, long), (thick + out, long + rise), (thick + out, land), (thick / 2, tip), (0, tip)]
    )


def _upright(figure: Region, width: float) -> Solid:
    """Return the extrusion along y of a figure in the x-z plane, with its middle at y = 0."""
    return figure.extrude(width).rotate(x=90).translate(0, width / 2, 0)
