"""Hyperplanes of half-spaces in exact rational numbers, and their rounding to the lattice.

A double means the shortest decimal that identifies it: 0.1 is a tenth. So hyperplanes have rational
coefficients, and transforms move them exactly.

A hyperplane n·x = d with integers n without a common divisor, and x in lattice steps, contains
lattice points if and only if d is an integer. Such a hyperplane is used as it is. Any other is
moved to the nearest one that contains lattice points, rounded like the coordinates of a mesh, so
that a half-space and a mesh face at the same coordinate meet; `LatticeHyperplane.moved` has the
distance.

Normals that are too wide for the core, as after rotations by odd angles, are rounded so that their
products fit a machine word. This turns the hyperplane by less than 2**-60.
"""

import math
import numbers
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any, Self

import numpy as np

from .._core import normal_bits
from ..errors import InvalidMeshError, invalid_parameter
from ..parameters import MAX_PITCH, is_complex, shown
from .arrays import is_masked

#: Exponent of the lattice step for sets that fit on any lattice.
DEFAULT_PITCH = -9

#: The smallest pitch that is chosen for a hyperplane: this lattice extends to 9000 units.
_FINEST_PITCH = -12

#: Lattice coordinates are below this many steps.
_REACH = 2**53

#: The number of bits to which normals are rounded: one less than products in 64-bit words allow.
_ROUNDED_BITS = 61

#: Transforms round coefficients of more bits than this to half as many bits.
_KEPT_BITS = 1024


@dataclass(frozen=True)
class LatticeHyperplane:
    """A hyperplane through lattice points, with integer coefficients.

    Parameters
    ----------
    row : list of int
        The integers (*n, c) of the hyperplane n·x = c, with x in lattice steps.
    moved : float or None
        The largest distance, anywhere on the lattice, from the hyperplane before rounding, in model
        units; None if nothing was rounded.
    """

    row: list[int]
    moved: float | None

    @property
    def note(self) -> str | None:
        """A sentence for a finding, if the hyperplane was moved to the lattice; else None."""
        if self.moved is None:
            return None
        return (
            "the plane contains no lattice point, or its coefficients have too many digits;"
            f" it was moved by at most {self.moved:.3e} units, to the nearest plane that can"
            " be represented"
        )


