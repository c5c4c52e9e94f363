"""Surfaces that are refined, warped, or level sets of functions."""

from collections.abc import Callable
from time import process_time
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg.mesh.crossing import crossings
from bspcsg.modelling.bodies.refining import least_halved, with_edges_halved
from support.checks import assert_closed, assert_sound

BOX = [(-1.5, -1.5, -1.5), (1.5, 1.5, 1.5)]


def holed() -> b.Solid:
    return b.cube(2) - b.cylinder(h=2, r=0.5, segments=8).translate(1, 1, 0)


def longest(solid: b.Solid) -> float:
    corners = solid.vertices[solid.faces]
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max())


# Refining


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 8])
def test_refined_triangles_are_n_squared_times_as_many(n: int) -> None:
    fine = b.cube(12).refine(n)
    assert fine == b.cube(12) and len(fine.faces) == 12 * n * n
    assert longest(fine) == pytest.approx(longest(b.cube(12)) / n)
    assert_sound(fine)


def test_refined_solids_keep_their_shape() -> None:
    for n in (2, 3, 7):
        fine = holed().refine(n)
        assert_sound(fine)
        assert fine.volume == pytest.approx(holed().volume, abs=1e-7) and fine.genus == 1


@pytest.mark.parametrize("length", [0.1, 0.3, 1.0, 5.0])
def test_no_edge_is_longer_than_asked(length: float) -> None:
    fine = holed().refine(edge_length=length)
    assert longest(fine) <= length or len(fine.faces) == len(holed().faces)
    assert_sound(fine)
    assert fine.volume == pytest.approx(holed().volume, abs=1e-7) and fine.genus == 1
    # Halves of lattice lengths are exact.
    assert b.cube(2).refine(edge_length=length) == b.cube(2)


@pytest.mark.parametrize(
    ("given", "kind"),
    [
        ({}, b.InvalidParameterError),
        ({"n": 2, "edge_length": 1}, b.InvalidParameterError),
        ({"n": 0}, b.InvalidParameterError),
        ({"n": 1.5}, b.InvalidParameterError),
        ({"n": 10_000}, b.LimitError),
        ({"edge_length": 0}, b.InvalidParameterError),
        ({"edge_length": float("nan")}, b.InvalidParameterError),
        ({"edge_length": 1e-6}, b.LimitError),
    ],
)
def test_refining_refuses(given: dict[str, Any], kind: type[Exception]) -> None:
    began = process_time()
    with pytest.raises(kind):
        b.cube(1).refine(**given)
    assert process_time() - began < 1


# Found: edges were halved until there were too many triangles, for some seconds.
@pytest.mark.parametrize(
    ("body", "length", "least"),
    [
        (b.cube(1), 1e-3, "25,165,824"),  # four times as many ten times, and those in two
        (b.box((1e6, 1e-6, 1e-6)), 1e-2, "533,333,3"),
        (b.cube(1), 1e-320, "far too many"),
    ],
)
def test_triangles_are_counted_before_edges_are_halved(
    body: b.Solid, length: float, least: str
) -> None:
    began = process_time()
    with pytest.raises(b.LimitError, match=least):
        body.refine(edge_length=length)
    assert process_time() - began < 1


def test_halving_makes_no_fewer_triangles_than_are_counted() -> None:
    rng = np.random.default_rng(0)
    for _ in range(60):
        vertices = rng.random((9, 3)) * 10 ** rng.uniform(-2, 2, 3)
        length = np.abs(vertices).max() * 10 ** rng.uniform(-2, 0)
        faces = np.arange(9).reshape(3, 3)
        assert least_halved(vertices, faces, length) <= len(
            with_edges_halved(vertices, faces, length)[1]
        )


def test_nothing_stays_nothing() -> None:
    assert b.Solid.empty().refine(3).is_empty
    assert b.Solid.empty().warp(lambda p: p + 1).is_empty


# Warping


def test_affine_warps_are_transforms() -> None:
    body = holed()
    assert body.warp(lambda p: p * 2 + 1) == body.scale(2).translate(1, 1, 1)
    # Turned inside out, and right again.
    assert body.warp(lambda p: -p) == body.scale(-1)


def test_a_bent_bar() -> None:
    def bent(p: Any) -> Any:
        angle, radius = p[:, 0], 3 + p[:, 1]
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), p[:, 2]])

    bar = b.box((np.pi, 1, 1)).refine(edge_length=0.2).warp(bent)
    assert_sound(bar)
    assert bar.volume == pytest.approx(np.pi / 2 * (16 - 9), rel=1e-2) and bar.genus == 0
    # Bent once round and further it meets itself.
    long = b.box((7, 1, 1)).refine(edge_length=1.1)
    with pytest.raises(b.InvalidMeshError) as caught:
        long.warp(bent)
    assert caught.value.code == "self_crossing" and caught.value.where
    ring = long.warp(bent, winding="nonzero")
    assert_sound(ring)
    assert ring.genus == 1


