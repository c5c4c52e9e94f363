"""Involute spur gears with the tooth form of ISO 53, profile A."""

import math
from dataclasses import dataclass

import numpy as np

from .._types import FloatArray, Scalar
from ..bsp import Region
from ..errors import invalid_parameter
from ..geometry.transform import cos_sin
from ..parameters import (
    SEGMENTS,
    at_least,
    not_negative,
    number,
    positive,
    refuse_many_corners,
    sides_around,
)
from ..solid.ledger import counted
from ..solid.solid import Solid

#: The height of a tooth above and its depth below the reference circle, in modules (ISO 53, profile
#: A).
_ADDENDUM, _DEDENDUM = 1.0, 1.25

#: The number of radii that are sampled to bracket the end of an undercut, before bisection.
_RADII_TRIED = 1000


@counted
def spur_gear(
    module: Scalar,
    teeth: int,
    width: Scalar,
    *,
    pressure_angle: Scalar = 20.0,
    backlash: Scalar = 0.0,
    bore: Scalar = 0.0,
    segments: int = SEGMENTS,
) -> Solid:
    """Return an involute spur gear that stands on z = 0 and has a tooth on the x axis.

    Parameters
    ----------
    module : float
        Diameter of the reference circle divided by the number of teeth, in millimetres.
    teeth : int
        Number of teeth, at least 6.
    width : float
        Length along the axis, in millimetres.
    pressure_angle : float
        Pressure angle in degrees, from 14 to 25.
    backlash : float
        The reduction of each tooth's thickness on the reference circle. Two such gears have twice
        that play.
    bore : float
        Diameter of the hole; 0 for none.
    segments : int
        The number of sides of the bore; a flank has a quarter as many.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range, the teeth are pointed, or there is no room for the bore.

    Notes
    -----
    Teeth have the form that a rack of ISO 53 cuts; the teeth of small gears are undercut at the
    root. So any two gears of one module and pressure angle mesh if the distance of their axes is
    ``module * (teeth + others) / 2``. If the second gear, at positive x, has an even number of
    teeth, it must be rotated by half a tooth, ``180 / teeth`` degrees.

    Examples
    --------
    >>> import bspcsg as csg
    >>> pinion, wheel = csg.parts.spur_gear(2, 12, 8, bore=5), csg.parts.spur_gear(2, 25, 8)
    >>> pinion.isdisjoint(wheel.translate(2 * (12 + 25) / 2, 0, 0))
    True
    """
    size, count, high = (
        positive(module, "module"),
        at_least(6, teeth, "teeth"),
        positive(width, "width"),
    )
    angle = number(pressure_angle, "pressure_angle")
    if not 14 <= angle <= 25:
        raise invalid_parameter(f"pressure_angle must be from 14 to 25 degrees, not {angle:g}.")
    around, hole = sides_around(8, segments, "segments"), not_negative(bore, "bore") / 2
    refuse_many_corners(count * around * 2, "This gear")
    # Compute in modules, so that rounding errors are relative to the gear's size.
    thickness = math.pi / 2 - not_negative(backlash, "backlash") / size
    if thickness <= 0:
        raise invalid_parameter(
            f"backlash {backlash:g} is larger than the thickness of the teeth; choose a smaller"
            " one."
        )
    form = _Form(count, math.radians(angle), thickness)
    if hole >= form.root * size:
        wide = 2 * form.root * size
        raise invalid_parameter(
            f"bore must be below {wide:g}, the root diameter of the gear, but is {2 * hole:g}."
        )
    tooth = _tooth(form, around // 4)
    turns = [tooth @ _turn(2 * math.pi * k / count) for k in range(count)]
    figure = Region(np.concatenate(turns) * size)
    if hole:
        figure = figure - Region.circle(hole, around)
    return figure.extrude(high)


@dataclass(frozen=True)
class _Form:
    """The outline of a tooth: half of its angle, in radians, for each radius, in modules.

    Parameters
    ----------
    teeth : int
        The number of teeth of the gear.
    angle : float
        The pressure angle, in radians.
    thickness : float
        The thickness of a tooth on the reference circle, in modules.
    """

    teeth: int
    angle: float
    thickness: float

    @property
    def reference(self) -> float:
        """The radius of the reference circle, in modules."""
        return self.teeth / 2

    @property
    def root(self) -> float:
        """The radius at the foot of the teeth, in modules."""
        return self.reference - _DEDENDUM

    @property
    def base(self) -> float:
        """The radius of the involute's base circle, in modules."""
        return self.reference * math.cos(self.angle)

    def flank(self, radii: FloatArray) -> FloatArray:
        """Return half of a tooth's angle, in radians, on the involute flank at each radius."""
        roll = np.sqrt(np.maximum((radii / self.base) ** 2 - 1, 0))
        whole = self.thickness / self.teeth + math.tan(self.angle) - self.angle
        return np.asarray(whole - (roll - np.arctan(roll)))

    def foot(self, radii: FloatArray) -> FloatArray:
        """Return half of a tooth's angle, in radians, at the foot, at each radius.

        The foot is cut by the corner of the rack's tooth. While the gear rotates by an angle, the
        rack moves by the length of that arc on the reference circle.
        """
        # The distance from the middle of the space between teeth to the corner of the rack's tooth.
        corner = (math.pi - self.thickness) / 2 - _DEDENDUM * math.tan(self.angle)
        behind = np.sqrt(np.maximum(radii**2 - self.root**2, 0))
        turned = np.arctan2(behind, self.root) - (behind - corner) / self.reference
        return np.asarray(math.pi / self.teeth - turned)

    def meeting(self) -> float:
        """Return the radius, in modules, at which the foot of a tooth passes into its flank."""
        along = self.reference * math.sin(self.angle) - _DEDENDUM / math.sin(self.angle)
        if along >= 0:
            return math.hypot(self.base, along)
        # The rack's corner undercuts the flank, up to the radius where its path leaves the flank.
        radii = np.linspace(self.base, self.reference + _ADDENDUM, _RADII_TRIED)
        inside = np.flatnonzero(self.foot(radii) < self.flank(radii))
        low, high = radii[inside[-1]], radii[min(inside[-1] + 1, _RADII_TRIED - 1)]
        for _ in range(50):
            middle = (low + high) / 2
            is_inside = self.foot(np.array([middle])) < self.flank(np.array([middle]))
            low, high = (middle, high) if is_inside[0] else (low, middle)
        return float(low)


def _tooth(form: _Form, steps: int) -> FloatArray:
    """Return the outline of the tooth on the x axis, counter-clockwise, in modules."""
    tip, start = form.reference + _ADDENDUM, form.meeting()
    # The foot is most curved near the root, so take more radii there.
    low = form.root + (start - form.root) * np.linspace(0, 1, steps, endpoint=False) ** 2
    high = np.linspace(start, tip, steps + 1)
    radii = np.concatenate([low, high])
    halves = np.concatenate([form.foot(low), form.flank(high)])
    if halves[-1] <= 0:
        raise invalid_parameter(
            f"The {form.teeth} teeth of this gear would be pointed; choose more teeth, or a"
            " smaller pressure_angle or backlash."
        )
    right = np.column_stack([radii * np.cos(halves), -radii * np.sin(halves)])
    return np.concatenate([right, [(tip, 0)], right[::-1] * (1, -1)])


def _turn(angle: float) -> FloatArray:
    """Return the (2, 2) matrix that rotates row vectors by an angle in radians."""
    cosine, sine = cos_sin(math.degrees(angle))
    return np.array([(cosine, sine), (-sine, cosine)])
