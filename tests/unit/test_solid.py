"""`Solid` as a value: operators, transforms, queries, errors, pickling."""

import copy
import pickle
import tempfile
import time
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp
from bspcsg.solid import measure
from bspcsg.solid.measure import volume_near

CUBE = b.cube(1).to_mesh()


def test_operators_are_those_of_sets() -> None:
    a, c = b.cube(2), b.cube(2).translate(1, 0, 0)
    assert (a | c).volume == (a + c).volume == 12
    assert (a & c).volume == 4
    assert (a - c).volume == 4
    assert (a ^ c).volume == 8
    assert (a & ~c).equals(a - c)


def test_sum_and_functions_take_many() -> None:
    cubes = [b.cube(1).translate(2 * k, 0, 0) for k in range(4)]
    assert sum(cubes).volume == 4  # type: ignore[union-attr]
    assert b.union(cubes).volume == b.union(*cubes).volume == 4
    assert b.union(cubes[0], cubes[1:]).volume == 4
    assert b.intersection(cubes).is_empty
    assert b.difference(b.box((7, 1, 1)), cubes).volume == 3
    assert b.difference(b.box((7, 1, 1)), *cubes).volume == 3
    assert b.xor(cubes[0], cubes[0], cubes[1]).volume == 1


def test_functions_of_nothing_are_the_neutral_elements() -> None:
    assert b.union().is_empty
    assert b.union([]).is_empty
    assert b.xor().is_empty
    assert not b.intersection([]).is_bounded
    assert b.union(b.cube(1)).volume == 1


@pytest.mark.parametrize("other", [1, None, "cube", CUBE])
def test_operators_refuse_what_is_no_solid(other: Any) -> None:
    for operate in (
        lambda: b.cube(1) | other,
        lambda: b.cube(1) & other,
        lambda: b.cube(1) - other,
        lambda: b.cube(1) ^ other,
        lambda: b.cube(1) <= other,
        lambda: 5 + b.cube(1),
    ):
        with pytest.raises(TypeError):
            operate()
    with pytest.raises(b.InvalidMeshError):
        b.union([b.cube(1), other])


def test_comparison_is_by_set() -> None:
    a, c = b.cube(1), b.cube(2)
    assert a <= c and c >= a
    assert not c <= a
    assert a.equals(b.cube(2) & a)
    assert a == b.cube(1)
    assert a is not b.cube(1)
    assert len({a, b.cube(1), a}) == 1
    assert a.isdisjoint(a.translate(1, 0, 0))


def test_truth_means_not_empty() -> None:
    a = b.cube(1)
    assert a
    assert not (a - a)
    assert ~a
    assert not b.Solid.empty()
    assert b.Solid.full()


def test_measures_of_a_box() -> None:
    box = b.box((1, 2, 3)).translate(0.5, 0, 0)
    assert (box.volume, box.area, box.genus, box.euler_number, box.surface_count) == (
        6,
        22,
        0,
        2,
        1,
    )
    assert box.volume_exact == Fraction(6)
    assert box.bounds is not None
    assert box.bounds.tolist() == [[0.5, 0, 0], [1.5, 2, 3]]
    assert box.centroid.tolist() == [1, 1, 1.5]
    assert box.pitch == -9


def test_measures_of_the_empty_set() -> None:
    empty = b.cube(1) - b.cube(1)
    assert (empty.volume, empty.area, empty.genus, empty.surface_count) == (0, 0, 0, 0)
    assert empty.bounds is None
    assert np.isnan(empty.centroid).all()
    mesh = empty.to_mesh()
    assert (mesh.vertices.shape, mesh.faces.shape) == ((0, 3), (0, 3))


@pytest.mark.parametrize(
    "name", ["volume", "volume_exact", "centroid", "bounds", "genus", "vertices", "faces"]
)
def test_unbounded_solids_have_no_measures(name: str) -> None:
    with pytest.raises(b.UnboundedError) as caught:
        getattr(~b.cube(1), name)
    assert caught.value.code == "unbounded"


