"""Cameras: the positions of points in a picture, and refusals."""

from typing import Any, get_args

import numpy as np
import pytest

from bspcsg import InvalidMeshError, bsp
from bspcsg.bsp.painting.camera import View

BOX = np.array([(0.0, 0, 0), (4, 3, 2)])


def test_perspective_of_known_points() -> None:
    camera = bsp.Camera.perspective((0, -10, 0), (0, 0, 0), field_of_view=90)
    image, depth = camera.project([(0, 0, 0), (5, 0, 5), (10, 0, 0), (0, 10, 5)])
    assert np.allclose(image, [(0, 0), (0.5, 0.5), (1, 0), (0, 0.25)], atol=1e-15)
    assert np.allclose(depth, [10, 10, 10, 20])
    assert camera.eye is not None and camera.eye.tolist() == [0, -10, 0]


def test_points_not_in_front_of_the_eye_have_no_image() -> None:
    camera = bsp.Camera.perspective((0, 0, 0), (0, 1, 0))
    image, depth = camera.project([(1, 0, 1), (1, -2, 1), (1, 1e-9, 1)])
    assert np.isnan(image[:2]).all()
    assert np.isfinite(image[2]).all()
    assert depth.tolist() == [0, -2, 1e-9]


def test_parallel_projection_of_known_points() -> None:
    camera = bsp.Camera.orthographic((0, 0, -2), up=(0, 1, 0), scale=10, target=(1, 1, 1))
    image, depth = camera.project([(1, 1, 1), (6, 1, 0), (1, 6, 4)])
    assert np.allclose(image, [(0, 0), (1, 0), (0, 1)])
    assert np.allclose(depth, [0, 1, -3])
    assert camera.eye is None


@pytest.mark.parametrize(
    ("view", "nearest", "right"),
    [
        ("front", (0, -1, 0), (1, 0, 0)),
        ("back", (0, 1, 0), (-1, 0, 0)),
        ("left", (-1, 0, 0), (0, -1, 0)),
        ("right", (1, 0, 0), (0, 1, 0)),
        ("top", (0, 0, 1), (1, 0, 0)),
        ("bottom", (0, 0, -1), (-1, 0, 0)),
    ],
)
def test_named_views(view: View, nearest: Any, right: Any) -> None:
    camera = bsp.Camera.named(view, BOX)
    assert np.array_equal(-camera.direction, nearest)
    assert np.array_equal(camera.axes[0], right)


@pytest.mark.parametrize("view", get_args(View))
@pytest.mark.parametrize("field_of_view", [None, 20, 100])
@pytest.mark.parametrize("aspect", [0.5, 1, 3])
def test_named_views_fit(view: View, field_of_view: float | None, aspect: float) -> None:
    points = np.random.default_rng(1).uniform(-3, 9, (60, 3))
    camera = bsp.Camera.named(view, points, aspect, field_of_view, margin=0.1)
    image, _ = camera.project(points)
    used = np.abs(image / (aspect, 1)).max()
    assert used == pytest.approx(0.8)
    assert np.allclose(camera.axes @ camera.axes.T, np.eye(3))


def test_two_points_are_a_box() -> None:
    corners = [(x, y, z) for x in (0, 4) for y in (0, 3) for z in (0, 2)]
    fitted = [bsp.Camera.named("iso", points) for points in (BOX, corners)]
    assert fitted[0].half_height == fitted[1].half_height
    assert np.array_equal(fitted[0].origin, fitted[1].origin)


@pytest.mark.parametrize("points", [np.zeros((0, 3)), np.full((1, 3), 5.0), np.full((9, 3), 5.0)])
@pytest.mark.parametrize("field_of_view", [None, 40])
def test_nothing_and_a_single_point_can_be_looked_at(points: Any, field_of_view: Any) -> None:
    camera = bsp.Camera.named("iso", points, field_of_view=field_of_view)
    image, _ = camera.project(points)
    assert np.abs(image).max(initial=0) < 1e-9
    assert camera.half_height > 0


