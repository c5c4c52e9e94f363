"""Solids of the points at which a function of space exceeds a level."""

from collections.abc import Callable, Iterator
from itertools import product
from typing import Any, TypeAlias

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray, MeshArrays, Scalar
from ...errors import InvalidMeshError, LimitError, invalid_parameter
from ...geometry.arrays import doubles
from ...mesh.weld import welded
from ...parameters import number, positive, shown
from ...shapes.primitives import box
from ...solid.ledger import counted
from ...solid.solid import Solid

#: A function that maps (n, 3) float64 points to (n,) numbers.
Field: TypeAlias = Callable[[FloatArray], Any]

#: The largest number of points at which a function is sampled. The memory is about 100 bytes per
#: point.
_MAX_SAMPLE_POINTS = 50_000_000

#: The number of points in one call of the function.
_POINTS_PER_CALL = 1 << 20

#: The four corners of the common face of two neighbouring cubes, in circular order: offsets of 0 or
#: 1 cubes along the two axes of the face.
_AROUND = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])


@counted
def level_set(f: Field, bounds: Any, edge_length: Scalar, *, level: Scalar = 0.0) -> Solid:
    """Return the solid of the points at which a function is above a level.

    The function is evaluated at the corners and centres of a grid of cubes. Tetrahedra between
    these points divide the box. In each tetrahedron the surface is planar, at the level of the
    function interpolated along the edges. So the surface is closed, and the bounds cut it exactly.

    Parameters
    ----------
    f : callable
        Takes points as (n, 3) float64, in model units, within the bounds, and returns (n,) numbers,
        positive inside. It is called with up to a million points at once.
    bounds : (2, 3) array_like of float
        Lowest and highest corner of the box that the solid lies in.
    edge_length : float
        The largest edge length of the cubes, which divide the box evenly.
    level : float

    Raises
    ------
    InvalidParameterError
        If a parameter is out of its range, or what `f` returns has another shape.
    InvalidMeshError
        If `f` returns NaN.
    LimitError
        If there are more than 50 million points ("too_large").

    Notes
    -----
    The method is marching tetrahedra on the body-centred lattice, as in the library Manifold.

    Examples
    --------
    >>> import numpy as np
    >>> import bspcsg as csg
    >>> cube = [(-1, -1, -1), (1, 1, 1)]
    >>> ball = csg.level_set(lambda p: 1 - np.linalg.norm(p, axis=1), cube, 0.1)
    >>> round(ball.volume, 1), ball.genus
    (4.2, 0)
    >>> gyroid = csg.level_set(
    ...     lambda p: (np.sin(p) * np.cos(np.roll(p, -1, axis=1))).sum(axis=1),
    ...     [(0, 0, 0), (2 * np.pi,) * 3],
    ...     0.5,
    ... )
    >>> round(gyroid.volume / (2 * np.pi) ** 3, 1)
    0.5
    """
    if not callable(f):
        raise invalid_parameter(f"f must be a function, not {shown(f)}.")
    low, high = _box(bounds)
    grid = _Grid.of(low, high, positive(edge_length, "edge_length"))
    values = grid.values(f, low, high) - number(level, "level")
    vertices, faces = grid.surface(values)
    if len(faces) == 0:
        return Solid.empty()
    solid = Solid(vertices, faces)
    reaches_out = (vertices < low).any() or (vertices > high).any()
    return solid & box(high - low).translate(low) if reaches_out else solid


def _box(bounds: Any) -> tuple[FloatArray, FloatArray]:
    refusal = invalid_parameter(
        f"bounds must be two corners of three numbers each, not {shown(bounds)}."
    )
    array = doubles(bounds, refusal).copy()
    if array.shape != (2, 3) or not np.isfinite(array).all() or not (array[0] < array[1]).all():
        raise invalid_parameter(
            "bounds must be two corners of three finite numbers each, the second above the first"
            f" along each axis, not {shown(bounds)}."
        )
    return array[0], array[1]


