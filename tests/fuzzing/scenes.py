"""Random scenes: operands that coincide, nearly or exactly, and an expression over them.

Coordinates are integers in lattice steps of 1e-9 units, so that nothing is rounded.
"""

import pickle
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import gcd
from typing import Any, TypeAlias

import numpy as np

import bspcsg as b

from .places import Below, Known, Point, Surface, Triangle, cross, dot, less, minus

Rng: TypeAlias = np.random.Generator

#: Steps in a unit, and their exponent.
UNIT, PITCH = 10**9, -9

#: The numbers of lattice steps of which coordinates are multiples: a unit, a tenth, one step.
GRIDS = (UNIT, UNIT // 10, 1)

#: The largest numbers of parts of an operand, operands of a scene, operations of an expression.
PARTS, OPERANDS, OPERATIONS = 3, 4, 6

Expression: TypeAlias = int | tuple[Any, ...]

_CUBE = [[k >> 2 & 1, k >> 1 & 1, k & 1] for k in range(8)]
_QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
_CUBE_FACES = tuple(t for p, q, r, s in _QUADS for t in ((p, q, r), (p, r, s)))
_TETRAHEDRON_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))


@dataclass(frozen=True)
class Part:
    """A closed surface; `plain` is true if it is embedded and oriented outwards."""

    vertices: tuple[Point, ...]
    faces: tuple[tuple[int, int, int], ...]
    plain: bool

    def turned(self) -> "Part":
        """Return the part with all faces reversed."""
        return Part(self.vertices, tuple((p, r, q) for p, q, r in self.faces), False)

    def triangles(self) -> list[Triangle]:
        """Return the corners of all faces."""
        v = self.vertices
        return [(v[p], v[q], v[r]) for p, q, r in self.faces]


def cuboid_part(low: Point, high: Point) -> Part:
    """Return the box between two corners."""
    ends = (low, high)
    return Part(tuple((ends[i][0], ends[j][1], ends[k][2]) for i, j, k in _CUBE), _CUBE_FACES, True)


def tetrahedron_part(corners: Sequence[Point]) -> Part | None:
    """Return the tetrahedron of four points in any order; None if they are coplanar."""
    p, q, r, s = corners
    turn = dot(cross(less(q, p), less(r, p)), less(s, p))
    if turn == 0:
        return None
    ordered = (p, q, r, s) if turn > 0 else (p, r, q, s)
    return Part(ordered, _TETRAHEDRON_FACES, True)


@dataclass(frozen=True)
class Motion:
    """A lattice motion, and the Python text that applies it.

    For each new axis, `axes` has the old axis and its sign.
    """

    axes: tuple[tuple[int, int], ...] = ((0, 1), (1, 1), (2, 1))
    shift: Point = (0, 0, 0)
    words: str = ""

    def point(self, p: Point) -> Point:
        """Return the image of a point under the motion."""
        x, y, z = (s * p[axis] + at for (axis, s), at in self._rows())
        return x, y, z

    @property
    def mirrors(self) -> bool:
        """Return true if the motion is orientation-reversing."""
        order = [axis for axis, _ in self.axes]
        even = order in ([0, 1, 2], [1, 2, 0], [2, 0, 1])
        return even != (np.prod([s for _, s in self.axes]) > 0)

    def _rows(self) -> Any:
        return zip(self.axes, self.shift, strict=True)


