"""Random solids for property tests, of few kinds, so that many faces coincide."""

import numpy as np
from hypothesis import strategies as st

import bspcsg as b

from .shapes import cube, cuboid, moved, random_rotation, tetrahedron, turned

_small = st.integers(-2, 2)


@st.composite
def boxes(draw: st.DrawFn) -> "b.Solid":
    """Return an axis-parallel box with small integer corners."""
    low = [draw(_small) for _ in range(3)]
    size = [draw(st.integers(1, 3)) for _ in range(3)]
    return b.Solid(*cuboid(low, [at + length for at, length in zip(low, size, strict=True)]))


@st.composite
def tetrahedra(draw: st.DrawFn) -> "b.Solid":
    """Return a tetrahedron with small integer corners."""
    points = np.array(
        draw(
            st.lists(st.tuples(_small, _small, _small), min_size=4, max_size=4, unique=True).filter(
                lambda p: abs(np.linalg.det(np.subtract(p[1:], p[0]).astype(float))) > 0.5
            )
        )
    )
    return b.Solid(*tetrahedron(points))


@st.composite
def turned_cubes(draw: st.DrawFn) -> "b.Solid":
    """Return a cube that is rotated at random."""
    rotation = random_rotation(np.random.default_rng(draw(st.integers(0, 2**32))))
    centred = moved(cube(draw(st.sampled_from([1.0, 2.0, 2.5]))), (-0.5, -0.5, -0.5))
    return b.Solid(*moved(turned(centred, rotation), [draw(_small) / 2 for _ in range(3)]))


@st.composite
def balls(draw: st.DrawFn) -> "b.Solid":
    """Return a coarse sphere made by the package."""
    ball = b.sphere(
        draw(st.sampled_from([0.75, 1.0, 1.5])), segments=draw(st.sampled_from([6, 8, 12]))
    )
    return ball.translate(draw(_small), draw(_small), draw(_small))


def solids() -> st.SearchStrategy["b.Solid"]:
    """Return a strategy for boxes, tetrahedra, rotated cubes, balls and the empty set."""
    kinds = (boxes(), tetrahedra(), turned_cubes(), balls(), st.builds(b.Solid.empty))
    return st.one_of(*kinds)
