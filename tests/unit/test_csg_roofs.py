"""Roofs over figures, and figures with filled holes."""

import math

import numpy as np
import pytest

import bspcsg as b
from bspcsg import csg
from bspcsg.bsp import Region
from bspcsg.modelling.making.roofs import is_convex, roof
from support.scripts import moved, region, volume

RING = "difference() { square(6, center = true); square(2, center = true); }"
CORNER = "polygon([[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]]);"


def gear(digits: int) -> Region:
    """Return a wheel of 50 teeth, whose edges meet at nearly the same heights of a roof."""
    radii = [10 + k // 2 % 2 * 2 for k in range(200)]
    angles = [k * math.pi / 100 for k in range(200)]
    corners = [(r * math.cos(t), r * math.sin(t)) for r, t in zip(radii, angles, strict=True)]
    return Region.polygon(np.round(corners, digits))


# Found: `roof` and `fill` were refused.
@pytest.mark.parametrize(
    ("figure", "expected"),
    [
        ("square(6, center = true);", 36),
        ("square([4, 2]);", 2 + 4 / 3),
        # Rectangles of width 2 without one end, and that end twice as a quarter of a pyramid.
        (CORNER, 16 / 3),
        (RING, 16),
        (f"square(2); {moved(2, 2, 0)} square(2);", 8 / 3),
        (f"square(2); {moved(5, 0, 0)} square(2);", 8 / 3),
        ("square(0);", 0),
    ],
)
def test_roofs_have_their_volume(figure: str, expected: float) -> None:
    found = volume(f'roof(method = "straight", $fn = 0, $fa = 12, $fs = 2) {{ {figure} }}')
    assert found == pytest.approx(expected)


def test_roofs_by_voronoi_are_the_same_over_convex_figures() -> None:
    for figure in ("square([4, 2]);", "circle(5);", f"square(1); {moved(2, 0, 0)} circle(1);"):
        straight = volume(f'roof(method = "straight") {{ {figure} }}')
        assert volume(f"roof() {{ {figure} }}") == straight > 0
    for figure in (RING, CORNER):
        with pytest.raises(b.FormatError, match=r"roof\(\): method “voronoi” is not supp") as told:
            csg.loads(f"roof() {{ {figure} }}")
        assert told.value.code == "unsupported"
    with pytest.warns(csg.CsgWarning, match="“hip” is unknown"):
        assert volume('roof(method = "hip") square(6);') == 36


def sections(solid: b.Solid) -> list[tuple[float, float]]:
    """Return four heights of a solid, with the area of the section at each."""
    assert solid.bounds is not None
    top = float(solid.bounds[1][2])
    return [(top * part, solid.slice(top * part).area) for part in (0.1, 0.35, 0.6, 0.85)]


@pytest.mark.parametrize(
    "figure",
    [
        gear(6),
        gear(4),
        gear(3),
        Region.circle(5, 64) - Region.circle(2, 32).translate(1, 0),
        Region.rectangle(9, 9).rotate(7) - Region.rectangle(3, 1).rotate(7).translate(2, 4),
        Region.rectangle(20, 10) - Region.circle(1.5, 16).translate(8, 5),
        b.text("g&", 10),
    ],
    ids=["gear", "gear 4", "gear 3", "ring", "turned", "plate", "text"],
)
def test_sections_of_roofs_are_offsets_inwards(figure: Region) -> None:
    for height, area in sections(roof(figure)):
        assert area == pytest.approx(figure.offset(-height, "miter").area, abs=1e-6 * figure.area)


@pytest.mark.parametrize("seed", range(8))
def test_sections_of_roofs_over_lattice_figures_are_offsets(seed: int) -> None:
    rng = np.random.default_rng(seed)
    figure = Region.rectangle(3, 2)
    for x, y, wide, high in rng.integers(0, 8, (6, 4)).tolist():
        figure = figure ^ Region.rectangle(wide + 1, high + 1).translate(x, y)
    for height, area in sections(roof(figure)):
        assert area == pytest.approx(figure.offset(-height, "miter").area, abs=1e-6 * figure.area)


@pytest.mark.parametrize("seed", range(8))
def test_all_sides_of_roofs_are_equally_steep(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = 10 + seed
    angles, radii = np.sort(rng.random(count)) * math.tau, rng.random(count) * 4 + 0.5
    figure = Region.polygon(np.column_stack([np.cos(angles), np.sin(angles)]) * radii[:, None])
    solid = roof(figure)
    corners = solid.vertices[solid.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    upward = normals[:, 2] > 0
    assert solid.area == pytest.approx(figure.area * (1 + math.sqrt(2)), rel=1e-6)
    assert normals[upward, 2].sum() / 2 == pytest.approx(figure.area, rel=1e-6)


def test_roofs_of_too_many_corners_are_refused() -> None:
    with pytest.raises(
        b.LimitError, match=r"a part of the roof has 1,001 corners, and at most 1,000"
    ):
        csg.loads("roof() circle(r = 1, $fn = 1001);")
    assert is_convex(Region.circle(1, 1001))


def test_figures_are_filled() -> None:
    assert region(f"fill() {{ {RING} }}").area == 36
    island = f"{RING} square(1, center = true); {moved(9, 0, 0)} square(1);"
    assert region(f"fill() {{ {island} }}").area == 37
    assert region("fill() square(0);").is_empty
    assert csg.evaluate(csg.parse("fill();")) is None
    with pytest.warns(csg.CsgWarning, match="3D children are ignored"):
        assert csg.evaluate(csg.parse("fill() cube(1);")) is None
