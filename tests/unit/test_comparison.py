"""The comparison of two solids: equality, symmetric difference and distances."""

import numpy as np
import pytest

import bspcsg as b
from bspcsg._types import FloatArray
from bspcsg.mesh.distance import distances_to_triangles
from bspcsg.verify import comparison
from bspcsg.verify.comparison import compare


def test_equal_sets_of_different_meshes() -> None:
    halves = b.box((1, 2, 2)) | b.box((1, 2, 2)).translate(1, 0, 0)
    found = compare(halves, b.cube(2))
    assert found.equal and found.hausdorff == 0 and found.difference.volume == 0


def test_a_small_bump_on_a_large_body_is_found() -> None:
    body = b.cube(100)
    bumped = body | b.box((0.01, 0.01, 3)).translate(50, 50, 99)
    found = compare(body, bumped, samples=50)
    assert not found.equal
    assert found.difference.volume == pytest.approx(2e-4, rel=1e-9)
    assert found.hausdorff == pytest.approx(2, rel=1e-9)


def test_both_ways_count() -> None:
    body, dented = b.cube(10), b.cube(10) - b.cube(1).translate(4.5, 4.5, 9.5)
    for pair in ((body, dented), (dented, body)):
        # The middle of the dent's floor is half its side from the nearest wall.
        assert 0.4 < (compare(*pair, 500).hausdorff or 0) <= 0.5 + 1e-9


def test_thickness_and_place() -> None:
    found = compare(b.cube(2), b.box((2, 2, 2.001)), samples=0)
    assert found.difference.thickness == pytest.approx(0.001, rel=0.01)
    assert found.difference.place is not None and found.difference.place[2] >= 2
    assert (found.hausdorff, found.samples) == (None, 0)


def test_an_empty_set_has_no_distance() -> None:
    found = compare(b.cube(1), b.Solid.empty())
    assert not found.equal and found.hausdorff is None and found.difference.volume == 1


@pytest.mark.parametrize("shift", [0.0, 1e6])
def test_the_farthest_of_many_points_is_that_of_all_pairs(shift: float) -> None:
    body = (b.sphere(3, segments=24) - b.cylinder(9, 0.001, segments=64)).translate(shift, 0, 0)
    mesh, points = body.to_mesh(), np.random.default_rng(4).normal(size=(300, 3)) * 3
    points[:, 0] += shift
    corners = mesh.vertices[mesh.faces]
    every = [
        distances_to_triangles(np.tile(point, (len(corners), 1)), corners).min() for point in points
    ]
    assert comparison._farthest(mesh, points) == max(every)
    assert comparison.distances(mesh, points).tolist() == every


# Found: each point was compared with all triangles in a cube around it, which for a fine mesh
# filled the memory.
def test_points_far_away_are_compared_with_few_triangles(monkeypatch: pytest.MonkeyPatch) -> None:
    compared = []

    def counted(points: FloatArray, corners: FloatArray) -> FloatArray:
        compared.append(len(points))
        return distances_to_triangles(points, corners)

    monkeypatch.setattr(comparison, "distances_to_triangles", counted)
    mesh = b.sphere(1, segments=64).to_mesh()
    points = np.random.default_rng(5).normal(size=(40, 3)) * 100
    assert (comparison.distances(mesh, points) > 1).all()
    assert sum(compared) < len(points) * len(mesh.faces) / 10
