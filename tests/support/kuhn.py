"""Meshes of Kuhn tetrahedra, and the measures of sets of these, by counting.

Each cube of a grid is divided into six tetrahedra, one for each order of the axes: the corners of a
tetrahedron are met on the way from the cube's lowest corner along the first, second and third axis.
A larger cube divided in the same way consists of such tetrahedra, too. Up to six walls meet in an
edge.
"""

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
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
Random: TypeAlias = np.random.Generator

#: Three coordinates; a fourth number tells corners in the same place apart.
Corner: TypeAlias = tuple[int, ...]

Edge: TypeAlias = tuple[Corner, Corner]

#: Corners of a triangle, counter-clockwise seen from outside; the least one comes first.
Triangle: TypeAlias = tuple[Corner, Corner, Corner]

#: An edge and the two walls that are connected there.
Meeting: TypeAlias = tuple[Edge, Triangle, Triangle]

ORDERS = list(permutations(range(3)))

#: The faces of a tetrahedron with positive volume, as places in the list of its corners.
_FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]

#: Edges can be divided at multiples of this part of their length, and walls at their centres.
STEPS = 12


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
        first, second, _ = self.order
        found = [self.low]
        for axis in self.order:
            found.append(tuple(x + self.size * (k == axis) for k, x in enumerate(found[-1])))
        is_even = (first + 1) % 3 == second
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


class Counts(NamedTuple):
    """Numbers of a set: parts, connected surfaces, and vertices minus edges plus faces."""

    parts: int
    surfaces: int
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
        corners = np.array([*faces] or np.empty((0, 3, 3)), np.int64)
        rows = corners.reshape(-1, corners.shape[-1])
        vertices, numbers = np.unique(rows, axis=0, return_inverse=True)
        return (vertices[:, :3] @ self.frame.T).astype(np.float64), numbers.reshape(-1, 3)

    def shells_apart(self, shells: Iterable[Shell]) -> Arrays:
        """Return shells as one mesh in which no two shells have a vertex in common."""
        return joined(*(self.mesh(shell.faces) for shell in shells))

    def shells_of(self, inside: Cells) -> list[Shell]:
        """Return one shell for each cell inside."""
        return [Shell(*self.cells[k]) for k in np.flatnonzero(inside)]

    def areas(self, inside: Cells) -> Counter[Corner]:
        """Return the areas of the boundary of a set by direction (see `areas_by_direction`)."""
        return areas_by_direction(*self.mesh(self.walls(inside)))

    def counts(self, inside: Cells) -> Counts:
        """Return the numbers of parts and surfaces and the Euler number of a set.

        Cells with a common face are connected. Two walls are connected at an edge if they bound the
        same wedge of the inside around it; so parts that touch only in an edge or a vertex have
        separate surfaces. An edge counts once for each wedge, and a vertex once for each fan of
        walls that are connected at its edges. These numbers depend on the set alone and are
        defined for every set; those of a mesh can be larger (see `has_twin_edges`).
        """
        parts, surfaces = Classes[int](), Classes[Triangle]()
        for sides in self._sides(inside).values():
            parts.join(*sides)
        walls, meetings = self.walls(inside), self._meetings(inside)
        for _, wall, other in meetings:
            surfaces.join(wall, other)
        vertices = _fans(meetings).count((wall, corner) for wall in walls for corner in wall)
        euler_number = vertices - len(meetings) + len(walls)
        count = parts.count(np.flatnonzero(inside).tolist())
        return Counts(count, surfaces.count(walls), euler_number)

    def has_twin_edges(self, inside: Cells) -> bool:
        """Return true if two edges of the boundary have both ends in common.

        No mesh can have such edges, so its vertices are doubled there, and perhaps its surfaces
        are parted.
        """
        meetings = self._meetings(inside)
        fans = _fans(meetings)
        ends = {tuple(fans.find((wall, end)) for end in edge) for edge, wall, _ in meetings}
        return len(ends) < len(meetings)

    def _meetings(self, inside: Cells) -> list[Meeting]:
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


def _fans(meetings: list[Meeting]) -> "Classes[tuple[Triangle, Corner]]":
    """Return the corners of walls, joined where walls are connected."""
    fans = Classes[tuple[Triangle, Corner]]()
    for edge, wall, other in meetings:
        for corner in edge:
            fans.join((wall, corner), (other, corner))
    return fans


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


def divided(grid: KuhnGrid, inside: Cells, rng: Random, *, apart: bool) -> Arrays:
    """Return the mesh of a set's walls, which are paired at random around each edge.

    The walls of a pair have the same vertices inside their edge, other pairs have others; with
    `apart`, even where these are in the same places. Each wall is a fan around its centre. The
    frame of the grid must consist of multiples of `STEPS`.
    """
    walls = list(grid.walls(inside))
    between = _vertices_inside_edges(walls, rng, apart=apart)
    faces: list[Triangle] = []
    for wall in walls:
        centre = (*(np.sum(wall, axis=0) * STEPS // 3).tolist(), 0)
        rim: list[Corner] = []
        for start, end in _half_edges(wall):
            rim += [_on_edge(start, end, 0), *between[wall, start]]
        faces += [(centre, p, q) for p, q in zip(rim, rim[1:] + rim[:1], strict=True)]
    return KuhnGrid(grid.side * STEPS, grid.frame // STEPS).mesh(faces)


def _half_edges(face: Triangle) -> Iterator[Edge]:
    return zip(face, (*face[1:], face[0]), strict=True)


def _on_edge(start: Corner, end: Corner, steps: int, name: int = 0) -> Corner:
    """Return the vertex some steps from the start of an edge, in steps of a finer grid."""
    x, y, z = (STEPS * p + steps * (q - p) for p, q in zip(start, end, strict=True))
    return x, y, z, name


def _vertices_inside_edges(
    walls: list[Triangle], rng: Random, *, apart: bool
) -> dict[tuple[Triangle, Corner], list[Corner]]:
    """Return the vertices inside each edge of each wall, given by where the edge starts there."""
    at: defaultdict[Edge, list[Triangle]] = defaultdict(list)
    for wall in walls:
        for half_edge in _half_edges(wall):
            at[half_edge].append(wall)
    inside = {}
    for start, end in [half_edge for half_edge in at if half_edge[0] < half_edge[1]]:
        mates = rng.permutation(len(at[end, start])).tolist()
        for name, (wall, mate) in enumerate(zip(at[start, end], mates, strict=True)):
            steps = rng.choice(range(1, STEPS), rng.choice((0, 0, 1, 2, 3)), replace=False)
            places = sorted(steps.tolist())
            vertices = [_on_edge(start, end, k, name if apart else 0) for k in places]
            inside[wall, start] = vertices
            inside[at[end, start][mate], end] = vertices[::-1]
    return inside