def shaken(by: float) -> Callable[[Any], Any]:
    rng = np.random.default_rng(0)
    return lambda p: p + by * rng.normal(size=p.shape)


# Found: the refusal of faces that pierce others took 6 to 60 s: first all pairs were found, and
# then those that no mending can separate.
@pytest.mark.parametrize(
    ("body", "f"),
    [
        (b.sphere(10, segments=64), shaken(0.1)),
        (b.sphere(10, segments=64), shaken(10)),
        (b.cube(10, center=True).refine(40), lambda p: p + 1.2 * np.sin(2 * p[:, [1, 2, 0]])),
    ],
)
def test_a_few_faces_that_pierce_others_tell(body: b.Solid, f: Any) -> None:
    count = len(body.normalized().to_mesh().faces)
    began = process_time()
    with pytest.raises(b.InvalidMeshError, match="cross or overlap") as caught:
        body.warp(f)
    assert process_time() - began < 1
    assert caught.value.code == "self_crossing"
    assert caught.value.where and max(caught.value.where) < count


def test_triangles_pierce_only_as_far_as_their_corners_must_move() -> None:
    rng = np.random.default_rng(1)
    faces, deep, found = np.arange(6).reshape(2, 3), 0.02, 0
    for pair in rng.random((80, 6, 3)):
        if not crossings(pair, faces, deep).are_deep:
            continue
        found += 1
        ways = rng.normal(size=(10, 6, 3))
        for way in deep * ways / np.linalg.norm(ways, axis=2, keepdims=True):
            assert len(crossings(pair + way, faces, 0.0).pairs) == 1
    assert found > 5


@pytest.mark.parametrize(
    ("f", "kind"),
    [
        (7, b.InvalidParameterError),
        (lambda p: p[:-1], b.InvalidParameterError),
        (lambda p: p[:, :2], b.InvalidMeshError),
        (lambda p: "no", b.InvalidMeshError),
        (lambda p: p / 0 if len(p) else p, b.InvalidMeshError),
        (lambda p: p * [1, 1, 0], b.InvalidMeshError),
        (lambda p: p * 0, b.InvalidMeshError),
    ],
)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_warps_refuse(f: Any, kind: type[Exception]) -> None:
    with pytest.raises(kind):
        b.cube(1).warp(f)
    with pytest.raises(b.InvalidParameterError):
        b.cube(1).warp(lambda p: p, winding="no")  # type: ignore[arg-type]


def test_warped_arrays_are_the_functions_own() -> None:
    body = b.cube(1)

    def spoil(p: Any) -> Any:
        p += 5
        return p

    assert body.warp(spoil) == b.cube(1).translate(5, 5, 5)
    assert body.bounds is not None and body.bounds.max() == 1


# Level sets


def ball(p: Any) -> Any:
    return 1 - np.linalg.norm(p, axis=1)


@pytest.mark.parametrize("edge", [0.5, 0.2, 0.1])
def test_a_ball_is_as_near_as_its_grid(edge: float) -> None:
    found = b.level_set(ball, BOX, edge)
    assert_sound(found)
    assert found.genus == 0 and found.surface_count == 1
    assert found.volume == pytest.approx(4 / 3 * np.pi, rel=2 * edge**2)
    radii = np.linalg.norm(found.vertices, axis=1)
    assert abs(radii - 1).max() < edge**2


@pytest.mark.parametrize("seed", range(6))
def test_any_field_gives_a_closed_surface(seed: int) -> None:
    rng = np.random.default_rng(seed)
    waves, phases = rng.normal(size=(5, 3)) * 3, rng.uniform(0, 6, 5)

    def field(p: Any) -> Any:
        # Rounded, so that it is 0 at many points of the grid.
        return np.round(np.sin(p @ waves.T + phases).sum(axis=1), seed % 3)

    found = b.level_set(field, BOX, 0.3)
    assert_sound(found)
    assert found <= b.cube(3, center=True)


