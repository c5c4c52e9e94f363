"""The bounds of the lecture notes against measurements, each with a known chance of failure."""

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp
from bspcsg.bsp.trees import analysis

#: A chance below this is taken for impossible; it holds for any seed.
FAILURE = 1e-6


def hoeffding(width: float, count: int, claims: int = 1) -> float:
    """Return how far `claims` means may exceed their expectations, except with chance FAILURE."""
    return width * math.sqrt(math.log(claims / FAILURE) / (2 * count))


def fence(posts: int) -> Any:
    """Return a segment on the x axis and upright segments to its right that its line crosses."""
    upright = [[[k, -1], [k, 1]] for k in range(2, posts + 2)]
    return np.array([[[0, 0], [1, 0]], *upright])


def test_frequencies_keep_below_the_bound() -> None:
    trials = 3000
    for seed in range(3):
        rows = analysis.cut_frequencies(analysis.disjoint_segments(25, seed), trials, seed * trials)
        assert len(rows) > 20
        slack = hoeffding(1, trials, 3 * len(rows))
        assert all(row.frequency <= row.bound + slack for row in rows)


def test_frequencies_reach_the_bound_where_nothing_else_separates() -> None:
    posts, trials = 6, 6000
    rows = analysis.cut_frequencies(fence(posts), trials)
    assert [(row.cutter, row.cut, row.distance) for row in rows] == [
        (0, k + 1, k) for k in range(posts)
    ]
    slack = hoeffding(1, trials, 2 * posts)
    assert all(abs(row.frequency - row.bound) <= slack for row in rows)
    # The first and the last bound differ by far more than chance allows.
    assert rows[0].bound - rows[-1].bound > 4 * slack


def test_the_mean_number_of_fragments_is_the_sum_of_the_chances() -> None:
    posts, trials = 12, 4000
    expected = 1 + posts + sum(1 / (k + 2) for k in range(posts))
    counts = [len(bsp.PartitionTree(fence(posts), seed=seed).fragments) for seed in range(trials)]
    # The fragments are between 13 and 25.
    assert np.mean(counts) == pytest.approx(expected, abs=hoeffding(posts, trials, 2))


def test_fragments_of_segments_keep_below_the_bound() -> None:
    """A count lies between n and n + k, k the ordered pairs of which one line can cut the other.

    Its mean is at most n plus the sum of all 1 / (dist + 2), which is at most n + 2 n ln n.
    """
    n, trials = 60, 3000
    scene = analysis.disjoint_segments(n, 5)
    found = np.concatenate([analysis.shielding_distance(scene, i) for i in range(n)])
    chances = (1 / (found[found >= 0] + 2)).sum()
    assert chances <= 2 * n * math.log(n)
    counts = [len(bsp.PartitionTree(scene, seed=seed).fragments) for seed in range(trials)]
    slack = hoeffding(int((found >= 0).sum()), trials)
    assert np.mean(counts) <= n + chances + slack
    assert slack < 0.2 * n


def test_distances_against_their_definition() -> None:
    for seed in range(4):
        scene = analysis.disjoint_segments(30, seed)
        for i in range(len(scene)):
            assert analysis.shielding_distance(scene, i).tolist() == distances(scene, i)


def distances(scene: Any, i: int) -> list[int]:
    """Return for each s_j the number of segments that the line of s_i crosses before it."""
    (x, y), (u, v) = scene[i].astype(int).tolist()
    du, dv = u - x, v - y
    crossings: dict[int, Fraction] = {}
    for j, ((ax, ay), (bx, by)) in enumerate(scene.astype(int).tolist()):
        ex, ey = bx - ax, by - ay
        slope = du * ey - dv * ex
        if j == i or slope == 0:
            continue
        along = Fraction((ax - x) * ey - (ay - y) * ex, slope)
        within = Fraction((ax - x) * dv - (ay - y) * du, slope)
        if 0 < within < 1:
            crossings[j] = along
    counted = []
    for j in range(len(scene)):
        if j not in crossings:
            counted.append(-1)
            continue
        t = crossings[j]
        between = [s for s in crossings.values() if (1 <= s < t if t >= 1 else t < s <= 0)]
        counted.append(len(between))
    return counted


