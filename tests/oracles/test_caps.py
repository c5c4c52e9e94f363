"""Volumes of prisms with self-overlapping fans as caps, against shapely."""

import numpy as np
import numpy.typing as npt
import pytest
import shapely

import bspcsg as b

OUTLINES = 200

Corners = npt.NDArray[np.float64]


def fan_prism(outline: Corners) -> tuple[Corners, npt.NDArray[np.int64]]:
    """Return the prism of height 2 over an outline, with each cap a fan around the first corner."""
    n = len(outline)
    vertices = np.vstack([np.c_[outline, np.full(n, z)] for z in (0.0, 2.0)])
    here = np.arange(n)
    there = (here + 1) % n
    first, second = here[1:-1], here[2:]
    apex = np.zeros_like(first)
    caps = [np.c_[apex, second, first], np.c_[apex + n, first + n, second + n]]
    walls = [np.c_[here, there, there + n], np.c_[here, there + n, here + n]]
    return vertices, np.vstack(caps + walls)


def random_outline(generator: np.random.Generator, number: int) -> Corners:
    """Return a random closed polygon on a grid, or one that winds around its first corner."""
    corners = int(generator.integers(4, 16))
    if number % 3 == 0:
        return generator.integers(-5, 6, (corners, 2)).astype(float)
    turns = 1.0 if number % 3 == 1 else 1.6
    angles = np.sort(generator.uniform(0, 2 * np.pi * turns, corners))
    radii = generator.uniform(2, 9, corners)
    outline: Corners = radii[:, None] * np.c_[np.cos(angles), np.sin(angles)]
    outline[0] = 0
    outline.round(3 * (number % 2), out=outline)
    return outline


def winding_number(outline: Corners, point: shapely.Point) -> int:
    """Return the winding number of an outline about a point, by a ray along x."""
    number = 0
    for start, end in zip(outline, np.roll(outline, -1, 0), strict=True):
        if (start[1] <= point.y) != (end[1] <= point.y):
            share = (point.y - start[1]) / (end[1] - start[1])
            if start[0] + share * (end[0] - start[0]) > point.x:
                number += 1 if end[1] > start[1] else -1
    return number


def area_and_numbers(outline: Corners) -> tuple[float, set[int]]:
    """Return the area with a positive winding number, and all winding numbers of an outline."""
    lines = shapely.unary_union(shapely.LinearRing(outline))
    cells = shapely.polygonize([lines]).geoms
    numbers = [winding_number(outline, cell.representative_point()) for cell in cells]
    area = sum(c.area for c, number in zip(cells, numbers, strict=True) if number > 0)
    return area, set(numbers)


def test_volumes_of_prisms_over_any_outline() -> None:
    generator = np.random.default_rng(5)
    simple = 0
    for number in range(OUTLINES):
        outline = random_outline(generator, number)
        if (np.roll(outline, -1, 0) == outline).all(1).any():
            continue
        area, numbers = area_and_numbers(outline)
        assert b.Solid(*fan_prism(outline)).volume == pytest.approx(2 * area, abs=1e-6)
        simple += numbers <= {0, 1}
    assert OUTLINES // 8 < simple < OUTLINES - OUTLINES // 8
