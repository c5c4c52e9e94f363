"""Figures grown and shrunk by pyclipper, as OpenSCAD does it."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..._types import FloatArray
from ...bsp import Region
from ...errors import InvalidMeshError
from ...mesh.interop import optional
from ..syntax.tree import Node

#: Mitred corners may reach this many times the distance: as far as they like.
_MITER_LIMIT = 1e6

#: Coordinates are brought near this; pyclipper counts in whole numbers of 64 bits.
_REACH = 2.0**40

#: OpenSCAD 2021.01 rounds the corners of figures that it combines to this part of a unit.
_GRID = 2.0**16

#: It joins corners of the result closer than this, and drops those as close to a line, in units.
_CLEANED = 0.001

#: Nodes that hand down an only child as it is.
_PASSING = frozenset({"group", "union", "color", "render", "multmatrix", "resize", "difference",
                      "intersection"})  # fmt: skip

#: Figures that are as the script has them.
_PRIMITIVE = frozenset({"square", "circle", "polygon"})


def is_combined(owner: Node) -> bool:
    """Whether the figure in a node is made of others, so that OpenSCAD has cleaned it."""
    while True:
        children = [child for child in owner.children if not child.is_ignored]
        if len(children) != 1:
            return True
        owner = children[0]
        if owner.name not in _PASSING:
            return owner.name not in _PRIMITIVE


def cleaned(figures: Sequence[Region]) -> Region:
    """Return the union of figures as OpenSCAD has it, without the slits and spikes it cleans away.

    Six digits put the sides of turned shapes a hair apart or across each other. To shrink such a
    figure widens the hair to a cut, and to grow it with mitres draws it out to a spike. What is
    left differs from the union by less than a thousandth of a unit.
    """
    clipper = optional("pyclipper", "2d")
    pen = clipper.Pyclipper()
    for figure in figures:
        pen.AddPaths(_whole_numbers(figure.to_polygons(), _GRID), clipper.PT_SUBJECT)
    paths = pen.Execute(clipper.CT_UNION, clipper.PFT_NONZERO, clipper.PFT_NONZERO)
    kept = [clipper.CleanPolygon(path, _CLEANED * _GRID) for path in paths]
    loops = [np.array(path) / _GRID for path in kept if len(path) >= 3]
    return Region(loops, pitch=min(figure.pitch for figure in figures))


def grown(figure: Region, delta: float, join: str, sides: int) -> Region:
    """Return a figure with its outline moved outwards by `delta`, or inwards if that is negative.

    Parameters
    ----------
    figure : Region
        Not empty.
    delta : float
    join : {"round", "square", "miter"}
        What corners become.
    sides : int
        Of a full circle, for round corners.
    """
    clipper = optional("pyclipper", "2d")
    loops = figure.to_polygons()
    scale = _scale(loops, delta)
    # This tolerance makes Clipper step by a whole circle's sides.
    tolerance = abs(delta) * scale * (1 - np.cos(np.pi / sides))
    pen = clipper.PyclipperOffset(_MITER_LIMIT, tolerance)
    kind = getattr(clipper, f"JT_{join.upper()}")
    pen.AddPaths(_whole_numbers(loops, scale), kind, clipper.ET_CLOSEDPOLYGON)
    paths = pen.Execute(delta * scale)
    return Region([np.array(path) / scale for path in paths], pitch=figure.pitch)


def stroked(line: FloatArray, width: float, cap: str) -> Region:
    """Return what a pen draws along a line.

    Parameters
    ----------
    line : (n, 2) float64
    width : float
    cap : {"butt", "square", "round"}
        How its ends look.
    """
    clipper = optional("pyclipper", "2d")
    scale = _scale([line], width)
    pen = clipper.PyclipperOffset()
    ends = getattr(clipper, f"ET_OPEN{cap.upper()}")
    pen.AddPaths(_whole_numbers([line], scale), clipper.JT_MITER, ends)
    return Region([np.array(path) / scale for path in pen.Execute(width / 2 * scale)])


def _whole_numbers(loops: list[FloatArray], scale: float) -> list[Any]:
    if not all(np.isfinite(loop).all() for loop in loops):
        raise InvalidMeshError("A drawing has coordinates that are not finite.", "non_finite")
    return [np.trunc(loop * scale).astype(int).tolist() for loop in loops]


def _scale(loops: list[FloatArray], delta: float) -> float:
    """Return the power of two that brings coordinates near the reach of whole numbers."""
    largest = max(float(np.abs(loop).max()) for loop in loops) + abs(delta)
    return float(2.0 ** np.floor(np.log2(_REACH / largest)))
