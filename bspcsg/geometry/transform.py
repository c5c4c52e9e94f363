"""Transforms as lists of affine factors, and the exact lattice motions among them.

A transform is a list of 4x4 factors, outermost first: ``(F1, F2)`` maps a point x to F1 (F2 x). A
solid stores it as a chain (`bspcsg/geometry/chain.py`). Factors are never multiplied or inverted
before they are applied, so that factors that two solids have in common can be recognised bit by bit
and removed.

A factor whose linear part only permutes and mirrors axes, and which shifts by whole lattice steps,
is a lattice motion: it acts on planes and lattice points without rounding.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeAlias

import numpy as np

from .._types import FloatArray, Scalar, Vector
from ..errors import LimitError, invalid_parameter
from ..parameters import number, shown
from .arrays import doubles, doubles_or_none

#: The largest number of lattice steps of a coordinate.
LATTICE_REACH = 2**53

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


class Factor:
    """One affine map of a transform, compared bit by bit.

    Parameters
    ----------
    matrix : (4, 4) float64
        An invertible matrix with the last row 0, 0, 0, 1.
    """

    __slots__ = ("_mirrors", "key", "matrix")

    def __init__(self, matrix: FloatArray) -> None:
        # Adding zero turns -0.0 into 0.0, so that equal maps have equal bits.
        self.matrix: FloatArray = np.array(matrix, dtype=np.float64) + 0.0
        self.matrix.flags.writeable = False
        self.key = self.matrix.tobytes()
        self._mirrors: bool | None = None

    def __eq__(self, other: object) -> bool:
        """Return true if both matrices have the same bits."""
        return isinstance(other, Factor) and self.key == other.key

    def __hash__(self) -> int:
        """Return a hash value of the matrix's bits."""
        return hash(self.key)

    def __reduce__(self) -> tuple[type["Factor"], tuple[FloatArray]]:
        """Return the matrix for pickling."""
        return Factor, (self.matrix,)

    def __repr__(self) -> str:
        """Return a text with the entries of the matrix."""
        return f"Factor({self.matrix.tolist()})"

    @property
    def is_identity(self) -> bool:
        """True if the map is the identity."""
        return self.key == _IDENTITY_KEY

    @property
    def mirrors(self) -> bool:
        """True if the map is orientation-reversing; computed once."""
        if self._mirrors is None:
            self._mirrors = determinant_sign(self.matrix) < 0
        return self._mirrors


_IDENTITY_KEY = np.eye(4).tobytes()

_UNIT_ROWS = np.eye(3).tolist()

#: A transform: factors, outermost first.
Factors: TypeAlias = tuple[Factor, ...]


def translation(offset: Vector) -> Factor:
    """Return the translation by `offset`, in model units."""
    matrix = np.eye(4)
    matrix[:3, 3] = vector3(offset, "offset")
    return Factor(matrix)


def scaling(factor: Scalar | Vector) -> Factor:
    """Return the scaling about the origin by one number, or by one number for each axis."""
    return matrix_factor(np.diag([*vector3(factor, "scale factor", spread=True), 1.0]))


def mirroring(normal: str | Vector) -> Factor:
    """Return the reflection in the plane through the origin with this normal."""
    unit = _unit(named_axis(normal), "normal")
    return _from_linear(_snapped(np.eye(3) - 2 * np.outer(unit, unit)))


def rotation(angle: Scalar, axis: str | Vector) -> Factor:
    """Return the rotation about an axis through the origin.

    Parameters
    ----------
    angle : float
        The angle in degrees, counter-clockwise when the axis points at the viewer.
    axis : "x", "y", "z" or (3,) float
        The axis, of any length but zero.
    """
    cosine, sine = cos_sin(number(angle, "angle"))
    u = axis_vector(axis)
    spin = np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])
    along = np.outer(u, u)
    # The form (I - uu') c + s [u] + uu' keeps coordinate axes and quarter turns exact.
    return _from_linear(_snapped((np.eye(3) - along) * cosine + spin * sine + along))


