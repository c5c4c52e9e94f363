"""The alignment of solids with points and other solids."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, TypeAlias

import numpy as np

from ..._types import FloatArray, Vector
from ...errors import InvalidParameterError, invalid_parameter
from ...geometry.hyperplane import exact_number
from ...geometry.transform import vector3
from ...parameters import shown
from ...solid.ledger import uncounted
from ...solid.solid import Solid

#: The positions along one axis that `align` makes equal: one name ("min", "center" or "max") for
#: both boxes, or a pair of names, of the moved solid's box and of the target's box.
Anchor: TypeAlias = str | tuple[str, str]

_SHARES = {"min": Fraction(0), "center": Fraction(1, 2), "max": Fraction(1)}


def align(solid: Solid, places: dict[str, Anchor | None], to: "Solid | Vector") -> Solid:
    """Return the solid translated so that chosen coordinates of its bounding box match a target.

    Parameters
    ----------
    solid : Solid
    places : dict
        For each of the axes x, y, z the positions that become equal, or None for no translation
        along it.
    to : Solid or (3,) float
        The target: a solid's bounding box, or a point.
    """
    named = [_names(axis, place) for axis, place in places.items()]
    own, other = _box(solid), _box(to)
    move = [0.0, 0.0, 0.0]
    for axis, names in enumerate(named):
        if names is not None:
            # Exact subtraction keeps short decimals short, so the result is in whole lattice steps.
            move[axis] = float(_at(other, axis, names[1]) - _at(own, axis, names[0]))
    return solid.translate(move)


def _names(axis: str, place: Any) -> tuple[str, str] | None:
    if place is None:
        return None
    pair = (place, place) if isinstance(place, str) else place
    if not isinstance(pair, (tuple, list)) or len(pair) != 2 or not _are_places(pair):
        raise _wrong(axis, place)
    return pair[0], pair[1]


def _are_places(pair: Sequence[Any]) -> bool:
    return all(isinstance(name, str) and name in _SHARES for name in pair)


def _wrong(axis: str, place: Any) -> InvalidParameterError:
    return invalid_parameter(
        f"{axis} must be 'min', 'center' or 'max', or a pair of them, not {shown(place)}."
    )


@uncounted
def _box(place: "Solid | Vector") -> FloatArray:
    """Return the bounding box of a solid or a point, (2, 3): least and greatest coordinates."""
    if not isinstance(place, Solid):
        return np.array([vector3(place, "point")] * 2)
    bounds = place.bounds
    if bounds is None:
        raise invalid_parameter(
            "An empty solid has no position, so it cannot be aligned or aligned to; pass a solid"
            " that is not empty."
        )
    return bounds


def _at(box: FloatArray, axis: int, name: str) -> Fraction:
    low, high = map(exact_number, box[:, axis].tolist())
    return low + (high - low) * _SHARES[name]
