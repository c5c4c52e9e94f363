"""Factors of transforms, their common prefix, and exact lattice motions."""

import math
import pickle
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import bspcsg as b
from bspcsg.geometry import transform
from bspcsg.geometry.chain import FactorChain, common_prefix
from bspcsg.geometry.transform import Factor, LatticeMotion

PITCH = -9


def as_motion(factor: Factor) -> LatticeMotion | None:
    return transform.lattice_motion((factor,), PITCH)


@pytest.mark.parametrize(
    ("angle", "expected"),
    [
        (0, (1, 0)),
        (30, (math.cos(math.pi / 6), 0.5)),
        (60, (0.5, math.cos(math.pi / 6))),
        (90, (0, 1)),
        (180, (-1, 0)),
        (-90, (0, -1)),
        (3690, (0, 1)),
        (330, (math.cos(math.pi / 6), -0.5)),
    ],
)
def test_cosine_and_sine_are_exact_where_rational(
    angle: float, expected: tuple[float, float]
) -> None:
    assert transform.cos_sin(angle) == expected


@given(st.floats(-1e6, 1e6))
def test_cosine_and_sine_agree_with_radians(angle: float) -> None:
    exact = math.radians(math.fmod(angle, 360))
    assert transform.cos_sin(angle) == pytest.approx((math.cos(exact), math.sin(exact)), abs=1e-14)


@pytest.mark.parametrize("axis", ["x", "y", "z", (0, 0, -2), (0.5, 0, 0)])
@pytest.mark.parametrize("angle", [90, 180, 270, -90, 450])
def test_quarter_turns_are_lattice_motions(axis: str, angle: float) -> None:
    motion = as_motion(transform.rotation(angle, axis))
    assert motion is not None
    assert sorted(map(abs, motion.axes)) == [1, 2, 3]
    assert motion.shift == (0, 0, 0)


def test_quarter_turn_goes_counter_clockwise() -> None:
    turned = transform.apply(transform.rotation(90, "z").matrix, np.array([[1.0, 0.0, 0.0]]))
    assert turned.tolist() == [[0, 1, 0]]


def test_third_turns_about_the_diagonal_permute_axes() -> None:
    motion = as_motion(transform.rotation(120, (1, 1, 1)))
    assert motion == LatticeMotion((3, 1, 2))


def test_other_rotations_are_no_lattice_motions() -> None:
    assert as_motion(transform.rotation(45, "x")) is None
    assert as_motion(transform.rotation(89.9999999, "z")) is None


def test_mirrors_in_diagonal_planes_swap_axes() -> None:
    assert as_motion(transform.mirroring((1, -1, 0))) == LatticeMotion((2, 1, 3))
    assert as_motion(transform.mirroring((0, 7, 0))) == LatticeMotion((1, -2, 3))


@pytest.mark.parametrize(
    ("length", "steps"),
    [
        (0.1, 10**8),
        (0.3, 3 * 10**8),
        (-7, -7 * 10**9),
        (1e-9, 1),
        (0, 0),
        (9007199.0, 9007199 * 10**9),
    ],
)
def test_short_decimals_are_whole_steps(length: float, steps: int) -> None:
    assert transform.whole_steps(length, PITCH) == steps


@pytest.mark.parametrize("length", [1 / 3, 1e-10, 0.1 + 0.2, math.pi, 1e12])
def test_other_lengths_are_not(length: float) -> None:
    assert transform.whole_steps(length, PITCH) is None


def test_coarser_lattices_have_fewer_whole_steps() -> None:
    assert transform.whole_steps(1e12, -3) == 10**15
    assert transform.whole_steps(3000.0, 3) == 3
    assert transform.whole_steps(0.1, 0) is None


@given(st.lists(st.integers(0, 5), max_size=6))
def test_composed_motions_agree_with_the_product(choice: list[int]) -> None:
    known = [
        transform.rotation(90, "x"),
        transform.rotation(-90, "y"),
        transform.mirroring((0, 0, 1)),
        transform.translation((1, 2, 3)),
        transform.translation((0.5, 0, -0.25)),
        transform.rotation(120, (1, 1, 1)),
    ]
    factors = tuple(known[index] for index in choice)
    motion = transform.lattice_motion(factors, PITCH)
    assert motion is not None
    point = [1.0, 10.0, 100.0]
    moved = [
        math.copysign(1, axis) * Fraction(point[abs(axis) - 1]) + Fraction(shift, 10**9)
        for axis, shift in zip(motion.axes, motion.shift, strict=True)
    ]
    image = transform.apply(transform.product(factors), np.array([point]))
    assert image[0].tolist() == moved


