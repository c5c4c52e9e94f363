"""Demonstrations that no other engine passes completely."""

import time
from statistics import median

import numpy as np
import pytest

import bspcsg as b
from support.checks import assert_sound, facts
from support.shapes import cube, moved, random_rotation, turned


def pair(shift: tuple[float, float, float]) -> tuple["b.Solid", "b.Solid"]:
    """Return the unit cube and a shifted copy."""
    return b.Solid(*cube()), b.Solid(*moved(cube(), shift))


def test_identical_cubes_leave_nothing() -> None:
    a, same = pair((0, 0, 0))
    assert (a - same).is_empty
    assert (a ^ same).is_empty
    assert facts((a - same).to_mesh()) == (0, 0, 0)
    assert facts((a | same).to_mesh()) == (8, 12, 1)
    assert facts((a & same).to_mesh()) == (8, 12, 1)


def test_cubes_that_share_a_face_become_one_box() -> None:
    a, beside = pair((1, 0, 0))
    assert facts(assert_sound(a | beside)) == (8, 12, 1)
    assert (a | beside).volume_exact == 2
    assert (a & beside).is_empty


@pytest.mark.parametrize("shift", [(1, 1, 0), (1, 1, 1)], ids=["edge", "vertex"])
def test_cubes_that_share_an_edge_or_a_vertex_stay_two(shift: tuple[float, float, float]) -> None:
    a, touching = pair(shift)
    both = a | touching
    assert facts(assert_sound(both)) == (16, 24, 2)
    assert both.volume_exact == 2
    codes = {finding.code for finding in both.findings}
    assert ("edge_contact" in codes) == (shift == (1, 1, 0))
    assert ("vertex_contact" in codes) == (shift == (1, 1, 1))


def test_cubes_turned_by_45_degrees_share_their_caps() -> None:
    centred = moved(cube(), (-0.5, -0.5, 0))
    eighth = np.array([[0.5**0.5, -(0.5**0.5), 0], [0.5**0.5, 0.5**0.5, 0], [0, 0, 1]])
    rest = b.Solid(*centred) - b.Solid(*turned(centred, eighth))
    assert len(assert_sound(rest).faces) == 32
    assert rest.volume == pytest.approx(0.171572875254, rel=1e-8)


def test_cut_and_put_back() -> None:
    """A ← (A − R) ∪ (A ∩ R) is A after every round, and later rounds take no longer."""
    rounds = 1000
    start = b.Solid(*cube())
    solid, times = start, []
    for k in range(rounds):
        rng = np.random.default_rng([9, k])
        shape = turned(moved(cube(0.8), (-0.4, -0.4, -0.4)), random_rotation(rng))
        tool = b.Solid(*moved(shape, rng.uniform(0, 1, 3)))
        began = time.perf_counter()
        solid = (solid - tool) | (solid & tool)
        triangles = len(solid.to_mesh().faces)
        times.append(time.perf_counter() - began)
        assert triangles == 12, f"round {k}"
    assert solid.equals(start)
    assert_sound(solid)
    assert len(solid.sources) < 100
    # Growth shows as a multiple of the first rounds; the slack is for a busy machine.
    fifth = rounds // 5
    assert median(times[-fifth:]) < 3 * median(times[:fifth]) + 0.005


def test_cut_and_put_back_by_one_tool_many_times() -> None:
    start = b.sphere(1, segments=24)
    triangles = len(start.to_mesh().faces)
    solid = start
    tool = b.Solid(*turned(cube(), random_rotation(np.random.default_rng(10))))
    for _ in range(10):
        solid = (solid - tool) | (solid & tool)
        assert len(solid.to_mesh().faces) == triangles
    assert solid.equals(start)


def test_a_plate_with_many_holes_in_one_expression() -> None:
    plate = b.box((21, 21, 1))
    drills = [
        b.box((1, 1, 3)).translate(2 * i + 1, 2 * j + 1, -1) for i in range(10) for j in range(10)
    ]
    drilled = b.difference(plate, *drills)
    assert drilled.volume_exact == 21 * 21 - 100
    assert assert_sound(drilled).genus == 100
