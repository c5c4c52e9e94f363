"""Solids from plane figures: linear_extrude and rotate_extrude."""

import numpy as np

from ..._types import FloatArray
from ...bsp import Region
from ...shapes.profile import least_segments
from ...solid.solid import Solid
from ..making.tessellation import Fineness
from ..syntax.arguments import Arguments
from ..syntax.tree import Node
from .files import drawing_of
from .registry import Evaluation, Geometry, node
from .sets import union_of


@node("linear_extrude")
def linear_extrude(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Extrude the children along z, turned (`twist`) and scaled on the way up."""
    arguments = run.arguments(owner, ("height", "center"))
    figure = _figure(arguments, owner, children, run)
    height = arguments.number("height", 100.0)
    if figure is None:
        return None
    if figure.is_empty or height <= 0:
        return Solid.empty()
    return _extruded(arguments, figure, height)


def _figure(
    arguments: Arguments, owner: Node, children: list[Geometry], run: Evaluation
) -> Region | None:
    if "file" in arguments and not owner.children:
        return drawing_of(owner, arguments, run)
    figure = union_of(owner, run.figures(owner, children), run)
    return figure if isinstance(figure, Region) else None


def _extruded(arguments: Arguments, figure: Region, height: float) -> Solid:
    direction = arguments.vector("v", 3, (0.0, 0.0, 1.0))
    if direction[:2] != (0, 0) or direction[2] <= 0:
        raise arguments.error("only v = [0, 0, 1] is supported.", "unsupported")
    x, y = arguments.vector("scale", 2, (1.0, 1.0))
    twist, scale = arguments.number("twist", 0.0), (max(x, 0.0), max(y, 0.0))
    slices = _slices(arguments, np.concatenate(figure.to_polygons()), height, twist, scale)
    center = arguments.flag("center")
    return figure.extrude(height, center=center, twist=twist, scale=scale, slices=slices)


def _slices(
    arguments: Arguments,
    points: FloatArray,
    height: float,
    twist: float,
    scale: tuple[float, float],
) -> int:
    count = 1.0
    fineness = Fineness.of(arguments)
    shift = float(np.linalg.norm(points * (1 - np.array(scale)), axis=1).max())
    reach = float(np.linalg.norm(points, axis=1).max())
    if "slices" in arguments:
        count = max(np.floor(arguments.number("slices")), 1)
    elif twist != 0:
        # A twist with unequal scales counts as an unscaled one.
        equal = scale[0] if scale[0] == scale[1] else 1.0
        count = fineness.twist_slices(reach, height, twist, equal)
    elif scale[0] != scale[1]:
        count = fineness.taper_slices(shift, height)
    arguments.limited(count * len(points), "this extrusion")
    return int(count)


@node("rotate_extrude")
def rotate_extrude(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Turn the children around the z axis, their x axis pointing away from it.

    A full turn of what lies at x >= 0 starts on the negative x axis, as in OpenSCAD.
    """
    arguments = run.arguments(owner, ("angle",))
    figure = _figure(arguments, owner, children, run)
    if figure is None:
        return None
    angle = arguments.number("angle", 360.0)
    angle = 360.0 if angle <= -360 or angle > 360 else angle
    bounds = figure.bounds
    if bounds is None or angle == 0:
        return Solid.empty()
    (left, _), (right, _) = bounds.tolist()
    if left < 0 < right:
        message = f"its children must not cross the axis: x runs from {left:g} to {right:g}."
        raise arguments.error(message)
    around = arguments.sides(Fineness.of(arguments).fragments(max(right, -left)), "this turn")
    segments = max(int(around * abs(angle) / 360), least_segments(angle))
    arguments.limited(segments * sum(map(len, figure.to_polygons())), "this turn")
    return _turned(figure, angle, segments, left < 0)


def _turned(figure: Region, angle: float, segments: int, is_left: bool) -> Solid:
    right = figure.mirror((1, 0)) if is_left else figure
    solid = right.revolve(angle=abs(angle), segments=segments)
    solid = solid.mirror((0, 1, 0)) if angle < 0 else solid
    return solid.rotate(180) if is_left != (angle == 360) else solid
