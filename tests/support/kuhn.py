"""Meshes of Kuhn tetrahedra, and the measures of sets of these, by counting.

Each cube of a grid is divided into six tetrahedra, one for each order of the axes: the corners of a
tetrahedron are met on the way from the cube's lowest corner along the first, second and third axis.
A larger cube divided in the same way consists of such tetrahedra, too.
"""

from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, permutations, product
from typing import Generic, NamedTuple, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

from .shapes import Arrays, Vertices, joined

T = TypeVar("T")
Integers: TypeAlias = npt.NDArray[np.int64]
Cells: TypeAlias = npt.NDArray[np.bool_]
Corner: TypeAlias = tuple[int, ...]

Edge: TypeAlias = tuple[Corner, Corner]

#: Corners of a triangle, counter-clockwise seen from outside; the least one comes first.
Triangle: TypeAlias = tuple[Corner, Corner, Corner]

ORDERS = list(permutations(range(3)))

#: The faces of a tetrahedron with positive volume, as places in the list of its corners.
_FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]


class Shell(NamedTuple):
    """The boundary of one tetrahedron of a cube, or of the whole cube if `order` is None."""

    low: Corner
    size: int
    order: tuple[int, ...] | None
    inward: bool = False

    @property
    def tetrahedra(self) -> list["Tetrahedron"]:
        """The tetrahedra inside the shell."""
        return [Tetrahedron(self.low, self.size, o) for o in ORDERS if self.order in (None, o)]

    @property
    def faces(self) -> Counter[Triangle]:
        """The faces of the shell; the walls between the tetrahedra of a cube are left out."""
        faces = reduced(Counter(face for each in self.tetrahedra for face in each.faces))
        return Counter(map(reverse, faces)) if self.inward else faces


class Tetrahedron(NamedTuple):
    """One tetrahedron of a cube."""

    low: Corner
    size: int
    order: tuple[int, ...]

    @property
    def corners(self) -> list[Corner]:
        """The four corners, in such an order that the volume is positive."""
        steps = [np.isin(range(3), self.order[:k]) * self.size for k in range(4)]
        found = [tuple(int(x) for x in self.low + step) for step in steps]
        is_even = np.linalg.det(np.eye(3)[list(self.order)]) > 0
        return found if is_even else [found[k] for k in (0, 2, 1, 3)]

    @property
    def faces(self) -> list[Triangle]:
        """The four faces."""
        corners = self.corners
        return [_from_least(*(corners[k] for k in face)) for face in _FACES]

    def holds(self, fourfold: Integers) -> Cells:
        """Return which points, given by four times their coordinates, are inside; none is on it."""
        x, y, z = (fourfold - 4 * np.array(self.low)).T[list(self.order)]
        inside: Cells = (4 * self.size > x) & (x > y) & (y > z) & (z > 0)
        return inside


def _from_least(a: Corner, b: Corner, c: Corner) -> Triangle:
    return min((a, b, c), (b, c, a), (c, a, b))


def reverse(face: Triangle) -> Triangle:
    """Return a triangle with the opposite orientation."""
    return face[0], face[2], face[1]


def reduced(faces: Counter[Triangle]) -> Counter[Triangle]:
    """Return the triangles without pairs that differ in their orientation only."""
    return faces - Counter({reverse(face): count for face, count in faces.items()})


def tally(shells: Iterable[Shell]) -> Counter[Triangle]:
    """Return the faces of all shells."""
    return sum((shell.faces for shell in shells), Counter())


class Surfaces(NamedTuple):
    """The number of connected surfaces, and vertices minus edges plus faces."""

    number: int
    euler_number: int


