"""Solids from plane figures: linear_extrude and rotate_extrude."""

from dataclasses import dataclass

import numpy as np

from ..._types import FloatArray, IndexArray
from ...bsp import Region
from ...geometry.polygon import directed_edges, triangulate
from ...geometry.transform import cos_sin
from ...mesh.weld import welded
from ...shapes.primitives import from_arrays
from ...solid.solid import Solid
from ..making.tessellation import Fineness
from ..syntax.arguments import Arguments
from ..syntax.tree import Node
from .registry import Evaluation, Geometry, node
from .sets import union_of

#: Diagonals whose lengths differ by less than this part are equal.
_EQUAL = 1e-5


@dataclass(frozen=True)
class _Sweep:
    """How the figure changes from the lower to the upper end."""

    height: float
    base: float
    twist: float
    scale: tuple[float, float]
    slices: int

    def section(self, points: FloatArray, slice_number: int) -> FloatArray:
        """Return the points of a level, 0 being the lower end."""
        part = slice_number / self.slices
        cosine, sine = cos_sin(-self.twist * part)
        x, y = points.T
        scale = [1 - (1 - end) * part for end in self.scale]
        turned = np.column_stack([x * cosine - y * sine, x * sine + y * cosine])
        return np.column_stack([turned * scale, np.full(len(points), self._level(part))])

    def _level(self, part: float) -> float:
        return self.base + self.height * part


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
    sweep = _sweep(arguments, figure, height)
    if sweep.twist == 0 and sweep.scale == (1.0, 1.0):
        return figure.extrude(height, center=arguments.flag("center"))
    return _swept(figure, sweep)


def _figure(
    arguments: Arguments, owner: Node, children: list[Geometry], run: Evaluation
) -> Region | None:
    if "file" in arguments:
        message = "the argument file is not supported; put an import() among the children."
        raise arguments.error(message, "unsupported")
    figure = union_of(owner, children, run)
    if isinstance(figure, Solid):
        run.warn(owner, "its children are solids; they are ignored")
        return None
    return figure


def _sweep(arguments: Arguments, figure: Region, height: float) -> _Sweep:
    direction = arguments.vector("v", 3, (0.0, 0.0, 1.0))
    if direction[:2] != (0, 0) or direction[2] <= 0:
        raise arguments.error("only v = [0, 0, 1] is supported.", "unsupported")
    x, y = arguments.vector("scale", 2, (1.0, 1.0))
    twist, scale = arguments.number("twist", 0.0), (max(x, 0.0), max(y, 0.0))
    slices = _slices(arguments, np.concatenate(figure.to_polygons()), height, twist, scale)
    base = -height / 2 if arguments.flag("center") else 0.0
    return _Sweep(height, base, twist, scale, slices)


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


def _swept(figure: Region, sweep: _Sweep) -> Solid:
    loops = figure.to_polygons()
    points = np.concatenate(loops)
    holes = np.concatenate([np.full(len(o.points), o.is_hole) for o in figure.outlines])
    levels = [sweep.section(points, k) for k in range(sweep.slices + 1)]
    edges = directed_edges(loops)
    bands = [
        _band(levels[k], levels[k + 1], edges, holes, sweep) + k * len(points)
        for k in range(sweep.slices)
    ]
    cap = triangulate(loops)
    faces = [cap[:, ::-1], *bands, cap + sweep.slices * len(points)]
    return _closed(np.concatenate(levels), np.concatenate(faces), crossing=sweep.twist != 0)


def _band(
    low: FloatArray, high: FloatArray, edges: IndexArray, holes: FloatArray, sweep: _Sweep
) -> IndexArray:
    """Return the triangles between two levels, each quadrilateral cut along its shorter diagonal.

    Where the diagonals are equal, the direction of the twist and whether the edge belongs to a hole
    decide; below an end without area the other diagonal is taken.
    """
    start, end = edges.T
    up, down = (
        np.linalg.norm((a - b)[:, :2], axis=1)
        for a, b in ((low[start], high[end]), (low[end], high[start]))
    )
    equal = 2 * np.abs(up - down) <= _EQUAL * (up + down)
    flipped = np.asarray(holes[start], dtype=bool) ^ (sweep.twist <= 0)
    rising = np.where(equal, ~flipped, up < down)
    if _is_flat(high):
        rising = ~rising
    above = len(low)
    first = np.column_stack([start, end, np.where(rising, end, start) + above])
    second = np.column_stack([np.where(rising, start, end), end + above, start + above])
    return np.concatenate([first, second])


def _is_flat(level: FloatArray) -> bool:
    return bool((np.ptp(level[:, :2], axis=0) == 0).any())


def _closed(vertices: FloatArray, faces: IndexArray, *, crossing: bool) -> Solid:
    """Return the solid of a mesh in which corners may coincide, and faces may cross or not."""
    points, same = welded(vertices)
    triangles = same[faces]
    proper = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    kept = np.ascontiguousarray(triangles[proper])
    return Solid(points, kept) if crossing else from_arrays(points, kept)


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
    segments = max(int(around * abs(angle) / 360), 1)
    arguments.limited(segments * sum(map(len, figure.to_polygons())), "this turn")
    return _turned(figure, angle, segments, left < 0)


def _turned(figure: Region, angle: float, segments: int, is_left: bool) -> Solid:
    right = figure.mirror((1, 0)) if is_left else figure
    solid = right.revolve(angle=abs(angle), segments=segments)
    solid = solid.mirror((0, 1, 0)) if angle < 0 else solid
    return solid.rotate(180) if is_left != (angle == 360) else solid