def test_common_prefix_is_the_outermost_equal_part() -> None:
    m, t, s = (transform.translation((k, 0, 0)) for k in (1, 2, 3))

    def common(*lists: tuple[Factor, ...]) -> tuple[Factor, ...]:
        return tuple(common_prefix([FactorChain.of(factors) for factors in lists]))

    assert common((m, t), (m, s)) == (m,)
    assert common((m, t), (m, t)) == (m, t)
    assert common((m, t), ()) == ()
    assert common((t, m), (s, m)) == ()
    assert common((m, t, *[s] * 99), (m, t, *[s] * 40, m)) == (m, t, *[s] * 40)


def test_factors_are_equal_bit_by_bit_but_for_the_sign_of_zero() -> None:
    minus_zero = np.eye(4)
    minus_zero[0, 1] = -0.0
    assert Factor(minus_zero) == Factor(np.eye(4))
    nearly = np.eye(4)
    nearly[0, 3] = 5e-324
    assert Factor(nearly) != Factor(np.eye(4))
    assert pickle.loads(pickle.dumps(Factor(nearly))) == Factor(nearly)


def test_euler_angles_turn_about_x_first() -> None:
    factors = transform.euler_rotation((90, 0, 90))
    assert factors == (transform.rotation(90, "z"), transform.rotation(90, "x"))
    image = transform.apply(transform.product(factors), np.array([[0.0, 1.0, 0.0]]))
    assert image.tolist() == [[0, 0, 1]]


@pytest.mark.parametrize(
    "matrix",
    [
        np.zeros((3, 3)),
        np.diag([1.0, 1.0, 0.0, 1.0]),
        np.diag([1.0, 1.0, 1.0, 2.0]),
        np.full((4, 4), np.nan),
        np.array([[1, 2, 0, 0], [2, 4, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]]),
    ],
)
def test_matrices_that_are_no_invertible_affine_map_are_refused(matrix: np.ndarray) -> None:
    with pytest.raises(b.InvalidMeshError) as caught:
        b.cube(1).transform(matrix)
    assert caught.value.code == "invalid_parameter"


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: b.cube(1).translate(1, 2),
        lambda: b.cube(1).translate(float("nan"), 0, 0),
        lambda: b.cube(1).scale(0),
        lambda: b.cube(1).scale((1, 0, 1)),
        lambda: b.cube(1).mirror((0, 0, 0)),
        lambda: b.cube(1).rotate(30, "w"),
        lambda: b.cube(1).rotate(30, (0, 0, 0)),
        lambda: b.cube(1).rotate(float("inf")),
        lambda: b.cube(1).rotate("far"),  # type: ignore[arg-type]
        lambda: b.cube(1).rotate((1, 2)),
    ],
)
def test_wrong_parameters_are_named(wrong) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(b.InvalidMeshError) as caught:
        wrong()
    assert caught.value.code == "invalid_parameter"


def test_determinant_signs_are_exact() -> None:
    nearly_flat = np.diag([1e-200, 1e-200, 1e-200, 1.0])
    assert transform.determinant_sign(nearly_flat) == 1
    assert transform.determinant_sign(-nearly_flat) == -1


def test_planes_are_named_by_the_axes_across_them() -> None:
    part = b.box(1, 2, 3)
    for axis, normal in (("x", (1, 0, 0)), ("y", (0, 1, 0)), ("Z", (0, 0, 1))):
        assert part.split(axis, 0.5)[0] == part.split(normal, 0.5)[0]
        assert part.trim(axis, 0.5) == part.trim(normal, 0.5)
        assert part.mirror(axis, about=(5, 6, 7)) == part.mirror(normal, about=(5, 6, 7))
        assert b.Assembly("a", part).mirror(axis).to_solid() == part.mirror(normal)
        assert part.slice(0.5, axis).outlines[0].points.tolist() == (
            part.slice(0.5, normal).outlines[0].points.tolist()
        )
        assert part & b.half_space(axis, 1) == part & b.half_space(normal, 1)
    for call in (part.split, part.trim, b.half_space):
        with pytest.raises(b.InvalidMeshError, match="must be 'x', 'y', 'z' or a vector"):
            call("up")
    for other in (part.mirror, lambda axis: part.slice(0.5, axis)):
        with pytest.raises(
            b.InvalidParameterError, match="An axis must be 'x', 'y', 'z' or a vector"
        ):
            other("up")


# Found: transforms that together lead too large for doubles, arrays for angles, and complex numbers
# of numpy ended in raw errors or lost a part.
@pytest.mark.parametrize(
    "moved",
    [
        lambda s: s.translate(1e308, 0, 0).translate(1e308, 0, 0),
        lambda s: s.scale(1e200).scale(1e200),
    ],
)
def test_what_leads_beyond_all_doubles_is_refused(moved: Callable[[b.Solid], b.Solid]) -> None:
    with pytest.raises(b.LimitError, match="too large for doubles"):
        assert moved(b.cube(1)).volume


