"""Clipping many polygons at once, and merging them into outlines."""

import numpy as np

from bspcsg.bsp.painting.clip import Polygons, clip
from bspcsg.bsp.painting.outline import outlines, polylines, straightened


def test_clipping_keeps_marks_of_old_edges_only() -> None:
    square = np.array([(0.0, 0), (4, 0), (4, 4), (0, 4)])
    marks = np.array([True, False, True, False])
    polygons = Polygons(square, np.array([0, 4]), marks)
    left, kept = clip(polygons, np.array([-1.0, 0.0]), -3.0)
    assert left.corners.tolist() == [[0, 0], [3, 0], [3, 4], [0, 4]]
    assert left.marked.tolist() == [True, False, True, False]
    assert kept.tolist() == [0]


def test_clipping_many_at_once() -> None:
    random = np.random.default_rng(0)
    triangles = random.normal(size=(500, 3, 3))
    polygons = Polygons(triangles.reshape(-1, 3), 3 * np.arange(501), np.ones(1500, dtype=bool))
    normal = np.array([0.3, -0.5, 0.8])
    parts = [clip(polygons, sign * normal, sign * 0.1) for sign in (1.0, -1.0)]
    areas = np.zeros(500)
    for part, kept in parts:
        assert len(part.corners) == part.offsets[-1]
        for owner, start, end in zip(kept, part.offsets, part.offsets[1:], strict=False):
            arms = part.corners[start:end] - part.corners[start]
            fan = np.cross(arms[1:-1], arms[2:]).sum(axis=0)
            areas[owner] += np.linalg.norm(fan) / 2
    whole = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    assert np.allclose(areas, np.linalg.norm(whole, axis=1) / 2)


def test_outlines_cancel_what_occurs_both_ways() -> None:
    left, right = [(0, 0), (2, 0), (2, 2), (0, 2)], [(2, 0), (5, 0), (5, 2), (2, 2)]
    (loop,) = outlines([left, right])
    assert sorted(straightened(loop)) == [(0, 0), (0, 2), (5, 0), (5, 2)]
    assert len(outlines([left, left])) == 2


def test_polylines_take_each_step_once() -> None:
    ring = [((0, 0), (1, 0)), ((1, 0), (1, 1)), ((1, 1), (0, 0))]
    (line,) = polylines([*ring, ((0, 0), (1, 0))])
    assert line[0] == line[-1] and len(line) == 4
    assert sorted(map(len, polylines([*ring, ((1, 1), (2, 2))]))) in ([2, 4], [5])
