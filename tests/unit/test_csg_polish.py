"""Corners in scripts that would coincide without rounding to six digits."""

import math
import warnings

import numpy as np
import pytest

from bspcsg import csg
from bspcsg.bsp import Region
from support.scripts import moved


def test_polish_makes_turned_boxes_meet() -> None:
    turn = (
        "multmatrix([[0.866025, -0.5, 0, {}], [0.5, 0.866025, 0, {}], [0, 0, 1, 0], [0, 0, 0, 1]])"
    )
    # 25.9808 is 30 cos 30°, to six digits; 30 times 0.866025 is less.
    text = turn.format(0, 0) + "cube([30, 10, 10]);" + turn.format("25.9808", 15) + "cube(10);"
    rough, polished = csg.loads(text), csg.loads(text, polish=True)
    assert len(rough.to_trimesh().vertices) == 16
    assert len(polished.to_trimesh().vertices) == 12
    assert polished.volume == pytest.approx(4000, rel=2e-5)
    assert polished.tree.pitch == -4


MOVES = {
    "a translation": "[[1, 0, 0, 5], [0, 1, 0, -3], [0, 0, 1, 0.25], [0, 0, 0, 1]]",
    "a mirror": "[[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]",
    "a quarter turn": "[[0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]]",
}


# Found: `polish` did not reach the parts of a model that is moved as a whole.
@pytest.mark.parametrize("move", MOVES)
@pytest.mark.parametrize("around", ["{}", "group() {{ {} }}", "render() {{ union() {{ {} }} }}"])
def test_polish_reaches_parts_inside_of_moves(move: str, around: str) -> None:
    turn = (
        "multmatrix([[0.866025, -0.5, 0, {}], [0.5, 0.866025, 0, {}], [0, 0, 1, 0], [0, 0, 0, 1]])"
    )
    inner = turn.format(0, 0) + "cube([30, 10, 10]);" + turn.format("25.9808", 15) + "cube(10);"
    inner = around.format(inner + " %sphere(50);")
    text = f"multmatrix({MOVES[move]}) multmatrix({MOVES['a translation']}) {{ {inner} }}"
    rough, polished = csg.loads(text), csg.loads(text, polish=True)
    assert len(rough.to_mesh().vertices) == 16
    assert len(polished.to_mesh().vertices) == 12
    assert polished.volume == pytest.approx(4000, rel=2e-5)
    assert polished.bounds == pytest.approx(rough.bounds, abs=1e-3)


def test_polish_moves_differences_part_by_part() -> None:
    turn = "multmatrix([[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])"
    flat = "multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1]])"
    inner = "difference() { cube(4); cube([2, 2, 4]); %cube(9); } intersection() { }"
    for text, volume in [(f"{turn} {{ {inner} }}", 48), (f"cube(1); {flat} {{ {inner} }}", 1)]:
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            assert csg.loads(text, polish=True).volume == pytest.approx(volume)
        assert len(said) == (1 if volume == 1 else 0)


def test_polish_takes_moves_nested_to_any_depth() -> None:
    step = "multmatrix([[1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])"
    solid = csg.loads(step * 300 + "{ cube(1); cube([2, 1, 1]); }", polish=True)
    assert solid.volume == 2 and solid.bounds is not None and solid.bounds[0, 0] == 150


# Found: `--polish` moved corners by twenty times what it cured.
@pytest.mark.parametrize("size", [0.03, 10, 700])
@pytest.mark.parametrize("offset", [0, 40, 500, 12345])
def test_polish_moves_corners_by_what_it_says_and_no_farther(size: float, offset: float) -> None:
    turn = (
        "multmatrix([[0.866025, -0.5, 0, {}], [0.5, 0.866025, 0, {}], [0, 0, 1, 0], [0, 0, 0, 1]])"
    )
    x, y = 3 * size * math.cos(math.pi / 6), 1.5 * size
    near = f"{turn.format(0, 0)} cube([{3 * size:g}, {size:g}, {size:g}]);"
    near += f"{turn.format(format(x, '.6g'), format(y, '.6g'))} cube({size:g});"
    far = f"multmatrix([[1, 0, 0, {offset}], [0, 1, 0, -9], [0, 0, 1, 0], [0, 0, 0, 1]]) cube(1);"
    told: list[csg.Polish] = []
    text = near + far if offset else near
    polished = csg.loads(text, polish=True, on_polish=told.append)
    found = polished.to_mesh().vertices
    assert len(found) == (20 if offset else 12) and told[0].pitch is not None
    assert told[0].pitch == polished.tree.pitch
    np.testing.assert_array_equal(found, np.round(found, -told[0].pitch))
    along, across = np.array([x, y, 0]) / 3, np.array([-y, x, 0]) / 3
    places = [i * along + j * across for i in (0, 3, 4) for j in (0, 1)]
    exact = np.array([place + [0, 0, k * size] for place in places for k in (0, 1)])
    gaps = np.linalg.norm(exact[:, None] - found, axis=2).min(axis=1)
    bound = math.sqrt(3) / 2 * 10.0 ** told[0].pitch
    # The numbers in the text are off by half a unit of the sixth digit.
    written = 10.0 ** (math.floor(math.log10(4 * size)) - 5)
    assert 0 < told[0].moved <= bound and gaps.max() <= told[0].moved + written
    assert 10.0 ** told[0].pitch <= 10 * written