def test_up_is_found_for_looking_down() -> None:
    assert np.array_equal(bsp.Camera.orthographic((0, 0, -1)).axes[1], (0, 1, 0))
    assert np.allclose(bsp.Camera.orthographic((1, 1, 0)).axes[1], (0, 0, 1))


def test_lengths_of_directions_do_not_matter() -> None:
    for length in (1e-200, 1.0, 1e200):
        camera = bsp.Camera.orthographic((length, 2 * length, 0), up=(0, 0, length))
        assert np.allclose(camera.direction, (5**-0.5, 2 * 5**-0.5, 0))


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"target": (1, 2, 3)}, "two different points"),
        ({"up": (0, 0, 0)}, "up vector of the camera must not be"),
        ({"up": (-2, -4, -6), "target": (2, 4, 6)}, "parallel"),
        ({"eye": (0, float("nan"), 0)}, "finite"),
        ({"eye": (0, 0)}, "three"),
        ({"target": "there"}, "three numbers"),
        ({"field_of_view": 0}, "field of view"),
        ({"field_of_view": 180}, "field of view"),
        ({"field_of_view": "wide"}, "field_of_view"),
    ],
)
def test_refused_perspectives(change: dict[str, Any], text: str) -> None:
    with pytest.raises(InvalidMeshError, match=text):
        bsp.Camera.perspective(**{"eye": (1, 2, 3), "target": (0, 0, 0), **change})


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"direction": (0, 0, 0)}, "direction of view must not be the zero"),
        ({"direction": (0, 0, float("inf"))}, "finite"),
        ({"up": (3, 0, 0)}, "parallel"),
        ({"scale": 0}, "scale"),
        ({"scale": float("nan")}, "scale"),
    ],
)
def test_refused_parallel_projections(change: dict[str, Any], text: str) -> None:
    with pytest.raises(InvalidMeshError, match=text):
        bsp.Camera.orthographic(**{"direction": (1, 0, 0), **change})


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"view": "above"}, "view must be one of"),
        ({"points": [(0, 0)]}, "points to fit"),
        ({"points": [(0, 0, float("nan"))]}, "points to fit"),
        ({"points": "box"}, "points to fit"),
        ({"margin": 0.5}, "margin"),
        ({"aspect": 0}, "aspect"),
    ],
)
def test_refused_views(change: dict[str, Any], text: str) -> None:
    with pytest.raises(InvalidMeshError, match=text):
        bsp.Camera.named(**{"view": "iso", "points": BOX, **change})


# Found: cameras kept the caller's array of the eye, and their own array could be changed.
def test_cameras_keep_copies_that_nobody_writes_into() -> None:
    eye, target = np.array([0.0, -10, 0]), np.array([0.0, 0, 0])
    cameras = [bsp.Camera.perspective(eye, target), bsp.Camera.orthographic((0, 1, 0), target=eye)]
    eye[0] = 100
    for camera in cameras:
        assert camera.origin.tolist() == [0, -10, 0]
        for array in (camera.origin, camera.axes, camera.direction):
            with pytest.raises(ValueError, match="read-only"):
                array[:] = 7


# Found: a perspective that was to show all of a scene could have its eye on the scene's nearest
# point.
@pytest.mark.parametrize(
    "points", [[(0, -2, 0), (5, 3, 0), (-5, 3, 0), (0, 3, 5)], [(0, -1, 0), (0, 1, 0), (0, 0, 0)]]
)
def test_points_on_the_axis_of_a_fitted_perspective_are_in_the_picture(points: Any) -> None:
    camera = bsp.Camera.named("front", points, field_of_view=90)
    image, depth = camera.project(points)
    assert depth.min() > 0
    assert np.abs(image / (4 / 3, 1)).max() <= 1


# Found: pictures from very far away leaked a warning of numpy to the terminal.
@pytest.mark.filterwarnings("error")
def test_eyes_very_far_away_see_which_faces_are_turned_to_them() -> None:
    camera = bsp.Camera.perspective((1e300, 0, 0), (0, 0, 0))
    cosines = camera.facing(np.zeros((2, 3)), np.array([(1.0, 0, 0), (0, 1.0, 0)]))
    assert cosines.tolist() == [1, 0]
