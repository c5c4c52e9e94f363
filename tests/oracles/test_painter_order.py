"""The painter's order against rays cast through scenes in rational arithmetic."""

from fractions import Fraction
from typing import Any, TypeAlias

import numpy as np
import pytest

from bspcsg import bsp

Point: TypeAlias = tuple[Fraction, ...]

#: Hits closer than this to a fragment's border are not judged: its corners are rounded.
CLEAR = 1e-9


def exact(point: Any) -> Point:
    return tuple(Fraction(float(x)) for x in point)


def cross(a: Point, b: Point) -> Point:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def dot(a: Point, b: Point) -> Fraction:
    return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))


def minus(a: Point, b: Point) -> Point:
    return tuple(x - y for x, y in zip(a, b, strict=True))


def hit_triangle(corners: Any, eye: Point, along: Point) -> Fraction | None:
    """Return the parameter at which a ray crosses the interior of a triangle, or None."""
    a, b, c = (exact(p) for p in corners)
    normal = cross(minus(b, a), minus(c, a))
    slope = dot(normal, along)
    if slope == 0:
        return None
    t = dot(normal, minus(a, eye)) / slope
    place = tuple(e + t * d for e, d in zip(eye, along, strict=True))
    turns = [dot(normal, cross(minus(q, p), minus(place, p))) for p, q in ((a, b), (b, c), (c, a))]
    return t if min(turns) > 0 else None


def hit_segment(corners: Any, eye: Point, along: Point) -> Fraction | None:
    """Return the parameter at which a ray crosses the interior of a segment, or None."""
    a, b = (exact(p) for p in corners)
    u, w = minus(b, a), minus(a, eye)
    slope = along[0] * u[1] - along[1] * u[0]
    if slope == 0:
        return None
    t = (w[0] * u[1] - w[1] * u[0]) / slope
    s = (w[0] * along[1] - w[1] * along[0]) / slope
    return t if 0 < s < 1 else None


def depth_in(piece: Any, place: Any) -> float:
    """Return how far inside a convex fragment a point of its plane is; negative outside."""
    if len(piece) == 2:
        u = piece[1] - piece[0]
        s = float((place - piece[0]) @ u / (u @ u))
        return min(s, 1 - s)
    # Corners that are rounded to one place make an edge without a direction.
    piece = piece[np.linalg.norm(np.roll(piece, -1, axis=0) - piece, axis=1) > CLEAR]
    arms = piece - piece[:1]
    normal = np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0)
    if np.linalg.norm(normal) < CLEAR:
        return -float(np.linalg.norm(place - piece, axis=1).min(initial=1.0))
    edges = np.roll(piece, -1, axis=0) - piece
    inward = np.cross(normal / np.linalg.norm(normal), edges)
    inward /= np.linalg.norm(inward, axis=1)[:, None]
    return float(((place - piece) * inward).sum(axis=1).min())


def judge(facets: Any, order: bsp.Fragments, rays: list[tuple[Point, Point]], ahead: bool) -> int:
    """Assert that along each ray fragments are ordered farthest first; return the number of pairs.

    `ahead` is true if only the half line before the eye counts.
    """
    hit = hit_segment if np.shape(facets)[-1] == 2 else hit_triangle
    pairs = 0
    for eye, along in rays:
        met = []
        for source, corners in enumerate(facets):
            t = hit(corners, eye, along)
            if t is None or (ahead and t <= 0):
                continue
            place = np.array([float(e + t * d) for e, d in zip(eye, along, strict=True)])
            own = np.flatnonzero(order.source == source)
            depths = np.array([depth_in(order[int(k)], place) for k in own])
            if np.abs(depths).min() < CLEAR:
                continue
            inside = own[depths > 0]
            assert len(inside) == 1, "a facet's fragments overlap or leave a gap"
            met.append((t, int(inside[0])))
        for t, k in met:
            for s, m in met:
                if t < s:
                    assert m < k, "something is painted over what is nearer"
                    pairs += 1
    return pairs


def soup(random: np.random.Generator, count: int, dimension: int) -> Any:
    """Return random segments or triangles with integer coordinates that cross each other."""
    while True:
        facets = random.integers(-9, 10, (count, dimension, dimension)).astype(float)
        edges = facets[:, 1:] - facets[:, :1]
        size = np.abs(edges[:, 0]).sum(1) if dimension == 2 else None
        if size is None:
            size = np.abs(np.cross(edges[:, 0], edges[:, 1])).sum(axis=1)
        if (size > 0).all():
            return facets


def rays_from(eye: Any, facets: Any, random: np.random.Generator) -> list[tuple[Point, Point]]:
    """Return rays from an eye through random points of the facets."""
    weights = random.dirichlet(np.ones(facets.shape[1]), len(facets))
    aims = (weights[:, :, None] * facets).sum(axis=1)
    start = exact(eye)
    return [(start, minus(exact(aim), start)) for aim in aims]


