"""The Python interface of the ray caster: shapes, errors, and rays in one and two dimensions."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp
from support import DEEP
from support.shapes import icosphere

SQUARE = [[[0, 0], [4, 0]], [[4, 0], [4, 4]], [[4, 4], [0, 4]], [[0, 4], [0, 0]]]


def test_a_solid_names_its_sources() -> None:
    caster = bsp.RayCaster(b.cube(2) - b.cube(1))
    hits = caster.first_hit([[0.5, 0.25, 5], [1.5, 0.25, 5], [9, 9, 9]], [0, 0, -1])
    assert hits.t.tolist() == [3, 3, np.inf]
    assert hits.hit.tolist() == [True, True, False]
    assert hits.source is not None
    assert hits.source[:, 0].tolist() == [0, 0, -1]
    inner = caster.first_hit([0.5, 0.25, 0.5], [0, 0, 1])
    assert inner.source is not None
    assert inner.source[0, 0] == 1
    np.testing.assert_array_equal(inner.normal, [[0, 0, -1]])
    assert np.isnan(hits.normal[2]).all()
    assert repr(caster).startswith("RayCaster(")


def test_no_ray_slips_through_a_closed_mesh() -> None:
    vertices, faces = icosphere(4)
    caster = bsp.RayCaster((vertices, faces))
    corners = vertices[faces]
    aims = np.concatenate([vertices, (corners + np.roll(corners, 1, axis=1)).reshape(-1, 3) / 2])
    rng = np.random.default_rng(5)
    inside = rng.normal(size=aims.shape) * 0.2
    assert caster.first_hit(inside, aims - inside).hit.all()
    assert caster.first_hit([0, 0, 0], aims).hit.all()
    assert (np.diff(caster.intervals(inside, aims - inside).offsets) == 1).all()
    # From outside, through vertices: in and out again.
    found = caster.intervals(aims * 3, -aims)
    assert (np.diff(found.offsets) == 1).all()
    np.testing.assert_allclose(found.lengths() * np.linalg.norm(aims, axis=1), 2, atol=0.02)


def test_first_facets_are_those_of_first_hits() -> None:
    vertices, faces = icosphere(3)
    caster = bsp.RayCaster((vertices, faces))
    origins = np.random.default_rng(4).normal(size=(3000, 3)) * 2
    directions = np.concatenate([vertices, -vertices, vertices])[:3000][: len(origins)]
    origins = origins[: len(directions)]
    facets = caster.first_facet(origins, directions)
    assert facets.dtype == np.int64
    np.testing.assert_array_equal(facets, caster.first_hit(origins, directions).facet)
    assert 0 < (facets < 0).sum() < len(facets)
    assert caster.first_facet(np.zeros((0, 3)), np.zeros((0, 3))).shape == (0,)
    with pytest.raises(b.InvalidMeshError):
        caster.first_facet([0, 0, 0], [0, 0, 0])


def test_normals_of_few_hits_are_those_of_many() -> None:
    rng = np.random.default_rng(6)
    for dimension in (1, 2, 3):
        facets = rng.normal(size=(200, dimension, dimension))
        caster = bsp.RayCaster(facets)
        rays = rng.normal(size=(2, 400, dimension))
        many, few = caster.first_hit(*rays), caster.first_hit(*rays[:, :100])
        assert few.hit.any()
        assert many[:100].normal.tobytes() == few.normal.tobytes()


def test_bytes_are_the_same_for_any_number_of_threads() -> None:
    vertices, faces = icosphere(4)
    rng = np.random.default_rng(2)
    origins = rng.normal(size=(20_000, 3)) * 2
    directions = vertices[rng.integers(0, len(vertices), 20_000)] - origins
    answers = set()
    for threads in (1, 2, 3):
        for deferred in (True, False):
            caster = bsp.RayCaster((vertices, faces), deferred=deferred)
            hits = caster.first_hit(origins, directions, threads=threads)
            found = caster.intervals(origins, directions, threads=threads)
            lists = caster.all_hits(origins, directions, threads=threads)
            columns = (hits.facet, hits.t, hits.weights, found.t, lists.offsets, lists.hits.t)
            answers.add(b"".join(column.tobytes() for column in columns))
    assert len(answers) == 1


def test_threads_share_a_caster_that_grows() -> None:
    vertices, faces = icosphere(4)
    shared, alone = bsp.RayCaster((vertices, faces)), bsp.RayCaster((vertices, faces))
    rng = np.random.default_rng(6)
    batches = [rng.normal(size=(500, 3)) for _ in range(16)]
    with ThreadPoolExecutor(4) as pool:
        answers = list(pool.map(lambda d: shared.first_hit([0.1, 0, 0], d).t, batches))
    for batch, answer in zip(batches, answers, strict=True):
        np.testing.assert_array_equal(answer, alone.first_hit([0.1, 0, 0], batch).t)


def test_the_plane() -> None:
    caster = bsp.RayCaster(SQUARE)
    hits = caster.first_hit(
        [[-1, 1], [-1, 0], [2, 2], [5, 4], [9, 9]], [[2, 0], [1, 0], [1, 1], [-1, 0], [1, 0]]
    )
    assert hits.t.tolist() == [0.5, 1, 2, 1, np.inf]
    assert hits.facet.tolist() == [3, 0, 1, 1, -1]
    assert hits.kind.tolist() == [bsp.INTERIOR, bsp.VERTEX, bsp.VERTEX, bsp.VERTEX, bsp.MISS]
    assert hits.normal[0].tolist() == [-1, 0]
    assert hits.point[0].tolist() == [0, 1]
    found = caster.intervals(
        [[-1, 1], [2, 2], [-1, 0], [-1, 4], [-1, -1]], [[1, 0], [1, 1], [1, 0], [1, 0], [1, 1]]
    )
    # Along the lower side the points above it count, along the upper side those above it too.
    assert [s.tolist() for s in found] == [[[1, 5]], [[0, 2]], [[1, 5]], [], [[1, 5]]]
    assert caster.occluded([2, 2], [[5, 2], [4, 2], [3, 3]]).tolist() == [True, False, False]


def test_the_line() -> None:
    caster = bsp.RayCaster([1.0, 3.0, 5.0, 9.0])
    hits = caster.first_hit([[0.0], [6.0], [6.0], [10.0]], [[2.0], [1.0], [-0.5], [1.0]])
    assert hits.t.tolist() == [0.5, 3, 2, np.inf]
    assert hits.facet.tolist() == [0, 3, 2, -1]
    found = caster.intervals([0.0, 2.0, 4.0], [2.0, 1.0, -1.0])
    assert [s.tolist() for s in found] == [[[0.5, 1.5], [2.5, 4.5]], [[0, 1], [3, 7]], [[1, 3]]]
    assert caster.occluded([2.0], [2.5]).tolist() == [False]
    assert caster.all_hits([0.0], [1.0]).hits.t.tolist() == [1, 3, 5, 9]


def test_winding_rules() -> None:
    nested = np.concatenate([np.array(SQUARE), np.array(SQUARE) * 0.5 + 1])
    reverse = nested[:, ::-1].copy()
    start, along = [-1.0, 1.5], [1.0, 0.0]

    def stretches(facets: Any, rule: Any) -> Any:
        return bsp.RayCaster(facets).intervals(start, along, winding=rule).t.tolist()

    assert stretches(nested, "positive") == [[1, 5]]
    assert stretches(nested, "even-odd") == [[1, 2], [4, 5]]
    assert stretches(reverse, "positive") == []
    assert stretches(reverse, "nonzero") == [[1, 5]]


def test_rays_in_a_face() -> None:
    caster = bsp.RayCaster(b.cube(2))
    on_top = caster.first_hit([[1.5, 0.25, 2], [-1, 0.25, 2], [1, 1, 2]], [1, 0, 0])
    assert on_top.t.tolist() == [0, 1, 0]
    assert on_top.kind.tolist() == [bsp.INTERIOR, bsp.EDGE, bsp.EDGE]
    # A shift by (ε, ε², ε³) leaves the cube through its top and enters it through its bottom.
    found = caster.intervals([[-1, 0.25, 2], [-1, 0.25, 0]], [1, 0, 0])
    assert [s.tolist() for s in found] == [[], [[1, 3]]]
    assert caster.occluded([-1, 1, 2], [5, 1, 2]).tolist() == [True]


def test_a_facet_at_the_start_is_hit_and_hides_nothing() -> None:
    caster = bsp.RayCaster(b.cube(2))
    assert caster.first_hit([1, 0.5, 2], [0, 0, 1]).t.tolist() == [0]
    assert caster.occluded([1, 0.5, 2], [1, 0.5, 3]).tolist() == [False]
    assert caster.occluded([1, 0.5, 3], [1, 0.5, 2]).tolist() == [False]
    assert caster.occluded([1, 0.5, 3], directions=[0, 0, -2], max_t=0.5).tolist() == [False]
    assert caster.occluded([1, 0.5, 3], directions=[0, 0, -2], max_t=0.51).tolist() == [True]
    assert caster.occluded([1, 0.5, 3], directions=[0, 0, -2]).tolist() == [True]


def test_nothing_to_hit() -> None:
    for empty in (np.zeros((0, 3, 3)), np.zeros((1, 3, 3)), b.Solid.empty()):
        caster = bsp.RayCaster(empty)
        hits = caster.first_hit([[0, 0, 0], [1, 2, 3]], [1, 0, 0])
        assert hits.facet.tolist() == [-1, -1]
        assert len(caster.intervals([0, 0, 0], [1, 0, 0]).t) == 0
    assert len(bsp.RayCaster(b.cube(1)).first_hit(np.zeros((0, 3)), [1, 0, 0])) == 0


def test_extreme_directions_and_far_origins() -> None:
    caster = bsp.RayCaster(b.cube(2))
    directions = [[0, 0, -5e-324], [0, 0, -1e308], [1e-300, 0, -1]]
    hits = caster.first_hit([1, 0.5, 3], directions)
    assert hits.facet.tolist() == [hits.facet[0]] * 3
    assert hits.t.tolist() == [np.inf, 1e-308, 1]
    assert caster.first_hit([1, 0.5, 9e6], [0, 0, -1]).t.tolist() == [9e6 - 2]


def test_lists_know_their_rays() -> None:
    lists = bsp.RayCaster(b.cube(2)).all_hits([[0.5, 0.25, 3], [9, 9, 9]], [0, 0, -1])
    assert [hits.t.tolist() for hits in lists] == [[1, 3], []]
    assert len(lists) == 2
    assert lists[-1].t.tolist() == []
    with pytest.raises(IndexError):
        lists[2]


CUBE = b.cube(2)

UP = [0.0, 0.0, 9.0]

BAD: list[tuple[Callable[[], object], str, list[int]]] = [
    (lambda: bsp.RayCaster([[0.0, 1.0]]), "shape", []),
    (lambda: bsp.RayCaster("nonsense"), "invalid_parameter", []),
    (lambda: bsp.RayCaster([["a"]]), "shape", []),
    (lambda: bsp.RayCaster((np.zeros((3, 3)), [[0, 1, 3]])), "index_out_of_range", [0]),
    (lambda: bsp.RayCaster([[[0, 0], [1, 1]], [[0, 0], [np.nan, 1]]]), "non_finite", [1]),
    (lambda: bsp.RayCaster([0.0, np.inf]), "non_finite", [1]),
    (lambda: bsp.RayCaster([0.0, 1e300]), "too_large", []),
    (lambda: bsp.RayCaster([0.0, 1e9], pitch=-9), "too_large", [1]),
    (lambda: bsp.RayCaster(b.half_space((0, 0, 1))), "unbounded", []),
    (lambda: bsp.RayCaster(CUBE).first_hit([0, 0], [0, 0, 1]), "shape", []),
    (lambda: bsp.RayCaster(CUBE).first_hit(np.zeros((2, 3)), np.ones((3, 3))), "shape", []),
    (lambda: bsp.RayCaster(CUBE).first_hit([0, 0, 0], [[0, 0, 1], [0, 0, 0]]), "bad_normal", [1]),
    (lambda: bsp.RayCaster(CUBE).all_hits([0, 0, 0], [0, 0, np.nan]), "non_finite", [0]),
    (lambda: bsp.RayCaster(CUBE).intervals([0, 0, np.inf], [0, 0, 1]), "non_finite", [0]),
    (lambda: bsp.RayCaster(CUBE).first_hit([0, 0, 1e9], [0, 0, 1]), "too_large", [0]),
    (
        lambda: bsp.RayCaster(CUBE).intervals([0, 0, 0], [0, 0, 1], winding="odd"),  # type: ignore[arg-type]
        "invalid_parameter",
        [],
    ),
    (lambda: bsp.RayCaster(CUBE).occluded([0, 0, 0]), "invalid_parameter", []),
    (lambda: bsp.RayCaster(CUBE).occluded([0, 0, 0], [0, 0, 0]), "bad_normal", [0]),
    (lambda: bsp.RayCaster(CUBE).occluded([0, 0, 0], UP, max_t=0.5), "invalid_parameter", []),
    (lambda: bsp.RayCaster(CUBE).occluded([0, 0, 0], UP, max_t="x"), "invalid_parameter", []),
    (
        lambda: bsp.RayCaster(CUBE).occluded([0, 0, 0], directions=[0, 0, 1], max_t=np.nan),
        "invalid_parameter",
        [],
    ),
]


# Found: `RayCaster.occluded` ignored `max_t` in silence where targets were given.
@pytest.mark.parametrize(("call", "code", "where"), BAD)
def test_bad_input_is_refused(call: Callable[[], object], code: str, where: list[int]) -> None:
    with pytest.raises(b.BspcsgError) as caught:
        call()
    assert caught.value.code == code
    assert list(caught.value.where) == where


TRIANGLES = np.concatenate([m.vertices[m.faces] for m in [b.cube(2).to_mesh()]])
SQUARE_WITH_PARTS = [[[0, 0], [4, 0]], [[4, 0], [4, 1]], [[4, 1], [4, 4]], [[4, 4], [0, 4]]]

OPEN: dict[str, tuple[Any, list[int]]] = {
    "mesh": (TRIANGLES[1:], []),
    "mesh with a triangle turned over": (np.concatenate([TRIANGLES[:1, ::-1], TRIANGLES[1:]]), []),
    "outline": (SQUARE_WITH_PARTS, [0]),
    "outline with an edge turned over": ([*SQUARE_WITH_PARTS, [[0, 0], [0, 4]]], [0, 4]),
    "points": ([0.0, 1.0, 2.0], []),
}


# Found: `intervals` returned a result for open meshes.
@pytest.mark.parametrize("name", OPEN)
def test_intervals_of_what_is_not_closed_are_refused(name: str) -> None:
    facets, where = OPEN[name]
    caster = bsp.RayCaster(facets)
    d = caster.dimension
    for _ in range(2):
        with pytest.raises(b.InvalidMeshError) as caught:
            caster.intervals(np.full(d, -1.0), np.full(d, 1.0))
        assert caught.value.code == "not_closed"
    if where:
        assert list(caught.value.where) == where
    elif d > 1:
        assert caught.value.where
    # What is in the way does not depend on an inside.
    assert len(caster.first_hit(np.full(d, -1.0), np.eye(d)[0])) == 1
    assert caster.occluded(np.full(d, -1.0), np.full(d, 9.0)).shape == (1,)


def test_closed_means_closed_on_the_lattice() -> None:
    # A T-junction in one edge, a repeated boundary, and slivers that the lattice closes.
    top = TRIANGLES[1:]
    a, c, d = TRIANGLES[0]
    middle = (a + c) / 2
    halves = np.array([[a, middle, d], [middle, c, d]])
    joint, twice = np.concatenate([halves, top]), np.concatenate([TRIANGLES] * 2)
    for closed in (joint, twice, TRIANGLES + 1e-13):
        found = bsp.RayCaster(closed).intervals([0.5, 0.25, 5], [0, 0, -1])
        assert found.t.tolist() == [[3, 5]]
    square = [*SQUARE_WITH_PARTS, [[0, 4], [0, 0]]]
    assert bsp.RayCaster(square).intervals([-1, 2], [1, 0]).t.tolist() == [[1, 5]]


def test_the_numbers_of_open_facets_are_those_of_the_input() -> None:
    flat = np.zeros((3, 3, 3))
    with pytest.raises(b.InvalidMeshError) as caught:
        bsp.RayCaster(np.concatenate([flat, TRIANGLES[:1]])).intervals([0, 0, 5], [0, 0, -1])
    assert list(caught.value.where) == [3]


# Found: a point at which a ray meets two triangles was returned twice.
def test_one_row_for_each_point_of_a_ray() -> None:
    caster = bsp.RayCaster(b.cube(2))
    starts = [[0.5, 0.5, 3], [0.5, 0.25, 3], [0, 0, 3], [-1, 1, 2], [2, 0, 3]]
    along = [[0, 0, -1], [0, 0, -1], [0, 0, -1], [1, 0, 0], [0, 0, -1]]
    apart, merged = caster.all_hits(starts, along), caster.all_hits(starts, along, merge=True)
    assert len(apart.hits) > len(merged.hits)
    for ray, (every, one) in enumerate(zip(apart, merged, strict=True)):
        assert one.t.tolist() == sorted(set(every.t.tolist())), ray
        first = [int(every.facet[every.t == t].min()) for t in one.t]
        assert one.facet.tolist() == first
    # Through the diagonals of the top and of the bottom; along an upright edge; past a corner.
    assert [hits.t.tolist() for hits in merged][:3] == [[1, 3], [1, 3], [1, 3]]


def test_points_are_merged_exactly() -> None:
    # Two walls whose distances along the ray round to one double.
    caster = bsp.RayCaster([[[1, 0], [1 + 1e-9, 1]], [[1 + 1e-9, 0], [1, 1]]])
    for y, facets in ((0.499999999, [0, 1]), (0.500000001, [1, 0]), (0.5, [0])):
        hits = caster.all_hits([-4e6, y], [1, 0], merge=True).hits
        assert len(set(hits.t.tolist())) == 1
        assert hits.facet.tolist() == facets


def test_complements_with_a_finite_boundary() -> None:
    shape = b.cube(2) - b.cube(1)
    inner, outer = bsp.RayCaster(shape), bsp.RayCaster(~shape)
    rng = np.random.default_rng(3)
    fixed = [[0.5, 0.5, 0.5], [1.5, 1.5, 1.5]]
    starts = np.concatenate([rng.integers(-4, 12, (200, 3)) / 4, fixed])
    along = np.concatenate([rng.integers(-3, 4, (200, 3)), [[1, 0, 0], [0, 0, 1]]]).astype(float)
    along[~along.any(axis=1)] = 1
    a, c = inner.first_hit(starts, along), outer.first_hit(starts, along)
    assert a.t.tolist() == c.t.tolist()
    assert np.array_equal(a.normal[a.hit], -c.normal[a.hit])
    for rule in ("positive", "nonzero", "even-odd"):
        inside = inner.intervals(starts, along)
        outside = outer.intervals(starts, along, winding=rule)
        for one, other in zip(inside, outside, strict=True):
            gaps = np.array([0.0, *one.ravel().tolist(), np.inf]).reshape(-1, 2)
            assert other.tolist() == gaps[gaps[:, 0] < gaps[:, 1]].tolist()
    last = outside.facets[outside.offsets[1:] - 1, 1]
    assert (last == -1).all()
    assert bsp.RayCaster(b.Solid.full()).intervals([0, 0, 0], [1, 0, 0]).t.tolist() == [[0, np.inf]]
    assert outer.occluded([0.5, 0.5, 0.5], [1.5, 1.5, 1.5]).tolist() == [True]
    assert bsp.AdaptiveTree(~shape).test_ray(starts, along).hits.t.tolist() == c.t.tolist()


def test_boundaries_without_end_are_refused() -> None:
    for endless in (b.half_space((0, 0, 1)), b.half_space((0, 0, 1)) - b.half_space((0, 0, 1), -1)):
        with pytest.raises(b.UnboundedError):
            bsp.RayCaster(endless)


def answer_bytes(caster: bsp.RayCaster, starts: Any, along: Any) -> bytes:
    hits, lists = caster.first_hit(starts, along), caster.all_hits(starts, along)
    blocked = caster.occluded(starts, directions=along)
    columns = (hits.facet, hits.t, hits.weights, hits.normal, lists.hits.t, lists.hits.facet)
    return b"".join(column.tobytes() for column in (*columns, blocked))


@pytest.mark.parametrize("deferred", [True, False])
def test_a_scene_that_has_moved_answers_as_a_new_one(deferred: bool) -> None:
    vertices, faces = icosphere(5 if DEEP else 4)
    rng = np.random.default_rng(7)
    starts = rng.normal(size=(400, 3)) * 2
    along = rng.normal(size=(400, 3)) * 0.4 - starts
    caster = bsp.RayCaster((vertices, faces), deferred=deferred)
    before = answer_bytes(caster, starts, along)
    turned = vertices @ np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]]).T + [3.0, -2.0, 9.0]
    bent = vertices * [1, 1, 2] + 0.3 * np.sin(5 * vertices[:, [1, 2, 0]])
    scattered = rng.permutation(vertices)
    for moved in (turned, bent, scattered, vertices):
        again = caster.refitted((moved, faces))
        fresh = bsp.RayCaster((moved, faces), pitch=caster.pitch)
        shift = moved.mean(axis=0)
        assert answer_bytes(again, starts + shift, along) == answer_bytes(
            fresh, starts + shift, along
        )
        assert again.pitch == caster.pitch
        assert len(again) == len(caster)
    assert answer_bytes(caster, starts, along) == before
    assert again.nodes.parent.tolist() == caster.nodes.parent.tolist()


def test_facets_that_lose_their_extent_leave_a_moved_scene() -> None:
    facets = np.array([[[0, 0], [0, 1]], [[1, 0], [1, 1]], [[2, 2], [2, 2]]], float)
    caster = bsp.RayCaster(facets)
    assert caster.first_hit([-1, 0.5], [1, 0]).facet.tolist() == [0]
    moved = facets.copy()
    moved[0], moved[2] = 7, [[3, 0], [3, 1]]
    again = caster.refitted(moved)
    assert again.all_hits([-1, 0.5], [1, 0]).hits.facet.tolist() == [1, 2]
    with pytest.raises(b.InvalidMeshError, match="same array shape"):
        caster.refitted(facets[:2])
    with pytest.raises(b.LimitError):
        caster.refitted(facets * 1e9)


def test_rays_in_any_order_answer_for_themselves() -> None:
    # Enough of them, and wild enough, to be sorted.
    vertices, faces = icosphere(4)
    caster = bsp.RayCaster((vertices, faces))
    rng = np.random.default_rng(8)
    starts = rng.normal(size=(3000, 3)) * 3
    along = vertices[rng.integers(0, len(vertices), 3000)] - starts
    limits = rng.uniform(0, 2, 3000)
    hits, lists = caster.first_hit(starts, along), caster.all_hits(starts, along)
    blocked = caster.occluded(starts, directions=along, max_t=limits)
    hidden = caster.occluded(starts, starts + along)
    for i in range(0, 3000, 50):
        one = slice(i, i + 1)
        assert caster.first_hit(starts[one], along[one]).facet.tolist() == hits.facet[one].tolist()
        assert caster.all_hits(starts[one], along[one])[0].t.tolist() == lists[i].t.tolist()
        alone = caster.occluded(starts[one], directions=along[one], max_t=limits[one])
        assert alone.tolist() == blocked[one].tolist()
        assert caster.occluded(starts[one], (starts + along)[one]).tolist() == hidden[one].tolist()
    bad = along.copy()
    bad[[700, 1500, 2900]] = 0
    with pytest.raises(b.InvalidMeshError) as caught:
        caster.first_hit(starts, bad)
    assert list(caught.value.where) == [700]


def test_scenes_far_away_and_rays_from_afar() -> None:
    # One step of the lattice at the end of its range, seen from the other end.
    far = 9.0e15
    wall = np.array([[[far, -far], [far, 8 - far]], [[far, 8 - far], [far, 20 - far]]])
    caster = bsp.RayCaster(wall, pitch=0)
    starts = [[-far, far], [-far, far + 4], [far - 1, 5 - far]]
    hits = caster.first_hit(starts, [[2 * far, 8 - 2 * far], [9.0, -9.0], [1, 0]])
    assert hits.facet.tolist() == [0, 0, 0]
    assert hits.kind.tolist() == [bsp.VERTEX, bsp.INTERIOR, bsp.INTERIOR]
    flat = np.zeros((100, 3, 3))
    flat[:, 1, 0] = flat[:, 2, 1] = 1
    flat[:, :, 0] += np.arange(100)[:, None]
    ground = bsp.RayCaster(flat)
    above = np.stack([np.arange(100) + 0.25, np.full(100, 0.25), np.full(100, 3.0)], axis=1)
    assert ground.first_hit(above, [0, 0, -1]).facet.tolist() == list(range(100))
    assert ground.first_hit([-1, 0, 0], [1, 0, 0]).facet.tolist() == [0]
    assert len(ground.all_hits([-1, 0, 0], [1, 0, 0]).hits) == 100


# Found: `lengths` of rays were NaN or 0 behind a ray that stays inside, or is very long.
def test_lengths_of_rays_do_not_mix() -> None:
    across, along = [[5, 1, 1], [1, 1, 1]], [[1.0, 0, 0], [0, 1, 0]]
    endless = bsp.RayCaster(~b.cube(2)).intervals(across, along)
    assert endless.lengths().tolist() == [np.inf, np.inf]
    short = [[1e-17, 0, 0], [1.0, 0, 0], [1.0, 0, 0]]
    spans = bsp.RayCaster(b.cube(2)).intervals([[1, 1, 1], [9, 1, 1], [-1, 1, 1]], short)
    assert spans.lengths().tolist() == [1e17, 0, 2]