@dataclass(frozen=True)
class Hyperplane:
    """The hyperplane of the points x with ``normal . x == offset``, in model units.

    Parameters
    ----------
    normal : tuple of one to three int
        Integers without a common divisor.
    offset : Fraction
    exact : bool
        True if neither normal nor offset was rounded.
    """

    normal: tuple[int, ...]
    offset: Fraction
    exact: bool = True

    @classmethod
    def of(cls, normal: Sequence[Fraction], offset: Fraction, exact: bool = True) -> Self:
        """Return the hyperplane of any normal but zero, reduced to coprime integers."""
        denominator = math.lcm(*(entry.denominator for entry in normal))
        whole = [entry.numerator * (denominator // entry.denominator) for entry in normal]
        divisor = math.gcd(*whole)
        coprime = tuple(entry // divisor for entry in whole)
        return cls(coprime, offset * Fraction(denominator, divisor), exact)

    @classmethod
    def from_numbers(cls, normal: Sequence[Any], offset: Any) -> Self:
        """Return the hyperplane of a normal and an offset, where 0.1 means exactly a tenth.

        Raises
        ------
        InvalidMeshError
            If the normal is zero or a number is not finite ("bad_normal").
        """
        try:
            entries, product = [exact_number(entry) for entry in normal], exact_number(offset)
        except (TypeError, ValueError, OverflowError) as error:
            message = (
                "A hyperplane must be a normal vector and an offset, all of them finite numbers."
            )
            raise InvalidMeshError(message, "bad_normal") from error
        if not any(entries):
            raise InvalidMeshError(
                "The normal of a hyperplane must not be the zero vector.", "bad_normal"
            )
        return cls.of(entries, product)

    def on_lattice(self, pitch: int) -> LatticeHyperplane:
        """Return the nearest hyperplane through points of the lattice of step ``10**pitch``."""
        steps = self.offset / Fraction(10) ** pitch
        normal, scale = self._narrow()
        offset = _nearest(scale * steps, scale * self._as_a_coordinate(pitch))
        if self.exact and scale == 1 and offset == steps:
            return LatticeHyperplane([*normal, offset], None)
        turned = sum(abs(a - scale * b) for a, b in zip(normal, self.normal, strict=True))
        off = turned * _REACH + abs(offset - scale * steps)
        return LatticeHyperplane([*normal, offset], float(off) / math.hypot(*normal) * 10.0**pitch)

    def is_above_lattice(self, pitch: int) -> bool | None:
        """Return true if the whole lattice lies on the minus side, false if on the plus side.

        None means that the hyperplane crosses the range of the lattice of step ``10**pitch``.
        """
        steps = self.offset / Fraction(10) ** pitch
        if abs(steps) < sum(map(abs, self.normal)) * _REACH:
            return None
        return steps > 0

    @property
    def pitch(self) -> int:
        """The coarsest pitch, from -9 to -12, at which the hyperplane contains lattice points.

        If the hyperplane is outside the range of the lattice of pitch -9, the search starts at the
        first of -6, -3, … whose range it crosses. If no pitch is found, it is the pitch at which
        the search started.
        """
        within = range(DEFAULT_PITCH, MAX_PITCH, 3)
        coarsest = next((p for p in within if self.is_above_lattice(p) is None), DEFAULT_PITCH)
        for pitch in range(coarsest, _FINEST_PITCH - 1, -1):
            if self.is_above_lattice(pitch) is None and self.on_lattice(pitch).moved is None:
                return pitch
        return coarsest

    def _as_a_coordinate(self, pitch: int) -> Fraction:
        """Return the offset, rounded to a double, in lattice steps; it decides ties in rounding.

        So ties are rounded as in meshes, whose coordinates are doubles.
        """
        near = abs(self.offset) < 2**1000
        return (Fraction(float(self.offset)) if near else self.offset) / Fraction(10) ** pitch

    def _narrow(self) -> tuple[tuple[int, ...], Fraction]:
        """Return the normal rounded to a width that the core accepts, and the factor applied."""
        bits = max(entry.bit_length() for entry in self.normal)
        if bits <= _bits(len(self.normal)):
            return self.normal, Fraction(1)
        power = 1 << (bits - _ROUNDED_BITS)
        rounded = [round(Fraction(entry, power)) for entry in self.normal]
        divisor = math.gcd(*rounded)
        return tuple(entry // divisor for entry in rounded), Fraction(1, power * divisor)

    def shortened(self) -> Self:
        """Return the hyperplane rounded to about 1024 bits, if it has more."""
        ratio = self.offset.as_integer_ratio()
        if max(entry.bit_length() for entry in (*self.normal, *ratio)) <= _KEPT_BITS:
            return self
        size = max(entry.bit_length() for entry in self.normal)
        grain = Fraction(2) ** (size - _KEPT_BITS // 2)
        normal = [round(entry / grain) * grain for entry in self.normal]
        offset = self.offset.limit_denominator(1 << (_KEPT_BITS // 2))
        return type(self).of(normal, offset, exact=False)


def exact_number(value: Any) -> Fraction:
    """Return a number as an exact fraction; a double means the shortest decimal that identifies it.

    Raises
    ------
    ValueError, OverflowError
        If the number is not finite.
    TypeError
        If the value is not a number.
    """
    # np.timedelta64 is a subclass of numpy's integers.
    no_numbers = (bool, np.bool_, np.timedelta64, str, bytes)
    if isinstance(value, no_numbers) or is_complex(value):
        raise TypeError("bools, strings, times and complex numbers are not accepted as numbers")
    if isinstance(value, numbers.Rational):
        return Fraction(int(value.numerator), int(value.denominator))
    double = float(value)
    return Fraction(int(double)) if double.is_integer() else Fraction(repr(double))


def exact_point(values: Any, dimension: int, name: str) -> list[Fraction]:
    """Return a point's coordinates as exact fractions; in 1D a single number is a point.

    Parameters
    ----------
    values : (dimension,) array_like of float
    dimension : int
    name : str
        The name of the parameter, for the error.
    """
    try:
        if is_masked(values):
            raise TypeError("masked")
        entries = np.atleast_1d(np.asarray(values, dtype=object)).tolist()
        found = [exact_number(entry) for entry in entries]
        if len(found) != dimension:
            raise ValueError("wrong number of coordinates")
    except (TypeError, ValueError, OverflowError) as error:
        count = "a finite number" if dimension == 1 else f"{dimension} finite numbers"
        raise invalid_parameter(f"{name} must be {count}, not {shown(values)}.") from error
    return found


def _nearest(value: Fraction, coordinate: Fraction) -> int:
    """Return the integer nearest to `value`; ties go towards `coordinate`, else away from zero."""
    low = math.floor(value)
    rest = value - low
    if rest == Fraction(1, 2) and coordinate != value:
        return low + (coordinate > value)
    return low + (rest > Fraction(1, 2) or (rest == Fraction(1, 2) and value > 0))


@lru_cache
def _bits(dimension: int) -> int:
    """Return the largest number of bits of the core's normals in this dimension."""
    return normal_bits(dimension)