def test_angles_are_numbers() -> None:
    with pytest.raises(b.InvalidParameterError):
        b.cube(1).rotate(10, x=np.array([1, 2]))  # type: ignore[arg-type]


# Found: assigning to the program of `last_operation` changed the solid itself.
def test_the_program_that_is_told_is_a_copy() -> None:
    part = b.half_space("z", 0) | b.cube(1)
    assert not part.is_bounded and part.last_operation is not None
    part.last_operation.program.clear()
    assert (part.rotate(30) & b.cube(10, center=True)).volume > 500


# Found: a solid scaled too thin for doubles could not be turned: its mesh had no faces.
@pytest.mark.parametrize("height", [1e-12, 1e-16, 1e-20, 1e-300])
def test_what_is_too_thin_for_doubles_is_empty_however_it_is_turned(height: float) -> None:
    plate = b.box(1, 1, 1).translate(1, 1, 1).scale((1, 1, height))
    turned = plate.rotate(30, (1, 2, 3))
    assert plate.is_empty and turned.is_empty and turned == b.Solid.empty()
    assert (turned.rotate(10, "x") | b.cube(1)).volume == 1
    with pytest.raises(b.InvalidMeshError, match="no face of positive area"):
        b.Solid(np.zeros((3, 3)), [[0, 1, 2]]).rotate(30, "x").to_mesh()


WEDGE = b.Assembly("wedge", b.box(1, 2, 3) - b.cube(1)), b.box(1, 2, 3) - b.cube(1)


def solid_of(shape: b.Solid | b.Assembly) -> b.Solid:
    return shape if isinstance(shape, b.Solid) else shape.to_solid()


# Found: `translate(z=5)` and `scale(z=2)` were TypeErrors, `rotate(z=90)` was not.
@pytest.mark.parametrize("shape", WEDGE, ids=["assembly", "solid"])
def test_transforms_take_values_numbers_and_names_of_axes(shape: b.Solid | b.Assembly) -> None:
    same = [
        [shape.translate((0, 0, 5)), shape.translate(0, 0, 5), shape.translate(z=5)],
        [shape.rotate(90, "y"), shape.rotate((0, 90, 0)), shape.rotate(y=90)],
        [shape.scale((1, 1, 2)), shape.scale(1, 1, 2), shape.scale(z=2)],
        [shape.scale(factor=2), shape.scale(2), shape.scale(2, 2, 2), shape.scale(x=2, y=2, z=2)],
        [shape.mirror((0, 1, 0)), shape.mirror(0, 1, 0), shape.mirror("y"), shape.mirror(y=3)],
        [shape.scale(x=2, about=(1, 0, 0)), shape.scale((2, 1, 1)).translate(x=-1)],
    ]
    for forms in same:
        assert len({solid_of(form) for form in forms}) == 1


def test_transforms_of_the_plane_do_so_too() -> None:
    ell = b.Region.rectangle(3, 2) - b.Region.rectangle(1, 1)
    same = [
        [ell.translate((0, 5)), ell.translate(0, 5), ell.translate(y=5)],
        [ell.scale((1, 2)), ell.scale(1, 2), ell.scale(y=2), ell.scale(y=2, about=(7, 0))],
        [ell.scale(factor=2), ell.scale(2), ell.scale(x=2, y=2)],
        [ell.mirror((1, 0)), ell.mirror(1, 0), ell.mirror("x"), ell.mirror(x=2)],
        [ell.rotate(90, about=(1, 0)), ell.translate(x=-1).rotate(90).translate(x=1)],
        [ell.mirror("y", about=(0, 1)), ell.mirror("y").translate(y=2)],
    ]
    for forms in same:
        assert len({*forms}) == 1


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda s: s.translate(), "offset is missing"),
        (lambda s: s.scale(), "scale factor is missing"),
        (lambda s: s.mirror(), "normal is missing"),
        (lambda s: s.translate((1, 2, 3), x=1), "offset is given twice; .* x= and y="),
        (lambda s: s.scale(2, y=1), "given twice"),
        (lambda s: s.mirror("x", y=1), "given twice"),
        (lambda s: s.translate(x="far"), "x must be a number"),
        (lambda s: s.scale(y=math.nan), "y must be a finite"),
        (lambda s: s.mirror("w"), "x"),
        (lambda s: s.mirror(x=0), "zero|normal"),
        (lambda s: s.scale(x=0), "flattens|determinant"),
        (lambda s: s.translate(1, 2, 3, 4), "offset"),
    ],
)
@pytest.mark.parametrize("shape", [b.cube(1), b.Region.rectangle(1), WEDGE[0]])
def test_transforms_refuse_what_is_no_place(
    call: Callable[[Any], Any], words: str, shape: Any
) -> None:
    with pytest.raises(b.InvalidParameterError, match=words) as caught:
        call(shape)
    assert caught.value.code == "invalid_parameter"
