"""Sets of directions: exact regions of the circle and of the sphere.

A great circle is the section of the sphere by a plane through the origin. So a region of the sphere
corresponds to a cone: a set in space cut only by such planes. Set operations are those of
`ObjectTree`, in 2D for directions of the plane, in 3D for directions of space.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from functools import reduce
from itertools import pairwise
from typing import Any, Self

import numpy as np

from ..._types import FloatArray, SideArray
from ...errors import invalid_parameter
from ...geometry.arrays import doubles
from ...geometry.hyperplane import exact_number, exact_point
from ...geometry.polytope import Corner, Polytope, cut_polygon, height
from ...parameters import instance_of, shown
from .objects import ObjectTree
from .operators import SetOperators

#: The pitch of the lattice of cones, whose steps are 1: directions are integer vectors.
_CONE_PITCH = 0

#: The largest coordinate of a direction. Normals between such directions have 106 bits, which the
#: core takes unrounded.
_MAX_DIRECTION = 1 << 52


class SphericalRegion(SetOperators):
    """A set of directions of the plane or of space; an immutable value.

    Make one with `hemisphere`, `polygon`, `arc`, `empty` or `full`, and combine them with ``| & - ^
    ~``. Directions are vectors of any length; their numbers count as the decimals they are written
    as. A direction that is no multiple of integers up to 2**52 is rounded to one that is, so that
    arcs between directions are exact; axes are not rounded. All decisions are exact; only `measure`
    and `share` are rounded.

    Examples
    --------
    >>> from bspcsg import bsp
    >>> east = bsp.SphericalRegion.hemisphere([1, 0, 0])
    >>> up = bsp.SphericalRegion.hemisphere([0, 0, 1])
    >>> round((east & up).share, 12), (east | ~east).is_full
    (0.25, True)
    """

    __slots__ = ("_cone",)

    def __init__(self, cone: ObjectTree) -> None:
        rows = instance_of(ObjectTree, cone, "cone").nodes.coefficients
        if cone.dimension not in (2, 3) or any(row[-1] for row in rows):
            raise invalid_parameter(
                "cone must be a set of 2 or 3 dimensions whose hyperplanes all pass through the"
                " origin."
            )
        self._cone = cone

    # Making

    @classmethod
    def empty(cls, dimension: int = 3) -> Self:
        """Return the empty set of directions of the plane (dimension 2) or of space (3)."""
        return cls(ObjectTree.uniform(dimension, full=False, pitch=_CONE_PITCH))

    @classmethod
    def full(cls, dimension: int = 3) -> Self:
        """Return the set of all directions of the plane (dimension 2) or of space (3)."""
        return cls(ObjectTree.uniform(dimension, full=True, pitch=_CONE_PITCH))

    @classmethod
    def hemisphere(cls, axis: Any) -> Self:
        """Return all directions within a quarter turn of an axis, a vector (2,) or (3,)."""
        whole = _primitive_direction(axis)
        return cls(ObjectTree.half_space([-x for x in whole], 0, pitch=_CONE_PITCH))

    @classmethod
    def polygon(cls, corners: Any) -> Self:
        """Return the convex polygon with these corners, joined by arcs of great circles.

        Parameters
        ----------
        corners : (k, 3) array_like of float
            At least three directions within one hemisphere, counterclockwise seen from outside.

        Raises
        ------
        InvalidParameterError
            If the polygon is not convex, runs clockwise, or all corners have one direction.
        """
        whole = [_snapped(corner) for corner in _listed(corners)]
        if len(whole) < 3 or any(len(corner) != 3 for corner in whole):
            raise invalid_parameter(
                "A spherical polygon needs at least three corners of three numbers each."
            )
        sides = [_cross(a, b) for a, b in pairwise([*whole, whole[0]])]
        if any(_dot(side, corner) < 0 for side in sides for corner in whole):
            raise invalid_parameter(
                "The corners of a spherical polygon must be convex and in counterclockwise order,"
                " seen from outside."
            )
        if not any(map(any, sides)):
            raise invalid_parameter(
                "The corners of a spherical polygon must not all have the same direction."
            )
        return cls._inside(side for side in sides if any(side))

    @classmethod
    def arc(cls, start: Any, end: Any) -> Self:
        """Return all directions of the plane counterclockwise from start to end, vectors (2,)."""
        a, b = _snapped(start), _snapped(end)
        if len(a) != 2 or len(b) != 2:
            raise invalid_parameter(
                "start and end of an arc must be directions of the plane, of two numbers each."
            )
        sides = [[-a[1], a[0]], [b[1], -b[0]]]
        turn = a[0] * b[1] - a[1] * b[0]
        if turn > 0 or (turn == 0 and a[0] * b[0] + a[1] * b[1] < 0):
            return cls._inside(sides)
        return ~cls._inside([[-x for x in side] for side in sides]) if turn else cls.empty(2)

    @classmethod
    def _inside(cls, normals: Iterable[Sequence[int]]) -> Self:
        halves = (cls.hemisphere(normal) for normal in normals)
        return reduce(lambda a, b: a & b, halves)

    # Set operations

    def _combined(self, other: object, operation: Callable[[Any, Any], Any]) -> Self:
        made: Self = NotImplemented
        if isinstance(other, SphericalRegion):
            made = type(self)(operation(self._cone, other._cone))
        return made

    def __invert__(self) -> Self:
        """Return the complement: all other directions."""
        return type(self)(~self._cone)

    def __eq__(self, other: object) -> bool:
        """Return true if both regions contain exactly the same directions."""
        if not isinstance(other, SphericalRegion):
            return NotImplemented
        return self.dimension == other.dimension and (self ^ other).is_empty

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, tuple[ObjectTree]]:
        """Return the cone, for pickling."""
        return type(self), (self._cone,)

    def __bool__(self) -> bool:
        """Return true if the region is not empty."""
        return not self.is_empty

    def __repr__(self) -> str:
        """Return a text with the fraction of the circle or sphere that the region covers."""
        return f"SphericalRegion({self.dimension - 1}S, {100 * self.share:.1f} %)"

    # Questions

    @property
    def cone(self) -> ObjectTree:
        """The region's cone: all points of the plane or space whose direction is in the region."""
        return self._cone

    @property
    def dimension(self) -> int:
        """2 for directions of the plane, 3 for directions of space."""
        return self._cone.dimension

    @property
    def is_empty(self) -> bool:
        """True if the region contains no direction."""
        return self._cone.is_empty

    @property
    def is_full(self) -> bool:
        """True if the region contains all directions."""
        return self._cone.is_full

    def classify(self, directions: Any) -> SideArray:
        """Classify directions as inside, outside or on the boundary, exactly.

        Parameters
        ----------
        directions : (k, d) array_like of float

        Returns
        -------
        (k,) int8
            +1 inside, 0 on the boundary, -1 outside.
        """
        nodes = self._cone.nodes
        start = 0 if len(nodes) else (nodes.IN if self.is_full else nodes.OUT)

        def side(direction: Any) -> int:
            place = tuple(map(Fraction, _snapped(direction)))
            if len(place) != self.dimension:
                raise invalid_parameter(
                    f"A direction must have {self.dimension} numbers here, not {len(place)}."
                )
            seen, pending = set(), [start]
            while pending:
                row = pending.pop()
                if row < 0:
                    seen.add(row)
                    continue
                value = height(place, nodes.coefficients[row])
                pending += [int(nodes.minus[row])] * (value <= 0)
                pending += [int(nodes.plus[row])] * (value >= 0)
            return 0 if len(seen) == 2 else (1 if nodes.IN in seen else -1)

        return np.array([side(direction) for direction in _listed(directions)], dtype=np.int8)

    def pieces(self) -> list[FloatArray]:
        """Return the region as convex pieces: the corners of each piece as unit vectors, (k, d).

        In the plane each piece has two ends; in space corners run counterclockwise seen from
        outside. Pieces are also cut along the projected edges of a cube about the origin.
        """
        return [_units(piece) for piece in self._cut_cube()]

    @property
    def measure(self) -> float:
        """The region's angle in radians (2D) or solid angle in steradians (3D)."""
        if self.dimension == 2:
            return math.fsum(_angle(piece) for piece in self.pieces())
        return math.fsum(
            _solid_angle(piece[0], b, c) for piece in self.pieces() for b, c in pairwise(piece[1:])
        )

    @property
    def share(self) -> float:
        """The fraction of the whole circle or sphere that the region covers."""
        return self.measure / (2 * math.pi if self.dimension == 2 else 4 * math.pi)

    def _cut_cube(self) -> Iterator[tuple[Corner, ...]]:
        """Yield the parts inside the cone of a cube's faces (3D) or of a square's sides (2D)."""
        nodes = self._cone.nodes
        if not len(nodes):
            yield from _cube(self.dimension) if self.is_full else ()
            return
        pending = [(0, part) for part in _cube(self.dimension)]
        while pending:
            row, part = pending.pop()
            for child, side in ((int(nodes.minus[row]), -1), (int(nodes.plus[row]), 1)):
                piece = cut_polygon(part, nodes.coefficients[row], side)
                if not piece or child == nodes.OUT:
                    continue
                if child == nodes.IN:
                    yield piece
                else:
                    pending.append((child, piece))


