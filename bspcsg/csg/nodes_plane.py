"""Figures of the plane: square, circle, polygon, offset."""

from typing import Any

import numpy as np

from .._types import FloatArray
from ..bsp import Region
from ..interop import optional
from ..sweep import unit_circle
from .arguments import Arguments
from .nodes_set import union_of
from .registry import Evaluation, Geometry, node
from .tessellation import Fineness
from .tree import Node

#: Mitred corners may reach this many times the distance: as far as they like.
_MITER_LIMIT = 1e6

#: Coordinates are brought near this; pyclipper counts in whole numbers of 64 bits.
_OFFSET_REACH = 2.0**40


@node("square")
def square(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Make a rectangle; a side of length 0 or less leaves it empty."""
    del children
    arguments = run.arguments(owner, ("size", "center"))
    width, height = arguments.vector("size", 2, (1.0, 1.0))
    if min(width, height) <= 0:
        return Region.empty()
    return Region.rectangle(width, height, center=arguments.flag("center"))


@node("circle")
def circle(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Make a regular polygon with its first corner on the x axis."""
    del children
    arguments = run.arguments(owner, ("r",))
    r = arguments.number("d") / 2 if "d" in arguments else arguments.number("r", 1.0)
    if r <= 0:
        return Region.empty()
    sides = arguments.limited(Fineness.of(arguments).fragments(r), "this circle")
    return Region(unit_circle(sides) * r)


@node("polygon")
def polygon(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Make what is inside an odd number of times of one path around all points, or of `paths`."""
    del children
    arguments = run.arguments(owner, ("points", "paths"))
    points = np.array(arguments.points("points", 2)).reshape(-1, 2)
    loops = [points[path] for path in _paths(arguments, len(points)) if len(path) >= 3]
    return Region(loops, winding="even-odd")


def _paths(arguments: Arguments, count: int) -> list[list[int]]:
    if "paths" not in arguments or arguments.value("paths") == ():
        return [list(range(count))]
    return arguments.index_lists("paths", count, single=True)


@node("offset")
def offset(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Grow or shrink the children, with round (`r`), mitred or chamfered (`delta`) corners."""
    arguments = run.arguments(owner, ("r",))
    figure = union_of(owner, children, run)
    if figure is None:
        return None
    if not isinstance(figure, Region):
        raise arguments.error("its children must be plane figures.")
    is_round = "delta" not in arguments
    delta = arguments.number("r", 1.0) if is_round else arguments.number("delta")
    if figure.is_empty or delta == 0:
        return figure
    sides = arguments.limited(Fineness.of(arguments).fragments(abs(delta)), "a corner")
    clipper = optional("pyclipper", "2d")
    join = _join(clipper, is_round, arguments)
    return _offset(clipper, figure, delta, join, sides)


def _join(clipper: Any, is_round: bool, arguments: Arguments) -> Any:
    if is_round:
        return clipper.JT_ROUND
    return clipper.JT_SQUARE if arguments.flag("chamfer") else clipper.JT_MITER


def _offset(clipper: Any, figure: Region, delta: float, join: Any, sides: int) -> Region:
    loops = figure.to_polygons()
    scale = _scale(loops, delta)
    # This tolerance makes Clipper step by a whole circle's sides.
    tolerance = abs(delta) * scale * (1 - np.cos(np.pi / sides))
    pen = clipper.PyclipperOffset(_MITER_LIMIT, tolerance)
    pen.AddPaths(
        [np.rint(loop * scale).astype(int).tolist() for loop in loops],
        join,
        clipper.ET_CLOSEDPOLYGON,
    )
    paths = pen.Execute(delta * scale)
    return Region([np.array(path) / scale for path in paths], pitch=figure.pitch)


def _scale(loops: list[FloatArray], delta: float) -> float:
    """Return the power of two that brings coordinates near the reach of whole numbers."""
    largest = max(float(np.abs(loop).max()) for loop in loops) + abs(delta)
    return float(2.0 ** np.floor(np.log2(_OFFSET_REACH / largest)))
