"""The number of sides of round things: OpenSCAD's rules, so that results have the same corners.

``$fn`` above 0 is the number of sides; otherwise ``$fe`` above 0 is how far sides may be from the
circle; otherwise ``$fa``, the smallest angle of a side in degrees, and ``$fs``, its smallest
length, say what is enough. Source: OpenSCAD's user manual, "Special variables"; the slices of
twisted extrusions follow OpenSCAD 2021.01, ``$fe`` its development snapshots.
"""

import math
from dataclasses import dataclass

from ..syntax.arguments import MAX_NUMBER, Arguments

#: The smallest angle of a side in degrees, and its smallest length.
_MIN_SIDE = 0.01

#: Lengths below this count as zero: a 2**20th of a unit.
_NOTHING = 2.0**-20


@dataclass(frozen=True)
class Fineness:
    """The special variables.

    Parameters
    ----------
    fn, fa, fs, fe : float
        Number of sides or 0; degrees; model units; the same, or 0.
    """

    fn: float = 0.0
    fa: float = 12.0
    fs: float = 2.0
    fe: float = 0.0

    @classmethod
    def of(cls, arguments: Arguments) -> "Fineness":
        """Return the special variables of a node."""
        fn = arguments.value("$fn")
        if isinstance(fn, float) and not math.isfinite(fn):
            # OpenSCAD makes triangles of it.
            return cls(3.0)
        return cls(
            arguments.number("$fn", 0.0),
            _step(arguments, "$fa", 12.0),
            _step(arguments, "$fs", 2.0),
            arguments.number("$fe", 0.0),
        )

    def fragments(self, radius: float) -> float:
        """Return the sides of a full circle, a whole number."""
        if radius < _NOTHING:
            return 3
        if self.fn > 0:
            return math.floor(max(self.fn, 3))
        if self.fe >= _NOTHING:
            finest = min(360 / _MIN_SIDE, radius * 2 * math.pi / _MIN_SIDE)
            return math.ceil(max(min(math.tau / self._step_within(radius), finest), 5))
        return math.ceil(max(min(360 / self.fa, radius * 2 * math.pi / self.fs), 5))

    def twist_slices(self, reach: float, height: float, twist: float, scale: float) -> float:
        """Return the slices of a twisted extrusion.

        Parameters
        ----------
        reach : float
            The largest distance from the axis.
        height, twist, scale : float
            Twist in degrees; scale of the upper end, the same in x and y.
        """
        turn = abs(twist)
        least = max(math.ceil(turn / 120), 1)
        if reach < _NOTHING:
            return least
        if self.fn > 0:
            return max(math.ceil(turn / 360 * self.fn), least)
        if self.fe >= _NOTHING and scale == 1:
            return max(math.ceil(math.radians(turn) / self._step_within(reach)), least)
        length = _helix_length(reach, height, math.radians(turn), scale)
        return max(min(math.ceil(turn / self.fa), math.ceil(length / self.fs)), least)

    def _step_within(self, radius: float) -> float:
        """Return the angle in radians whose chord is `fe` away from a circle at most."""
        return 2 * math.acos(max(1 - self.fe / radius, 0.0))

    def taper_slices(self, shift: float, height: float) -> float:
        """Return the slices of an extrusion that scales x and y differently.

        Parameters
        ----------
        shift : float
            The farthest that a corner moves.
        height : float
        """
        if shift < _NOTHING:
            return 1
        if self.fn > 0:
            return max(math.floor(self.fn), 1)
        return max(math.ceil(math.hypot(shift, height) / self.fs), 1)


def _step(arguments: Arguments, name: str, default: float) -> float:
    """Return the smallest angle or length of a side; NaN counts as very small."""
    value = arguments.value(name)
    if isinstance(value, float) and not math.isfinite(value):
        return MAX_NUMBER if value == math.inf else _MIN_SIDE
    return max(arguments.number(name, default), _MIN_SIDE)


def _helix_length(reach: float, height: float, turn: float, scale: float) -> float:
    """Return the length of a corner's path: a helix, on a cone if it is scaled."""
    if scale == 1:
        return math.hypot(turn * reach, height)
    end = turn * scale / (scale - 1) if scale > 1 else turn / (1 - scale)
    growth = reach / end
    spiral = _archimedes(growth, end) - _archimedes(growth, end - turn)
    return math.hypot(spiral, height)


def _archimedes(growth: float, angle: float) -> float:
    """Return the length of the spiral r = growth * angle from 0 on."""
    return 0.5 * growth * (angle * math.hypot(1, angle) + math.asinh(angle))
