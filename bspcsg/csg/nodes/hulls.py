"""Evaluation of the nodes hull and minkowski."""

from functools import reduce
from typing import TypeVar

from ...bsp import Region
from ...errors import LimitError
from ...modelling.bodies import hulls, sums
from ...solid.solid import Solid
from ..syntax.arguments import Arguments
from ..syntax.tree import Node
from .registry import Evaluation, Geometry, node

_Shape = TypeVar("_Shape", Solid, Region)


@node("hull")
def hull(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return the convex hull of all children together.

    Child meshes need not be closed: only their corners matter, as in OpenSCAD.
    """
    solids, regions = run.same_kind(owner, children)
    if solids:
        body: Solid = hulls.hull(*map(run.corners_or, solids))
        return body
    return hulls.hull(*regions) if regions else None


@node("minkowski")
def minkowski(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return the Minkowski sum of all children; empty solids are ignored, as in OpenSCAD."""
    arguments = run.arguments(owner)
    solids, regions = run.same_kind(owner, children)
    if solids:
        summands = [solid for solid in solids if not solid.is_empty]
        summed = reduce(lambda a, b: _sum(a, b, arguments), summands) if summands else None
        return summed or Solid.empty()
    if regions:
        return reduce(lambda a, b: _sum(a, b, arguments), _summands(children, regions))
    return None


def _summands(children: list[Geometry], regions: list[Region]) -> list[Region]:
    """Return the regions whose Minkowski sum is computed; one empty region if the sum is empty.

    Like OpenSCAD, ignore empty operands; but the sum is empty if the first operand is empty, or if
    fewer than two operands are not.
    """
    figures = [region for region in regions if not region.is_empty]
    first = children[0]
    if len(children) > 1 and (first is None or first.is_empty or len(figures) < 2):
        return [Region.empty()]
    return regions if len(children) == 1 else figures


def _sum(a: _Shape, b: _Shape, arguments: Arguments) -> _Shape:
    try:
        return sums.minkowski(a, b)
    except LimitError as error:
        raise arguments.error(error.message, error.code) from error