def test_planes_of_the_grid_and_bounds_are_exact() -> None:
    assert b.level_set(lambda p: 1 - abs(p).max(axis=1), BOX, 0.5) == b.cube(2, center=True)
    assert b.level_set(lambda p: p[:, 0] * 0 + 1, BOX, 0.7) == b.cube(3, center=True)
    assert b.level_set(lambda p: p[:, 2], BOX, 0.5) == b.box((3, 3, 1.5)).translate(-1.5, -1.5, 0)
    half = b.level_set(ball, [(-1.5, -1.5, -1.5), (1.5, 1.5, 0)], 0.25)
    whole = b.level_set(ball, BOX, 0.25)
    # Only tetrahedra across the bounds differ.
    lower = whole & b.half_space((0, 0, 1), -0.125)
    assert half.bounds is not None and half.bounds[1, 2] < 1e-12 and lower <= half
    assert b.level_set(ball, BOX, 0.25, level=-0.2).volume > whole.volume


def test_fields_that_are_nowhere_positive_are_empty() -> None:
    assert b.level_set(lambda p: p[:, 0] * 0, BOX, 0.5).is_empty
    assert b.level_set(ball, [(5, 5, 5), (6, 6, 6)], 0.5).is_empty


def test_infinities_are_inside_and_outside() -> None:
    def field(p: Any) -> Any:
        return np.where(abs(p).max(axis=1) < 1, np.inf, -np.inf)

    assert_closed(b.level_set(field, BOX, 0.5).faces)


@pytest.mark.parametrize(
    ("f", "bounds", "edge", "kind"),
    [
        (3, BOX, 0.5, b.InvalidParameterError),
        (ball, [(0, 0, 0)], 0.5, b.InvalidParameterError),
        (ball, [(0, 0, 0), (1, 1, 0)], 0.5, b.InvalidParameterError),
        (ball, [(0, 0, 0), (1, 1, float("inf"))], 0.5, b.InvalidParameterError),
        (ball, "box", 0.5, b.InvalidParameterError),
        (ball, BOX, 0, b.InvalidParameterError),
        (ball, BOX, -1, b.InvalidParameterError),
        (ball, BOX, 1e-5, b.LimitError),
        (ball, BOX, 1e-300, b.LimitError),
        (lambda p: p, BOX, 0.5, b.InvalidParameterError),
        (lambda p: 1.0, BOX, 0.5, b.InvalidParameterError),
        (lambda p: ["a"] * len(p), BOX, 0.5, b.InvalidParameterError),
        (lambda p: p[:, 0] * np.nan, BOX, 0.5, b.InvalidMeshError),
    ],
)
def test_level_sets_refuse(
    f: Callable[..., Any], bounds: Any, edge: float, kind: type[Exception]
) -> None:
    with pytest.raises(kind):
        b.level_set(f, bounds, edge)


# Shading, rays, sections


def test_normals_of_faces_and_of_round_bodies() -> None:
    cube = b.cube(2, center=True)
    flat = cube.normals()
    assert (np.abs(flat).sum(axis=2) == 1).all() and (flat[:, 0] == flat[:, 1]).all()
    assert np.einsum("ijk,ijk->ij", flat, cube.vertices[cube.faces]) == pytest.approx(1)
    smooth = cube.normals(180)
    assert smooth == pytest.approx(cube.vertices[cube.faces] / 3**0.5)
    ball = b.sphere(1, segments=64)
    assert ball.normals() == pytest.approx(ball.vertices[ball.faces], abs=0.01)
    can = b.cylinder(2, 1, segments=64)
    caps = np.abs(can.normals()[..., 2])
    assert set(caps.round(9).ravel().tolist()) == {0, 1}
    assert b.Solid.empty().normals().shape == (0, 3, 3)
    with pytest.raises(b.InvalidParameterError):
        cube.normals(181)


def test_curvatures_add_up() -> None:
    ball = b.sphere(2, segments=96)
    gaussian, mean = ball.curvature()
    assert np.median(gaussian) == pytest.approx(1 / 4, rel=0.01)
    assert np.median(mean) == pytest.approx(1 / 2, rel=0.01)
    for body in (b.cube(3), b.torus(3, 1, segments=12, tube_segments=8), holed()):
        gaussian, _ = body.curvature()
        corners = body.vertices[body.faces]
        sizes = np.linalg.norm(np.cross(*(corners[:, 1:] - corners[:, :1]).swapaxes(0, 1)), axis=1)
        shares = np.bincount(body.faces.ravel(), np.repeat(sizes / 6, 3))
        # Gauss and Bonnet: the sum is 2 pi times the Euler number.
        assert gaussian @ shares == pytest.approx(2 * np.pi * body.euler_number, abs=1e-9)
    outside = (~b.cube(2)) & b.cube(4, center=True).translate(1, 1, 1)
    _, mean = outside.curvature()
    assert (mean[(outside.vertices >= 0).all(1) & (outside.vertices <= 2).all(1)] < 0).all()
    assert b.cube(1).curvature()[1].min() > 0


