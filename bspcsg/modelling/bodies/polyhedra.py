"""Closed meshes with integer coordinates, and exact tests of their face and edge directions."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from ..._types import FloatArray, IndexArray
from ...mesh.mesh import surfaces_of
from .shading import half_edges, unit_vectors

#: An array of Python integers, which cannot overflow.
LongArray: TypeAlias = np.ndarray[Any, np.dtype[np.object_]]

#: An array of truth values.
Mask: TypeAlias = np.ndarray[Any, np.dtype[np.bool_]]

#: A bound of the rounding error of the dot product of two unit vectors in doubles.
_SIGN_ERROR = 2e-15

#: The number of signs of dot products in one batch. Each takes about 10 bytes, and 100 if doubles
#: do not decide it.
_SIGNS_PER_BATCH = 1 << 22

#: The outward faces of a tetrahedron whose corners 1, 2, 3 appear clockwise from corner 0.
_TETRAHEDRON = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])


class Vectors(NamedTuple):
    """Vectors, (n, 3), as exact integers (`exact`) and as rounded unit vectors (`units`)."""

    exact: LongArray
    units: FloatArray

    def at(self, rows: IndexArray | slice) -> "Vectors":
        """Return the vectors at the given row numbers."""
        return Vectors(self.exact[rows], self.units[rows])


class Directions(NamedTuple):
    """Distinct directions (`distinct`), and the row in them for each edge or face (`rows`)."""

    distinct: Vectors
    rows: IndexArray

    def at(self, things: IndexArray) -> Vectors:
        """Return the direction vectors of edges or faces, given their numbers."""
        return self.distinct.at(self.rows[things])


@dataclass(frozen=True, eq=False)
class Polyhedron:
    """A closed triangle mesh with integer points in lattice steps, made by `polyhedron_of`."""

    points: IndexArray
    faces: IndexArray
    normals: Directions

    @cached_property
    def _sides(self) -> tuple[IndexArray, IndexArray]:
        return half_edges(self.faces)

    @cached_property
    def ends(self) -> tuple[IndexArray, IndexArray]:
        """The numbers of the start and end point of each edge."""
        forth, back = self._sides
        return self.faces.ravel()[forth], self.faces.ravel()[back]

    @cached_property
    def adjacent_faces(self) -> tuple[IndexArray, IndexArray]:
        """The faces on the left and right of each edge, seen from outside."""
        forth, back = self._sides
        return forth // 3, back // 3

    @cached_property
    def along(self) -> Directions:
        """The directions of the edges."""
        start, end = self.ends
        return _directions((self.points[end] - self.points[start]).astype(object))

    @cached_property
    def sharp(self) -> IndexArray:
        """The edges between faces of different directions."""
        left, right = self.adjacent_faces
        return np.flatnonzero(self.normals.rows[left] != self.normals.rows[right])

    @cached_property
    def convex(self) -> IndexArray:
        """The sharp edges at which the solid is convex, or whose two faces lie back to back."""
        left, right = (self.normals.at(side[self.sharp]).exact for side in self.adjacent_faces)
        return self.sharp[_dots(_cross(left, right), self.along.at(self.sharp).exact) >= 0]

    @cached_property
    def _leaving(self) -> tuple[IndexArray, IndexArray, IndexArray]:
        """The half-edges sorted by start point, where each point's group begins, and the points.

        Edge e has the half-edges e and e + (number of edges), which run in opposite directions.
        """
        starts = np.concatenate(self.ends)
        order = np.argsort(starts, kind="stable")
        corners, first = np.unique(starts[order], return_index=True)
        return order, first, corners

    def holds(self, point: IndexArray) -> bool:
        """Return True if a point is inside this convex polyhedron or on its surface."""
        away = (point - self.points[self.faces[:, 0]]).astype(object)
        return bool((_dots(self.normals.distinct.exact[self.normals.rows], away) <= 0).all())

    def tops(self, rises: Mask) -> tuple[IndexArray, IndexArray]:
        """Return all pairs of a corner and a direction in which none of the corner's edges rises.

        Parameters
        ----------
        rises : (edges, n) bool
            Whether an edge rises from its start to its end in each of n directions.
        """
        order, first, corners = self._leaving
        leaving = np.concatenate([rises, ~rises])[order]
        row, column = np.nonzero(~np.logical_or.reduceat(leaving, first, axis=0))
        return corners[row], column


def in_steps(points: FloatArray, pitch: int) -> FloatArray:
    """Return coordinates divided by the lattice step, not rounded."""
    steps: FloatArray = points * 10.0**-pitch if pitch < 0 else points / 10.0**pitch
    return steps


def in_units(steps: IndexArray, pitch: int) -> FloatArray:
    """Convert points from lattice steps to model units."""
    points: FloatArray = (
        steps / np.float64(10.0**-pitch) if pitch < 0 else steps * np.float64(10.0**pitch)
    )
    return points


def polyhedron_of(points: IndexArray, faces: IndexArray) -> Polyhedron:
    """Return the polyhedron of a closed mesh, without edges of length zero.

    A face without area gets the normal of a neighbour. A connected surface of only such faces is
    replaced by a tetrahedron one lattice step wide.
    """
    points, faces = _with_wide_shells(points, faces)
    faces = _without_short_edges(points, faces)
    normals = _normals(points, faces)
    kept = _borrow_normals(normals, faces)
    return Polyhedron(points, np.ascontiguousarray(faces[kept]), _directions(normals[kept]))


def _normals(points: IndexArray, faces: IndexArray) -> LongArray:
    corners = points.astype(object)[faces]
    return _cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def _with_wide_shells(points: IndexArray, faces: IndexArray) -> tuple[IndexArray, IndexArray]:
    """Return the mesh with a tetrahedron in place of each connected surface without area."""
    has_area = (_normals(points, faces) != 0).any(axis=1)
    if has_area.all():
        return points, faces
    shells = surfaces_of(faces, len(points))
    is_wide = np.isin(shells, shells[has_area])
    thin = (np.unique(faces[shells == shell]) for shell in np.unique(shells[~is_wide]))
    tetrahedra = [_tetrahedron(points[corners]) for corners in thin]
    numbers = len(points) + 4 * np.arange(len(tetrahedra))
    added = (numbers[:, None, None] + _TETRAHEDRON).reshape(-1, 3)
    return np.concatenate([points, *tetrahedra]), np.concatenate([faces[is_wide], added])


def _tetrahedron(points: IndexArray) -> IndexArray:
    """Return the 4 corners of a tetrahedron, one lattice step wide, along collinear points."""
    axis = int(np.ptp(points, axis=0).argmax())
    along, *across = np.roll(np.eye(3, dtype=np.int64), -axis, axis=0)
    low, high = points[points[:, axis].argmin()], points[points[:, axis].argmax()]
    end = high if high[axis] > low[axis] else low + along
    return np.stack([low, end, *(low + step for step in across)])


def _without_short_edges(points: IndexArray, faces: IndexArray) -> IndexArray:
    """Return the faces that remain after each edge of length zero is collapsed to a point."""
    ends = np.stack([faces.ravel(), np.roll(faces, -1, axis=1).ravel()], axis=1)
    short = np.unique(ends[(points[ends[:, 0]] == points[ends[:, 1]]).all(axis=1)])
    if not len(short):
        return faces
    _, first, same = np.unique(points[short], axis=0, return_index=True, return_inverse=True)
    number = np.arange(len(points))
    number[short] = short[first[same.ravel()]]
    welded = number[faces]
    kept: IndexArray = welded[(welded != np.roll(welded, 1, axis=1)).all(axis=1)]
    return kept


def _borrow_normals(normals: LongArray, faces: IndexArray) -> Mask:
    """Replace zero normals, in place, by normals of neighbouring faces.

    Return a mask, (n,) bool, that is True for each face with a nonzero normal.
    """
    has_normal: Mask = (normals != 0).any(axis=1)
    if has_normal.all():
        return has_normal
    forth, back = half_edges(faces)
    here, there = np.concatenate([forth, back]) // 3, np.concatenate([back, forth]) // 3
    while (borrowing := ~has_normal[here] & has_normal[there]).any():
        normals[here[borrowing]] = normals[there[borrowing]]
        has_normal[here[borrowing]] = True
    return has_normal


def _directions(vectors: LongArray) -> Directions:
    """Return the distinct directions of nonzero integer vectors, and the direction of each."""
    shortest = vectors // np.gcd.reduce(vectors, axis=1)[:, None]
    numbers: dict[tuple[int, ...], int] = {}
    of = [numbers.setdefault(tuple(row), len(numbers)) for row in shortest.tolist()]
    whole = np.array(list(numbers), dtype=object).reshape(-1, 3)
    return Directions(
        Vectors(whole, unit_vectors(whole.astype(np.float64))), np.array(of, np.int64)
    )


def positive_products(first: Vectors, second: Vectors) -> Mask:
    """Return an (m, n) mask that is True where the dot product of two vectors is positive.

    Rows are the `first`, columns the `second` vectors. The second ones are rotated by an
    infinitesimal angle, the same in all calls, so that no dot product is zero.
    """
    products = first.units @ second.units.T
    signs: Mask = products > 0
    row, column = np.nonzero(np.abs(products) <= _SIGN_ERROR)
    if len(row):
        signs[row, column] = _is_positive(first.exact[row], second.exact[column])
    return signs


def positive_pair_products(first: Vectors, second: Vectors) -> Mask:
    """Return a mask, (n,) bool: whether the dot product of first[k] and second[k] is positive.

    The second vectors are rotated by an infinitesimal angle, so that no dot product is zero.
    """
    products = np.einsum("ij,ij->i", first.units, second.units)
    signs: Mask = products > 0
    doubtful = np.flatnonzero(np.abs(products) <= _SIGN_ERROR)
    if len(doubtful):
        signs[doubtful] = _is_positive(first.exact[doubtful], second.exact[doubtful])
    return signs


def _is_positive(first: LongArray, second: LongArray) -> Mask:
    """Return a mask: whether the dot product of first[k] and the rotated second[k] is positive.

    The rotation is infinitesimal, and its axis has a large x, a smaller y and a much smaller z. So
    a dot product of zero gets the sign of the first nonzero component of second[k] x first[k].
    """
    sign = _dots(first, second)
    for change in _cross(second, first).T:
        sign = np.where(sign == 0, change, sign)
    positive: Mask = (sign > 0).astype(bool)
    return positive


def blocks(count: int, width: int) -> Iterator[slice]:
    """Yield slices that divide `count` rows into batches of about `_SIGNS_PER_BATCH` entries.

    A row has `width` entries; each batch has at least one row.
    """
    step = max(1, _SIGNS_PER_BATCH // max(width, 1))
    return (slice(start, start + step) for start in range(0, count, step))


def _dots(first: LongArray, second: LongArray) -> LongArray:
    products: LongArray = (first * second).sum(axis=1)
    return products


def _cross(first: LongArray, second: LongArray) -> LongArray:
    x, y, z = first.T
    u, v, w = second.T
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=1)
