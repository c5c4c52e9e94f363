"""Convex bodies in one to three dimensions, cut by hyperplanes in exact fractions.

They are the regions of small trees: all numbers are `Fraction`, so this is slow.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import TypeAlias

import numpy as np

from .._types import FloatArray

#: A point in exact coordinates.
Corner: TypeAlias = tuple[Fraction, ...]

#: The integers (*n, c) of the hyperplane n·x = c, whose minus side has n·x < c.
RowOfCut: TypeAlias = Sequence[int]


def height(point: Corner, row: RowOfCut) -> Fraction:
    """Return n·x - c for a point x and a hyperplane (*n, c): negative on the minus side."""
    return sum((n * x for n, x in zip(row[:-1], point, strict=True)), Fraction(-row[-1]))


def cut_polygon(corners: Sequence[Corner], row: RowOfCut, side: int) -> tuple[Corner, ...]:
    """Return the part of a convex polygon, segment or point on one side of a hyperplane.

    Parameters
    ----------
    corners : sequence of points
        The corners in order; two for a segment, one for a point.
    row : sequence of int
    side : {-1, 1}

    Returns
    -------
    tuple of points
        The corners of the part; empty if no point lies strictly on this side.
    """
    heights = [side * height(corner, row) for corner in corners]
    if max(heights, default=Fraction(0)) <= 0:
        return ()
    kept: list[Corner] = []
    steps = zip(
        corners, heights, [*corners[1:], corners[0]], [*heights[1:], heights[0]], strict=True
    )
    for here, low, there, high in steps:
        if low >= 0:
            kept.append(here)
        if (low < 0 < high) or (high < 0 < low):
            share = low / (low - high)
            kept.append(tuple(a + share * (b - a) for a, b in zip(here, there, strict=True)))
    return tuple(dict.fromkeys(kept))


@dataclass(frozen=True)
class Polytope:
    """A bounded convex body with an interior: an interval, a polygon or a polyhedron.

    Parameters
    ----------
    dimension : int
    faces : tuple of tuples of points
        In 1D the two ends, the lesser first; in 2D one tuple with the corners counterclockwise; in
        3D the faces, each counterclockwise seen from outside.
    """

    dimension: int
    faces: tuple[tuple[Corner, ...], ...]

    @classmethod
    def box(cls, low: Sequence[int], high: Sequence[int]) -> "Polytope":
        """Return the box between two corners; `low` must be less than `high` on each axis."""
        if len(low) == 1:
            return cls(1, ((_point(low),), (_point(high),)))
        if len(low) == 2:
            (x, y), (u, v) = low, high
            return cls(2, (tuple(map(_point, ((x, y), (u, y), (u, v), (x, v)))),))
        return cls(3, tuple(_box_face(low, high, axis, end) for axis in range(3) for end in (0, 1)))

    @property
    def corners(self) -> tuple[Corner, ...]:
        """All corners of the body, each once."""
        return tuple(dict.fromkeys(corner for face in self.faces for corner in face))

    def clipped(self, row: RowOfCut, side: int) -> "Polytope | None":
        """Return the part on one side (-1 or 1) of a hyperplane; None if it has no interior."""
        heights = [side * height(corner, row) for corner in self.corners]
        if max(heights) <= 0:
            return None
        if min(heights) >= 0:
            return self
        if self.dimension == 1:
            at = (Fraction(row[1], row[0]),)
            low, high = self.faces
            rising = side * row[0] > 0
            return Polytope(1, ((at,), high) if rising else (low, (at,)))
        if self.dimension == 2:
            return Polytope(2, (cut_polygon(self.faces[0], row, side),))
        parts = tuple(part for face in self.faces if (part := cut_polygon(face, row, side)))
        rim = dict.fromkeys(p for part in parts for p in part if height(p, row) == 0)
        return Polytope(3, (*parts, _ring(list(rim), row, side)))

    @property
    def measure(self) -> Fraction:
        """The exact length, area or volume of the body."""
        if self.dimension == 1:
            return self.faces[1][0][0] - self.faces[0][0][0]
        if self.dimension == 2:
            return _area2(self.faces[0]) / 2
        apex = self.faces[0][0]
        return sum((_cone6(face, apex) for face in self.faces), Fraction(0)) / 6

    def shape(self, unit: float) -> FloatArray | list[FloatArray]:
        """Return the faces as doubles times `unit`, in the form of `PartitionTree.region`."""
        arrays = [
            np.array([[float(x) * unit for x in corner] for corner in face]) for face in self.faces
        ]
        if self.dimension == 1:
            return np.concatenate(arrays).ravel()
        return arrays[0] if self.dimension == 2 else arrays


def _point(coordinates: Sequence[int]) -> Corner:
    return tuple(map(Fraction, coordinates))


def _box_face(low: Sequence[int], high: Sequence[int], axis: int, end: int) -> tuple[Corner, ...]:
    u, v = (axis + 1) % 3, (axis + 2) % 3
    corners = []
    for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
        corner = [0, 0, 0]
        corner[axis], corner[u], corner[v] = (
            (low, high)[end][axis],
            (low, high)[a][u],
            (low, high)[b][v],
        )
        corners.append(_point(corner))
    return tuple(corners if end else reversed(corners))


def _ring(points: list[Corner], row: RowOfCut, side: int) -> tuple[Corner, ...]:
    """Return the corners of a convex face in order, counterclockwise seen from the removed side."""
    axis = max(range(3), key=lambda k: abs(row[k]))
    u, v = (axis + 1) % 3, (axis + 2) % 3
    count = len(points)
    middle = [sum((p[k] for p in points), Fraction(0)) / count for k in (u, v)]
    arms = {p: (p[u] - middle[0], p[v] - middle[1]) for p in points}
    above = [p for p in points if arms[p][1] > 0 or (arms[p][1] == 0 and arms[p][0] > 0)]
    below = [p for p in points if p not in set(above)]
    ordered = _turned(above, arms) + _turned(below, arms)
    # Counterclockwise about the axis, because the face points to the side that was cut off.
    outwards = -side * row[axis]
    return tuple(ordered if outwards > 0 else reversed(ordered))


def _turned(points: list[Corner], arms: dict[Corner, tuple[Fraction, Fraction]]) -> list[Corner]:
    """Return points sorted counterclockwise by the angles of their vectors `arms`, exactly.

    All vectors must lie within a half-plane.
    """
    ordered: list[Corner] = []
    for point in points:
        x, y = arms[point]
        place = sum(arms[other][0] * y - arms[other][1] * x > 0 for other in ordered)
        ordered.insert(place, point)
    return ordered


def _area2(corners: Sequence[Corner]) -> Fraction:
    pairs = zip(corners, [*corners[1:], corners[0]], strict=True)
    return sum((a[0] * b[1] - a[1] * b[0] for a, b in pairs), Fraction(0))


def _cone6(face: Sequence[Corner], apex: Corner) -> Fraction:
    arms = [tuple(x - y for x, y in zip(corner, apex, strict=True)) for corner in face]
    total = Fraction(0)
    for (a, b, c), (d, e, f) in pairwise(arms[1:]):
        x, y, z = arms[0]
        total += x * (b * f - c * e) - y * (a * f - c * d) + z * (a * e - b * d)
    return total