@dataclass(frozen=True)
class KuhnGrid:
    """A grid of cubes that are divided into tetrahedra, its cells, and mapped by a matrix.

    Parameters
    ----------
    side : int
        The number of cubes along each axis.
    frame : (3, 3) array of int
        The matrix, with a positive determinant.
    """

    side: int
    frame: Integers

    @cached_property
    def cells(self) -> list[Tetrahedron]:
        """All cells."""
        lows = product(range(self.side), repeat=3)
        return [Tetrahedron(low, 1, order) for low in lows for order in ORDERS]

    @cached_property
    def _fourfold_centres(self) -> Integers:
        corners: Integers = np.array([cell.corners for cell in self.cells])
        return corners[:, 0] + corners[:, 1] + corners[:, 2] + corners[:, 3]

    @property
    def centres(self) -> Vertices:
        """The centres of all cells."""
        centres: Vertices = self._fourfold_centres @ self.frame.T / 4
        return centres

    @property
    def six_volumes(self) -> int:
        """Six times the volume of a cell."""
        return round(float(np.linalg.det(self.frame)))

    def winding_numbers(self, shells: Iterable[Shell]) -> Integers:
        """Return how often shells wind around each cell."""
        numbers = np.zeros(len(self.cells), np.int64)
        for shell in shells:
            for each in shell.tetrahedra:
                numbers += each.holds(self._fourfold_centres) * (-1 if shell.inward else 1)
        return numbers

    def mesh(self, faces: Iterable[Triangle]) -> Arrays:
        """Return triangles as a mesh; equal corners are one vertex."""
        corners = np.array(list(faces), np.int64).reshape(-1, 3)
        vertices, numbers = np.unique(corners, axis=0, return_inverse=True)
        return (vertices @ self.frame.T).astype(np.float64), numbers.reshape(-1, 3)

    def shells_apart(self, shells: Iterable[Shell]) -> Arrays:
        """Return shells as one mesh in which no two shells have a vertex in common."""
        return joined(*(self.mesh(shell.faces) for shell in shells))

    def shells_of(self, inside: Cells) -> list[Shell]:
        """Return one shell for each cell inside."""
        return [Shell(*self.cells[k]) for k in np.flatnonzero(inside)]

    def areas(self, inside: Cells) -> Counter[Corner]:
        """Return the areas of the boundary of a set by direction (see `areas_by_direction`)."""
        return areas_by_direction(*self.mesh(self.walls(inside)))

    def part_count(self, inside: Cells) -> int:
        """Return the number of parts of a set; cells with a common face are connected."""
        parts = Classes[int]()
        for cell, other in self._sides(inside).values():
            parts.join(cell, other)
        return parts.count(np.flatnonzero(inside).tolist())

    def surfaces(self, inside: Cells) -> Surfaces | None:
        """Return the numbers of surfaces and the Euler number of a set; None if a mesh decides.

        Two walls are connected at an edge if cells between them are connected around it. So parts
        that touch only in an edge or a vertex have separate surfaces. If an edge has two copies
        then, and these have a common end, it depends on the mesh: two edges of a mesh cannot have
        both ends in common.
        """
        walls, meetings = self.walls(inside), self._meetings(inside)
        surfaces, fans = Classes[Triangle](), Classes[tuple[Triangle, Corner]]()
        for edge, wall, other in meetings:
            surfaces.join(wall, other)
            for corner in edge:
                fans.join((wall, corner), (other, corner))
        corners = [(edge, wall, corner) for edge, wall, _ in meetings for corner in edge]
        ends = {(edge, fans.find((wall, corner))) for edge, wall, corner in corners}
        if len(ends) < len(corners):
            return None
        vertices = fans.count((wall, corner) for wall in walls for corner in wall)
        return Surfaces(surfaces.count(walls), vertices - len(meetings) + len(walls))

    def _meetings(self, inside: Cells) -> list[tuple[Edge, Triangle, Triangle]]:
        """Return the edges in which two walls are connected, with these walls."""
        wedges = Classes[tuple[int, Edge]]()
        for face, (cell, other) in self._sides(inside).items():
            for edge in _edges(face):
                wedges.join((cell, edge), (other, edge))
        met: defaultdict[tuple[int, Edge], list[Triangle]] = defaultdict(list)
        for wall, cell in self.walls(inside).items():
            for edge in _edges(wall):
                met[wedges.find((cell, edge))].append(wall)
        return [(edge, wall, other) for (_, edge), (wall, other) in met.items()]

    def walls(self, inside: Cells) -> dict[Triangle, int]:
        """Return the faces between cells inside and outside, each with its cell inside."""
        return {face: cell for face, (cell, other) in self._sides(inside).items() if cell == other}

    def _sides(self, inside: Cells) -> dict[Triangle, tuple[int, int]]:
        """Return the cells inside on both sides of each face; the same one twice for a wall."""
        own = {face: k for k in np.flatnonzero(inside).tolist() for face in self.cells[k].faces}
        return {face: (cell, own.get(reverse(face), cell)) for face, cell in own.items()}


def _edges(face: Triangle) -> list[Edge]:
    return list(combinations(sorted(face), 2))


class Classes(Generic[T]):
    """Classes of things that were joined, directly or through others."""

    def __init__(self) -> None:
        self._joined_to: dict[T, T] = {}

    def find(self, thing: T) -> T:
        """Return the thing that stands for the class of another."""
        while (above := self._joined_to.get(thing, thing)) != thing:
            thing = above
        return thing

    def join(self, one: T, other: T) -> None:
        """Join the classes of two things."""
        self._joined_to[self.find(one)] = self.find(other)

    def count(self, things: Iterable[T]) -> int:
        """Return the number of classes that have any of the things."""
        return len(set(map(self.find, things)))


def areas_by_direction(vertices: Vertices, faces: Integers) -> Counter[Corner]:
    """Return the areas of triangles by direction, in exact units, with corners rounded to integers.

    A direction is a normal of integers without common divisor, and the unit is half its length.
    """
    a, b, c = np.rint(vertices).astype(np.int64)[faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    normals = normals[normals.any(axis=1)]
    lengths = np.gcd.reduce(normals, axis=1)
    total: Counter[Corner] = Counter()
    directions = (normals // lengths[:, None]).tolist()
    for direction, length in zip(directions, lengths.tolist(), strict=True):
        total[tuple(direction)] += length
    return total
