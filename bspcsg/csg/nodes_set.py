"""Operations on children: unions, differences, intersections, and nodes that only group."""

from functools import reduce
from operator import and_, sub
from typing import cast

from .. import setops
from ..bsp import Region
from ..solid import Solid
from .registry import Evaluation, Geometry, node
from .tree import Node


def union_of(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return the union of the children of one kind; None if there is none."""
    same = run.same_kind(owner, children)
    if not same:
        return None
    if len(same) == 1:
        return same[0]
    if isinstance(same[0], Solid):
        return setops.union(cast("list[Solid]", same))
    regions = cast("list[Region]", same)
    # Outlines wind once around what is inside: all of them together wind at least once.
    loops = [loop for region in regions for loop in region.to_polygons()]
    return Region(loops, pitch=min(region.pitch for region in regions))


@node("group", "union", "color", "render", makes_corners=False)
def group(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Unite the children; colours and hints for the preview make no difference."""
    return union_of(owner, children, run)


@node("difference", makes_corners=False)
def difference(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Take all children but the first from the first; if that is nothing, so is the result."""
    if not children or children[0] is None:
        return None
    same = run.same_kind(owner, children)
    if isinstance(same[0], Solid):
        solids = cast("list[Solid]", same)
        return setops.difference(solids[0], solids[1:])
    return reduce(sub, cast("list[Region]", same))


@node("intersection", makes_corners=False)
def intersection(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Intersect the children; one that is nothing leaves nothing."""
    if any(child is None for child in children):
        return None
    same = run.same_kind(owner, children)
    if not same:
        return None
    if isinstance(same[0], Solid):
        return setops.intersection(cast("list[Solid]", same))
    return reduce(and_, cast("list[Region]", same))