def test_random_segments_do_not_meet() -> None:
    scene = analysis.disjoint_segments(40, 1)
    assert scene.shape == (40, 2, 2)
    for i in range(40):
        for j in range(i):
            (a, c), (d, e) = (
                [[Fraction(int(x)) for x in end] for end in scene[k].tolist()] for k in (i, j)
            )
            assert not meet(a, c, d, e)
    assert np.array_equal(scene, analysis.disjoint_segments(40, 1))


def meet(a: Any, c: Any, d: Any, e: Any) -> bool:
    def turn(p: Any, q: Any, r: Any) -> int:
        value = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        return int(value > 0) - int(value < 0)

    across = turn(a, c, d) * turn(a, c, e), turn(d, e, a) * turn(d, e, c)
    return max(across) <= 0 and any(across)


@pytest.mark.parametrize("policy", bsp.POLICIES)
def test_the_grid_is_quadratic_under_every_policy(policy: bsp.Policy) -> None:
    """Of two strips that pass each other the first to be a pivot cuts the other one there."""
    for n in (8, 16, 32):
        k = n // 2
        grid = analysis.ruled_grid(n)
        assert len(bsp.PartitionTree(grid, policy).fragments) == n + k * k
        assert len(bsp.PartitionTree(grid, policy, top=4).fragments) >= n + k * k
    assert bsp.PartitionTree(analysis.ruled_grid(4)).pitch == -9


def test_strips_of_the_grid_are_disjoint() -> None:
    grid = analysis.ruled_grid(12)
    for first in grid:
        for second in grid:
            if first is second or (first[0] == first[1])[0] == (second[0] == second[1])[0]:
                continue
            # They pass each other on one upright line, at different heights.
            x = first[0, 0] if first[0, 0] == first[1, 0] else second[0, 0]
            y = first[0, 1] if first[0, 1] == first[1, 1] else second[0, 1]
            spans = [height_above(strip, x, y) for strip in (first, second)]
            assert spans[0][1] < spans[1][0] or spans[1][1] < spans[0][0]


def height_above(strip: Any, x: float, y: float) -> tuple[float, float]:
    axis = 0 if strip[0, 0] != strip[1, 0] else 1
    t = ((x, y)[axis] - strip[0, axis]) / (strip[1, axis] - strip[0, axis])
    low = strip[0, 2] + t * (strip[1, 2] - strip[0, 2])
    high = strip[3, 2] + t * (strip[2, 2] - strip[3, 2])
    return low, high


def test_surfaces_are_near_linear() -> None:
    table = analysis.growth_table((), (), [b.sphere(1, segments=k) for k in (16, 64)], trials=2)
    few, many = table
    assert many.n > 15 * few.n
    exponent = math.log(many.fragments / few.fragments) / math.log(many.n / few.n)
    assert exponent < 1.2


def test_the_table() -> None:
    table = analysis.growth_table((50, 100), (8, 16), trials=2)
    assert [row.scene for row in table] == ["disjoint segments"] * 2 + ["ruled grid"] * 2
    assert [row.fragments for row in table[2:]] == [24, 80]
    assert table[1].bound == 100 + 200 * math.log(100)
    assert all(row.seconds > 0 and row.ratio <= 1 for row in table)
    lines = str(table).splitlines()
    assert len(lines) == 5 and len({len(line) for line in lines}) == 1


@pytest.mark.parametrize("n", [3, -2, 1.5])
def test_bad_sizes_are_refused(n: Any) -> None:
    with pytest.raises(b.InvalidMeshError):
        analysis.ruled_grid(n)


def test_bad_segments_are_refused() -> None:
    for bad in ([[[0, 0], [0.5, 1]]], [[0, 0]], [[[0, 0], [1 << 26, 1]]]):
        with pytest.raises(b.InvalidMeshError):
            analysis.cut_frequencies(bad)
