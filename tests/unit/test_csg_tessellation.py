"""The number of sides of round shapes in scripts."""

import math

import pytest

from bspcsg import csg
from support.scripts import region

# Tessellation


@pytest.mark.parametrize(
    ("arguments", "sides"),
    [
        ("r = 1", 5),
        ("r = 10", 30),
        ("r = 0.1", 5),
        ("r = 1, $fn = 2", 3),
        ("r = 1, $fn = 12.9", 12),
        ("r = 1, $fn = nan", 3),
        ("r = 10, $fa = 5, $fs = 0.1", 72),
        ("d = 20", 30),
    ],
)
def test_circles_have_openscads_sides(arguments: str, sides: int) -> None:
    (outline,) = region(f"circle({arguments});").outlines
    assert len(outline.points) == sides


def test_special_variables_hold_inside_a_node() -> None:
    def sides(text: str) -> int:
        return len(region(text).to_polygons()[0])

    assert sides("union($fn = 8) circle(r = 1);") == 8
    assert sides("union($fn = 8) group($fa = 1) circle(r = 1, $fn = 4);") == 4
    assert sides("union($fn = 8); circle(r = 1);") == 5


@pytest.mark.parametrize(("r", "faces", "sides"), [(1, 22, 5), (10, 842, 30)])
def test_spheres_have_no_poles(r: int, faces: int, sides: int) -> None:
    mesh = csg.loads(f"sphere(r = {r});").to_mesh()
    rings = (sides + 1) // 2
    assert len(mesh.vertices) == rings * sides
    assert len(mesh.faces) == 2 * (sides - 2) + 2 * sides * (rings - 1)
    # OpenSCAD counts each cap as one.
    assert faces == 2 + 2 * sides * (rings - 1)
    assert mesh.vertices[:, 2].max() == pytest.approx(r * math.cos(math.pi / 2 / rings))


def test_first_ring_of_a_sphere() -> None:
    bounds = csg.loads("sphere(r = 10, $fn = 8);").bounds
    assert bounds is not None
    assert bounds[1, 2] == pytest.approx(9.238795325, abs=1e-9)


# What is left out


@pytest.mark.parametrize(
    ("argument", "faces"), [("$fa = nan", 5), ("$fa = inf", 5), ("$fs = nan", 30)]
)
def test_sides_that_are_no_numbers(argument: str, faces: int) -> None:
    assert len(region(f"circle(r = 1, {argument});").to_polygons()[0]) == faces