class _Grid:
    """The corners and centres of equal cubes that fill a box and two extra layers around it.

    Points of the outermost layer count as outside, so the surface is closed; the next layer repeats
    the function's values at the border of the box. Corners are numbered before centres, both with z
    fastest.
    """

    def __init__(self, low: FloatArray, step: FloatArray, counts: IndexArray) -> None:
        self._low, self._step = low - 2 * step, step
        self._corners = tuple(int(n) + 5 for n in counts)
        self._middles = tuple(int(n) + 4 for n in counts)
        self._first_middle = int(np.prod(self._corners))

    @classmethod
    def of(cls, low: FloatArray, high: FloatArray, edge: float) -> "_Grid":
        """Return the grid of cubes that divide a box evenly, with edges of at most `edge`."""
        with np.errstate(over="ignore"):
            # Do not add a cube if rounding lifted a whole quotient above its value.
            counts = np.maximum(np.ceil((high - low) / edge * (1 - 1e-12)), 1.0)
            points = 2 * float(np.prod(counts + 5))
        if points > _MAX_SAMPLE_POINTS:
            message = (
                f"edge_length would need {points:.3g} sample points, and at most"
                f" {_MAX_SAMPLE_POINTS:,} are allowed. Choose a larger edge_length."
            )
            raise LimitError(message, "too_large")
        return cls(low, (high - low) / counts, counts.astype(np.int64))

    def points(self, numbers: IndexArray) -> FloatArray:
        """Return the (n, 3) coordinates of points of the grid, given their numbers."""
        middle = numbers >= self._first_middle
        corners = np.stack(np.unravel_index(np.where(middle, 0, numbers), self._corners), axis=1)
        own = np.where(middle, numbers - self._first_middle, 0)
        middles = np.stack(np.unravel_index(own, self._middles), axis=1) + 0.5
        return self._low + self._step * np.where(middle[:, None], middles, corners)

    def values(self, f: Field, low: FloatArray, high: FloatArray) -> FloatArray:
        """Return the function's values at all points of the grid, (n,) float64.

        A point outside the box gets the value at the nearest point of the box.
        """
        total = self._first_middle + int(np.prod(self._middles))
        found = np.empty(total)
        for start in range(0, total, _POINTS_PER_CALL):
            numbers = np.arange(start, min(start + _POINTS_PER_CALL, total))
            points = np.clip(self.points(numbers), low, high)
            found[numbers] = _asked(f, points)
        return found

    def _is_rim(self) -> BoolArray:
        """Return a mask, (n,) bool, that is True at the points of the outermost layer."""
        rims = []
        for shape in (self._corners, self._middles):
            rim = np.ones(shape, dtype=bool)
            rim[1:-1, 1:-1, 1:-1] = False
            rims.append(rim.ravel())
        return np.concatenate(rims)

    def surface(self, values: FloatArray) -> MeshArrays:
        """Return vertices and faces of the closed surface around the points of positive value."""
        bounded = np.where(self._is_rim(), -np.abs(values), values)
        inside = bounded > 0
        triangles = np.concatenate([_cut(four, inside) for four in self._tetrahedra(inside)])
        ends = np.sort(triangles.reshape(-1, 2), axis=1)
        keys, corners = np.unique(ends[:, 0] * len(values) + ends[:, 1], return_inverse=True)
        first, second = keys // len(values), keys % len(values)
        shares = bounded[first] / (bounded[first] - bounded[second])
        start, end = self.points(first), self.points(second)
        vertices, same = welded(start + (end - start) * shares[:, None])
        faces = same[corners.reshape(-1, 3)]
        # Where the function is 0 at a grid point, surface corners on several edges coincide.
        return vertices, faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]

    def _tetrahedra(self, inside: BoolArray) -> Iterator[IndexArray]:
        """Yield the tetrahedra with corners both inside and outside, as (n, 4) point numbers.

        A tetrahedron joins the centres of two neighbouring cubes and one edge of their common face.
        """
        corner = np.arange(self._first_middle).reshape(self._corners)
        middle = np.arange(int(np.prod(self._middles))).reshape(self._middles) + self._first_middle
        for axis, edge in product(range(3), range(4)):
            along = np.moveaxis(middle, axis, 0)
            pair = [np.moveaxis(half, 0, axis) for half in (along[:-1], along[1:])]
            ends = [_beside(corner, axis, _AROUND[(edge + k) % 4]) for k in (0, 1)]
            numbers = (*pair, *ends)
            signs = [inside[one] for one in numbers]
            mixed = np.logical_or.reduce(signs) & ~np.logical_and.reduce(signs)
            yield np.stack([one[mixed] for one in numbers], axis=1)


