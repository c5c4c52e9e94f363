"""Poses place the second mesh as their names say."""

import numpy as np
import pytest

from bspcsg.campaign.cases.poses import COINCIDENT, POSES, placed, pose_matrix, shuffled
from support.shapes import Arrays, cuboid, icosphere

FIRST = cuboid((1, 2, 3), (4, 7, 4))
SECOND = cuboid((0, 0, 0), (20, 30, 10))


def in_pose(name: str, second: Arrays = SECOND, number: int = 0) -> Arrays:
    return placed(second, pose_matrix(name, FIRST[0], second[0], 1, number))


def volume(mesh: Arrays) -> float:
    corners = mesh[0][mesh[1]]
    return float(np.linalg.det(corners).sum() / 6)


@pytest.mark.parametrize("name", POSES)
def test_poses_keep_solids_the_right_way_round(name: str) -> None:
    for number in range(3):
        assert volume(in_pose(name, number=number)) > 0


def test_random_pose_overlaps_and_is_seeded() -> None:
    ball = icosphere(1)
    mesh = in_pose("random", ball, 4)
    assert np.array_equal(mesh[0], in_pose("random", ball, 4)[0])
    assert not np.array_equal(mesh[0], in_pose("random", ball, 5)[0])
    low, high = mesh[0].min(axis=0), mesh[0].max(axis=0)
    assert (low < FIRST[0].max(axis=0)).all() and (high > FIRST[0].min(axis=0)).all()


def test_corner_and_beside_share_planes() -> None:
    corner = in_pose("corner")[0]
    assert corner.min(axis=0) == pytest.approx([1, 2, 3], abs=1e-12)
    assert np.ptp(corner, axis=0) == pytest.approx([2, 3, 1])
    beside = in_pose("beside")[0].min(axis=0)
    moved = beside - FIRST[0].min(axis=0)
    axis = int(moved.argmax())
    assert moved[axis] == pytest.approx(np.ptp(FIRST[0], axis=0)[axis])


def test_copies_keep_the_box_or_slide_along_an_axis() -> None:
    for name in ("mirror", "same"):
        mesh = in_pose(name, FIRST)[0]
        assert np.array_equal(mesh.min(axis=0), FIRST[0].min(axis=0))
        assert np.array_equal(mesh.max(axis=0), FIRST[0].max(axis=0))
    shift = in_pose("copy", FIRST)[0] - FIRST[0]
    assert np.count_nonzero(shift[0]) == 1 and (shift == shift[0]).all()
    turned = in_pose("turned", FIRST)[0]
    assert np.ptp(turned, axis=0).tolist() == [5, 3, 1]


def test_shuffling_keeps_the_faces() -> None:
    vertices, faces = shuffled(FIRST, 1, 2)
    assert vertices is FIRST[0] and not np.array_equal(faces, FIRST[1])
    assert sorted(faces.tolist()) == sorted(FIRST[1].tolist())


def test_half_of_the_poses_are_coincident() -> None:
    assert set(COINCIDENT) == set(POSES) - {"random"}