def test_a_cavity_is_a_surface_of_its_own() -> None:
    hollow = b.cube(3, center=True) - b.cube(1, center=True)
    assert (hollow.surface_count, hollow.genus, hollow.euler_number) == (2, 0, 4)


@pytest.mark.parametrize(("shift", "simple"), [((20, 0, 0), True), ((3, 0.5, 0.5), False)])
def test_rings_in_one_mesh_are_found_apart_or_linked(
    shift: tuple[float, float, float], simple: bool
) -> None:
    ring = b.box((6, 6, 2)) - b.box((2, 2, 4)).translate(2, 2, -1)
    one = ring.rotate(33, (1, 2, 3)).to_mesh()
    vertices = np.vstack([one.vertices, one.vertices + shift])
    both = b.Solid(vertices, np.vstack([one.faces, one.faces + len(one.vertices)]))
    united = both.normalized()
    assert both.tree.simple is simple
    assert united.tree.simple is True
    assert (both.volume == pytest.approx(128)) is simple


def test_mesh_arrays_are_the_documented_ones_and_kept() -> None:
    solid = b.cube(2) - b.cube(1)
    mesh = solid.to_mesh()
    assert mesh.vertices.dtype == np.float64
    assert mesh.faces.dtype == mesh.source.dtype == np.int64
    assert mesh.source.shape == (len(mesh.faces), 2)
    assert solid.to_mesh() is mesh
    assert solid.vertices is mesh.vertices
    with pytest.raises(ValueError, match="read-only"):
        solid.vertices[0, 0] = 1


def test_a_solid_does_not_see_later_changes_of_the_arrays() -> None:
    vertices, faces = CUBE.vertices.copy(), CUBE.faces.copy()
    solid = b.Solid(vertices, faces)
    vertices *= 2
    faces[:] = 0
    assert solid.rotate(90).volume == 1


def test_uncut_meshes_come_out_as_they_came_in() -> None:
    vertices = CUBE.vertices / 3
    mesh = b.Solid(vertices, CUBE.faces).to_mesh()
    assert set(map(tuple, mesh.vertices.tolist())) == set(map(tuple, vertices.tolist()))


def test_points_are_classified() -> None:
    points = [(0.5, 0.5, 0.5), (1, 0.5, 0.5), (1.5, 0.5, 0.5), (0, 0, 0)]
    sides = b.cube(1).classify(points)
    assert sides.dtype == np.int8
    assert sides.tolist() == [1, 0, -1, 0]
    assert (~b.cube(1)).classify(points).tolist() == [-1, 0, 1, 0]
    assert b.cube(1).classify(np.zeros((0, 3))).shape == (0,)
    with pytest.raises(b.InvalidMeshError):
        b.cube(1).classify([(0, 0)])


def test_whole_steps_are_exact() -> None:
    a = b.cube(0.1).translate(0.2, 0, 0)
    assert set(a.vertices[:, 0].tolist()) == {0.2, 0.3}
    assert (a | b.cube(0.1).translate(0.3, 0, 0)).volume_exact == Fraction(2, 1000)


def test_every_transform_keeps_the_outside_outside() -> None:
    part = b.cube(2) - b.cube(1)
    for moved in (
        part.mirror((1, 0, 0)),
        part.mirror((1, 2, 3)),
        part.scale(-1),
        part.scale((1, -1, 1)),
        part.rotate(37, (1, 1, 0)),
        part.rotate((10, 20, 30)),
        part.mirror((1, 2, 3)).mirror((3, 0, 1)),
        b.cube(2).mirror((1, 2, 3)) - b.cube(1).mirror((1, 2, 3)),
    ):
        assert moved.volume == pytest.approx(7, abs=1e-7)


def test_scaling_takes_numpy_numbers() -> None:
    assert b.cube(1).scale(2).volume == b.cube(1).scale(np.int64(2)).volume == 8
    assert b.cube(1).scale((1, 2, 3)).volume == 6
    assert b.cube(1).scale(np.array([1, 2, 3])).volume == 6
    assert b.cube(np.float32(2)).translate(np.array([1, 2, 3])).volume == 8


