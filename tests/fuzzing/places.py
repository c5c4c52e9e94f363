"""The side of points by exact winding numbers in integers, without the core.

A place is a point and up to three vectors from it, each infinitely shorter than the one before. All
predicates are linear in the place, so the first value that is not zero decides.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, product
from math import gcd
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Point: TypeAlias = tuple[int, int, int]
Triangle: TypeAlias = tuple[Point, Point, Point]
Steps: TypeAlias = tuple[Point, ...]

#: The rules that say which winding numbers are inside.
RULES: dict[str, Callable[[int], bool]] = {
    "positive": lambda w: w > 0,
    "nonzero": lambda w: w != 0,
    "even-odd": lambda w: w % 2 == 1,
}

#: Directions of rays, in no plane of small normals.
RAYS: list[Point] = [
    (61, 37, 23),
    (-53, 29, 41),
    (17, -59, 43),
    (3137, -4801, 1499),
    (-19001, -6143, 29009),
    (590033, -110017, -370003),
]


#: The largest number of planes through one point: more divide its neighbourhood into too many
#: parts.
MAX_PLANES = 12


class UndecidedError(Exception):
    """A place cannot be classified: all rays meet edges, it is on a face, or many planes meet."""


class Balls:
    """Triangles with a bounding ball each, which excludes most of them from a search.

    Balls are doubles, one step larger than necessary; triangles that they do not exclude are tested
    in integers.
    """

    def __init__(self, triangles: Sequence[Triangle]) -> None:
        self.triangles = triangles
        corners = np.array(triangles, dtype=np.float64).reshape(-1, 3, 3)
        self._centres = corners.mean(axis=1)
        arms = np.linalg.norm(corners - self._centres[:, None], axis=2)
        self._radii = arms.max(axis=1, initial=0.0) * (1 + 1e-9) + 1.0

    def around(self, point: Point, reach: float = 0.0) -> list[Triangle]:
        """Return all triangles within `reach` of a point, and possibly some others."""
        away = np.linalg.norm(self._centres - np.array(point, dtype=np.float64), axis=1)
        return self._chosen(away <= self._radii + reach)

    def along(self, point: Point, ray: Point) -> list[Triangle]:
        """Return all triangles that a line through a point meets, and possibly some others."""
        arms = self._centres - np.array(point, dtype=np.float64)
        away = np.linalg.norm(np.cross(arms, np.array(ray, dtype=np.float64)), axis=1)
        return self._chosen(away <= self._radii * (1 + 1e-9) * dot(ray, ray) ** 0.5)

    def _chosen(self, flags: npt.NDArray[np.bool_]) -> list[Triangle]:
        return [self.triangles[k] for k in np.flatnonzero(flags).tolist()]


@dataclass(frozen=True)
class Surface:
    """The set of points whose winding number about triangles satisfies a rule."""

    triangles: tuple[Triangle, ...]
    rule: str = "positive"

    @cached_property
    def balls(self) -> Balls:
        """The triangles with their bounding balls."""
        return Balls(self.triangles)

    def normals_at(self, point: Point) -> list[Point]:
        """Return the normals of the triangles that contain a point."""
        return [normal(each) for each in self.balls.around(point) if touches(each, point)]

    def sides(self, point: Point, places: Sequence[Steps]) -> list[bool]:
        """Return for each place beside a point whether it is inside the set."""
        return [RULES[self.rule](number) for number in windings(self.balls, point, places)]


@dataclass(frozen=True)
class Below:
    """The closed half-space below a plane through three points, counterclockwise from above."""

    corners: Triangle

    def normals_at(self, point: Point) -> list[Point]:
        """Return the plane's normal if a point lies on the plane, else nothing."""
        n = normal(self.corners)
        return [n] if dot(n, less(point, self.corners[0])) == 0 else []

    def sides(self, point: Point, places: Sequence[Steps]) -> list[bool]:
        """Return for each place beside a point whether it is below the plane."""
        n = normal(self.corners)
        found = [sign(dot(n, less(point, self.corners[0])), n, place) for place in places]
        if 0 in found:
            raise UndecidedError
        return [side < 0 for side in found]


Known: TypeAlias = Surface | Below


