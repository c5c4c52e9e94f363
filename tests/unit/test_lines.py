"""Edges on different lines that are equal modulo a 61-bit prime."""

import pytest

import bspcsg as b
from support.checks import assert_sound

#: Steps of a lattice of 1e-9.
STEP = 1e-9


def slanted_prism() -> b.Solid:
    """Return a prism with two sides on lines that are equal modulo 2^61 - 1."""
    long, short = (2**31 * STEP, STEP), (STEP, 2**30 * STEP)
    corners = [(0.0, 0.0), long, (long[0] + short[0], long[1] + short[1]), short]
    return b.Region.polygon(corners).extrude(1)


# Found: lines that are the same modulo 2⁶¹ − 1 were taken for one, and one line for two, which
# ended in an `InternalError`.
@pytest.mark.parametrize("operation", [b.Solid.__or__, b.Solid.__sub__, b.Solid.__and__])
def test_sides_that_a_prime_takes_for_one_line(operation: object) -> None:
    prism, cube = slanted_prism(), b.cube(0.25).translate(1, 0.5, 0.8)
    made = operation(prism, cube)  # type: ignore[operator]
    assert_sound(made)
    assert made.genus == 0
    both = (prism | cube).volume_exact + (prism & cube).volume_exact
    assert both == prism.volume_exact + cube.volume_exact


def test_planes_whose_meet_a_prime_takes_for_nothing() -> None:
    cube = b.cube(4).translate(-2, -2, -2)
    one, other = b.half_space((2**31, 1, 0), 0), b.half_space((1, 2**30, 0), 0)
    parts = [cube & one & other, cube & one - other, cube & other - one, cube - one - other]
    for part in parts:
        assert_sound(part)
        assert part.genus == 0
    assert b.union(parts).equals(cube)
    assert sum(part.volume_exact for part in parts) == cube.volume_exact
