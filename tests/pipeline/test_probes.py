"""Random probes of coincidence that other engines fail now and then; here none may fail.

`scripts/probes` runs the same functions at full counts.
"""

import time
from collections.abc import Callable

import numpy as np
import pytest

from support import DEEP, measures, probes


def count(small: int, full: int) -> int:
    """Return how many rounds to run."""
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


# Found: spheres moved by 1e-12 took seconds.
def test_nearly_identical_cubes() -> None:
    assert probes.nearly_identical_cubes(count(60, 2000), seed=6) == []


def test_decimals_meet() -> None:
    assert probes.decimals_meet() == []


def test_points_on_half_spaces() -> None:
    assert probes.points_on_half_spaces(count(100, 10_000), seed=8) == []
    assert probes.corner_of_a_box() == []


@pytest.mark.deep
@pytest.mark.parametrize("clock", [time.process_time, time.perf_counter])
def test_shares_of_proofs_are_told_of_each_form(clock: measures.Clock) -> None:
    failed, shares = measures.shares_of_proofs(500, 1, clock)
    assert failed == [] and {"stl", "stl as text", "ply", "vtu"} < set(shares)
    assert all(0 <= share < 1 for share in shares.values())


@pytest.mark.deep
def test_shares_of_checks_are_told_of_each_format() -> None:
    failed, shares = measures.shares_of_checks(500, turns=1)
    assert failed == [] and {"stl", "ply", "glb"} < set(shares)
    assert all(0 <= share < 1 for share in shares.values())


@pytest.mark.deep
@pytest.mark.parametrize("measure", [measures.shares_of_proofs, measures.shares_of_checks])
def test_a_share_beyond_the_bound_is_a_failure(
    monkeypatch: pytest.MonkeyPatch, measure: Callable[..., measures.Measured]
) -> None:
    monkeypatch.setattr(measures, "LARGE", 0)
    monkeypatch.setattr(measures, "SHARE", -1.0)
    failed, shares = measure(500, turns=1)
    assert len(failed) == len(shares)


def test_chains_of_turned_cubes_stay_sound() -> None:
    assert probes.chains_of_cubes(count(6, 60), length=8, seed=7) == []


def test_a_failure_is_told_with_its_round() -> None:
    told = probes.failures(3, seed=0, probe=lambda rng: "" if rng.random() < 2 else "never")
    assert told == []
    told = probes.failures(2, seed=0, probe=lambda rng: "wrong")
    assert [failure.round for failure in told] == [0, 1]
    assert np.random.default_rng([0, 1]).random() != np.random.default_rng([0, 0]).random()
