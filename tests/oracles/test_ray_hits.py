"""All results of the ray caster against brute force in integers and fractions.

The oracle uses another method than the core: it computes the point in the facet's plane, and then
in a projection the side of each edge on which it lies.
"""

from fractions import Fraction

import numpy as np
import numpy.typing as npt
import pytest

from bspcsg import bsp
from support import drawn
from support.shapes import icosphere

Integers = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]


def lattice_scene() -> Integers:
    """Return a ball, and coplanar, overlapping, repeated and needle triangles, (n, 3, 3)."""
    rng = np.random.default_rng(3)
    vertices, faces = icosphere(1)
    ball = np.round(vertices * 40).astype(np.int64)[faces]
    soup = rng.integers(-60, 61, (25, 3, 3))
    flat = rng.integers(-60, 61, (10, 3, 3))
    flat[:, :, 2] = 20
    # Two needles, a repetition, and one without area, which is never hit.
    thin = np.array([[(0, 0, 0), (60, 1, 0), (59, 1, 0)], [(-60, 3, 9), (60, 3, 10), (0, 3, 9)]])
    none = np.array([[(0, 0, 0), (10, 10, 10), (30, 30, 30)]])
    return np.concatenate([ball, soup, flat, thin, ball[5:7], none])


def lattice_rays(scene: Integers, count: int) -> tuple[Integers, Integers]:
    """Return random rays: free, through vertices and edges, from vertices, in facets' planes."""
    rng = np.random.default_rng(4)
    origins = rng.integers(-90, 91, (count, 3))
    facets = scene[rng.integers(0, len(scene), count)]
    aims = facets[:, 0].copy()
    kind = rng.choice(7, count, p=[0.1, 0.1, 0.4, 0.2, 0.02, 0.01, 0.17])
    aims[kind == 1] = rng.integers(-60, 61, ((kind == 1).sum(), 3))
    directions = aims - origins
    edges = kind == 2
    directions[edges] = (facets[:, 0] + facets[:, 1] - 2 * origins)[edges]
    origins[kind == 3] = facets[kind == 3, 1]
    within = kind == 4
    origins[within] = (2 * facets[:, 0] - facets[:, 1])[within]
    directions[within] = (2 * facets[:, 1] + facets[:, 2] - 3 * facets[:, 0])[within]
    level = kind == 5
    origins[level, 2], directions[level, 2] = 20, 0
    axes = kind == 6
    directions[axes] = np.eye(3, dtype=np.int64)[rng.integers(0, 3, axes.sum())] * 7
    directions[(directions == 0).all(axis=1)] = (1, 0, 0)
    return origins, directions


def crossings(
    origins: Integers, directions: Integers, scene: Integers
) -> tuple[Integers, Integers, Flags, Flags]:
    """Return numerator and denominator of t, whether each ray hits each facet, and if in-plane."""
    a, b, c = scene[:, 0], scene[:, 1], scene[:, 2]
    normals = np.cross(b - a, c - a)
    below = directions @ normals.T
    above = (a * normals).sum(axis=1) - origins @ normals.T
    sign = np.where(below < 0, -1, 1)
    above, below = above * sign, below * sign
    hit = (below > 0) & (above >= 0)
    axis = np.abs(normals).argmax(axis=1)
    u, v = (axis + 1) % 3, (axis + 2) % 3
    row = np.arange(len(scene))
    # The points times their denominators, in the projection along the normal's main axis.
    x = origins[:, u] * below + above * directions[:, u]
    y = origins[:, v] * below + above * directions[:, v]
    facing = np.sign(normals[row, axis])
    for p, q in ((a, b), (b, c), (c, a)):
        edge = q - p
        turn = edge[row, u] * (y - p[row, v] * below) - edge[row, v] * (x - p[row, u] * below)
        hit &= turn * facing >= 0
    flat = (normals == 0).all(axis=1)
    within: Flags = (below == 0) & (above == 0) & ~flat
    met: Flags = hit & ~flat
    return above, below, met, within


def first_within(origin: Integers, direction: Integers, corners: Integers) -> Fraction | None:
    """Return the least t at which a ray in a triangle's plane is in the triangle, or None."""
    o = [Fraction(int(x)) for x in origin]
    d = [Fraction(int(x)) for x in direction]
    points = [[Fraction(int(x)) for x in corner] for corner in corners]
    found = [Fraction(0)] if _holds(points, o) else []
    for i in range(3):
        p, q = points[i], points[(i + 1) % 3]
        found += _on_edge(o, d, p, q)
    return min((s for s in found if s >= 0), default=None)