def test_polish_moves_nothing_where_nothing_meets_by_it() -> None:
    thin = "cube([1, 1, 0.000123]);"
    far = "multmatrix([[1, 0, 0, 5000], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])"
    large = "multmatrix([[5000, 0, 0, 0], [0, 5000, 0, 0], [0, 0, 5000, 0], [0, 0, 0, 1]])"
    parts = "union() { cube(0.001234); cube([0.004321, 0.001, 0.001]); }"
    told: list[csg.Polish] = []
    for text in f"{far} cube(1.23457);", f"{large} {parts}", thin:
        polished = csg.loads(text, polish=True, on_polish=told.append)
        assert polished.equals(csg.loads(text)) and told.pop() == (None, 0.0)


def test_polish_spares_small_parts() -> None:
    turn = (
        "multmatrix([[0.866025, -0.5, 0, {}], [0.5, 0.866025, 0, {}], [0, 0, 1, 0], [0, 0, 0, 1]])"
    )
    large = f"{turn.format(0, 0)} cube([3000, 1000, 1000]);"
    large += f"{turn.format('2598.08', 1500)} cube(1000);"
    ball = f"{moved(-1, 0, 0)} sphere(r = 0.03, $fn = 16);"
    polished = csg.loads(large + ball, polish=True)
    assert len(csg.loads(large + ball).to_mesh().vertices) == 16 + 128
    assert len(polished.to_mesh().vertices) in (16 + 128, 12 + 128)


def test_polish_lets_plane_figures_meet() -> None:
    move = "multmatrix([[1, 0, 0, 3.33333], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])"
    tree = csg.parse(f"square([3.333333, 2]); {move} square([1, 2]);")
    told: list[csg.Polish] = []
    figure = csg.evaluate(tree, polish=True, on_polish=told.append)
    assert isinstance(figure, Region)
    assert told[0].pitch == -5 and told[0].moved == pytest.approx(3e-6)
    assert len(np.concatenate(figure.to_polygons())) == 4


def test_polish_keeps_what_is_no_rotation() -> None:
    shear = "multmatrix([[1, 0.01, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])"
    bounds = csg.loads(f"{shear} cube(10);", polish=True).bounds
    assert bounds is not None
    assert bounds[1, 0] == pytest.approx(10.1)
    assert csg.loads("", polish=True).is_empty


# Found: `csg.evaluate(..., polish=True)` raised its warnings twice.
def test_polish_tells_a_warning_once() -> None:
    near = 'cube([10, 10, 10.00001]); cube(9); import("no.stl");'
    up = "multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 10], [0, 0, 0, 1]]) cube(10);"
    told: list[csg.Polish] = []
    with pytest.warns(csg.CsgWarning) as said:
        csg.loads(near + up, polish=True, on_polish=told.append)
    assert told[0].pitch == -4
    assert len(said) == 1


def at(x: float, y: float, z: float) -> str:
    return f"multmatrix([[1, 0, 0, {x}], [0, 1, 0, {y}], [0, 0, 1, {z}], [0, 0, 0, 1]])"


THIN = {
    "a plate": "cube([100, 100, 0.0004]);",
    "a plate with a block": "render() { cube([100, 100, 0.0004]);" + at(0, 0, 20) + "cube(3); }",
}


# Found: polishing a script removed plates and figures thinner than half a step, in silence.
@pytest.mark.parametrize("thin", THIN)
def test_polish_removes_no_body(thin: str) -> None:
    nearly = "".join(
        at(x, 0, 50) + "cube([10, 10, 10.0001]);" + at(x, 0, 60) + "cube(10);" for x in (0, 20, 40)
    )
    told: list[csg.Polish] = []
    polished = csg.loads(THIN[thin] + nearly, polish=True, on_polish=told.append)
    alone = csg.loads(THIN[thin])
    assert told[0].pitch == -3
    assert polished.volume == pytest.approx(alone.volume + 6000, rel=1e-9)
    assert len(polished.decompose()) == len(alone.decompose()) + 3


def test_polish_removes_no_figure() -> None:
    nearly = at(0, 50, 0) + "square([10, 10.0001]);" + at(0, 60, 0) + "square(10);"
    nearly += at(10.0001, 50, 0) + "square(10);"
    polished = csg.evaluate(csg.parse("square([100, 0.0004]);" + nearly), polish=True)
    assert isinstance(polished, Region)
    assert polished.area == pytest.approx(300.04, abs=1e-9)
