"""Evaluation of the nodes union, difference and intersection, and of nodes that only group."""

from functools import reduce
from operator import and_

from ...bsp import Region
from ...operations import setops
from ...solid.solid import Solid
from ..syntax.tree import Node
from .registry import Evaluation, Geometry, node
from .signature import Signature


def union_of(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return the union of the children; None without any.

    If there are solids and regions, only those of the first child's dimension are united.
    """
    solids, regions = run.same_kind(owner, children)
    if solids:
        return setops.union(solids)
    if len(regions) <= 1:
        return regions[0] if regions else None
    # Each region has winding number 1 inside, so all outlines have at least 1 in the union.
    loops = [loop for region in regions for loop in region.to_polygons()]
    union = Region(loops, pitch=min(region.pitch for region in regions))
    # Store the union too, so that no other figure gets its `id`.
    run.united[id(union)] = union, [part for region in regions for part in run.parts_of(region)]
    return union


@node("group", "union", "render", makes_corners=False)
@node("color", takes=Signature(("c", "alpha")), makes_corners=False)
def group(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return the union of the children; colours and preview hints are ignored."""
    return union_of(owner, children, run)


@node("difference", makes_corners=False)
def difference(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return the first child minus all other children; None if the first has no geometry."""
    if not children or children[0] is None:
        return None
    solids, regions = run.same_kind(owner, children)
    if solids:
        return setops.difference(solids[0], solids[1:])
    return regions[0] - setops.union(regions[1:]) if regions[1:] else regions[0]


@node("intersection", makes_corners=False)
def intersection(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return the intersection of the children.

    It is None if a child has no geometry, and empty if there are both solids and regions.
    """
    if not children or any(child is None for child in children):
        return None
    solids, regions = run.same_kind(owner, children)
    if len(solids) + len(regions) < len(children):
        return Solid.empty() if solids else Region.empty()
    return setops.intersection(solids) if solids else reduce(and_, regions)