def location(sets: Sequence[Known], value: Callable[[Sequence[bool]], bool], point: Point) -> int:
    """Return 1 if a point is inside an expression of sets, 0 on its boundary, -1 outside.

    The planes through the point divide its neighbourhood; the point is on the boundary if the
    expression is true in some of these parts and false in others.
    """
    normals = sorted({reduced(n) for each in sets for n in each.normals_at(point)})
    if len(normals) > MAX_PLANES:
        raise UndecidedError
    places = around(normals)
    columns = [each.sides(point, places) for each in sets]
    held = {value(inside) for inside in zip(*columns, strict=True)}
    return 0 if len(held) == 2 else 1 if True in held else -1


def windings(balls: Balls, point: Point, places: Sequence[Steps]) -> Iterator[int]:
    """Yield the winding number of triangles about each of the places beside a point."""
    near = [each for each in balls.around(point) if touches(each, point)]
    # What the point does not lie on is the same for all places, unless a ray meets its edges.
    kept: dict[Point, int] = {}
    for place in places:
        yield _winding(balls, near, point, place, kept)


def _winding(
    balls: Balls, near: Sequence[Triangle], point: Point, place: Steps, kept: dict[Point, int]
) -> int:
    for ray in RAYS:
        try:
            if ray not in kept:
                kept[ray] = _windings_away(balls, near, point, ray)
            return kept[ray] + sum(crossing(each, point, place, ray) for each in near)
        except UndecidedError:
            continue
    raise UndecidedError


def _windings_away(balls: Balls, near: Sequence[Triangle], point: Point, ray: Point) -> int:
    there = set(near)
    away = [each for each in balls.along(point, ray) if each not in there]
    return sum(crossing(each, point, (), ray) for each in away)


def crossing(triangle: Triangle, point: Point, place: Steps, ray: Point) -> int:
    """Return 1 if a ray from a place leaves through a triangle, -1 if it enters, 0 if it misses."""
    a, b, c = (less(corner, point) for corner in triangle)
    turns = [
        sign(dot(ray, cross(p, q)), cross(less(p, q), ray), place)
        for p, q in ((a, b), (b, c), (c, a))
    ]
    if 1 in turns and -1 in turns:
        return 0
    n = normal(triangle)
    side, slope = sign(-dot(n, a), n, place), dot(n, ray)
    if side == 0 or (0 in turns and slope != 0):
        raise UndecidedError
    return 0 if side * slope >= 0 else 1 if slope > 0 else -1


def around(normals: Sequence[Point]) -> list[Steps]:
    """Return a place in each part of the neighbourhood that planes with these normals make.

    Unless all planes are parallel, each part is bounded by a ray in which two planes meet, and the
    parts around such a ray lie beside the planes that contain it.
    """
    places: list[Steps] = []
    lines = {reduced(cross(p, q)) for p, q in combinations(normals, 2)} - {(0, 0, 0)}
    for line in sorted(lines | {minus(line) for line in lines}):
        for n in (n for n in normals if dot(n, line) == 0):
            across = cross(n, line)
            pairs = product((across, minus(across)), (n, minus(n)))
            places.extend((line, aside, off) for aside, off in pairs)
    if not places and normals:
        return [(normals[0],), (minus(normals[0]),)]
    return places or [()]


def touches(triangle: Triangle, point: Point) -> bool:
    """Return true if a point lies on a closed triangle."""
    n = normal(triangle)
    a, b, c = (less(corner, point) for corner in triangle)
    if n == (0, 0, 0) or dot(n, a) != 0:
        return False
    return all(dot(n, cross(p, q)) >= 0 for p, q in ((a, b), (b, c), (c, a)))


def sign(value: int, gradient: Point, place: Steps) -> int:
    """Return the sign at a place of a linear form with this value at the point and gradient."""
    changes = (dot(gradient, step) for step in place)
    found = next((each for each in (value, *changes) if each), 0)
    return (found > 0) - (found < 0)


def reduced(vector: Point) -> Point:
    """Return the shortest integer vector with the same direction."""
    size = gcd(*vector) or 1
    x, y, z = vector
    return x // size, y // size, z // size


def normal(triangle: Triangle) -> Point:
    """Return the outward normal of a triangle, of any length."""
    a, b, c = triangle
    return cross(less(b, a), less(c, a))


def dot(a: Point, b: Point) -> int:
    """Return the inner product of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Point, b: Point) -> Point:
    """Return the cross product of two vectors."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def less(a: Point, b: Point) -> Point:
    """Return the difference a - b of two vectors."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def minus(a: Point) -> Point:
    """Return the negative of a vector."""
    return -a[0], -a[1], -a[2]