def euler_rotation(angles: Vector) -> Factors:
    """Return the rotations about x, then y, then z by angles in degrees, outermost first.

    Rotations by zero are left out.
    """
    about = zip(vector3(angles, "angles"), "xyz", strict=True)
    turns = [rotation(float(angle), axis) for angle, axis in about]
    return tuple(turn for turn in reversed(turns) if not turn.is_identity)


def about(point: Vector, factors: Factors) -> Factors:
    """Return factors that act about `point` as the given factors act about the origin."""
    there = vector3(point, "point")
    return (translation(there), *factors, translation(-there)) if there.any() else factors


def matrix_factor(matrix: Any) -> Factor:
    """Return the factor of a (4, 4) or (3, 4) matrix, checked to be an invertible affine map.

    Raises
    ------
    InvalidParameterError
        If the shape is wrong, an entry is not finite, the last row is not 0, 0, 0, 1, or the
        determinant is zero.
    """
    array = doubles(matrix, invalid_parameter("A transform must be a 4x4 matrix of numbers."))
    if array.shape == (3, 4):
        array = np.vstack([array, [0.0, 0.0, 0.0, 1.0]])
    if array.shape != (4, 4):
        raise invalid_parameter(
            f"A transform must be a matrix of shape (4, 4) or (3, 4), not {array.shape}."
        )
    if not np.isfinite(array).all():
        raise invalid_parameter("A transform has an entry that is not a finite number.")
    if array[3].tolist() != [0.0, 0.0, 0.0, 1.0]:
        raise invalid_parameter("The last row of a transform must be 0, 0, 0, 1.")
    if determinant_sign(array) == 0:
        raise invalid_parameter(
            "The transform has determinant zero, so it would flatten the solid; use an invertible"
            " matrix."
        )
    return Factor(array)


def cos_sin(angle: float) -> tuple[float, float]:
    """Return the cosine and sine of a finite angle in degrees; rational values are exact."""
    quarter, rest = divmod(math.fmod(angle, 360.0), 90.0)
    cosine, sine = _cos_sin_in_quarter(rest)
    # Adding zero turns -0.0 into 0.0.
    turned = ((cosine, sine), (-sine, cosine), (-cosine, -sine), (sine, -cosine))
    x, y = turned[int(quarter) % 4]
    return x + 0.0, y + 0.0


def _cos_sin_in_quarter(angle: float) -> tuple[float, float]:
    if angle > 45:
        # So the results for angle and 90 - angle are equal bit by bit.
        sine, cosine = _cos_sin_in_quarter(90 - angle)
        return cosine, sine
    if angle == 45:
        return math.sqrt(0.5), math.sqrt(0.5)
    sine = 0.5 if angle == 30 else math.sin(math.radians(angle))
    return math.cos(math.radians(angle)), sine


def product(factors: Factors) -> FloatArray:
    """Return the matrix product of factors, each entry of each product rounded once."""
    return multiplied([factor.matrix for factor in factors])


def multiplied(matrices: Sequence[FloatArray]) -> FloatArray:
    """Return the product of (4, 4) matrices in the given order, each entry rounded once."""
    if len(matrices) == 1:
        return matrices[0]
    rows = np.eye(4).tolist()
    for matrix in matrices:
        columns = matrix.T.tolist()
        rows = [[_dot(row, column) for column in columns] for row in rows]
    return np.array(rows)


def _dot(a: list[float], b: list[float]) -> float:
    try:
        value = math.fsum((a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]))
    except (OverflowError, ValueError):
        value = math.inf
    if not math.isfinite(value):
        raise LimitError(
            "The product of these transforms has an entry that is too large for doubles; scale or"
            " move less.",
            "too_large",
        )
    return value


