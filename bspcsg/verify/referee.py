"""The referee: settles where two engines disagree by exact counts of crossings.

It decides whether a point is inside the operands by counting, in integers, how a ray from the point
crosses their triangles. It shares no code with the core.
"""

from collections.abc import Sequence
from enum import Enum
from math import lcm

import numpy as np

from .._types import FloatArray, ProgramLine
from ..mesh.mesh import Mesh
from ..mesh.pieces import Point
from ..solid.program import TRUTH


class Ruling(Enum):
    """The engine that is right at all points that exact counts of crossings decide, or unclear."""

    OURS = "ours"
    THEIRS = "theirs"
    UNCLEAR = "unclear"


def settle(
    program: Sequence[ProgramLine],
    operands: Sequence[Mesh],
    ours: Mesh,
    theirs: Mesh,
    pieces: Sequence[Sequence[Point]],
) -> Ruling:
    """Decide which of two results is right in every piece of their symmetric difference.

    Parameters
    ----------
    program : sequence of (str, list of int)
    operands : sequence of Mesh
        The operands; a point is inside one if its winding number is positive.
    ours, theirs : Mesh
    pieces : sequence of sequences of points
        Points for each piece of the difference, at least one of which should be inside it.
    """
    rulings = {_settled_piece(program, operands, ours, theirs, points) for points in pieces}
    return rulings.pop() if len(rulings) == 1 else Ruling.UNCLEAR


def count_agreeing(
    program: Sequence[ProgramLine],
    operands: Sequence[Mesh],
    ours: Mesh,
    points: Sequence[Point],
) -> tuple[int, int]:
    """Return at how many points our result is right, and the number of points that were decided."""
    agreeing = settled = 0
    for point in points:
        inside = is_inside(ours, point)
        found = [is_inside(operand, point) for operand in operands]
        known = [each for each in found if each is not None]
        if inside is not None and len(known) == len(found):
            settled += 1
            agreeing += TRUTH.evaluate(program, known) == inside
    return agreeing, settled


def _settled_piece(
    program: Sequence[ProgramLine],
    operands: Sequence[Mesh],
    ours: Mesh,
    theirs: Mesh,
    points: Sequence[Point],
) -> Ruling:
    for point in points:
        in_ours, in_theirs = is_inside(ours, point), is_inside(theirs, point)
        if in_ours is None or in_theirs is None or in_ours == in_theirs:
            continue
        found = [is_inside(operand, point) for operand in operands]
        known = [inside for inside in found if inside is not None]
        if len(known) == len(found):
            return Ruling.OURS if TRUTH.evaluate(program, known) == in_ours else Ruling.THEIRS
    return Ruling.UNCLEAR


def is_inside(mesh: Mesh, point: Point) -> bool | None:
    """Return whether a point's winding number is positive; None if each axis ray grazes an edge."""
    return RayClassifier(mesh).is_inside(point)


class RayClassifier:
    """A mesh prepared to classify many points by rays along the axes.

    Parameters
    ----------
    mesh : Mesh
    """

    def __init__(self, mesh: Mesh) -> None:
        self._mesh = mesh
        self._extents: dict[int, tuple[FloatArray, FloatArray]] = {}

    def is_inside(self, point: Point) -> bool | None:
        """Return whether a point's winding number is positive; None if all axis rays meet edges."""
        for axis in range(3):
            winding = self._winding_along(point, axis)
            if winding is not None:
                return winding > 0
        return None

    def _winding_along(self, point: Point, axis: int) -> int | None:
        """Return a point's winding number by a ray along an axis; None if it touches an edge."""
        order = [axis, (axis + 1) % 3, (axis + 2) % 3]
        start = [point[k] for k in order]
        winding = 0
        for triangle in self._met(point, order):
            crossing = _crossing(triangle, start)
            if crossing is None:
                return None
            winding += crossing
        return winding

    def _met(self, point: Point, order: list[int]) -> FloatArray:
        """Return the (k, 3, 3) corners, axes reordered, of triangles whose boxes a ray meets."""
        across, other = order[1:]
        low, high = self._extent(across)
        near = np.flatnonzero((low <= point[across]) & (high >= point[across]))
        corners = self._mesh.vertices[self._mesh.faces[near]][:, :, order]
        at = np.array([point[k] for k in order])
        low, high = corners[:, :, 2].min(axis=1), corners.max(axis=1)
        met: FloatArray = corners[(low <= point[other]) & (high >= at).all(axis=1)]
        return met

    def _extent(self, axis: int) -> tuple[FloatArray, FloatArray]:
        """Return the least and the greatest coordinate of each triangle along an axis, (m,)."""
        if axis not in self._extents:
            a, b, c = self._mesh.vertices[:, axis][self._mesh.faces.T]
            lowest, highest = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
            self._extents[axis] = lowest, highest
        return self._extents[axis]


def _crossing(triangle: FloatArray, start: list[float]) -> int | None:
    """Return 1 if the ray leaves through the triangle, -1 if it enters, 0 if not, None if unclear.

    Unclear is a ray that meets an edge or starts on the triangle.
    """
    numbers = _whole([*triangle.ravel().tolist(), *start])
    a, b, c, ray = (numbers[k : k + 3] for k in range(0, 12, 3))
    areas = [_doubled_area(b, c, ray), _doubled_area(c, a, ray), _doubled_area(a, b, ray)]
    if min(areas) < 0 < max(areas):
        return 0
    if 0 in areas:
        return None
    whole = sum(areas)
    # The signed distance along the ray to the triangle's plane, times `whole`.
    ahead = sum(area * (p[0] - ray[0]) for area, p in zip(areas, (a, b, c), strict=True))
    if ahead == 0:
        return None
    if (ahead > 0) != (whole > 0):
        return 0
    return 1 if whole > 0 else -1


def _whole(numbers: list[float]) -> list[int]:
    """Return doubles as integers, all multiplied by one power of two."""
    ratios = [number.as_integer_ratio() for number in numbers]
    scale = lcm(*(below for _, below in ratios))
    return [above * (scale // below) for above, below in ratios]


def _doubled_area(a: list[int], b: list[int], c: list[int]) -> int:
    """Return twice the signed area of a triangle's projection along the ray."""
    return (b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1])
