"""Random sets of few boxes and tetrahedra with small integer coordinates."""

from collections.abc import Sequence
from random import Random

import numpy as np

import bspcsg as b

from .shapes import Arrays, cuboid, tetrahedron

#: The largest coordinate; the least is 0.
REACH = 8


def random_shapes(random: Random) -> list[Arrays]:
    """Return two to six random boxes and tetrahedra."""
    return [_random_shape(random) for _ in range(random.randint(2, 6))]


def _random_shape(random: Random) -> Arrays:
    if random.random() < 0.4:
        low = [random.randrange(REACH) for _ in range(3)]
        return cuboid(low, [random.randint(x + 1, REACH) for x in low])
    while True:
        corners = [[random.randint(0, REACH) for _ in range(3)] for _ in range(4)]
        if abs(np.linalg.det(np.subtract(corners[1:], corners[0]))) > 0.5:
            return tetrahedron(corners)


def random_set(random: Random, solids: Sequence[b.Solid]) -> b.Solid:
    """Return a random expression over solids, each used at least once."""
    terms = [*solids, *random.choices(solids, k=3)]
    while len(terms) > 1:
        at = random.randrange(len(terms) - 1)
        operation = random.choice(["union", "union", "intersection", "difference", "xor"])
        terms[at : at + 2] = [getattr(b, operation)(*terms[at : at + 2])]
    return terms[0]
