"""The distance of solids, against an exact search over all pairs of triangles."""

import math
import time
from fractions import Fraction
from itertools import combinations
from random import Random

import numpy as np
import pytest

import bspcsg as b
from support.shapes import random_rotation, tetrahedron


def segment_gap(p: np.ndarray, q: np.ndarray, x: np.ndarray, y: np.ndarray) -> float:
    """Return the distance of two segments."""
    ends = [point_gap(one, x, y) for one in (p, q)] + [point_gap(one, p, q) for one in (x, y)]
    u, v, r = q - p, y - x, x - p
    n = np.cross(u, v)
    if (size := n @ n) > 1e-18:
        s, t = np.cross(r, v) @ n / size, np.cross(r, u) @ n / size
        if 0 <= s <= 1 and 0 <= t <= 1:
            ends.append(abs(r @ n) / math.sqrt(size))
    return min(ends)


def point_gap(point: np.ndarray, start: np.ndarray, end: np.ndarray) -> float:
    way = end - start
    share = min(max((point - start) @ way / (way @ way), 0), 1)
    return float(np.linalg.norm(start + share * way - point))


def face_gap(point: np.ndarray, corners: np.ndarray) -> float:
    a, c, d = corners
    n = np.cross(c - a, d - a)
    sides = [np.cross(corners[k - 2] - corners[k], point - corners[k]) @ n for k in range(3)]
    return abs((point - a) @ n) / np.linalg.norm(n) if min(sides) >= 0 else math.inf


def slow_gap(one: b.Solid, other: b.Solid) -> float:
    """Return the least distance of two solids that do not overlap, over all edges and corners."""
    first, second = (solid.vertices[solid.faces] for solid in (one, other))
    gaps = []
    for f in first:
        for g in second:
            pairs = combinations(range(3), 2)
            gaps += [
                segment_gap(f[i], f[j], g[k], g[m])
                for i, j in pairs
                for k, m in [(0, 1), (1, 2), (2, 0)]
            ]
            gaps += [face_gap(p, g) for p in f] + [face_gap(p, f) for p in g]
    return min(gaps)


def random_body(rng: np.random.Generator) -> b.Solid:
    solid: b.Solid = b.hull(rng.normal(size=(6, 3)).round(3))
    return solid


@pytest.mark.sampled(3)
@pytest.mark.parametrize("seed", range(12))
def test_gaps_are_those_of_all_pairs(seed: int) -> None:
    rng = np.random.default_rng(seed)
    one = random_body(rng)
    other = random_body(rng).translate(*(rng.normal(size=3) * 4 + (6, 0, 0)).round(3).tolist())
    if one.isdisjoint(other):
        wanted = slow_gap(one, other)
        assert one.min_gap(other) == pytest.approx(wanted, rel=1e-12)
        assert other.min_gap(one) == one.min_gap(other)
        p, q = one.closest_points(other)
        assert np.linalg.norm(p - q) == pytest.approx(wanted, rel=1e-12)
        assert one.min_gap(b.hull(p + 1e-12 * np.eye(4, 3)) | one) == 0
    else:
        assert one.min_gap(other) == 0


def random_tetrahedron(random: Random) -> b.Solid:
    while True:
        corners = [[random.randint(0, 8) for _ in range(3)] for _ in range(4)]
        if abs(np.linalg.det(np.subtract(corners[1:], corners[0]))) > 20:
            return b.Solid(*tetrahedron(corners))


# Found: `intersects` and `min_gap` said that pieces which share a slanted wall do not touch (17
# of 55), by rounded corners.
@pytest.mark.sampled(4)
@pytest.mark.parametrize("seed", range(60))
def test_pieces_that_share_a_slanted_wall_touch_though_corners_are_rounded(seed: int) -> None:
    random = Random(seed)
    body, cut, other = (random_tetrahedron(random) for _ in range(3))
    rest, piece = body - cut, body & cut & other
    if (rest | piece).area > rest.area + piece.area - 1e-6:
        return
    assert rest.intersects(piece) and piece.intersects(rest)
    assert rest.isdisjoint(piece) and rest.min_gap(piece) == 0
    p, q = rest.closest_points(piece)
    assert (p == q).all()