@dataclass(frozen=True)
class Body:
    """An operand: a mesh of parts, or the half-space below three points; then moved."""

    parts: tuple[Part, ...] = ()
    rule: str = "positive"
    plane: Triangle | None = None
    motions: tuple[Motion, ...] = ()

    @property
    def volume(self) -> Fraction | None:
        """The exact volume if the operand is one plain part, else None."""
        if self.plane is not None or len(self.parts) != 1 or not self.parts[0].plain:
            return None
        six = sum(dot(p, cross(q, r)) for p, q, r in self.parts[0].triangles())
        return Fraction(six, 6 * UNIT**3)

    def known(self) -> Known:
        """Return the moved operand as a set of the exact reference."""
        if self.plane is not None:
            return Below(self._moved(self.plane))
        faces = [self._moved(each) for part in self.parts for each in part.triangles()]
        flat = {
            each
            for each in faces
            if cross(less(each[1], each[0]), less(each[2], each[0])) == (0, 0, 0)
        }
        return Surface(tuple(each for each in faces if each not in flat), self.rule)

    def _moved(self, corners: Triangle) -> Triangle:
        p, q, r = corners
        for motion in self.motions:
            p, q, r = motion.point(p), motion.point(q), motion.point(r)
            if motion.mirrors:
                q, r = r, q
        return p, q, r

    def arrays(self) -> tuple[list[list[float]], list[list[int]]]:
        """Return the vertices of all parts, in units, and their faces."""
        vertices = [[k / UNIT for k in p] for part in self.parts for p in part.vertices]
        starts = np.cumsum([0] + [len(part.vertices) for part in self.parts]).tolist()
        faces = [
            [start + k for k in face]
            for part, start in zip(self.parts, starts, strict=False)
            for face in part.faces
        ]
        return vertices, faces

    def half_space(self) -> tuple[list[float], float]:
        """Return normal and offset of the operand's plane in units, both short decimals."""
        assert self.plane is not None
        p, q, r = self.plane
        n = cross(less(q, p), less(r, p))
        size = gcd(*n)
        return [float(k // size) for k in n], dot(n, p) // size / UNIT


@dataclass(frozen=True)
class Scene:
    """Operands, an expression over their indices, and points to classify."""

    bodies: tuple[Body, ...]
    expression: Expression
    points: tuple[Point, ...]

    def known(self) -> list[Known]:
        """Return the operands as sets of the exact reference."""
        return [body.known() for body in self.bodies]

    def value(self, inside: Sequence[bool]) -> bool:
        """Return whether a point is inside, given for each operand whether it is."""
        return value_of(self.expression, inside)

    @property
    def is_bounded(self) -> bool:
        """Return true if no operand is a half-space and the expression excludes infinity."""
        return all(body.plane is None for body in self.bodies) and not self.value(
            [False] * len(self.bodies)
        )

    def text(self) -> str:
        """Return the expression as Python text, with each operand moved."""
        return text_of(self.expression, self.bodies)


def value_of(expression: Expression, inside: Sequence[bool]) -> bool:
    """Return the truth value of an expression, given the value of each operand."""
    if isinstance(expression, int):
        return inside[expression]
    operator, *arguments = expression
    found = [value_of(argument, inside) for argument in arguments]
    if operator in ("copied", "asked"):
        return found[0]
    if operator == "~":
        return not found[0]
    first, second = found
    values = {
        "|": first or second,
        "&": first and second,
        "-": first and not second,
        "^": first != second,
    }
    return values[operator]


def text_of(expression: Expression, bodies: Sequence[Body]) -> str:
    """Return an expression over ``a``, ``b``, … as Python text."""
    if isinstance(expression, int):
        words = (motion.words for motion in bodies[expression].motions)
        return chr(ord("a") + expression) + "".join(words)
    operator, *arguments = expression
    found = [text_of(argument, bodies) for argument in arguments]
    if operator == "~":
        return f"~({found[0]})"
    if operator in ("copied", "asked"):
        return f"{operator}({found[0]})"
    return f"({found[0]} {operator} {found[1]})"


def asked_for(expression: Expression, *, steps: bool) -> Expression:
    """Return the expression with each operation evaluated at once (`steps`), or with none."""
    if isinstance(expression, int):
        return expression
    operator, *arguments = expression
    inner = [asked_for(argument, steps=steps) for argument in arguments]
    if operator == "asked":
        return inner[0]
    return ("asked", (operator, *inner)) if steps else (operator, *inner)


def copied(solid: "b.Solid") -> "b.Solid":
    """Return the solid after pickling and unpickling."""
    found: b.Solid = pickle.loads(pickle.dumps(solid))
    return found


def asked(solid: "b.Solid") -> "b.Solid":
    """Return the solid after evaluating it."""
    solid.is_empty  # noqa: B018
    return solid


#: The functions that expressions may call.
CALLS = {"copied": copied, "asked": asked}


# Random scenes


def random_scene(rng: Rng) -> Scene:
    """Return a random scene with many coincident parts."""
    grid, reach = int(rng.choice(GRIDS, p=[0.6, 0.25, 0.15])), int(rng.choice([2, 3, 6]))
    parts: list[Part] = []
    bodies = tuple(
        _random_body(rng, grid, reach, parts) for _ in range(int(rng.integers(1, OPERANDS + 1)))
    )
    expression = random_expression(rng, len(bodies))
    scene = Scene(bodies, expression, ())
    points = _random_points(rng, scene.known(), grid, reach)
    return replace(scene, bodies=tuple(_irregular(rng, body) for body in bodies), points=points)


def _irregular(rng: Rng, body: Body) -> Body:
    """Return the same set, often with divided faces or separate vertices."""
    parts = [divided_part(rng, part) if rng.random() < 0.2 else part for part in body.parts]
    parts = [loose_part(part) if rng.random() < 0.1 else part for part in parts]
    return replace(body, parts=tuple(parts))


def divided_part(rng: Rng, part: Part) -> Part:
    """Return a part with T-junctions: faces divided on one side of an edge, or with flat faces."""
    vertices, faces = list(part.vertices), list(part.faces)
    for _ in range(int(rng.integers(1, 4))):
        k = int(rng.integers(len(faces)))
        p, q, r = np.roll(faces[k], rng.integers(3)).tolist()
        along, steps = _divided(less(vertices[q], vertices[p]))
        if steps > 1:
            vertices.append(_sum(vertices[p], along, int(rng.integers(1, steps))))
            m = len(vertices) - 1
            faces[k] = (p, m, r)
            faces += [(m, q, r), (p, q, m)] if rng.random() < 0.3 else [(m, q, r)]
    return Part(tuple(vertices), tuple(faces), part.plain)


def loose_part(part: Part) -> Part:
    """Return a part whose faces share no vertices."""
    corners = tuple(part.vertices[k] for face in part.faces for k in face)
    faces = ((k, k + 1, k + 2) for k in range(0, len(corners), 3))
    return Part(corners, tuple(faces), part.plain)


def _random_body(rng: Rng, grid: int, reach: int, earlier: list[Part]) -> Body:
    motions = tuple(random_motion(rng, grid) for _ in range(int(rng.choice([0, 0, 1, 2]))))
    if rng.random() < 0.15:
        plane = _random_corners(rng, max(grid, UNIT // 10), reach, 3)
        surfaces = [part for part in earlier if _is_coarse(part)]
        if surfaces and rng.random() < 0.6:
            part = surfaces[int(rng.integers(len(surfaces)))]
            order = rng.choice(len(part.vertices), 3, replace=False)
            plane = [part.vertices[int(k)] for k in order]
        p, q, r = plane
        if cross(less(q, p), less(r, p)) != (0, 0, 0):
            return Body(plane=(p, q, r), motions=motions)
    parts: list[Part] = []
    for _ in range(int(rng.choice([1, 1, 1, 2, PARTS]))):
        part = _random_part(rng, grid, reach, earlier + parts)
        parts.append(part.turned() if rng.random() < 0.1 else part)
    earlier.extend(parts)
    rule = str(rng.choice(["positive", "positive", "nonzero", "even-odd"]))
    return Body(tuple(parts), rule, None, motions)


def _is_coarse(part: Part) -> bool:
    return all(k % (UNIT // 10) == 0 for p in part.vertices for k in p)


def _random_part(rng: Rng, grid: int, reach: int, earlier: Sequence[Part]) -> Part:
    if earlier and rng.random() < 0.3:
        return _nearly(rng, earlier[int(rng.integers(len(earlier)))])
    if rng.random() < 0.45:
        part = tetrahedron_part(_random_corners(rng, grid, reach, 4))
        if part is not None:
            return part
    first, second = _random_corners(rng, grid, reach, 2)
    low = [min(h, k) for h, k in zip(first, second, strict=True)]
    size = [abs(h - k) or grid for h, k in zip(first, second, strict=True)]
    x, y, z = low
    return cuboid_part((x, y, z), (x + size[0], y + size[1], z + size[2]))


def _nearly(rng: Rng, part: Part) -> Part:
    """Return a copy of a part: equal, shifted by some steps, or with some corners shifted."""
    kind = int(rng.integers(3))
    if kind == 0:
        return part
    most = int(rng.choice([1, 3, 1000]))
    shift = rng.integers(-most, most + 1, 3).tolist()
    moved = rng.random(len(part.vertices)) < (1.0 if kind == 1 else 0.3)
    vertices = [
        (p[0] + shift[0], p[1] + shift[1], p[2] + shift[2]) if at else p
        for p, at in zip(part.vertices, moved.tolist(), strict=True)
    ]
    return Part(tuple(vertices), part.faces, part.plain and kind == 1)


def random_plane(rng: Rng, grid: int, reach: int) -> Triangle | None:
    """Return three random points of a plane; None if they are collinear."""
    p, q, r = _random_corners(rng, grid, reach, 3)
    return None if cross(less(q, p), less(r, p)) == (0, 0, 0) else (p, q, r)


def _random_corners(rng: Rng, grid: int, reach: int, count: int) -> list[Point]:
    scale = UNIT // grid if grid == 1 else 1
    drawn = rng.integers(0, reach * scale + 1, (count, 3)).tolist()
    return [(x * grid, y * grid, z * grid) for x, y, z in drawn]


def random_motion(rng: Rng, grid: int) -> Motion:
    kind, axis = int(rng.integers(4)), int(rng.integers(3))
    if kind == 0:
        x, y, z = (int(k) * grid for k in rng.integers(-2, 3, 3))
        decimals = ", ".join(repr(k / UNIT) for k in (x, y, z))
        return Motion(shift=(x, y, z), words=f".translate({decimals})")
    if kind == 1:
        signs = tuple((k, -1 if k == axis else 1) for k in range(3))
        unit = tuple(int(k == axis) for k in range(3))
        return Motion(axes=signs, words=f".mirror({unit})")
    if kind == 2:
        second, third = (axis + 1) % 3, (axis + 2) % 3
        rows = {axis: (axis, 1), second: (third, -1), third: (second, 1)}
        return Motion(axes=tuple(rows[k] for k in range(3)), words=f".rotate(90, '{'xyz'[axis]}')")
    turn, signs = rng.permutation(3).tolist(), rng.choice([-1, 1], 3).tolist()
    matrix = [[signs[i] * (k == turn[i]) for k in range(3)] for i in range(3)]
    words = f".transform({_matrix(matrix)})"
    return Motion(axes=tuple(zip(turn, signs, strict=True)), words=words)


def _matrix(rows: list[list[int]]) -> list[list[int]]:
    return [*([*row, 0] for row in rows), [0, 0, 0, 1]]


def random_expression(rng: Rng, operands: int) -> Expression:
    """Return a random expression that uses each operand."""
    values: list[Expression] = list(range(operands))
    extra = int(rng.integers(0, max(OPERATIONS - operands, 0) + 1))
    values += [int(k) for k in rng.integers(0, operands, extra)]
    while len(values) > 1:
        first = values.pop(int(rng.integers(len(values))))
        second = values.pop(int(rng.integers(len(values))))
        made: Expression = (str(rng.choice(list("||&&--^"))), first, second)
        if rng.random() < 0.1:
            made = ("~", made)
        if rng.random() < 0.25:
            made = (str(rng.choice(list(CALLS))), made)
        values.append(made)
    return values[0]


def _random_points(rng: Rng, sets: Sequence[Known], grid: int, reach: int) -> tuple[Point, ...]:
    """Return random points: corners, points on edges and faces, points near these, and others."""
    triangles = [each for known in sets for each in _triangles(known)]
    points = _random_corners(rng, max(grid // 4, 1), reach * 4 if grid > 3 else reach, 6)
    for k in rng.integers(0, len(triangles), 14).tolist():
        points.append(point_of(rng, triangles[k]))
    for k in rng.integers(0, len(points), 6).tolist():
        x, y, z = points[k]
        dx, dy, dz = rng.integers(-2, 3, 3).tolist()
        points.append((x + dx, y + dy, z + dz))
    return tuple(points)


def _triangles(known: Known) -> Sequence[Triangle]:
    return known.triangles if isinstance(known, Surface) else (known.corners,)


def point_of(rng: Rng, triangle: Triangle) -> Point:
    """Return a random lattice point of a triangle: a corner, or one on an edge or inside."""
    order = rng.permutation(3).tolist()
    p, q, r = (triangle[k] for k in order)
    if rng.random() < 0.3:
        return p
    along, steps = _divided(less(q, p))
    x = int(rng.integers(0, steps + 1))
    if rng.random() < 0.5:
        return _sum(p, along, x)
    aside, more = _divided(less(r, p))
    y = int(rng.integers(0, max((steps - x) * more // steps, 0) + 1))
    return _sum(_sum(p, along, x), aside, y)


def _divided(edge: Point) -> tuple[Point, int]:
    size = gcd(*edge) or 1
    x, y, z = edge
    return (x // size, y // size, z // size), size


def _sum(p: Point, along: Point, times: int) -> Point:
    return less(p, minus((along[0] * times, along[1] * times, along[2] * times)))
