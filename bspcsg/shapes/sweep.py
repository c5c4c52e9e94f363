"""Surfaces of revolution as arrays of vertices and faces."""

import math

import numpy as np

from .._types import FloatArray, IndexArray


def unit_circle(count: int) -> FloatArray:
    """Return (count, 2) points of the unit circle, counter-clockwise from (1, 0).

    Points that are mirror images in the axes or diagonals have equal coordinates, except for signs
    and order.
    """
    return np.array([_on_circle(index, count) for index in range(count)])


def _on_circle(index: int, count: int) -> tuple[float, float]:
    quarter, rest = divmod(4 * index, count)
    if 2 * rest > count:
        y, x = _cos_sin_of_quarter(count - rest, count)
    else:
        x, y = _cos_sin_of_quarter(rest, count)
    x, y = ((x, y), (-y, x), (-x, -y), (y, -x))[quarter]
    return x + 0.0, y + 0.0  # no negative zeros


def _cos_sin_of_quarter(part: int, count: int) -> tuple[float, float]:
    if 2 * part == count:
        return math.sqrt(0.5), math.sqrt(0.5)
    angle = math.pi / 2 * part / count
    # A third of a quarter turn is 30 degrees, whose sine is exactly 0.5.
    return math.cos(angle), 0.5 if 3 * part == count else math.sin(angle)


def surface_of_revolution(
    profile: FloatArray, segments: int, *, closed: bool
) -> tuple[FloatArray, IndexArray]:
    """Return the mesh of the surface that a curve sweeps around the z axis in a full turn.

    Parameters
    ----------
    profile : (n, 2) float64
        Points as distance from the axis, never negative, and height. The inside is on the left.
    segments : int
        Number of sides around the axis.
    closed : bool
        True if the last point is joined to the first.

    Returns
    -------
    vertices : (k, 3) float64
        The vertices of each profile point in turn: one for a point on the axis, otherwise
        `segments`.
    faces : (m, 3) int64
        Triangles, counter-clockwise seen from outside. The surface has a hole where an open profile
        ends off the axis.
    """
    rings = RingLayout(profile, segments)
    faces = [
        _band(rings.ring(start), rings.ring(end))
        for start, end in profile_edges(len(profile), closed=closed)
    ]
    return rings.vertices(unit_circle(segments)), np.concatenate(faces)


class RingLayout:
    """The numbering of the vertices of a surface of revolution, one profile point after another.

    Parameters
    ----------
    profile : (n, 2) float64
    columns : int
        The number of positions around the axis for each profile point.
    """

    def __init__(self, profile: FloatArray, columns: int) -> None:
        self._profile = profile
        self._columns = columns
        sizes = np.where(profile[:, 0] == 0, 1, columns)
        self._starts = np.concatenate([[0], np.cumsum(sizes)])

    def ring(self, point: int) -> IndexArray:
        """Return the vertex numbers of a profile point, (columns,); all equal on the axis."""
        start, end = self._starts[point : point + 2]
        return np.resize(np.arange(start, end), self._columns)

    def vertices(self, directions: FloatArray) -> FloatArray:
        """Return all vertices, (k, 3), given unit vectors around the axis, (columns, 2)."""
        parts = []
        for radius, height in self._profile:
            around = directions * radius if radius else np.zeros((1, 2))
            parts.append(np.column_stack([around, np.full(len(around), height)]))
        return np.concatenate(parts)


def profile_edges(count: int, *, closed: bool) -> list[tuple[int, int]]:
    """Return the edges between consecutive points of a profile, as pairs of point numbers."""
    edges = [(index, index + 1) for index in range(count - 1)]
    return [*edges, (count - 1, 0)] if closed else edges


def _band(start: IndexArray, end: IndexArray) -> IndexArray:
    return quad_triangles(start, np.roll(start, -1), end, np.roll(end, -1))


def quad_triangles(a: IndexArray, b: IndexArray, c: IndexArray, d: IndexArray) -> IndexArray:
    """Return two triangles for each quadrilateral a, b, d, c; none with two equal corners."""
    triangles = np.concatenate([np.column_stack([a, b, d]), np.column_stack([a, d, c])])
    proper = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    return np.compress(proper, triangles, axis=0)