def _cross(a: list[Fraction], b: list[Fraction]) -> list[Fraction]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _less(a: list[Fraction], b: list[Fraction]) -> list[Fraction]:
    return [x - y for x, y in zip(a, b, strict=True)]


def _dot(a: list[Fraction], b: list[Fraction]) -> Fraction:
    return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))


def _holds(points: list[list[Fraction]], o: list[Fraction]) -> bool:
    normal = _cross(_less(points[1], points[0]), _less(points[2], points[0]))
    turns = [
        _dot(normal, _cross(_less(points[(i + 1) % 3], points[i]), _less(o, points[i])))
        for i in range(3)
    ]
    return all(turn >= 0 for turn in turns)


def _on_edge(
    o: list[Fraction], d: list[Fraction], p: list[Fraction], q: list[Fraction]
) -> list[Fraction]:
    """Return the values of t at which a line meets a segment in its plane; both ends if within."""
    along = _less(q, p)
    span = _cross(d, along)
    square = _dot(span, span)
    if square == 0:
        if any(_cross(_less(p, o), d)):
            return []
        return [_dot(_less(end, o), d) / _dot(d, d) for end in (p, q)]
    s = _dot(_cross(_less(p, o), along), span) / square
    r = _dot(_cross(_less(p, o), d), span) / square
    return [s] if 0 <= r <= 1 else []


def first_by_brute_force(
    origins: Integers, directions: Integers, scene: Integers
) -> tuple[Integers, list[Fraction | None]]:
    """Return the first facet of each ray, -1 for none, and the exact t of the hit."""
    above, below, hit, within = crossings(origins, directions, scene)
    facet = np.full(len(origins), -1)
    best = [np.ones(len(origins), dtype=np.int64), np.zeros(len(origins), dtype=np.int64)]
    for k in range(len(scene)):
        nearer = hit[:, k] & ((facet < 0) | (above[:, k] * best[1] < best[0] * below[:, k]))
        facet[nearer] = k
        best[0][nearer], best[1][nearer] = above[nearer, k], below[nearer, k]
    at = [
        Fraction(int(n), int(m)) if f >= 0 else None
        for f, n, m in zip(facet, best[0], best[1], strict=True)
    ]
    for ray, k in np.argwhere(within):
        s, old = first_within(origins[ray], directions[ray], scene[k]), at[ray]
        if s is not None and (old is None or (s, k) < (old, facet[ray])):
            at[ray], facet[ray] = s, k
    return facet, at


@pytest.fixture(scope="module")
def scene() -> Integers:
    return lattice_scene()


def test_first_hits_of_many_rays(scene: Integers) -> None:
    rays = np.array(drawn(range(100_000), 3))
    origins, directions = (each[rays] for each in lattice_rays(scene, 100_000))
    caster = bsp.RayCaster(scene.astype(float), pitch=0)
    hits = caster.first_hit(origins, directions)
    for start in range(0, len(origins), 5000):
        rows = slice(start, start + 5000)
        facet, at = first_by_brute_force(origins[rows], directions[rows], scene)
        np.testing.assert_array_equal(hits.facet[rows], facet)
        expected = [np.inf if s is None else float(s) for s in at]
        np.testing.assert_array_equal(hits.t[rows], expected)
    # The rays are of all kinds.
    assert (np.bincount(hits.kind + 1) > 0.04 * len(rays)).all()


def test_all_hits_and_kinds(scene: Integers) -> None:
    rays = np.array(drawn(range(4000), 3))
    origins, directions = (each[rays] for each in lattice_rays(scene, 4000))
    caster = bsp.RayCaster(scene.astype(float), pitch=0)
    lists = caster.all_hits(origins, directions)
    above, below, hit, within = crossings(origins, directions, scene)
    for ray, hits in enumerate(lists):
        expected = [
            (Fraction(int(above[ray, k]), int(below[ray, k])), k) for k in np.flatnonzero(hit[ray])
        ]
        for k in np.flatnonzero(within[ray]):
            s = first_within(origins[ray], directions[ray], scene[k])
            expected += [] if s is None else [(s, k)]
        expected.sort()
        assert hits.facet.tolist() == [k for _, k in expected]
        assert hits.t.tolist() == [float(s) for s, _ in expected]
        for row, (s, k) in enumerate(expected):
            point = [
                int(o) + s * int(d) for o, d in zip(origins[ray], directions[ray], strict=True)
            ]
            assert hits.kind[row] == kind_of(point, scene[k])
            np.testing.assert_allclose(hits.point[row], np.array(point, dtype=float), atol=1e-12)


def kind_of(point: list[Fraction], corners: Integers) -> int:
    points = [[Fraction(int(x)) for x in corner] for corner in corners]
    if point in points:
        return bsp.VERTEX
    for i in range(3):
        p, q = points[i], points[(i + 1) % 3]
        if not any(_cross(_less(point, p), _less(q, p))):
            return bsp.EDGE
    return bsp.INTERIOR


