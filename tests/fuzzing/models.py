"""Random scripts in OpenSCAD's `.csg` language; the volume of integer cubes is known."""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Rng: TypeAlias = np.random.Generator
Points: TypeAlias = npt.NDArray[np.float64]
Flags: TypeAlias = npt.NDArray[np.bool_]
Inside: TypeAlias = Callable[[Points], Flags]

#: The depth of a script, the largest size of cubes, and the largest translation of a level; all
#: coordinates stay within REACH.
DEPTH, SIZE, MOVE = 3, 4, 3
REACH = SIZE + DEPTH * MOVE + 1

_TICKS = np.arange(-REACH, REACH) + 0.5
_CENTRES = np.stack(np.meshgrid(_TICKS, _TICKS, _TICKS, indexing="ij"), axis=-1).reshape(-1, 3)

#: Shapes with any numbers.
_WILD = [
    "sphere($fn = N, r = X);",
    "cylinder($fn = N, h = X, r1 = Y, r2 = X, center = true);",
    "linear_extrude(height = X, twist = Y, slices = N, scale = [X, Y]) { square(size = [X, Y]); }",
    "rotate_extrude(angle = X, $fn = N) { intersection() { square(9); circle(r = Y); } }",
    "hull() { cube(size = [X, Y, 1]); multmatrix([[1, 0, 0, Y], [0, 1, 0, X]]) { cube(N); } }",
    "minkowski() { cube(size = [X, Y, 1]); cube(size = Y); }",
    "linear_extrude(height = X) { offset(r = Y, $fn = N) { square(size = [X, X]); } }",
    "linear_extrude(height = 1) { offset(delta = Y, chamfer = true) { circle(r = X, $fn = N); } }",
    "linear_extrude(height = 1) { projection(cut = true) { cube([X, Y, N], center = true); } }",
    "resize(newsize = [X, 0, Y], auto = true) { cube(size = [N, 1, 2]); }",
    "polyhedron(points = [[0, 0, 0], [X, 0, 0], [0, Y, 0], [0, 0, N]],"
    " faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [0, 2, 3]]);",
]
_VALUES = [
    "0",
    "1",
    "-1",
    "0.5",
    "2.25",
    "1e-9",
    "1e9",
    "1e300",
    "-0",
    "undef",
    "90",
    "360",
    '"x"',
    "[1, 2]",
    "true",
]


@dataclass(frozen=True)
class Model:
    """A script, and a function that tells which points are inside its set."""

    text: str
    inside: Inside


def random_model(rng: Rng) -> tuple[str, Fraction | None]:
    """Return a random script and its exact volume, or None if it has other shapes than cubes."""
    if rng.random() < 0.3:
        return _wild(rng), None
    model = _random(rng, DEPTH)
    return model.text + "\n", Fraction(int(model.inside(_CENTRES).sum()))


def _wild(rng: Rng) -> str:
    shapes = []
    for _ in range(int(rng.integers(1, 3))):
        x, y = (str(rng.choice(_VALUES)) for _ in range(2))
        n = str(rng.choice(["0", "3", "5", "12", "-2", "1e7", "2.5", "undef"]))
        shape = str(rng.choice(_WILD))
        shapes.append(shape.replace("X", x).replace("Y", y).replace("N", n))
    operation = str(rng.choice(["union", "difference", "intersection", "hull", "render", "group"]))
    return f"{operation}() {{ {' '.join(shapes)} }}\n"


def _random(rng: Rng, depth: int) -> Model:
    if depth == 0 or rng.random() < 0.2:
        return _cube(rng)
    makers = [_combined, _combined, _moved, _wrapped]
    return makers[int(rng.integers(len(makers)))](rng, depth)


def _cube(rng: Rng) -> Model:
    size = rng.integers(1, SIZE + 1, 3)
    x, y, z = size.tolist()
    text = f"cube(size = [{x}, {y}, {z}], center = false);"
    if rng.random() < 0.2:
        text = f"linear_extrude(height = {z}) {{ square(size = [{x}, {y}], center = false); }}"

    def inside(points: Points) -> Flags:
        found: Flags = np.all((points > 0) & (points < size), axis=1)
        return found

    return Model(text, inside)


_MERGED: dict[str, Callable[[Flags, Flags], Flags]] = {
    "union": np.logical_or,
    "group": np.logical_or,
    "intersection": np.logical_and,
    "difference": lambda p, q: p & ~q,
}


def _combined(rng: Rng, depth: int) -> Model:
    children = [_random(rng, depth - 1) for _ in range(int(rng.integers(1, 4)))]
    name = str(rng.choice(list(_MERGED)))

    def inside(points: Points) -> Flags:
        first, *others = (child.inside(points) for child in children)
        for other in others:
            first = _MERGED[name](first, other)
        return first

    return Model(f"{name}() {{ {' '.join(child.text for child in children)} }}", inside)


def _moved(rng: Rng, depth: int) -> Model:
    child = _random(rng, depth - 1)
    axes, signs = rng.permutation(3), rng.choice([-1, 1], 3)
    turn = np.zeros((3, 3), dtype=int)
    turn[np.arange(3), axes] = signs
    shift = rng.integers(-MOVE, MOVE + 1, 3)
    rows = [[*row, at] for row, at in zip(turn.tolist(), shift.tolist(), strict=True)]
    text = f"multmatrix({[*rows, [0, 0, 0, 1]]}) {{ {child.text} }}"
    return Model(text, lambda p: child.inside((p - shift) @ turn))


def _wrapped(rng: Rng, depth: int) -> Model:
    child = _random(rng, depth - 1)
    wrapper = str(rng.choice(["color([1, 0, 0, 1])", "render(convexity = 2)", "union()"]))
    return Model(f"{wrapper} {{ {child.text} group(); }}", child.inside)
