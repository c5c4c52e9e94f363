"""Distances of points from triangles, wide ones and needles."""

import numpy as np
import pytest

from bspcsg.mesh.distance import distances_to_triangles, nearest_on_triangles

RIGHT = np.array([(0.0, 0, 0), (4, 0, 0), (0, 3, 0)])


@pytest.mark.parametrize(
    ("point", "distance"),
    [
        ((1, 1, 2), 2.0),
        ((1, 1, 0), 0.0),
        ((4, 3, 0), 2.4),
        ((-3, -4, 0), 5.0),
        ((2, -1, 0), 1.0),
        ((6, 0, 2), 8**0.5),
    ],
)
def test_face_side_and_corner(point: tuple[float, ...], distance: float) -> None:
    for turn in range(3):
        triangle = np.roll(RIGHT, turn, axis=0)
        found = distances_to_triangles(np.array([point]), triangle[None])
        assert found[0] == pytest.approx(distance, abs=1e-15)
        assert distances_to_triangles(np.array([point]), triangle[None, ::-1])[0] == found[0]


def test_needles_far_away_err_by_their_width_only() -> None:
    rng = np.random.default_rng(1)
    start = rng.uniform(-1, 1, (2000, 3)) + 1000
    along = rng.normal(size=(2000, 3))
    width = rng.normal(size=(2000, 3)) * 1e-9
    corners = np.stack([start, start + along, start + 0.4 * along + width], axis=1)
    weights = rng.dirichlet((1, 1, 1), 2000)
    points = np.einsum("kc,kci->ki", weights, corners)
    assert distances_to_triangles(points, corners).max() < 1e-8
    off = np.cross(along, rng.normal(size=(2000, 3)))
    off /= np.linalg.norm(off, axis=1)[:, None]
    assert distances_to_triangles(points + off, corners) == pytest.approx(1, abs=1e-8)


def test_triangle_without_area_is_its_longest_side() -> None:
    flat = np.array([[(0.0, 0, 0), (2, 0, 0), (1, 0, 0)]])
    assert distances_to_triangles(np.array([(1.5, 2, 0)]), flat)[0] == 2
    assert distances_to_triangles(np.array([(5.0, 4, 0)]), flat[:, [0, 0, 0]])[0] == 41**0.5


def test_nearest_points_are_at_the_distances() -> None:
    rng = np.random.default_rng(2)
    corners = rng.normal(size=(5000, 3, 3))
    points = rng.normal(size=(5000, 3)) * 2
    found = nearest_on_triangles(points, corners)
    distances = distances_to_triangles(points, corners)
    assert np.linalg.norm(found - points, axis=1) == pytest.approx(distances, abs=1e-12)
    assert distances_to_triangles(found, corners).max() < 1e-12
    flat = np.array([[(0.0, 0, 0), (2, 0, 0), (1, 0, 0)]])
    assert nearest_on_triangles(np.array([(1.5, 2, 0)]), flat).tolist() == [[1.5, 0, 0]]