def visible_sky(facets: Any, eye: Any) -> SphericalRegion:
    """Return the directions in which an eye sees the sky, not blocked by facets.

    Parameters
    ----------
    facets : (n, 2, 2) or (n, 3, 3) array_like of float
        Segments in the plane or triangles in space, opaque from both sides.
    eye : (2,) or (3,) array_like of float
        The eye must not lie in a facet. A facet seen edge-on hides nothing.

    Examples
    --------
    >>> from bspcsg import bsp
    >>> wall = [[[1, -1], [1, 1]]]
    >>> bsp.visible_sky(wall, [0, 0]).share
    0.75
    """
    shapes = doubles(facets, invalid_parameter("Facets must be an array of numbers."))
    if shapes.ndim != 3 or shapes.shape[1:] not in ((2, 2), (3, 3)):
        raise invalid_parameter(
            "Facets must be segments of shape (n, 2, 2) or triangles of shape (n, 3, 3), not"
            f" {shapes.shape}."
        )
    place = exact_point(eye, shapes.shape[2], "eye")
    hidden = [SphericalRegion.empty(len(place))]
    for shape in shapes.tolist():
        arms = [[exact_number(x) - y for x, y in zip(p, place, strict=True)] for p in shape]
        cone = _cone_of(arms)
        if cone is not None:
            hidden.append(cone)
    # Unite pairs of neighbours, then pairs of results, so that no operand is large for long.
    while len(hidden) > 1:
        hidden = [
            hidden[k] | hidden[k + 1] if k + 1 < len(hidden) else hidden[k]
            for k in range(0, len(hidden), 2)
        ]
    return ~hidden[0]


