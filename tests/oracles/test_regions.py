"""Regions of crossing, overlapping and touching outlines against brute force."""

from fractions import Fraction

import numpy as np
import pytest

from bspcsg import bsp
from support.plane import RULES, area, random_loops, winding_number

# Quarters that no edge of the small lattice passes through except by design.
OFFSETS = (Fraction(1, 4), Fraction(1, 8))


def test_the_oracle_knows_a_square() -> None:
    square = [(0, 0), (2, 0), (2, 2), (0, 2)]
    assert winding_number([square], Fraction(1), Fraction(1)) == 1
    assert winding_number([square[::-1]], Fraction(1), Fraction(1)) == -1
    assert area([square, square], "positive") == 4
    assert area([square, square], "even-odd") == 0


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("seed", range(25))
def test_random_outlines(seed: int, rule: str) -> None:
    size = 4 + seed % 9
    loops = random_loops(seed, 1 + seed % 3, 3 + seed % 6, size)
    region = bsp.Region(loops, winding=rule)  # type: ignore[arg-type]
    assert region.area_exact == area(loops, rule)
    points = [(x + OFFSETS[0], y + OFFSETS[1]) for x in range(size) for y in range(size)]
    found = region.classify([(float(x), float(y)) for x, y in points])
    for (x, y), place in zip(points, found.tolist(), strict=True):
        if place != 0:
            assert (place > 0) == RULES[rule](winding_number(loops, x, y))
    assert (found != 0).mean() > 0.5


@pytest.mark.parametrize("seed", range(12))
def test_set_operations_point_by_point(seed: int) -> None:
    a, c = (bsp.Region(random_loops(s, 2, 5, 9), winding="even-odd") for s in (seed, seed + 50))
    rng = np.random.default_rng(seed)
    points = np.round(rng.uniform(-1, 9, (400, 2)), 6)
    x, y = a.classify(points) > 0, c.classify(points) > 0
    for result, expected in [(a | c, x | y), (a & c, x & y), (a - c, x & ~y), (a ^ c, x ^ y)]:
        places = result.classify(points)
        assert ((places > 0) == expected)[places != 0].all()
        assert (places != 0).sum() > 390


@pytest.mark.parametrize("seed", range(12))
def test_lines_through_regions(seed: int) -> None:
    region = bsp.Region(random_loops(seed, 2, 6, 9), winding="even-odd")
    rng = np.random.default_rng(seed)
    for _ in range(10):
        origin, direction = rng.integers(-3, 12, 2), rng.integers(-4, 5, 2)
        if not direction.any():
            continue
        stretches = region.cast(origin, direction)
        assert (np.diff(stretches.ravel()) >= 0).all()
        middles = stretches.mean(axis=1)
        assert (region.classify(origin + middles[:, None] * direction) == 1).all()
        gaps = [-20, *stretches.ravel().tolist(), 20]
        between = np.array(list(zip(gaps[::2], gaps[1::2], strict=True)))
        wide = between[np.diff(between)[:, 0] > 1e-6].mean(axis=1)
        # A line may run along an edge, so that one side of it is inside.
        aside = np.array([-direction[1], direction[0]]) * 1e-6
        beside = [region.classify(origin + wide[:, None] * direction + s * aside) for s in (-1, 1)]
        assert (np.minimum(*beside) <= 0).all()


@pytest.mark.parametrize("seed", range(8))
def test_nearest_boundary_points(seed: int) -> None:
    region = bsp.Region(random_loops(seed, 1, 6, 9), winding="nonzero")
    points = np.random.default_rng(seed).uniform(-2, 10, (50, 2))
    nearest, distance = region.nearest(points)
    loops = region.to_polygons()
    edges = [pair for p in loops for pair in zip(p, np.roll(p, -1, axis=0), strict=True)]
    samples = np.concatenate([np.linspace(a, e, 400) for a, e in edges])
    sampled = np.sqrt(((points[:, None] - samples) ** 2).sum(axis=2)).min(axis=1)
    assert (distance <= sampled + 1e-12).all()
    assert (sampled - distance < 0.05).all()
    assert np.allclose(np.hypot(*(points - nearest).T), distance)
