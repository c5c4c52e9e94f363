"""Solids whose faces are thousands of needles: what they cost, and that they stay exact."""

from collections.abc import Callable

import numpy as np
import pytest

import bspcsg as b
from support.timing import seconds

TURN = (30, 20, 10)


def comb(teeth: int) -> b.Solid:
    """Return a bar with teeth; the needles of its caps share two corners."""
    x = 2.0 * np.arange(teeth)
    steps = [(x, 0 * x), (x + 1, 0 * x), (x + 1, 0 * x + 9), (x + 2, 0 * x + 9)]
    points = np.stack([np.column_stack(pair) for pair in steps], axis=1).reshape(-1, 2)
    return b.extrude(np.concatenate([points, [(2.0 * teeth, 10.0), (0.0, 10.0)]]), 2)


def cut_cylinder(sides: int, turn: tuple[int, int, int]) -> b.Mesh:
    """Return the mesh of a turned cylinder of many sides with a notch."""
    notch = b.cube(3).translate(8.5, -1.5, -1)
    return (b.cylinder(1, 10, segments=sides).rotate(turn) - notch.rotate(turn)).to_mesh()


@pytest.mark.parametrize(
    ("few", "make"),
    [
        (500, lambda count: comb(count).normalized()),
        (500, lambda count: comb(count).rotate(TURN).normalized()),
        (2_500, lambda count: cut_cylinder(count, TURN)),
        (10_000, lambda count: cut_cylinder(count, (0, 0, 0))),
    ],
)
def test_many_needles_cost_each_alike(few: int, make: Callable[[int], object]) -> None:
    assert seconds(lambda: make(4 * few), 2) < 10 * seconds(lambda: make(few), 2)


@pytest.mark.parametrize("teeth", [500, 2500])
def test_a_corner_of_thousands_of_needles_is_cut_at_once(teeth: int) -> None:
    part = comb(teeth) - b.cube(3).translate(0, 7, 1)
    assert seconds(lambda: part.volume_exact) < 20
    assert part.volume_exact == 22 * teeth - 7
    assert part.to_mesh().certificate.ok
