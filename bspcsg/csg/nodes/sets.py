"""Operations on children: unions, differences, intersections, and nodes that only group."""

from functools import reduce
from operator import and_

from ...bsp import Region
from ...operations import setops
from ...solid.solid import Solid
from ..syntax.tree import Node
from .registry import Evaluation, Geometry, node
from .signature import Signature


def union_of(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return the union of the children of one kind; None if there is none."""
    solids, regions = run.same_kind(owner, children)
    if solids:
        return setops.union(solids)
    if len(regions) <= 1:
        return regions[0] if regions else None
    # Outlines wind once around the inside, so all of them wind at least once around the union.
    loops = [loop for region in regions for loop in region.to_polygons()]
    union = Region(loops, pitch=min(region.pitch for region in regions))
    # Kept with its parts, so that no other figure gets its `id`.
    run.united[id(union)] = union, [part for region in regions for part in run.parts_of(region)]
    return union


@node("group", "union", "render", makes_corners=False)
@node("color", takes=Signature(("c", "alpha")), makes_corners=False)
def group(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Unite the children; ignore colours and hints for the preview."""
    return union_of(owner, children, run)


@node("difference", makes_corners=False)
def difference(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Subtract all other children from the first; if the first is nothing, so is the result."""
    if not children or children[0] is None:
        return None
    solids, regions = run.same_kind(owner, children)
    if solids:
        return setops.difference(solids[0], solids[1:])
    return regions[0] - setops.union(regions[1:]) if regions[1:] else regions[0]


@node("intersection", makes_corners=False)
def intersection(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Intersect the children; one that is nothing, or of the other dimension, leaves nothing."""
    if not children or any(child is None for child in children):
        return None
    solids, regions = run.same_kind(owner, children)
    if len(solids) + len(regions) < len(children):
        return Solid.empty() if solids else Region.empty()
    return setops.intersection(solids) if solids else reduce(and_, regions)