def apply(matrix: FloatArray, points: FloatArray) -> FloatArray:
    """Return the images of (n, 3) points, computed in the same order on every platform."""
    x, y, z = points.T
    rows = [x * row[0] + y * row[1] + z * row[2] + row[3] for row in matrix[:3]]
    # Adding zero turns -0.0 into 0.0.
    return np.ascontiguousarray(np.array(rows).T) + 0.0


def determinant_sign(matrix: FloatArray) -> int:
    """Return the exact sign of the determinant of a matrix's linear part: -1, 0 or 1."""
    if matrix[:3, :3].tolist() == _UNIT_ROWS:
        return 1
    value = determinant(exact_linear(matrix))
    return (value > 0) - (value < 0)


def determinant(rows: list[list[Fraction]]) -> Fraction:
    """Return the exact determinant of a (3, 3) matrix, given as three rows."""
    return exact_dot(rows[0], cofactors(rows)[0])


def exact_linear(matrix: FloatArray) -> list[list[Fraction]]:
    """Return the linear part of a matrix as three rows of fractions."""
    return [[Fraction(entry) for entry in row] for row in matrix[:3, :3].tolist()]


def exact_dot(a: Sequence[Fraction], b: Sequence[Fraction]) -> Fraction:
    """Return the exact inner product of two vectors."""
    return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))


def cofactors(rows: list[list[Fraction]]) -> list[list[Fraction]]:
    """Return the cofactor matrix of three rows, which maps normals if `rows` maps points."""
    a, b, c = rows
    return [_cross(b, c), _cross(c, a), _cross(a, b)]


def _cross(a: list[Fraction], b: list[Fraction]) -> list[Fraction]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


@dataclass(frozen=True)
class LatticeMotion:
    """A distance-preserving map of the lattice onto itself: signed permutation, then translation.

    Parameters
    ----------
    axes : tuple of int
        For each new axis, the old axis (1, 2 or 3) that becomes it, negative if it is mirrored.
    shift : tuple of int
        The translation in lattice steps, after the permutation.
    """

    axes: tuple[int, int, int] = (1, 2, 3)
    shift: tuple[int, int, int] = (0, 0, 0)

    @property
    def is_identity(self) -> bool:
        """True if the motion is the identity."""
        return self == LatticeMotion()

    @property
    def linear(self) -> FloatArray:
        """The matrix of the signed permutation, (3, 3) float64."""
        rows = [np.sign(axis) * np.eye(3)[abs(axis) - 1] for axis in self.axes]
        return np.array(rows)

    def after(self, inner: "LatticeMotion") -> "LatticeMotion":
        """Return the motion that applies `inner` first and then this motion."""
        signs = [1 if axis > 0 else -1 for axis in self.axes]
        olds = [abs(axis) - 1 for axis in self.axes]
        axes = [sign * inner.axes[old] for sign, old in zip(signs, olds, strict=True)]
        moved = [sign * inner.shift[old] for sign, old in zip(signs, olds, strict=True)]
        shift = [a + b for a, b in zip(moved, self.shift, strict=True)]
        return LatticeMotion((axes[0], axes[1], axes[2]), (shift[0], shift[1], shift[2]))


def permuting_run(factors: Factors) -> Factors:
    """Return the outermost factors before the first that does more than permute axes and shift."""
    for position, factor in enumerate(factors):
        if _signed_axes(factor) is None:
            return factors[:position]
    return factors


def lattice_motion(
    factors: Factors, pitch: int, motion: LatticeMotion | None = LatticeMotion()
) -> LatticeMotion | None:
    """Return the factors as one exact lattice motion, or None if they are not one.

    Parameters
    ----------
    factors : tuple of Factor
    pitch : int
        The lattice step is ``10**pitch`` model units.
    motion : LatticeMotion or None
        The motion that is applied before the factors; None if it is not exact.
    """
    for factor in reversed(factors):
        step = _motion_of(factor, pitch)
        if step is None or motion is None:
            return None
        motion = step.after(motion)
    return motion


