"""Solids thickened, made thinner and rounded by a ball."""

from ..._types import Scalar
from ...parameters import number, positive, sides_around, truth_value
from ...shapes.primitives import sphere
from ...solid.counting import counted
from ...solid.solid import Solid
from .sums import minkowski


@counted
def offset(solid: Solid, r: Scalar, segments: int = 16) -> Solid:
    """Return the solid with its surface moved outwards (see `Solid.offset`)."""
    distance = number(r, "r")
    ball = _ball(abs(distance), segments) if distance else None
    if ball is None:
        return solid
    return minkowski(solid, ball) if distance > 0 else ~minkowski(~solid, ball)


@counted
def rounded(solid: Solid, r: Scalar, segments: int = 16, inside: bool = False) -> Solid:
    """Return the solid with round edges (see `Solid.rounded`)."""
    radius = positive(r, "r")
    first = radius if truth_value(inside, "inside") else -radius
    return offset(offset(solid, first, segments), -first, segments)


def _ball(r: float, segments: int) -> Solid:
    """Return a ball with corners at r along each axis, so that faces across them move by r."""
    around = sides_around(4, segments, "segments")
    return sphere(r, segments=around + -around % 4)