def test_walls_apart_by_less_than_doubles_tell_do_not_touch() -> None:
    normal = (1000, 999, 998)
    ball = b.sphere(1000, segments=12)
    below, rest = ball.split(normal, 12345)
    for offset, touches in [(12345, True), (12345 + 1e-9, False)]:
        above = rest.split(normal, offset)[1]
        assert below.intersects(above) is touches
        assert below.isdisjoint(above)


def test_gaps_of_faces_edges_and_corners_are_exact() -> None:
    cube = b.cube(1)
    for by, gap in [((3, 0, 0), 2), ((4, 5, 0), 5), ((2, 3, 3), 3), ((0.5, 0.5, 1.1), 0.1)]:
        assert cube.min_gap(cube.translate(by)) == gap
    assert b.cube(4).min_gap(cube.translate(5, 1, 1)) == 1


@pytest.mark.parametrize("by", [(1, 0, 0), (1, 1, 0), (1, 1, 1), (0.25, 0.25, 1), (0.1, 0.2, 0.3)])
def test_contact_and_overlap_are_no_gap(by: tuple[float, float, float]) -> None:
    cube, other = b.cube(1), b.cube(1).translate(by)
    assert cube.min_gap(other) == 0 and cube.intersects(other)
    p, q = cube.closest_points(other)
    assert (p == q).all() and cube.classify([p])[0] >= 0 and other.classify([p])[0] >= 0


def test_a_step_of_the_lattice_is_a_gap() -> None:
    cube = b.cube(1)
    for by in [(1 + 1e-9, 0, 0), (1, 1, 1 + 1e-9), (0.25, -1 - 1e-9, 0.5)]:
        other = cube.translate(by)
        assert cube.min_gap(other) == pytest.approx(1e-9, rel=1e-6) and not cube.intersects(other)


def test_one_inside_the_other_overlaps_and_in_a_cavity_does_not() -> None:
    shell = b.cube(10) - b.cube(8).translate(1, 1, 1)
    assert b.cube(10).min_gap(b.cube(1).translate(4, 4, 4)) == 0
    assert shell.min_gap(b.cube(1).translate(4, 4, 4.5)) == 3
    assert shell.min_gap(b.cube(8).translate(1, 1, 1)) == 0


def test_gaps_of_solids_that_edges_cross() -> None:
    rng = np.random.default_rng(5)
    for _ in range(5):
        bar = b.box((10, 1, 1), center=True)
        turn = np.eye(4)
        turn[:3, :3] = random_rotation(rng)
        turn[2, 3] = 1.25
        other = bar.transform(turn)
        assert (bar.min_gap(other) == 0) == (not bar.isdisjoint(other))


def test_the_empty_set_is_far_and_has_no_points() -> None:
    assert b.cube(1).min_gap(b.Solid.empty()) == math.inf
    assert not b.cube(1).intersects(b.Solid.empty())
    with pytest.raises(b.InvalidParameterError):
        b.cube(1).closest_points(b.Solid.empty())
    with pytest.raises(b.UnboundedError):
        b.cube(1).translate(5, 0, 0).min_gap(b.half_space((1, 0, 0), 0))


def test_cost_follows_the_size() -> None:
    def seconds(segments: int) -> float:
        one = b.sphere(5, segments=segments)
        other = one.translate(12, 1, 2)
        assert one.volume == other.volume
        start = time.process_time()
        assert one.min_gap(other) > 2
        return time.process_time() - start

    assert seconds(256) < 40 * max(seconds(64), 0.05)


def test_squares_of_small_and_large_gaps() -> None:
    tiny = b.Solid(*b.cube(1).scale(1e-6).to_mesh(), pitch=-15)
    assert tiny.min_gap(tiny.translate(3e-6, 0, 0)) == pytest.approx(2e-6, rel=1e-12)
    assert Fraction(b.cube(1e6).min_gap(b.cube(1e6).translate(3e6, 0, 0))) == 2_000_000


# Found: `closest_points` of solids whose common part is so thin for doubles ended in an
# `IndexError`.
def test_what_is_common_may_be_too_thin_for_doubles() -> None:
    far = 8e6
    offset = 32_000_000 + Fraction(1, 10**9)
    cut = b.half_space((1, 3, 0), offset)  # type: ignore[arg-type]
    corner = b.box(2, 2, 1).translate(far - 1, far - 1, 0) & cut
    box = b.box(1, 1, 1).translate(far, far, 0)
    assert corner.min_gap(box) == 0
    with pytest.raises(b.LimitError, match="so thin"):
        corner.closest_points(box)
