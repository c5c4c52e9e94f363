"""Evaluation of the nodes linear_extrude, rotate_extrude and roof."""

import math

import numpy as np

from ..._types import FloatArray
from ...bsp import Region
from ...modelling.making import roofs
from ...shapes.profile import extrude, least_segments
from ...solid.solid import Solid
from ..making.edge_subdivision import TwistAndScale, divided_outline
from ..making.tessellation import Fineness
from ..syntax.arguments import Arguments
from ..syntax.tree import Node
from .files import drawing_of
from .registry import Evaluation, Geometry, node
from .set_operations import union_of
from .signature import Signature

#: Arguments of extrusions in scripts from before 2013, which name the file of a drawing.
_DRAWING = ("file", "layer", "origin", "timestamp")

_LINEAR = Signature(
    ("height", "v", "scale", "center", "twist", "slices", "segments"),
    ("h", *_DRAWING),
    (("h", ("height",)),),
)

_ROTATE = Signature(("angle", "start"), ("a", "scale", *_DRAWING), (("a", ("angle",)),))


@node("linear_extrude", takes=_LINEAR)
def linear_extrude(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Extrude the children along z or the vector `v`, with `twist` and `scale`."""
    arguments = run.arguments(owner)
    figure = _figure(arguments, owner, children, run)
    vector = _extrusion_vector(arguments)
    if figure is None:
        return None
    if figure.is_empty or vector[2] == 0:
        return Solid.empty()
    return _sheared(_extruded(arguments, figure, abs(vector[2])), vector)


def _extrusion_vector(arguments: Arguments) -> tuple[float, float, float]:
    """Return the vector from the lower to the upper end of an extrusion.

    It is `v`, scaled to the length `height` if both are given, else (0, 0, height). A negative
    height counts as 0, as in OpenSCAD 2021.01; later versions write it as a `v` that points
    downwards.
    """
    name = "height" if "height" in arguments else "h"
    if "v" not in arguments:
        return 0.0, 0.0, max(arguments.number(name, 100.0), 0.0)
    x, y, z = arguments.vector("v", 3)
    if name not in arguments:
        return x, y, z
    # A zero vector stays zero.
    length = math.hypot(x, y, z) or 1.0
    height = max(arguments.number(name), 0.0)
    return x / length * height, y / length * height, z / length * height


def _sheared(upright: Solid, vector: tuple[float, float, float]) -> Solid:
    """Shear an upright extrusion so that its top is displaced by a vector.

    The length of the vector along z is the height; if it points down, the solid is mirrored.
    """
    x, y, z = vector
    if z < 0:
        upright = upright.mirror((0, 0, 1))
    if x == 0 and y == 0:
        return upright
    return upright.transform([[1, 0, x / z, 0], [0, 1, y / z, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


def _figure(
    arguments: Arguments, owner: Node, children: list[Geometry], run: Evaluation
) -> Region | None:
    if "file" in arguments and not owner.children:
        return drawing_of(owner, arguments, run)
    figure = union_of(owner, run.figures(owner, children), run)
    return figure if isinstance(figure, Region) else None


def _extruded(arguments: Arguments, figure: Region, height: float) -> Solid:
    x, y = arguments.vector("scale", 2, (1.0, 1.0))
    twist, scale = arguments.number("twist", 0.0), (max(x, 0.0), max(y, 0.0))
    outlines = figure.to_polygons()
    slices = _slices(arguments, np.concatenate(outlines), height, twist, scale)
    stretch = TwistAndScale(twist, scale, slices)
    shape = figure if stretch.is_even else _segmented(arguments, outlines, stretch)
    center = arguments.flag("center")
    return extrude(shape, height, center=center, twist=twist, scale=scale, slices=slices)


def _segmented(
    arguments: Arguments, outlines: list[FloatArray], stretch: TwistAndScale
) -> list[FloatArray]:
    """Return the outlines with edges divided, so that each outline has up to `segments` edges."""
    wanted = arguments.number("segments", 0.0)
    arguments.limited(wanted * len(outlines) * (stretch.slices + 1), "this extrusion")
    return [
        outline if len(outline) >= wanted else divided_outline(outline, int(wanted), stretch)
        for outline in outlines
    ]


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
        # With unequal scales, count the slices as without scale.
        equal = scale[0] if scale[0] == scale[1] else 1.0
        count = fineness.twist_slices(reach, height, twist, equal)
    elif scale[0] != scale[1]:
        count = fineness.taper_slices(shift, height)
    arguments.limited(count * len(points), "this extrusion")
    return int(count)


@node("rotate_extrude", takes=_ROTATE)
def rotate_extrude(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Revolve the children around the z axis; their x becomes the distance from the axis.

    The solid starts at the angle `start`. By default a full turn starts on the negative x axis, and
    any other turn on the positive x axis, as in OpenSCAD 2021.01.
    """
    arguments = run.arguments(owner)
    figure = _figure(arguments, owner, children, run)
    if figure is None:
        return None
    angle = arguments.number("angle" if "angle" in arguments else "a", 360.0)
    angle = 360.0 if angle <= -360 or angle > 360 else angle
    bounds = figure.bounds
    if bounds is None or angle == 0:
        return Solid.empty()
    (left, _), (right, _) = bounds.tolist()
    if left < 0 < right:
        message = (
            "its 2D children must lie on one side of the rotation axis x = 0, but extend from x ="
            f" {left:g} to {right:g}."
        )
        raise arguments.error(message)
    around = arguments.sides(Fineness.of(arguments).fragments(max(right, -left)), "this turn")
    segments = max(int(around * abs(angle) / 360), least_segments(angle))
    arguments.limited(segments * sum(map(len, figure.to_polygons())), "this turn")
    start = arguments.number("start", 180.0 if angle == 360 else 0.0)
    return _revolved(figure, angle, segments, start + 180 if left < 0 else start)


def _revolved(figure: Region, angle: float, segments: int, start: float) -> Solid:
    """Revolve a figure on one side of the y axis by an angle, in `segments` steps.

    The side away from the axis starts at the angle `start`, in degrees.
    """
    bounds = figure.bounds
    right = figure.mirror((1, 0)) if bounds is not None and bounds[0, 0] < 0 else figure
    solid = right.revolve(angle=abs(angle), segments=segments)
    solid = solid.mirror((0, 1, 0)) if angle < 0 else solid
    return solid.rotate(start % 360) if start % 360 else solid


@node("roof", takes=Signature(("method",)))
def roof(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Build a roof over the children, with a slope of 45 degrees on all sides.

    If there are reflex corners, the method "voronoi" would give a curved roof, and is refused;
    otherwise both methods give the same roof.
    """
    arguments = run.arguments(owner)
    figure = union_of(owner, run.figures(owner, children), run)
    if not isinstance(figure, Region):
        return None
    method = arguments.text("method", "voronoi")
    if method not in ("voronoi", "straight"):
        run.warn(
            owner,
            f"its method “{method}” is unknown (known are voronoi and straight); voronoi is"
            " used instead",
        )
    if method != "straight" and not roofs.is_convex(figure):
        message = (
            "method “voronoi” is not supported for figures with concave corners, where its"
            " roof would be curved; use method “straight”."
        )
        raise arguments.error(message, "unsupported")
    return roofs.roof(figure)