@pytest.mark.sampled(5)
@pytest.mark.parametrize("policy", bsp.POLICIES)
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("top", [0, 4])
def test_from_an_eye(policy: bsp.Policy, dimension: int, top: int) -> None:
    random = np.random.default_rng([dimension, top, len(policy)])
    pairs = 0
    for _ in range(3):
        facets = soup(random, 14, dimension)
        tree = bsp.PartitionTree(facets, policy, top=top)
        eye = random.uniform(-12, 12, dimension)
        order = tree.back_to_front(eye=eye)
        pairs += judge(facets, order, rays_from(eye, facets, random), ahead=True)
    assert pairs > 20


@pytest.mark.parametrize("dimension", [2, 3])
def test_along_a_direction(dimension: int) -> None:
    random = np.random.default_rng(dimension)
    facets = soup(random, 25, dimension)
    tree = bsp.PartitionTree(facets)
    for along in [np.eye(dimension)[0], -np.eye(dimension)[1], random.normal(size=dimension)]:
        order = tree.back_to_front(direction=along)
        starts = [eye for _, eye in rays_from(np.zeros(dimension), facets, random)]
        rays = [(start, exact(along)) for start in starts]
        assert judge(facets, order, rays, ahead=False) > 10


@pytest.mark.parametrize("dimension", [2, 3])
def test_from_eyes_in_the_hyperplanes_of_facets(dimension: int) -> None:
    random = np.random.default_rng(7)
    facets = soup(random, 14, dimension)
    tree = bsp.PartitionTree(facets)
    for corners in facets[:6]:
        order = tree.back_to_front(eye=corners[0])
        assert judge(facets, order, rays_from(corners[0], facets, random), ahead=True) > 0


def test_front_to_back_is_the_reverse() -> None:
    random = np.random.default_rng(11)
    tree = bsp.PartitionTree(soup(random, 20, 3))
    there, back = tree.back_to_front(eye=[1, 2, 3]), tree.front_to_back(eye=[1, 2, 3])
    assert np.array_equal(there.source, back.source[::-1])
    assert np.array_equal(there.node, back.node[::-1])
    assert all(map(np.array_equal, there, reversed(list(back))))


def bars() -> Any:
    """Return three long triangles that overlap cyclically seen from above."""
    turns = [2 * np.pi * k / 3 for k in range(3)]
    bars = []
    for turn in turns:
        across = np.array([np.cos(turn), np.sin(turn)])
        along = np.array([-np.sin(turn), np.cos(turn)])
        left, right = across * 1.0 - along * 6, across * 1.0 + along * 6
        wide = across * 1.8 + along * 6
        bars.append([[*left, -1.0], [*wide, 1.0], [*right, 1.0]])
    return np.round(np.array(bars), 3)


def covered(bars: Any, upper: int, lower: int, random: np.random.Generator) -> bool:
    """Return true if the upper bar hides the lower one at some points and never the reverse."""
    seen = set()
    for weights in random.dirichlet(np.ones(3), 400):
        x, y, _ = weights @ bars[lower]
        ray = exact([x, y, 50.0]), exact([0, 0, -1])
        over, under = hit_triangle(bars[upper], *ray), hit_triangle(bars[lower], *ray)
        if over is not None and under is not None:
            seen.add(over < under)
    return seen == {True}


def test_a_cyclic_overlap_is_cut() -> None:
    random = np.random.default_rng(5)
    scene = bars()
    ways = [[covered(scene, (k + s) % 3, k, random) for k in range(3)] for s in (1, 2)]
    assert [True, True, True] in ways, "the scene has no cycle"
    for policy in bsp.POLICIES:
        tree = bsp.PartitionTree(scene, policy)
        assert len(tree.splits) > 0
        order = tree.back_to_front(direction=[0, 0, -1])
        flat = (random.dirichlet(np.ones(3), (60, 3))[..., None] * scene).sum(axis=2)
        rays = [(exact([x, y, 50.0]), exact([0, 0, -1])) for x, y, _ in flat.reshape(-1, 3)]
        assert judge(scene, order, rays, ahead=True) > 5


def test_points_on_a_line() -> None:
    random = np.random.default_rng(2)
    places = random.uniform(-5, 5, 40)
    tree = bsp.PartitionTree(places)
    order = tree.back_to_front(eye=0.25).vertices.ravel()
    right, left = order[order > 0.25], order[order < 0.25]
    assert (np.diff(right) < 0).all() and (np.diff(left) > 0).all()
    assert (np.diff(tree.back_to_front(direction=1.0).vertices.ravel()) < 0).all()


def test_an_eye_next_to_a_plane_is_not_on_it() -> None:
    # The double 0.1 is above a tenth, the one before it below.
    wall = [[[0, 0.1], [1, 0.1]], [[0.2, 0.0], [0.4, 0.0]], [[0.2, 0.3], [0.4, 0.3]]]
    tree = bsp.PartitionTree(wall, "first")
    above = tree.back_to_front(eye=[0.5, 0.1]).source.tolist()
    below = tree.back_to_front(eye=[0.5, np.nextafter(0.1, 0)]).source.tolist()
    assert above == [1, 0, 2]
    assert below == [2, 0, 1]