def _motion_of(factor: Factor, pitch: int) -> LatticeMotion | None:
    axes = _signed_axes(factor)
    if axes is None:
        return None
    shift = [whole_steps(value, pitch) for value in factor.matrix[:3, 3].tolist()]
    x, y, z = shift
    if x is None or y is None or z is None:
        return None
    return LatticeMotion(axes, (x, y, z))


def _signed_axes(factor: Factor) -> tuple[int, int, int] | None:
    """Return the axes of a signed permutation as in `LatticeMotion`, or None for another map."""
    axes = []
    for row in factor.matrix[:3, :3].tolist():
        used = [axis for axis, entry in enumerate(row) if entry != 0]
        if len(used) != 1 or abs(row[used[0]]) != 1:
            return None
        axes.append((used[0] + 1) * int(row[used[0]]))
    return axes[0], axes[1], axes[2]


def whole_steps(length: float, pitch: int) -> int | None:
    """Return the number of lattice steps in a length, or None if it is not an integer.

    A double counts as the decimal that it was written as: 0.1 is 10**8 steps of 10**-9, because 0.1
    is the nearest double to that decimal.
    """
    numerator, denominator = length.as_integer_ratio()
    scale = 10 ** abs(pitch)
    # The quotient of two ints is rounded once, as the quotient of two fractions would be.
    if pitch < 0:
        steps = _nearest(numerator * scale, denominator)
        fits = abs(steps) < LATTICE_REACH and steps / scale == length
    else:
        steps = _nearest(numerator, denominator * scale)
        fits = abs(steps) < LATTICE_REACH and float(steps * scale) == length
    return steps if fits else None


def _nearest(numerator: int, denominator: int) -> int:
    """Return the integer nearest to a quotient of positive denominator, ties to even."""
    floor, rest = divmod(numerator, denominator)
    above = 2 * rest - denominator
    return floor + (above > 0 or (above == 0 and floor % 2 == 1))


def _from_linear(linear: FloatArray) -> Factor:
    matrix = np.eye(4)
    matrix[:3, :3] = linear
    return Factor(matrix)


def _snapped(linear: FloatArray) -> FloatArray:
    """Return the signed permutation that a matrix equals up to rounding, or the matrix itself."""
    nearest = np.round(linear)
    return nearest if np.abs(linear - nearest).max() < 1e-15 else linear


def axis_vector(axis: str | Vector) -> FloatArray:
    """Return the unit vector along "x", "y", "z" or a vector that is not zero."""
    return _unit(named_axis(axis), "axis")


def named_axis(axis: str | Vector) -> Vector:
    """Return the unit vector for "x", "y" or "z"; any other argument unchanged."""
    if not isinstance(axis, str):
        return axis
    if axis.lower() not in _AXES:
        raise invalid_parameter(
            f"An axis must be 'x', 'y', 'z' or a vector of three numbers, not {shown(axis)}."
        )
    return _AXES[axis.lower()]


def _unit(value: Vector, name: str) -> FloatArray:
    vector = vector3(value, name)
    if not vector.any():
        raise invalid_parameter(f"The {name} must not be the zero vector.")
    # Scaling by the largest entry avoids overflow and underflow of the squares.
    vector /= np.abs(vector).max()
    vector /= math.hypot(*vector)
    return vector


def vector3(value: Any, name: str, *, spread: bool = False) -> FloatArray:
    """Return a vector as (3,) float64, or raise an error that names the parameter.

    Parameters
    ----------
    value : (3,) array_like of float
    name : str
    spread : bool
        True if a single number means three equal numbers.
    """
    given = doubles_or_none(value)
    if given is None:
        raise invalid_parameter(f"The {name} must be three numbers, not {shown(value)}.")
    vector = given.copy()
    if spread and vector.ndim == 0:
        vector = np.full(3, vector)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise invalid_parameter(f"The {name} must be three finite numbers, not {shown(value)}.")
    return vector