def test_shadows_are_all_hits_between_the_ends(scene: Integers) -> None:
    origins, directions = lattice_rays(scene, 4000)
    caster = bsp.RayCaster(scene.astype(float), pitch=0)
    above, below, hit, within = crossings(origins, directions, scene)
    plain: Flags = np.asarray(~within.any(axis=1))
    expected: Flags = np.asarray((hit & (above > 0) & (above < below)).any(axis=1))
    np.testing.assert_array_equal(
        caster.occluded(origins, origins + directions)[plain], expected[plain]
    )
    np.testing.assert_array_equal(
        caster.occluded(origins, directions=directions, max_t=1.0)[plain], expected[plain]
    )
    assert 0.2 < expected.mean() < 0.8


def test_doubles_are_taken_bit_by_bit() -> None:
    rng = np.random.default_rng(8)
    vertices, faces = icosphere(1)
    vertices = vertices @ np.linalg.qr(rng.normal(size=(3, 3)))[0] + [1 / 3, 0.1, -2]
    caster = bsp.RayCaster((vertices, faces))
    corners = [[[snapped(x) for x in p] for p in t] for t in vertices[faces]]
    origins = rng.normal(size=(150, 3)) * 3
    directions = (vertices[rng.integers(0, len(vertices), 150)] - origins) * 10.0 ** rng.integers(
        -200, 200, (150, 1)
    )
    directions[::3] += rng.normal(size=(50, 3)) * np.abs(directions[::3]).max(axis=1, keepdims=True)
    hits = caster.first_hit(origins, directions)
    for i in drawn(range(150), 3):
        o = [snapped(x) for x in origins[i]]
        d = [Fraction(x) for x in directions[i]]
        found = [(s, k) for k, t in enumerate(corners) for s in across(o, d, t)]
        s, k = min(found, default=(None, -1))
        assert hits.facet[i] == k
        assert hits.t[i] == (np.inf if s is None else float(s))
    assert 0.4 < hits.hit.mean() < 1


def snapped(x: float) -> Fraction:
    steps = Fraction(x) * 10**9
    return Fraction(int(abs(steps) + Fraction(1, 2)) * (1 if steps > 0 else -1), 10**9)


def across(o: list[Fraction], d: list[Fraction], t: list[list[Fraction]]) -> list[Fraction]:
    normal = _cross(_less(t[1], t[0]), _less(t[2], t[0]))
    slope = _dot(normal, d)
    if slope == 0:
        return []
    s = _dot(normal, _less(t[0], o)) / slope
    point = [x + s * y for x, y in zip(o, d, strict=True)]
    return [s] if s >= 0 and _holds(t, point) else []


def test_intervals_through_voxels() -> None:
    """Rays on half-integers and integers: every edge and face of the grid is hit lengthwise too."""
    rng = np.random.default_rng(12)
    full = rng.random((4, 4, 4)) < 0.5
    quads = []
    for cell in np.argwhere(full):
        for axis in range(3):
            for side in (0, 1):
                quads.append(wall(cell, axis, side))
    caster = bsp.RayCaster(np.concatenate(quads).astype(float), pitch=-1)
    origins = rng.integers(-2, 11, (2000, 3)) / 2
    directions = rng.integers(-2, 3, (2000, 3)).astype(float)
    directions[(directions == 0).all(axis=1)] = (0, 1, 0)
    found = caster.intervals(origins, directions)
    # Between two consecutive multiples of 1/4 no ray crosses a plane of the grid.
    for k in range(-1, 60):
        t = k / 4 + 0.1234
        points = origins + t * directions
        cells = np.floor(points).astype(int)
        inside = ((cells >= 0) & (cells < 4)).all(axis=1)
        expected = inside & full[tuple(np.clip(cells, 0, 3).T)] & (t > 0)
        actual = [bool(((s[:, 0] < t) & (t < s[:, 1])).any()) for s in found]
        np.testing.assert_array_equal(actual, expected)
    assert (found.t[1:, 0] >= 0).all()
    assert (found.t[:, 0] < found.t[:, 1]).all()


def wall(cell: Integers, axis: int, side: int) -> Integers:
    """Return the two triangles of one side of a unit cell, facing outwards."""
    u, v = np.eye(3, dtype=np.int64)[[(axis + 1) % 3, (axis + 2) % 3]]
    corner = cell + side * np.eye(3, dtype=np.int64)[axis]
    quad = [corner, corner + u, corner + u + v, corner + v]
    if side == 0:
        quad.reverse()
    return np.array([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]])
