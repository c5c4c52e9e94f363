"""The parts of a prism are the prisms over the parts of its base, which other code computes."""

from random import Random

import numpy as np
import pytest

import bspcsg as b

#: The largest coordinate; the least is 0.
REACH = 8

HEIGHT = 2


def triangle(random: Random) -> b.Region:
    while True:
        corners = [(random.randint(0, REACH), random.randint(0, REACH)) for _ in range(3)]
        region = b.Region.polygon(corners)
        if region.area > 1:
            return region


def base_and_prism(seed: int) -> tuple[b.Region, b.Solid]:
    """Return a random expression of a square and triangles, and the same of prisms over them."""
    random = Random(seed)
    base = b.Region.rectangle(REACH, REACH)
    prism = base.extrude(HEIGHT)
    for _ in range(random.randint(1, 6)):
        operation = random.choice(["difference", "difference", "difference", "union", "xor"])
        more = triangle(random)
        base = getattr(b, operation)(base, more)
        prism = getattr(b, operation)(prism, more.extrude(HEIGHT))
    return base, prism


@pytest.mark.sampled(4)
@pytest.mark.parametrize("axis", ["x", "y", "z"])
@pytest.mark.parametrize("first", range(0, 120, 20))
def test_parts_of_prisms_are_prisms_over_parts(first: int, axis: str) -> None:
    divided = 0
    for seed in range(first, first + 20):
        base, prism = base_and_prism(seed)
        if axis != "z":
            prism = prism.rotate(90, axis)
        parts = prism.decompose()
        expected = [HEIGHT * part.area for part in base.decompose()]
        assert len(parts) == len(expected), seed
        assert np.allclose([part.volume for part in parts], sorted(expected, reverse=True)), seed
        assert b.union(parts).volume == pytest.approx(prism.volume)
        divided += prism.to_mesh().surface_count < prism.surface_count
    # Else no edge lay in the middle of a wall that goes on from one part to another.
    assert divided > 0
