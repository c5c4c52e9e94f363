"""The number of sides of round shapes by OpenSCAD's rules, so that results have the same corners.

``$fn`` above 0 is the number of sides; otherwise ``$fe`` above 0 is the largest distance of a side
from the circle; otherwise ``$fa``, the smallest angle of a side in degrees, and ``$fs``, its
smallest length, limit the number. Source: OpenSCAD's user manual, "Special variables"; the slices
of twisted extrusions follow OpenSCAD 2021.01, ``$fe`` its development snapshots.
"""

import math
from dataclasses import dataclass

from ..syntax.arguments import MAX_NUMBER, Arguments

#: The lower bound of ``$fa``, in degrees, and of ``$fs``, in model units.
_MIN_SIDE = 0.01

#: Lengths below this, in model units, count as zero.
_MIN_LENGTH = 2.0**-20


@dataclass(frozen=True)
class Fineness:
    """OpenSCAD's special variables ``$fn``, ``$fa``, ``$fs`` and ``$fe`` for one node.

    Parameters
    ----------
    fn, fa, fs, fe : float
        The number of sides, or 0; the smallest angle of a side in degrees; its smallest length in
        model units; its largest distance from the circle in model units, or 0.
    """

    fn: float = 0.0
    fa: float = 12.0
    fs: float = 2.0
    fe: float = 0.0

    @classmethod
    def of(cls, arguments: Arguments) -> "Fineness":
        """Return the special variables in the arguments of a node."""
        fn = arguments.value("$fn")
        if isinstance(fn, float) and not math.isfinite(fn):
            # For these values, OpenSCAD makes triangles.
            return cls(3.0)
        return cls(
            arguments.number("$fn", 0.0),
            _step(arguments, "$fa", 12.0),
            _step(arguments, "$fs", 2.0),
            arguments.number("$fe", 0.0),
        )

    def fragments(self, radius: float) -> float:
        """Return the number of sides of a full circle of the given radius, a whole number."""
        if radius < _MIN_LENGTH:
            return 3
        if self.fn > 0:
            return math.floor(max(self.fn, 3))
        if self.fe >= _MIN_LENGTH:
            finest = min(360 / _MIN_SIDE, radius * 2 * math.pi / _MIN_SIDE)
            return math.ceil(max(min(math.tau / self._step_within(radius), finest), 5))
        return math.ceil(max(min(360 / self.fa, radius * 2 * math.pi / self.fs), 5))

    def twist_slices(self, reach: float, height: float, twist: float, scale: float) -> float:
        """Return the number of slices of a twisted extrusion.

        Parameters
        ----------
        reach : float
            The largest distance from the axis.
        height, twist, scale : float
            Height, twist in degrees, and scale factor of the upper end, equal along x and y.
        """
        turn = abs(twist)
        least = max(math.ceil(turn / 120), 1)
        if reach < _MIN_LENGTH:
            return least
        if self.fn > 0:
            return max(math.ceil(turn / 360 * self.fn), least)
        if self.fe >= _MIN_LENGTH and scale == 1:
            return max(math.ceil(math.radians(turn) / self._step_within(reach)), least)
        length = _helix_length(reach, height, math.radians(turn), scale)
        return max(min(math.ceil(turn / self.fa), math.ceil(length / self.fs)), least)

    def _step_within(self, radius: float) -> float:
        """Return the angle in radians of a chord whose distance from the circle is `fe`."""
        return 2 * math.acos(max(1 - self.fe / radius, 0.0))

    def taper_slices(self, shift: float, height: float) -> float:
        """Return the number of slices of an extrusion that scales x and y differently.

        Parameters
        ----------
        shift : float
            The largest distance between a corner's x, y at the lower and at the upper end.
        height : float
        """
        if shift < _MIN_LENGTH:
            return 1
        if self.fn > 0:
            return max(math.floor(self.fn), 1)
        return max(math.ceil(math.hypot(shift, height) / self.fs), 1)


def _step(arguments: Arguments, name: str, default: float) -> float:
    """Return ``$fa`` or ``$fs``, at least 0.01; NaN counts as 0.01."""
    value = arguments.value(name)
    if isinstance(value, float) and not math.isfinite(value):
        return MAX_NUMBER if value == math.inf else _MIN_SIDE
    return max(arguments.number(name, default), _MIN_SIDE)


def _helix_length(reach: float, height: float, turn: float, scale: float) -> float:
    """Return the length of a corner's path in an extrusion: a helix, conical if scaled.

    `turn` is in radians.
    """
    if scale == 1:
        return math.hypot(turn * reach, height)
    end = turn * scale / (scale - 1) if scale > 1 else turn / (1 - scale)
    growth = reach / end
    spiral = _archimedes(growth, end) - _archimedes(growth, end - turn)
    return math.hypot(spiral, height)


def _archimedes(growth: float, angle: float) -> float:
    """Return the length of the spiral r = growth * angle from angle 0 to the given angle."""
    return 0.5 * growth * (angle * math.hypot(1, angle) + math.asinh(angle))