def test_boxes_turned_together_unite_as_if_they_had_not_been() -> None:
    rng = np.random.default_rng(3)
    for _ in range(20):
        angles = rng.uniform(-180, 180, 3)
        a, c = b.cube(1).rotate(angles), b.cube(1).translate(1, 0, 0).rotate(angles)
        mesh = (a | c).to_mesh()
        assert (mesh.surface_count, mesh.euler_number) == (1, 2)


def test_a_result_is_turned_as_a_whole() -> None:
    union = b.cube(1) | b.cube(1).translate(1, 0, 0)
    mesh = (union.rotate(30) | b.cube(1).translate(9, 0, 0)).to_mesh()
    assert (mesh.surface_count, mesh.euler_number) == (2, 4)


def test_identity_transforms_change_nothing() -> None:
    a = b.cube(1)
    assert a.translate(0, 0, 0) is a
    assert a.rotate(360) is a
    assert a.scale(1) is a
    assert a.transform(np.eye(4)[:3]) is a


def test_half_spaces_cut_and_move() -> None:
    box = b.cube(2, center=True)
    below = b.half_space((0, 0, 1), 0.5)
    assert (box & below).volume == 6
    assert (box - below).volume == 2
    assert (box & below.translate(0, 0, 0.25)).volume == 7
    assert (box & below.rotate(90, "x")).volume == 6
    assert (box & below.mirror((0, 0, 1))).volume == 6
    assert (box & below.scale(2)).volume == 8
    assert (box & b.half_space((3, 3, 3), 0).rotate(17, (1, 1, 1))).volume == pytest.approx(4)


@pytest.mark.parametrize("normal", [(0, 0, 1), (1, 2, 3)])
def test_half_spaces_and_their_complements_are_unbounded(normal: tuple[float, ...]) -> None:
    half, box = b.half_space(normal, 0.5), b.cube(1)
    for unbounded in (half, ~half, half | box, half - box, ~(half & box), half ^ ~box):
        assert not unbounded.is_bounded
        assert pickle.loads(pickle.dumps(unbounded)).equals(unbounded)
    for bounded in (half & box, box - half, ~(~half | ~box)):
        assert bounded.is_bounded
    assert (half & box).volume + (~half & box).volume == pytest.approx(1)


def test_unbounded_solids_of_several_planes_move_after_evaluation() -> None:
    outside = b.half_space((0, 0, 1), 0) | b.half_space((0, 0, -1), -2)
    assert not outside.is_bounded
    assert not (~outside).is_bounded
    assert (outside.translate(0, 0, 0.25) & b.box((1, 1, 3))).volume == 1


def test_half_spaces_follow_the_solid_under_oblique_maps() -> None:
    shear = np.array([[1, 0.3, 0, 1], [0, 2, 0.1, 0], [0.2, 0, -1, 3], [0, 0, 0, 1]])
    cut = (b.cube(2, center=True) & b.half_space((1, 2, 3), 0.5)).transform(shear)
    apart = b.cube(2, center=True).transform(shear) & b.half_space((1, 2, 3), 0.5).transform(shear)
    beside = apart & b.cube(50, center=True)
    assert beside.volume == pytest.approx(cut.volume, rel=1e-6)


def test_unbounded_results_can_still_be_moved() -> None:
    outside = ~(b.cube(2) | b.cube(1))
    assert not outside.is_empty
    assert (b.cube(20, center=True) & outside.rotate(30)).volume == pytest.approx(7992)
    mixed = b.half_space((0, 0, 1), 0) - b.cube(2, center=True)
    assert not mixed.is_empty
    assert (mixed.rotate(30) & b.cube(4, center=True)).volume == pytest.approx(28)


def test_far_solids_get_a_coarser_lattice() -> None:
    a, c = (b.cube(k).translate(1e12, 0, 0) for k in (2, 1))
    assert a.pitch == -3
    assert (a - c).volume == 7


def test_a_pitch_can_be_chosen() -> None:
    coarse = b.Solid(CUBE.vertices, CUBE.faces, pitch=-3)
    assert coarse.pitch == -3
    assert (coarse | b.cube(0.5)).pitch == -9