def _cone_of(arms: list[list[Fraction]]) -> SphericalRegion | None:
    """Return the directions of a facet with corners `arms` from the origin; None if edge-on."""
    if len(arms) == 2:
        (a, b), (c, d) = map(_snapped, arms)
        turn = a * d - b * c
        if not turn:
            return None
        return SphericalRegion.arc(*(arms if turn > 0 else arms[::-1]))
    whole = [_snapped(arm) for arm in arms]
    volume = _dot(_cross(whole[0], whole[1]), whole[2])
    if not volume:
        return None
    return SphericalRegion.polygon(whole if volume > 0 else whole[::-1])


def _listed(directions: Any) -> list[Any]:
    try:
        return list(directions)
    except TypeError as error:
        given = shown(directions)
        message = f"Directions must be a list of two or three numbers each, not {given}."
        raise invalid_parameter(message) from error


def _primitive_direction(direction: Any) -> list[int]:
    """Return the integers without a common divisor that have the same direction."""
    entries = direction if isinstance(direction, list) else np.asarray(direction, object).tolist()
    try:
        exact = [exact_number(entry) for entry in entries]
    except (TypeError, ValueError, OverflowError) as error:
        raise invalid_parameter("A direction must be two or three finite numbers.") from error
    if len(exact) not in (2, 3) or not any(exact):
        raise invalid_parameter("A direction must be two or three numbers that are not all zero.")
    denominator = math.lcm(*(x.denominator for x in exact))
    whole = [int(x * denominator) for x in exact]
    divisor = math.gcd(*whole)
    return [x // divisor for x in whole]


def _snapped(direction: Any) -> list[int]:
    """Return integers up to 2**52 in nearly the same direction, equal for equal directions."""
    whole = _primitive_direction(direction)
    largest = max(map(abs, whole))
    if largest <= _MAX_DIRECTION:
        return whole
    grain = 1 << ((largest - 1).bit_length() - (_MAX_DIRECTION - 1).bit_length())
    return _primitive_direction([round(Fraction(entry, grain)) for entry in whole])


def _cross(a: Sequence[int], b: Sequence[int]) -> list[int]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _dot(a: Sequence[int], b: Sequence[int]) -> int:
    return sum(x * y for x, y in zip(a, b, strict=True))


def _cube(dimension: int) -> list[tuple[Corner, ...]]:
    """Return the faces of a cube (3D) or the sides of a square (2D), counterclockwise."""
    body = Polytope.box([-1] * dimension, [1] * dimension)
    if dimension == 3:
        return list(body.faces)
    ring = body.faces[0]
    return list(pairwise([*ring, ring[0]]))


def _units(piece: Sequence[Corner]) -> FloatArray:
    points = np.array([[float(x) for x in corner] for corner in piece])
    return np.asarray(points / np.linalg.norm(points, axis=1, keepdims=True))


def _angle(piece: FloatArray) -> float:
    (a, b), (c, d) = piece
    return math.atan2(a * d - b * c, a * c + b * d)


def _solid_angle(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    """Return the solid angle of a triangle of unit vectors (Van Oosterom, Strackee 1983)."""
    top = float(np.dot(a, np.cross(b, c)))
    return 2 * math.atan2(top, 1 + float(a @ b) + float(b @ c) + float(c @ a))
