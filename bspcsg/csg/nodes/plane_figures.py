"""Evaluation of the nodes of plane figures: square, circle, polygon, offset, fill."""

import numpy as np

from ...bsp import Region
from ...geometry.polygon import signed_area
from ...modelling.planar.offsetting import offset_outline, openscad_union, refuse_far
from ...shapes.sweep import unit_circle
from ..making.tessellation import Fineness
from ..syntax.arguments import Arguments
from ..syntax.tree import Node
from .registry import Evaluation, Geometry, node
from .set_operations import union_of
from .signature import Signature

#: The names of nodes in which OpenSCAD does not clean the outlines of an only child.
_GROUPING = frozenset({"group", "union", "color", "render", "multmatrix", "resize", "difference",
                      "intersection"})  # fmt: skip

#: The names of nodes whose outlines are exactly as given in the script.
_PRIMITIVE = frozenset({"square", "circle", "polygon"})


@node("square", takes=Signature(("size", "center")))
def square(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Make a rectangle; it is empty if a side has length 0 or less."""
    del children
    arguments = run.arguments(owner)
    width, height = arguments.vector("size", 2, (1.0, 1.0))
    if min(width, height) <= 0:
        return Region.empty()
    return Region.rectangle(width, height, center=arguments.flag("center"))


@node("circle", takes=Signature(("r",), ("d",), (("r", ("d",)),)))
def circle(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Make a regular polygon with its first corner on the x axis."""
    del children
    arguments = run.arguments(owner)
    r = arguments.number("d") / 2 if "d" in arguments else arguments.number("r", 1.0)
    if r <= 0:
        return Region.empty()
    sides = arguments.sides(Fineness.of(arguments).fragments(r), "this circle")
    return Region(unit_circle(sides) * r)


@node("polygon", takes=Signature(("points", "paths", "convexity")))
def polygon(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Make the region inside `paths`, by default one path through all points, even-odd."""
    del children
    arguments = run.arguments(owner)
    points = np.array(arguments.points("points", 2)).reshape(-1, 2)
    loops = [points[path] for path in _paths(arguments, len(points)) if len(path) >= 3]
    return Region(loops, winding="even-odd")


def _paths(arguments: Arguments, count: int) -> list[list[int]]:
    if "paths" not in arguments or arguments.value("paths") == ():
        return [list(range(count))]
    return arguments.index_lists("paths", count, single=True)


_OFFSET = Signature(("r",), ("delta", "chamfer"), (("delta", ("r",)), ("chamfer", ("r",))))


@node("offset", takes=_OFFSET)
def offset(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Move the outlines of the children outwards, or inwards for a negative distance.

    Corners are round with `r`, and mitred or chamfered with `delta`.
    """
    arguments = run.arguments(owner)
    figure = union_of(owner, run.figures(owner, children), run)
    if not isinstance(figure, Region):
        return None
    is_round = "r" in arguments or "delta" not in arguments
    delta = arguments.number("r", 1.0) if is_round else arguments.number("delta")
    if figure.is_empty or delta == 0:
        return figure
    sides = arguments.sides(Fineness.of(arguments).fragments(abs(delta)), "a corner")
    figure = openscad_union(run.parts_of(figure)) if _is_combined(owner) else figure
    if figure.is_empty:
        return figure
    refuse_far(figure, delta)
    return offset_outline(figure, delta, _join(is_round, arguments), sides)


@node("fill")
def fill(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return the children's union without holes."""
    figure = union_of(owner, run.figures(owner, children), run)
    if not isinstance(figure, Region):
        return None
    outer = [loop for loop in figure.to_polygons() if signed_area(loop) > 0]
    return Region(outer, pitch=figure.pitch) if outer else figure


def _is_combined(owner: Node) -> bool:
    """Return True if OpenSCAD cleans a node's outlines, since they are computed from others.

    False means that they come from a single square, circle or polygon.
    """
    while True:
        children = [child for child in owner.children if not child.is_ignored]
        if len(children) != 1:
            return True
        owner = children[0]
        if owner.name not in _GROUPING:
            return owner.name not in _PRIMITIVE


def _join(is_round: bool, arguments: Arguments) -> str:
    if is_round:
        return "round"
    return "square" if arguments.flag("chamfer") else "miter"
