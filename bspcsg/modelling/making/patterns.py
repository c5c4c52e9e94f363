"""Copies of solids and regions in rows, circles and grids."""

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, TypeVar

from ..._types import Scalar, Vector
from ...bsp import Region
from ...errors import LimitError, invalid_parameter
from ...geometry.arrays import doubles
from ...geometry.hyperplane import exact_number
from ...geometry.transform import vector3
from ...operations.setops import union
from ...parameters import at_least, number, shown, truth_value
from ...solid.ledger import counted
from ...solid.solid import Solid

#: The largest number of copies in one pattern. Each takes about 2 kB, as a node of the expression
#: with a transform.
_MAX_COPIES = 100_000

_Shape = TypeVar("_Shape", Solid, Region)


@counted
def linear_pattern(shape: _Shape, count: int, step: Vector) -> _Shape:
    """Return the union of a shape and its copies in a row.

    Parameters
    ----------
    shape : Solid or Region
    count : int
        Number of copies including the shape itself, at least 1.
    step : (3,) or (2,) float
        Vector from each copy to the next, in model units; two numbers for a region.

    Raises
    ------
    InvalidParameterError
        If a parameter is out of its range.
    LimitError
        If there are more than 100 000 copies.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.linear_pattern(csg.cube(1), 4, (2, 0, 0)).volume
    4.0
    """
    return _row(_of_shape(shape), _copies(count), step)


@counted
def polar_pattern(
    shape: _Shape,
    count: int,
    *,
    angle: Scalar = 360.0,
    axis: str | Vector = "z",
    center: Vector = (0, 0, 0),
) -> _Shape:
    """Return the union of a shape and its copies, rotated about an axis.

    Parameters
    ----------
    shape : Solid or Region
        A region is rotated about a point of the plane.
    count : int
        Number of copies including the shape itself, at least 1.
    angle : float
        Degrees between the first copy and the last; 360 divides the full turn evenly.
    axis : {"x", "y", "z"} or (3,) float
        Axis of rotation, which is counter-clockwise if the axis points at the viewer.
    center : (3,) or (2,) float
        A point of the axis.

    Raises
    ------
    InvalidParameterError
        If a parameter is out of its range.
    LimitError
        If there are more than 100 000 copies.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.polar_pattern(csg.cube(1).translate(2, 0, 0), 4).volume
    4.0
    """
    _of_shape(shape)
    copies, turn = _copies(count), number(angle, "angle")
    parts = copies if turn % 360 == 0 else max(copies - 1, 1)
    middle = _vector(shape, center, "center")
    moved = shape.translate([-x for x in middle])
    turned: list[Any] = [_turned(moved, turn * k / parts, axis) for k in range(copies)]
    result: _Shape = _united(turned).translate(middle)
    return result


@counted
def grid(shape: _Shape, counts: Sequence[int], steps: Vector, *, center: bool = False) -> _Shape:
    """Return the union of a shape and its copies in a grid along the axes.

    Parameters
    ----------
    shape : Solid or Region
    counts : (2,) or (3,) int
        Number of copies along x, y and z, at least 1 each.
    steps : (2,) or (3,) float
        Distance from each copy to the next along x, y and z; as many numbers as in `counts`.
    center : bool
        True if the given shape is in the middle of the grid, instead of at its corner of least
        coordinates.

    Raises
    ------
    InvalidParameterError
        If a parameter is out of its range.
    LimitError
        If there are more than 100 000 copies.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.grid(csg.cube(1), (3, 2), (2, 2)).volume
    6.0
    """
    axes = 2 if isinstance(_of_shape(shape), Region) else 3
    is_central = truth_value(center, "center")
    numbers, lengths = _entries(counts), _entries(steps)
    if len(numbers) != len(lengths) or not 2 <= len(numbers) <= axes:
        raise invalid_parameter(
            f"counts and steps must both have one number for each axis, for 2 to {axes} axes, but"
            f" have {len(numbers)} and {len(lengths)}."
        )
    copies = [at_least(1, entry, "counts") for entry in numbers]
    _refuse_many(math.prod(copies))
    result = shape
    for axis, (amount, length) in enumerate(zip(copies, lengths, strict=True)):
        step = [0.0] * axes
        step[axis] = number(length, "steps")
        shift = _scaled_vector(step, Fraction(1 - amount, 2)) if is_central else [0.0] * axes
        result = _row(result.translate(shift), amount, step)
    return result


def _of_shape(shape: _Shape) -> _Shape:
    if not isinstance(shape, (Solid, Region)):
        raise invalid_parameter(
            f"The shape of a pattern must be a Solid or a Region, not {shown(shape)}."
        )
    return shape


def _entries(given: Any) -> list[Any]:
    try:
        return list(given)
    except TypeError as error:
        raise invalid_parameter(
            "counts and steps of a grid must be lists with one number for each axis."
        ) from error


def _row(shape: _Shape, copies: int, step: Vector) -> _Shape:
    stride = _vector(shape, step, "step")
    united: _Shape = _united([shape.translate(_scaled_vector(stride, k)) for k in range(copies)])
    return united


def _scaled_vector(step: Sequence[float], factor: int | Fraction) -> list[float]:
    """Return a vector times a factor, computed exactly from its decimals and then rounded once."""
    try:
        return [float(exact_number(entry) * factor) for entry in step]
    except OverflowError as error:
        raise LimitError(
            "The last copies would have coordinates that are too large for doubles; choose a"
            " smaller step or fewer copies.",
            "too_large",
        ) from error


def _turned(shape: Any, angle: float, axis: str | Vector) -> Any:
    return shape.rotate(angle) if isinstance(shape, Region) else shape.rotate(angle, axis)


def _united(shapes: Sequence[Any]) -> Any:
    return union(*shapes) if isinstance(shapes[0], Solid) else _united_in_pairs(shapes)


def _united_in_pairs(regions: Sequence[Any]) -> Any:
    """Return the union of regions: pairs of neighbours are united, then pairs of the results."""
    while len(regions) > 1:
        pairs = zip(regions[::2], regions[1::2], strict=False)
        rest = [regions[-1]] if len(regions) % 2 else []
        regions = [one | other for one, other in pairs] + rest
    return regions[0]


def _vector(shape: Solid | Region, given: Any, name: str) -> list[float]:
    if isinstance(shape, Solid):
        return [float(entry) for entry in vector3(given, name)]
    refusal = invalid_parameter(f"The {name} of a region's pattern must be two numbers.")
    both = doubles(given, refusal).ravel()
    if len(both) == 3 and both[2] == 0:
        both = both[:2]
    if len(both) != 2:
        raise refusal
    return [number(entry, name) for entry in both]


def _copies(count: int) -> int:
    copies = at_least(1, count, "count")
    _refuse_many(copies)
    return copies


def _refuse_many(copies: int) -> None:
    if copies > _MAX_COPIES:
        message = f"A pattern can have at most {_MAX_COPIES} copies, not {shown(copies)}."
        raise LimitError(message, "too_many")
