"""Solids at the limits of the lattice, where doubles are as coarse, equal those at the origin."""

from random import Random

import numpy as np
import pytest

import bspcsg as b
from support.shapes import cuboid, moved, tetrahedron
from support.small import random_set, random_shapes

# Coordinates are below this many steps.
END = 2**53


def triangles(solid: b.Solid) -> list[list[list[float]]]:
    """Return the sorted corners of each triangle, all triangles in order."""
    return sorted(sorted(triangle) for triangle in solid.vertices[solid.faces].tolist())


def far_corner(random: Random) -> list[int]:
    """Return an offset that keeps coordinates from 0 to 8 on the lattice, mostly near its end."""
    near_end = END - random.randint(9, 90)
    ends = [
        near_end,
        -near_end - 8,
        END // 2 - random.randint(0, 9),
        END - 2 ** random.randint(4, 50),
        0,
    ]
    return [random.choice(ends) for _ in range(3)]


@pytest.mark.sampled(4)
@pytest.mark.parametrize("seed", range(120))
def test_sets_of_random_shapes_are_the_same_at_the_end_of_the_lattice(seed: int) -> None:
    random = Random(seed)
    shapes = random_shapes(random)
    offset, state = far_corner(random), random.getstate()
    near = random_set(random, [b.Solid(*shape, pitch=0) for shape in shapes])
    random.setstate(state)
    far = random_set(random, [b.Solid(*moved(shape, offset), pitch=0) for shape in shapes])
    assert far.volume_exact == near.volume_exact
    points = np.array([[random.randint(-1, 9) for _ in range(3)] for _ in range(60)])
    assert (far.classify(points + offset) == near.classify(points)).all()
    back = far.normalized().translate(*(-x for x in offset))
    assert triangles(back) == triangles(near.normalized())


# Found: walls along which doubles tell points apart worse than across, as at the end of the
# lattice, could keep crossings in any order: the result had no mesh.
def test_walls_that_run_between_coordinates_of_doubles() -> None:
    def cut_union(at: int) -> b.Solid:
        shapes = (
            cuboid((4, 4, 4), (5, 5, 5)),
            tetrahedron([(2, 0, 0), (7, 0, 7), (4, 6, 5), (2, 8, 0)]),
            cuboid((2, 0, 2), (5, 6, 6)),
            cuboid((4, 1, 3), (8, 7, 5)),
        )
        small, tetra, wide, last = (b.Solid(*moved(s, (at, at, at)), pitch=0) for s in shapes)
        return (small | tetra | wide | last) - wide

    near = cut_union(0)
    for at in (END - 10, END - 14, END - 18, END - 26, END - 42, END - 1034):
        far = cut_union(at)
        assert far.volume_exact == near.volume_exact
        assert triangles(far.translate(-at, -at, -at)) == triangles(near)
