"""Random probes of coincidence, in which other engines sometimes fail; here none may fail."""

import pytest

from support import DEEP, measures, probes


def count(small: int, full: int) -> int:
    """Return the number of rounds: `full` in a deep run, else `small`."""
    return full if DEEP else small


def test_tetrahedra_glued_on_a_triangle() -> None:
    assert probes.glued_tetrahedra(count(300, 20_000), seed=1) == []


def test_parts_of_an_intersection_put_together() -> None:
    assert probes.parts_reunited(count(60, 1000), seed=2) == []


def test_halves_of_a_random_cut_put_together() -> None:
    assert probes.halves_reunited(count(60, 1000), seed=3) == []


def test_boxes_turned_together_meet_in_their_face() -> None:
    assert probes.boxes_turned_together(count(100, 3000), seed=4) == []


def test_half_of_a_turned_box_taken_away() -> None:
    assert probes.half_of_turned_box(count(100, 3000), seed=5) == []


@pytest.mark.parametrize("far", [0.0, 1e3, 1e6, 1e9, 1e12])
def test_cubes_anywhere(far: float) -> None:
    assert probes.cubes_at(far) == []


# Found: operations on spheres that differ by a translation of 1e-12 took seconds.
def test_nearly_identical_cubes() -> None:
    assert probes.nearly_identical_cubes(count(60, 2000), seed=6) == []


def test_decimals_meet() -> None:
    assert probes.decimals_meet() == []


def test_points_on_half_spaces() -> None:
    assert probes.points_on_half_spaces(count(100, 10_000), seed=8) == []
    assert probes.corner_of_a_box() == []


@pytest.mark.timeout(600)
def test_crossings_of_nearly_coincident_parts_are_told() -> None:
    assert measures.crossings(count(100, 10_000))[0] == []


@pytest.mark.deep
@pytest.mark.timeout(1800)
def test_proofs_take_a_small_share_of_writing() -> None:
    assert measures.shares_of_proofs(327_000, turns=7)[0] == []


@pytest.mark.deep
@pytest.mark.timeout(1800)
def test_checks_take_a_small_share_of_reading() -> None:
    assert measures.shares_of_checks(327_000)[0] == []


def test_chains_of_turned_cubes_stay_sound() -> None:
    assert probes.chains_of_cubes(count(6, 60), length=8, seed=7) == []
