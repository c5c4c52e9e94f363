"""Operands that do not fit one lattice of the finest step, and coordinates outside lattices."""

from collections.abc import Callable

import numpy as np
import pytest

import bspcsg as b
from bspcsg import Solid

CUBE = b.box(1, 2.5, 3)
LARGE = b.box(2e8, 2e8, 2e8, center=True)


def told(solid: Solid) -> list[str]:
    return [finding.code for finding in solid.findings]


def evaluated(solid: Solid) -> Solid:
    assert solid.volume > 0
    return solid


# Found: solids of very different sizes, and planes, sections and points beyond the lattice, were
# refused.
@pytest.mark.parametrize("prepare", [lambda solid: solid, evaluated])
def test_small_and_large_solids_meet_on_one_lattice(prepare: Callable[[Solid], Solid]) -> None:
    small = prepare(CUBE - b.cube(0.5))
    assert small.pitch == -9 and LARGE.pitch == -6
    inside = small & LARGE
    assert inside.pitch == -7 and inside.volume == 7.5 - 0.125
    assert inside == small.translate(0, 0, 0) and "operand_rounded" not in told(inside)
    assert (LARGE | small).volume == 8e24 and (small - LARGE).is_empty
    assert (LARGE ^ small).exact_volume() == LARGE.exact_volume() - inside.exact_volume()


# Found: a mesh on a lattice that is too coarse for it, as by `union --pitch 22`, was called one
# without area, and nothing named the lattice.
def test_a_lattice_that_is_too_coarse_for_a_mesh_is_named() -> None:
    with pytest.raises(b.InvalidMeshError, match=r"steps of 10\^22"):
        Solid(*CUBE.to_mesh(), pitch=22)


@pytest.mark.parametrize("prepare", [lambda solid: solid, evaluated])
def test_an_operand_that_has_to_be_rounded_says_so(prepare: Callable[[Solid], Solid]) -> None:
    ball = prepare(b.sphere(1, segments=12).rotate((10, 20, 30)))
    inside = ball & LARGE
    assert "operand_rounded" in told(inside) and "operand_rounded" not in told(ball)
    assert inside.volume == pytest.approx(ball.volume, abs=1e-6)
    assert np.abs(inside.vertices - ball.vertices).max() <= 0.5e-7


@pytest.mark.parametrize("prepare", [lambda solid: solid, evaluated])
def test_no_operand_is_rounded_that_would_lose_its_shape(
    prepare: Callable[[Solid], Solid],
) -> None:
    ball = prepare(b.sphere(1, segments=12))
    for solid in (ball, ~ball, prepare(ball - b.cube(1e-3))):
        with pytest.raises(b.LimitError, match="2\\^53 steps"):
            (solid & b.cube(1e11)).volume  # noqa: B018
    assert (prepare(CUBE) & b.cube(1e11)).volume == 7.5


def test_complements_meet_large_solids_too() -> None:
    outside = evaluated(~(~b.cube(1) & ~b.cube(2)))
    assert (evaluated(LARGE) - outside).exact_volume() == LARGE.exact_volume() - 8
    hollow = Solid.full() - b.cube(1)
    assert hollow.classify([[0.5, 0.5, 0.5]])[0] == -1
    assert (hollow & LARGE).exact_volume() == LARGE.exact_volume() - 1


def test_words_on_faces_stay_with_an_operand_that_is_rounded() -> None:
    painted = b.sphere(1, segments=8).rotate(10).tagged(part="ball")
    mesh = (painted & LARGE).to_mesh()
    assert mesh.face_attributes["part"].tolist() == ["ball"] * len(mesh.faces)


def test_what_is_made_of_small_and_large_solids_meets_too() -> None:
    part = b.cube(1e8) - b.sphere(1, segments=8)
    assert part.offset(5).volume == pytest.approx(b.cube(1e8).offset(5).volume, rel=1e-12)
    assert part.rotate(30).volume == pytest.approx(1e24)
    mesh = CUBE.to_mesh()
    assert (Solid(mesh.vertices, mesh.faces, pitch=-9) & LARGE) == CUBE


def test_arrays_of_small_and_large_meshes() -> None:
    small, large = CUBE.to_mesh(), LARGE.to_mesh()
    vertices, faces = b.boolean(
        small.vertices, small.faces, large.vertices, large.faces, "intersection"
    )
    assert Solid(vertices, faces) == CUBE


@pytest.mark.parametrize("far", [1e8, 1e12, 1e30])
def test_planes_beyond_the_lattice_take_all_or_nothing(far: float) -> None:
    below, beyond = b.half_space((1, 2, 3), far), b.half_space((1, 2, 3), -far)
    assert (CUBE & below) == CUBE and (CUBE - below).is_empty
    assert (CUBE & beyond).is_empty and (CUBE - beyond) == CUBE
    assert (CUBE & below).pitch == -9
    assert CUBE.trim("x", far).is_empty and CUBE.trim((-1, 0, 0), -far) == CUBE
    minus, plus = CUBE.split("z", far)
    assert minus == CUBE and plus.is_empty
    assert (~(~CUBE | beyond)).volume == (CUBE - beyond).volume == 7.5


def test_planes_beyond_the_lattice_of_a_mesh_count_where_they_matter() -> None:
    far = b.half_space("x", -1e12)
    both = CUBE | far
    assert both.pitch == -3
    points = [[0.5, 0.5, 0.5], [2, 0.5, 0.5], [-1.1e12, 0, 0], [-1e12, 7, 7]]
    assert both.classify(points).tolist() == [1, -1, 1, 0]
    with pytest.raises(b.LimitError):
        (b.sphere(1) | far).is_empty  # noqa: B018