def _beside(corner: IndexArray, axis: int, step: IndexArray) -> IndexArray:
    """Return one corner of each face between two neighbouring cubes along an axis.

    The array `corner` has the numbers of all cube corners. `step` selects the corner of a face: 0
    or 1 along each of the two axes of the face.
    """
    places = []
    for k in range(3):
        if k == axis:
            places.append(slice(1, -1))
        else:
            first = int(step[(k - axis) % 3 - 1])
            places.append(slice(first, corner.shape[k] - 1 + first))
    return corner[tuple(places)]


def _asked(f: Field, points: FloatArray) -> FloatArray:
    refusal = invalid_parameter(
        "f must return an array with one number for each point that it is given."
    )
    found = doubles(f(points), refusal)
    if found.shape != (len(points),):
        raise invalid_parameter(
            f"f must return an array of shape ({len(points)},), not {found.shape}."
        )
    bad = np.flatnonzero(np.isnan(found))
    if len(bad):
        message = (
            f"f must not return NaN, but did for {len(bad)} points, the first of which is"
            f" {points[bad[0]].tolist()}."
        )
        raise InvalidMeshError(message, "non_finite", bad[:20].tolist())
    # Clip infinite values, which cannot be interpolated.
    return np.clip(found, -1e150, 1e150)


def _cut(tetrahedra: IndexArray, inside_points: BoolArray) -> IndexArray:
    """Return the surface triangles inside tetrahedra, (n, 3, 2) point numbers.

    Each corner of a triangle lies on the edge between the two points that are given for it.
    """
    inside = inside_points[tetrahedra]
    order = np.argsort(~inside, axis=1, kind="stable")
    chosen, is_even = np.take_along_axis(tetrahedra, order, axis=1), _is_even(order)
    counts = inside.sum(axis=1)
    pieces = [np.zeros((0, 3, 2), dtype=np.int64)]
    for count, triangle in _TRIANGLES:
        rows = counts == count
        found = np.stack([chosen[rows][:, edge] for edge in triangle], axis=1)
        # An odd permutation of the corners mirrors the tetrahedron.
        pieces.append(np.where(is_even[rows][:, None, None], found, found[:, ::-1]))
    return np.concatenate(pieces)


def _is_even(order: IndexArray) -> BoolArray:
    swaps = sum((order[:, i] > order[:, j]).astype(int) for i in range(4) for j in range(i + 1, 4))
    even: BoolArray = np.asarray(swaps) % 2 == 0
    return even


#: For a tetrahedron whose inner corners come first: the number of inner corners, and a triangle of
#: the surface as three edges, each a pair of corner numbers. Its normal points outside if the
#: corners are oriented like the origin and the ends of the unit vectors x, y and z.
_TRIANGLES = [
    (1, [[0, 1], [0, 2], [0, 3]]),
    (2, [[0, 2], [0, 3], [1, 3]]),
    (2, [[0, 2], [1, 3], [1, 2]]),
    (3, [[0, 3], [1, 3], [2, 3]]),
]