# Found: a given pitch was lost by pickling, tagging, combining, warping and smoothing, so that
# the solid turned into another set; hulls and refined solids kept one that nobody gave.
def test_a_given_pitch_is_kept() -> None:
    mesh = b.cube(0.37).to_mesh()
    coarse = b.Solid(mesh.vertices, mesh.faces, pitch=-2)
    turned = coarse.rotate(30)
    assert pickle.loads(pickle.dumps(turned)) == turned
    assert hash(pickle.loads(pickle.dumps(turned))) == hash(turned)
    assert coarse.tagged(name="part").rotate(30).volume == turned.volume
    for same in (
        pickle.loads(pickle.dumps(coarse)),
        coarse | b.Solid.empty(),
        coarse & b.half_space("z", 9),
        ~~coarse.tagged(layer=1),
        coarse.normalized(),
        coarse.warp(lambda points: points),
        coarse.refine(2),
        b.hull(coarse),
    ):
        assert same == coarse
        assert same.rotate(30).pitch == -2
    assert coarse.smooth(2).pitch == -2


# Found: hulls and refined solids kept a pitch that nobody gave, and vanished when they were made
# small.
def test_a_pitch_that_nobody_gave_is_not_kept() -> None:
    for body in (b.hull(b.cube(1)), b.cube(1).refine(2), b.cube(1) | b.cube(2)):
        assert body.scale(1e-6).rotate(30).pitch < -9
        assert body.scale(1e10).rotate(30).pitch == -3


def test_wrong_winding_rules_are_refused() -> None:
    with pytest.raises(b.InvalidMeshError):
        b.Solid(CUBE.vertices, CUBE.faces, winding="odd")  # type: ignore[arg-type]


@pytest.mark.parametrize("op", ["union", "intersection", "difference", "xor"])
def test_arrays_in_arrays_out(op: Any) -> None:
    moved = CUBE.vertices + np.array([0.5, 0, 0])
    vertices, faces = b.boolean(CUBE.vertices, CUBE.faces, moved, CUBE.faces, op)
    volume = b.Solid(vertices, faces).volume
    assert volume == {"union": 1.5, "intersection": 0.5, "difference": 0.5, "xor": 1}[op]


def test_repr_of_large_results_makes_no_mesh() -> None:
    large = b.sphere(1, segments=256) - b.cube(3)
    assert large.volume > 0
    assert repr(large) == "Solid(evaluated, without a mesh)"
    assert np.shares_memory(large.faces, large.to_mesh().faces) and "triangles" in repr(large)


# Found: `repr` said “Solid(evaluated)”.
def test_repr_tells_what_is_known_and_evaluates_nothing() -> None:
    a = b.cube(1)
    assert repr(a) == "Solid(12 triangles, bounds (0, 0, 0) to (1, 1, 1))"
    assert repr(a.translate(1, 2, 3)) == "Solid(12 triangles, bounds (1, 2, 3) to (2, 3, 4))"
    assert repr(a.rotate(90).scale(z=2)) == "Solid(12 triangles, bounds (-1, 0, 0) to (0, 1, 2))"
    far = a.scale(1e300).scale(1e300)
    assert repr(far) == "Solid(12 triangles, transformed beyond all doubles)"
    difference = b.cube(2) - a
    assert repr(difference) == "Solid(pending: 2 operands)"
    assert difference.volume == 7
    count = len((b.cube(2) - a).faces)
    assert repr(difference) == f"Solid({count} triangles, bounds (0, 0, 0) to (2, 2, 2))"
    assert (
        repr(difference.rotate(90)) == f"Solid({count} triangles, bounds (-2, 0, 0) to (0, 2, 2))"
    )
    moved = difference.translate(1, 0, 0)
    assert moved.volume == difference.volume
    assert repr(moved) == f"Solid({count} triangles, bounds (1, 0, 0) to (3, 2, 2))"
    assert repr(pickle.loads(pickle.dumps(difference))) == repr(difference)
    endless = b.half_space((0, 0, 1)) - a
    assert endless.classify([(0.5, 0.5, 0.5)])[0] == -1
    assert repr(endless) == "Solid(evaluated, without a mesh)"
    assert repr(~a) == "Solid(pending: 1 operand)"
    assert repr(b.half_space((0, 0, 1))) == "Solid(half-space)"
    assert repr(b.Solid.empty()) == "Solid(empty)"
    assert repr(b.Solid.full()) == "Solid(all of space)"
    empty = a - a
    assert empty.is_empty
    assert repr(empty) == "Solid(empty)"