def test_planes_alone_choose_a_lattice_that_reaches_them() -> None:
    sides = [b.half_space(normal, 5e9) for normal in np.vstack([np.eye(3), -np.eye(3)])]
    assert b.intersection(sides) == b.cube(1e10).translate(-5e9, -5e9, -5e9)
    assert (b.half_space("x", 1e12) - b.half_space("x", 1)).classify([[2, 0, 0]]).tolist() == [1]
    assert b.cube(1e8).offset(-5).volume == (1e8 - 10) ** 3


def test_sections_beyond_the_lattice_are_empty() -> None:
    assert CUBE.slice(1e12).is_empty
    assert [region.area for region in CUBE.slice([-1e8, 1, 1e8, 2], "z")] == [0, 2.5, 0, 2.5]
    column = b.half_space("z", 0) & b.half_space("x", 1) & b.half_space((-1, 0, 0), 1)
    with pytest.raises(b.UnboundedError):
        column.slice(1e12)


def test_points_beyond_the_lattice_are_outside_of_what_is_bounded() -> None:
    points = [[1e8, 0, 0], [0.5, 0.5, 0.5], [0, -1e300, 0], [0, 0, 0]]
    assert CUBE.classify(points).tolist() == [-1, 1, -1, 0]
    assert (1e9, 0.5, 0.5) not in CUBE
    disc = b.Region.circle(1)
    assert disc.classify([[1e8, 0], [0, 0]]).tolist() == [-1, 1]
    assert b.bsp.Intervals([(0, 1)]).classify([1e8, 0.5]).tolist() == [-1, 1]


@pytest.mark.parametrize("points", [[[np.inf, 0, 0]], [[np.nan, 0, 0]], [[1e8, np.nan, 0]]])
def test_points_that_are_no_numbers_are_refused(points: list[list[float]]) -> None:
    with pytest.raises(b.BspcsgError, match=r"finite|more than 2\^53"):
        CUBE.classify(points)


def test_points_far_out_are_refused_where_they_may_be_inside() -> None:
    with pytest.raises(b.LimitError):
        (~CUBE).classify([[1e8, 0, 0]])


@pytest.mark.parametrize("seed", range(30))
def test_random_small_and_large_solids_agree_with_their_points(seed: int) -> None:
    rng = np.random.default_rng(seed)
    size = 10.0 ** rng.integers(7, 10)
    large = [
        b.box(size, size, size, center=True),
        b.sphere(size, segments=8).rotate((rng.uniform(0, 90), 7, 0)),
        b.box(size, 2, 2, center=True).rotate(rng.uniform(0, 90)),
    ][seed % 3].translate(rng.uniform(-0.7, 0.7) * size, 0, 0)
    place = rng.uniform(-1, 1, 3) * rng.choice([1.0, size / 4])
    shapes = [b.sphere(50, segments=12), b.torus(40, 9, segments=8), b.box(30, 40, 50).rotate(9)]
    small = shapes[rng.integers(3)].translate(place)
    if rng.random() < 0.5:
        small -= b.half_space((1, 2, 3), float(place @ (1, 2, 3)))
    if rng.random() < 0.5:
        evaluated(small)
    if rng.random() < 0.2:
        small = ~small
    points = place + rng.uniform(-60, 60, (60, 3))
    p, q = large.classify(points) > 0, small.classify(points) > 0
    found = [one.classify(points) > 0 for one in (large | small, large & small, large - small)]
    assert np.array_equal(found, [p | q, p & q, p & ~q])


# Found: regions of very different sizes could not be compared or combined, and splits by planes
# beyond the lattice were refused.
def test_regions_of_very_different_sizes_combine_where_no_corner_moves() -> None:
    large, small = b.Region.rectangle(1e9, 1e9), b.Region.rectangle(1, 1)
    assert small != large and small <= large and not small.isdisjoint(large)
    assert (large - small).area_exact == 10**18 - 1
    assert (~small & large).area_exact == 10**18 - 1
    assert b.Region.compose([small, large]) == small | large == large
    assert (small & b.Region.half_plane((1, 0), 1e9)) == small
    fine = b.Region.rectangle(1e-8, 1)
    assert fine != large
    with pytest.raises(b.LimitError, match="that the corners of another region need"):
        fine | large
    with pytest.raises(b.LimitError, match="that the corners of another region need"):
        b.Region.compose([fine, large])


@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_sets_lie_on_one_side_of_what_is_beyond_the_lattice(dimension: int) -> None:
    made = {
        1: b.bsp.Intervals([(0, 1)]).tree,
        2: b.Region.rectangle(1, 1).tree,
        3: b.bsp.ObjectTree.from_mesh(b.cube(1)),
    }[dimension]
    up = [1.0] * dimension
    for far in (1e9, 1e300):
        assert made.split(up, far)[0] == made and made.split(up, far)[1].is_empty
        assert made.split(up, -far)[1] == made and made.split(up, -far)[0].is_empty
        with pytest.raises(b.LimitError):
            (~made).split(up, far)


def test_nothing_of_a_region_lies_in_a_line_beyond_the_lattice() -> None:
    assert b.bsp.SubHyperplane.inside(b.Region.rectangle(1, 1), (1, 0), 1e9).is_empty
    with pytest.raises(b.LimitError):
        b.bsp.SubHyperplane.inside(b.Region.rectangle(1, 1), (1, 0), 1e300)