def test_smooth_bodies() -> None:
    egg = b.cube(2, center=True).smooth(6, sharp_angle=180)
    assert_sound(egg)
    assert len(egg.faces) == 12 * 36 and egg.genus == 0
    radii = np.linalg.norm(egg.vertices, axis=1)
    assert radii.max() == pytest.approx(3**0.5) and radii.min() > 1.3
    assert b.cube(2).smooth(3, sharp_angle=30) == b.cube(2)
    assert holed().smooth(2, sharp_angle=20).volume == pytest.approx(holed().volume, abs=1e-6)
    assert b.Solid.empty().smooth(3).is_empty


@pytest.mark.parametrize("segments", [8, 12, 32])
def test_smooth_cylinders_have_flat_ends_and_round_walls(segments: int) -> None:
    can = b.cylinder(h=2, r=1, segments=segments).smooth(6)
    assert_sound(can)
    assert can.bounds is not None and can.bounds[:, 2] == pytest.approx([0, 2])
    assert can.volume == pytest.approx(2 * np.pi, rel=0.02) and can.genus == 0
    ball = b.sphere(1, segments=segments).smooth(4, sharp_angle=180)
    assert np.linalg.norm(ball.vertices, axis=1) == pytest.approx(1, abs=0.05)


@pytest.mark.parametrize(
    ("given", "kind"),
    [
        ({"n": 0}, b.InvalidParameterError),
        ({"n": 2, "sharp_angle": 200}, b.InvalidParameterError),
        ({"n": 2, "sharp_angle": -1}, b.InvalidParameterError),
        ({"n": 5000}, b.LimitError),
    ],
)
def test_smoothing_refuses(given: dict[str, Any], kind: type[Exception]) -> None:
    with pytest.raises(kind):
        b.cube(1).smooth(**given)


def test_rays_hit_each_point_of_the_surface_once() -> None:
    hits = holed().ray_cast((1, 3, 1), (0, -1, 0))
    assert hits.t.tolist() == [1, 1.5, 2.5, 3]
    assert b.cube(2).ray_cast((-1, -1, -1), (1, 1, 1)).t.tolist() == [1, 3]
    both = b.cube(2).ray_cast(np.array([(1, 1, 5), (9, 9, 9)]), (0, 0, -1))
    assert [len(one) for one in both] == [2, 0]
    with pytest.raises(b.InvalidMeshError):
        b.cube(1).ray_cast((0, 0, 0), (0, 0, 0))


def test_sections_by_many_planes_are_those_by_each() -> None:
    body = holed()
    heights = [0.5, 1, 2, 3]
    assert body.slice(heights) == [body.slice(z) for z in heights]
    assert body.slice(np.array([0.5]), (1, 0, 0)) == [body.slice(0.5, (1, 0, 0))]
    assert body.slice([]) == []


def test_inertia_is_that_of_the_mesh() -> None:
    assert np.diag(b.box((1, 2, 3)).inertia) == pytest.approx([6.5, 5.0, 2.5])
    assert np.isnan(b.Solid.empty().inertia).all()


# Attributes


def painted() -> b.Solid:
    cube = b.cube(2).to_mesh()
    heights = cube.vertices @ [1.0, 2.0, 4.0]
    return b.Solid(
        *cube,
        vertex_attributes={"height": heights, "normal": cube.vertices / 2},
        face_attributes={"number": np.arange(12)},
    )


@pytest.mark.parametrize("how", [{"n": 3}, {"edge_length": 0.4}])
def test_finer_triangles_say_what_coarse_ones_do(how: dict[str, Any]) -> None:
    mesh = painted().refine(**how).to_mesh()
    assert mesh.vertex_attributes["height"] == pytest.approx(mesh.vertices @ [1.0, 2.0, 4.0])
    numbers = mesh.face_attributes["number"]
    assert sorted(set(numbers.tolist())) == list(range(12))
    coarse = painted().vertices[painted().faces]
    normals = np.cross(coarse[:, 1] - coarse[:, 0], coarse[:, 2] - coarse[:, 0])
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    away = np.einsum("ij,ij->i", middles - coarse[numbers, 0], normals[numbers])
    assert away == pytest.approx(0)


def test_parts_and_warped_solids_keep_what_is_said() -> None:
    far = b.cube(1).translate(9, 0, 0)
    first, second = (painted() | far).decompose()
    assert set(first.to_mesh().face_attributes["number"].tolist()) == set(range(12))
    assert second.volume == 1
    warped = painted().warp(lambda p: p * 3).to_mesh()
    assert warped.vertex_attributes["height"].max() == 14
    assert "normal" not in warped.attributes.names