def test_copies_are_the_solid_itself() -> None:
    a = b.cube(2) - b.cube(1)
    assert copy.copy(a) is a
    assert copy.deepcopy([a])[0] is a


SOLIDS: dict[str, Callable[[], b.Solid]] = {
    "mesh": lambda: b.cube(1),
    "expression": lambda: b.cube(2) - b.cube(1),
    "moved": lambda: (b.cube(2) - b.cube(1)).rotate(30),
    "empty": b.Solid.empty,
    "half-space": lambda: b.half_space((1, 2, 3), 4) & b.cube(1),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_pickling_keeps_the_set_and_the_transform(name: str) -> None:
    solid = SOLIDS[name]()
    again = pickle.loads(pickle.dumps(solid))
    assert again.equals(solid)
    assert again._factors == solid._factors
    assert again.to_mesh().faces.shape == solid.to_mesh().faces.shape


def test_errors_have_a_code_places_and_a_sentence() -> None:
    with pytest.raises(b.InvalidMeshError) as caught:
        b.Solid(CUBE.vertices, CUBE.faces[1:])
    assert caught.value.code == "not_closed"
    assert caught.value.where
    assert isinstance(caught.value, ValueError)
    assert "close the holes" in str(caught.value)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (again.code, again.where, str(again)) == (
        caught.value.code,
        caught.value.where,
        str(caught.value),
    )


# Found: messages of errors had numbers of twenty digits.
def test_messages_round_numbers() -> None:
    ball = b.sphere(1, segments=12).rotate((10, 20, 33))
    with pytest.raises(b.InvalidMeshError) as caught:
        b.Solid(ball.vertices * 1e-5, ball.faces[1:])
    numbers = [word.strip("(),.") for word in caught.value.message.split() if "e-" in word]
    assert len(numbers) == 6 and all(len(number) <= len("-1.23456e-10") for number in numbers)


def test_errors_of_the_core_become_errors_of_the_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from bspcsg import _core
    from bspcsg.errors import from_core

    # Where the reports of defects go.
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    kinds = {
        "not_closed": b.InvalidMeshError,
        "bad_normal": b.InvalidMeshError,
        "too_small": b.LimitError,
        "unbounded": b.UnboundedError,
        "internal": b.InternalError,
        "never heard of": b.InternalError,
        "cancelled": KeyboardInterrupt,
    }
    for code, kind in kinds.items():
        error = _core.CoreError("sentence")
        error.code, error.where, error.message = code, [3], "A sentence"
        assert isinstance(from_core(error), kind)


def test_results_leave_for_other_libraries() -> None:
    part = b.cube(2) - b.cube(1)
    assert part.to_trimesh().is_volume
    assert part.to_trimesh().volume == pytest.approx(7)
    assert part.to_manifold().status().name == "NoError"


def test_the_area_of_a_complement_is_that_of_the_solid() -> None:
    part = b.cube(3) - b.cube(1)
    assert (~part).area == part.area == 54
    for endless in (b.half_space((0, 0, 1)), b.half_space((0, 0, 1)) - part):
        with pytest.raises(b.UnboundedError):
            endless.area  # noqa: B018


def test_unbounded_solids_moved_together_can_be_pickled() -> None:
    turn = [[0, 1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    first, second = b.half_space((1, 2, 3), 1), b.half_space((-1, 1, 1), 0)
    wedge = first.transform(turn) & second.transform(turn)
    points = [(9, 9, 9), (-9, -9, -9), (0, 0, -9)]
    for solid in (wedge, first.rotate(30), wedge.rotate(30)):
        copy = pickle.loads(pickle.dumps(solid))
        assert copy.classify(points).tolist() == solid.classify(points).tolist()
        assert copy.equals(solid)


def test_a_mesh_that_is_wrongly_trusted_is_named() -> None:
    one = b.cube(2).to_mesh()
    vertices = np.concatenate([one.vertices, one.vertices + (0.7, 0.8, 0.9)])
    faces = np.concatenate([one.faces, one.faces + len(one.vertices)])
    trusted = b.Solid(vertices, faces, trusted=True)
    with pytest.raises(b.InvalidMeshError, match=r"operand 0 .* declared trusted") as caught:
        (trusted & b.cube(1.5)).tree.stats()
    assert caught.value.code == "not_reduced"
    assert (b.Solid(vertices, faces) & b.cube(1.5)).volume == 3.375


def test_operands_in_one_place_are_combined_without_dividing_space() -> None:
    for count in (20, 40):
        turns = [(17.0 * k, 29.0 * k, 43.0 * k) for k in range(count)]
        cubes = [b.cube(2, center=True).rotate(turn) for turn in turns]
        counts = b.union(*cubes).tree.stats()
        assert counts["cells"] <= 2 * count, counts
        # One part is left of each face that is not covered.
        assert counts["parts"] <= 12 * count, counts


# Found: exact volumes had no limit of digits.
def test_exact_volumes_refuse_to_be_too_long() -> None:
    ball = b.sphere(1, segments=24)
    rest = ball - ball.rotate((10, 20, 30)).translate((0.1, 0.2, 0.3))
    with pytest.raises(
        b.LimitError, match=r"up to \d+ digits, more than the limit of 10\b"
    ) as caught:
        rest.exact_volume(most_digits=10)
    assert caught.value.code == "too_many"
    exact = rest.exact_volume()
    assert exact == rest.volume_exact
    assert abs(exact - volume_near(rest)) < Fraction(1, 10**50)


@pytest.mark.parametrize("name", ["volume_near", "volume_residues"])
def test_what_goes_with_the_next_version_says_so(name: str) -> None:
    with pytest.warns(DeprecationWarning, match=name) as warned:
        value = getattr(b.cube(2), name)
    assert warned[0].filename == __file__
    assert value == getattr(measure, name)(b.cube(2))


def test_check_is_another_name_of_validate_until_the_next_version() -> None:
    part = b.cube(2) - b.cube(1)
    with pytest.warns(DeprecationWarning, match=r"use validate"):
        assert part.check().ok
    assert part.validate().ok


def test_solids_show_what_users_need_and_no_more() -> None:
    inside = {"from_node", "from_leaf", "alias", "expression"}
    assert not inside & set(dir(b.Solid))


# Found: small results from meshes of more than 16 384 faces lacked whole faces.
def test_little_of_a_large_mesh_is_whole() -> None:
    # Short lists are worked on outside of the pool, long meshes in chunks: both at once here.
    ball = b.sphere(10, segments=200)
    corner = b.box(1).translate(9.5, 0, 0)
    parts = [corner & ball, corner - ball, (corner | ball) - ball]
    volumes = [b.Solid(*part.to_mesh()).volume for part in parts]
    assert volumes[0] + volumes[1] == pytest.approx(1, abs=1e-12)
    assert volumes[1] == pytest.approx(volumes[2], abs=1e-12)


def test_the_last_of_many_balls_is_not_lost() -> None:
    ball = b.sphere(1, segments=32).to_mesh()
    count = 2**15 // len(ball.faces) + 1
    moved = [ball.vertices + (3 * k, 0, 0) for k in range(count)]
    faces = [np.asarray(ball.faces) + k * len(ball.vertices) for k in range(count)]
    many = b.Solid(np.concatenate(moved), np.concatenate(faces))
    for k in (0, count // 2, count - 1):
        alone = (many & b.box(3, center=True).translate(3 * k, 0, 0)).to_mesh()
        assert len(alone.faces) == len(ball.faces)


def bar_with_a_round_end(corners: int) -> tuple["b._types.FloatArray", "b._types.IndexArray"]:
    """Return a rotated bar in single precision with fans of needles as caps."""
    angles = np.linspace(-np.pi / 2, np.pi / 2, corners - 1)
    arc = np.column_stack([9 + np.cos(angles) / 2, np.sin(angles) / 2])
    outline = np.concatenate([[(0, -0.5)], arc, [(0, 0.5)]])
    count = len(outline)
    levels = [np.column_stack([outline, np.full(count, height)]) for height in (0.0, 1.0)]
    vertices = np.concatenate(levels) @ np.linalg.qr(np.arange(9.0).reshape(3, 3) ** 2 + 1)[0]
    fan = np.array([(0, k + 1, k) for k in range(1, count - 1)])
    low, high = np.arange(count), np.roll(np.arange(count), -1)
    walls = [(low, high, high + count), (low, high + count, low + count)]
    sides = np.concatenate([np.column_stack(wall) for wall in walls])
    faces = np.concatenate([fan, fan[:, ::-1] + count, sides])
    return vertices.astype(np.float32).astype(np.float64), faces


# Found: needle fans in single precision took minutes to check.
# Found: two trusted meshes failed with an internal error.
def test_needle_fans_in_single_precision_are_measured_at_once() -> None:
    vertices, faces = bar_with_a_round_end(301)
    began = time.process_time()
    volume = abs(b.Solid(vertices, faces).volume)
    # Before, 1 204 triangles took more than 90 seconds; now they take a hundredth of one.
    assert len(faces) == 1204 and time.process_time() - began < 9
    assert volume == pytest.approx(9 + np.pi / 8, rel=1e-4)
    solids = [b.Solid(vertices + shift, faces, trusted=True) for shift in (0, 0.01)]
    common, joint = solids[0] & solids[1], solids[0] | solids[1]
    assert common.volume + joint.volume == pytest.approx(2 * volume, rel=1e-9)


# Found: the numbers in `mesh.source` depended on whether intermediate results had been queried.
@pytest.mark.parametrize("asked", [False, True])
def test_numbers_of_sources_do_not_tell_what_was_asked_for(asked: bool) -> None:
    def seen(solid: b.Solid) -> b.Solid:
        if asked:
            assert solid.volume >= 0
        return solid

    first = b.box(1, 1, 2).translate(2, 0, 3)
    second = b.box(2, 3, 2).translate(1, 0, 2)

    def moved() -> b.Solid:
        return seen(seen(second.translate(-2, 1, -2)).mirror((1, 0, 0)))

    kept = seen(seen(first.mirror((1, 0, 0))) - moved())
    solid = seen(seen(kept - seen(moved() ^ moved())) | moved())
    assert set(solid.to_mesh().source[:, 0].tolist()) == {0, 1}


@pytest.mark.parametrize(
    "sets",
    [
        [b.cube(2), b.cube(2).translate(1, 1, 1), b.cube(1)],
        [bsp.Region.rectangle(2), bsp.Region.rectangle(3, 1), bsp.Region.rectangle(1, 3)],
        [bsp.Intervals([(0, 2)]), bsp.Intervals([(1, 3)]), bsp.Intervals([(0, 5)])],
    ],
    ids=["solids", "regions", "intervals"],
)
def test_set_operations_have_names_beside_the_signs(sets: Any) -> None:
    one, other, third = sets
    assert one.union(other, third) == one.union([other, third]) == one | other | third
    assert one.intersection(other, third) == one & other & third
    assert one.difference(other, third) == one - other - third
    assert one.symmetric_difference(other, third) == one ^ other ^ third
    assert type(one.union(other)) is type(one) and one.difference() == one


def test_set_operations_by_name_refuse_other_operands() -> None:
    wrong: list[Any] = [3, bsp.Region.circle(1), "cube", [b.cube(1), None]]
    for other in wrong:
        with pytest.raises(b.InvalidParameterError) as caught:
            b.cube(1).union(other)
        assert caught.value.code == "invalid_parameter"
    with b.union() as block:
        b.cube(1).difference(b.cube(0.5))
    assert block.solid.volume == 0.875
