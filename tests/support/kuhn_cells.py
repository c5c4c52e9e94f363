"""Random sets of tetrahedra of a grid, whose parts and surfaces are counted without geometry.

Each cell of the grid is divided into six tetrahedra around its diagonal (Kuhn's triangulation), so
that up to six walls meet in an edge, and planes pass through it.
"""

from collections.abc import Hashable, Iterable, Iterator
from itertools import combinations, permutations, product
from random import Random
from typing import NamedTuple

import numpy as np

import bspcsg as b

Point = tuple[int, int, int]
Tetrahedron = tuple[Point, Point, Point, Point]

#: The length of a cell's side. Edges can be divided at each step, and faces at their centres.
STEPS = 12


class Counts(NamedTuple):
    """Numbers that depend on the set of points alone."""

    parts: int
    surfaces: int
    euler_number: int


def counts_of(solid: b.Solid) -> Counts:
    return Counts(len(solid.components), solid.surface_count, solid.euler_number)


def random_set(random: Random) -> list[Tetrahedron]:
    """Return some of the tetrahedra of one, two, four or eight cells."""
    sizes = [random.choice((1, 2)) for _ in range(3)]
    share = random.choice((0.3, 0.5, 0.6))
    every = [t for cell in product(*map(range, sizes)) for t in _of_cell(cell)]
    return [t for t in every if random.random() < share] or every[:1]


def _of_cell(cell: tuple[int, ...]) -> Iterator[Tetrahedron]:
    for order in permutations(range(3)):
        corners = [np.array(cell) * STEPS]
        for axis in order:
            corners.append(corners[-1] + STEPS * np.eye(3, dtype=int)[axis])
        if np.linalg.det(np.diff(corners, axis=0)) < 0:
            corners[1], corners[2] = corners[2], corners[1]
        first, second, third, fourth = (tuple(map(int, corner)) for corner in corners)
        yield (first, second, third, fourth)  # type: ignore[misc]


def united(tetrahedra: Iterable[Tetrahedron]) -> b.Solid:
    parts = [b.hull(corners) for corners in tetrahedra]
    whole: b.Solid = b.union(parts)
    return whole


class _Sets:
    """Disjoint sets of things."""

    def __init__(self, things: Iterable[Hashable]) -> None:
        self._above = {thing: thing for thing in things}

    def name(self, thing: Hashable) -> Hashable:
        while self._above[thing] != thing:
            thing = self._above[thing]
        return thing

    def join(self, one: Hashable, other: Hashable) -> None:
        self._above[self.name(one)] = self.name(other)

    def __len__(self) -> int:
        return len({self.name(thing) for thing in self._above})


def expected(tetrahedra: list[Tetrahedron]) -> Counts:
    """Count by common faces alone: walls of one wedge of the inside around an edge are joined."""
    at: dict[frozenset[Point], list[int]] = {}
    for number, corners in enumerate(tetrahedra):
        for face in combinations(corners, 3):
            at.setdefault(frozenset(face), []).append(number)
    parts = _Sets(range(len(tetrahedra)))
    for numbers in at.values():
        parts.join(numbers[0], numbers[-1])
    walls = [face for face, numbers in at.items() if len(numbers) == 1]
    surfaces = _Sets(walls)
    vertices = _Sets((wall, corner) for wall in walls for corner in wall)
    for wall in walls:
        for edge in combinations(sorted(wall), 2):
            other = _around(wall, frozenset(edge), tetrahedra, at)
            surfaces.join(wall, other)
            for corner in edge:
                vertices.join((wall, corner), (other, corner))
    # There are three half-edges to each triangle.
    return Counts(len(parts), len(surfaces), len(vertices) - len(walls) // 2)


def _around(
    wall: frozenset[Point],
    edge: frozenset[Point],
    tetrahedra: list[Tetrahedron],
    at: dict[frozenset[Point], list[int]],
) -> frozenset[Point]:
    """Return the wall that is reached from another one around their edge through the inside."""
    (number,) = at[wall]
    while True:
        wall = frozenset(tetrahedra[number]) - (wall - edge)
        others = [n for n in at[wall] if n != number]
        if not others:
            return wall
        (number,) = others


#: A vertex: its place, and what tells it from other vertices there.
Vertex = tuple[int, int, int, Hashable]

Wall = tuple[Point, ...]


def divided(tetrahedra: list[Tetrahedron], random: Random, *, apart: bool) -> b.Solid:
    """Return the mesh of the walls, which are paired at random around each edge.

    The walls of a pair have the same vertices inside their edge, other pairs have others; with
    `apart`, even where these are in the same places. Each wall is a fan around its centre.
    """
    walls = _walls(tetrahedra)
    inside = _vertices_inside(walls, random, apart=apart)
    numbers: dict[Vertex, int] = {}
    faces: list[tuple[int, int, int]] = []
    for number, wall in enumerate(walls):
        rim: list[Vertex] = []
        for start, end in _edges(wall):
            rim += [(*start, None), *inside[number, start, end]]
        x, y, z = (np.sum(wall, axis=0) // 3).tolist()
        centre = numbers.setdefault((x, y, z, number), len(numbers))
        around = [numbers.setdefault(vertex, len(numbers)) for vertex in rim]
        faces += [(centre, p, q) for p, q in zip(around, around[1:] + around[:1], strict=True)]
    return b.Solid([vertex[:3] for vertex in numbers], faces)


def _walls(tetrahedra: list[Tetrahedron]) -> list[Wall]:
    walls: dict[frozenset[Point], Wall] = {}
    for a, c, d, e in tetrahedra:
        for wall in ((a, d, c), (a, c, e), (c, d, e), (a, e, d)):
            if walls.pop(frozenset(wall), None) is None:
                walls[frozenset(wall)] = wall
    return list(walls.values())


def _edges(wall: Wall) -> Iterator[tuple[Point, Point]]:
    return zip(wall, (*wall[1:], wall[0]), strict=True)


def _vertices_inside(
    walls: list[Wall], random: Random, *, apart: bool
) -> dict[tuple[int, Point, Point], list[Vertex]]:
    """Return the vertices inside each edge of each wall, from its start to its end."""
    halves: dict[tuple[Point, Point], list[int]] = {}
    for number, wall in enumerate(walls):
        for ends in _edges(wall):
            halves.setdefault(ends, []).append(number)
    inside = {}
    for (start, end), numbers in sorted(halves.items()):
        if start < end:
            mates = random.sample(halves[end, start], len(numbers))
            for pair in zip(numbers, mates, strict=True):
                vertices = _random_vertices(start, end, pair if apart else None, random)
                inside[pair[0], start, end] = vertices
                inside[pair[1], end, start] = vertices[::-1]
    return inside


def _random_vertices(start: Point, end: Point, name: Hashable, random: Random) -> list[Vertex]:
    steps = sorted(random.sample(range(1, STEPS), random.choice((0, 0, 1, 2, 3))))
    x, y, z = ((q - p) // STEPS for p, q in zip(start, end, strict=True))
    return [(start[0] + k * x, start[1] + k * y, start[2] + k * z, name) for k in steps]
