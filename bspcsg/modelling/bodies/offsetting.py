"""Offsets and rounding of solids by Minkowski sums with a ball."""

from ..._types import Scalar
from ...errors import invalid_parameter
from ...parameters import number, positive, sides_around, truth_value
from ...shapes.primitives import sphere
from ...solid.ledger import counted
from ...solid.solid import Solid
from .sums import minkowski

#: The least radius of a ball, in model units: ten steps of the finest lattice.
_SMALLEST = 1e-21


@counted
def offset(solid: Solid, r: Scalar, segments: int) -> Solid:
    """Return the solid with its surface moved outwards by `r`, or inwards if `r` is negative."""
    distance, around = number(r, "r"), sides_around(4, segments, "segments")
    if not distance:
        return solid
    ball = _ball(abs(distance), around)
    return minkowski(solid, ball) if distance > 0 else ~minkowski(~solid, ball)


@counted
def rounded(solid: Solid, r: Scalar, segments: int, inside: bool) -> Solid:
    """Return the solid with its edges rounded by radius `r`, the concave ones if `inside`."""
    radius = positive(r, "r")
    first = radius if truth_value(inside, "inside") else -radius
    return offset(offset(solid, first, segments), -first, segments)


def _ball(r: float, around: int) -> Solid:
    """Return a polyhedral ball with corners at distance r from the origin on each axis.

    So a Minkowski sum moves faces that are perpendicular to an axis by exactly r.
    """
    if r < _SMALLEST:
        message = (
            f"r is {r:g}, which is smaller than the finest lattice step; choose 0, or at least"
            f" {_SMALLEST:g}."
        )
        raise invalid_parameter(message)
    return sphere(r, segments=around + -around % 4)
