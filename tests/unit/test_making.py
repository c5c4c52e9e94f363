"""Rounded boxes, surfaces over heights, and patterns."""

import math
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

import bspcsg as b


@pytest.mark.parametrize("segments", [4, 8, 9, 32])
def test_round_boxes_are_convex_and_fill_their_box(segments: int) -> None:
    box = b.rounded_box((4, 3, 2), 0.5, segments=segments, center=True)
    mesh = box.to_mesh()
    assert mesh.certificate.ok and box.genus == 0
    assert box.bounds is not None and box.bounds.tolist() == [[-2, -1.5, -1], [2, 1.5, 1]]
    # Steiner's formula, for a true ball.
    inner, r = (3.0, 2.0, 1.0), 0.5
    true = 6 + r * 22 + math.pi * r**2 * sum(inner) + 4 / 3 * math.pi * r**3
    assert box.volume < true
    assert box.volume == pytest.approx(true, rel=6 / segments**2)


def test_a_radius_of_half_an_edge_leaves_no_slivers() -> None:
    capsule = b.rounded_box((4, 2, 2), 1, segments=12)
    ball = b.rounded_box(2, 1, segments=12)
    for solid in (capsule, ball):
        assert solid.to_mesh().certificate.ok
        assert solid.to_manifold().status().name == "NoError"
    assert (len(ball.vertices), ball.genus) == (4 * 9 + 2, 0)
    assert b.rounded_box(2, 0) == b.box(2)
    assert b.rounded_box((1, 2, 3), 0.25).volume < 6


def test_round_boxes_are_the_same_along_each_axis() -> None:
    one, other = b.rounded_box((2, 3, 4), 0.5), b.rounded_box((3, 4, 2), 0.5)
    turn = np.array([(0, 1, 0, 0), (0, 0, 1, 0), (1, 0, 0, 0)])
    assert one.transform(turn) == other


def test_surfaces_stand_on_their_floor(tmp_path: Path) -> None:
    table = [[1, 1, 1], [1, 4, 1], [1, 1, 1]]
    body = b.surface(table)
    assert body.volume == pytest.approx(4 + 4 * 0.75)
    wide = b.surface(table, cell=(2, 3), floor=-1, center=True)
    assert wide.bounds is not None
    assert wide.bounds.tolist() == [[-2, -3, -1], [2, 3, 4]]
    assert wide.volume == pytest.approx(6 * (body.volume + 4))
    path = tmp_path / "table.dat"
    path.write_text("1 1 1\n1 4 1\n1 1 1\n")
    assert b.surface(path) == body
    assert b.surface([[-5, -5], [-5, -5]]).bounds.tolist()[0] == [0, 0, -6]  # type: ignore[union-attr]


def test_patterns_unite_copies() -> None:
    cube = b.cube(1)
    assert b.linear_pattern(cube, 3, (1, 0, 0)) == b.box((3, 1, 1))
    assert b.linear_pattern(cube, 3, (0, 0, 0)) == cube
    assert b.grid(cube, (2, 3), (1, 1)) == b.box((2, 3, 1))
    assert b.grid(cube, (2, 2, 2), (1, 1, 1)) == b.cube(2)
    assert b.grid(cube, (3, 3), (2, 2), center=True).bounds.tolist() == [[-2, -2, 0], [3, 3, 1]]  # type: ignore[union-attr]
    post = cube.translate(2, 0, 0)
    assert b.polar_pattern(post, 1) == post
    assert b.polar_pattern(post, 4) == b.union(post.rotate(90 * k) for k in range(4))
    assert b.polar_pattern(post, 3, angle=180) == b.union(post.rotate(90 * k) for k in range(3))
    assert b.polar_pattern(cube, 2, center=(1, 0, 0)) == cube | cube.translate(1, -1, 0)
    assert b.polar_pattern(post, 2, axis="x").volume == 2


def test_patterns_of_regions_are_regions() -> None:
    square = b.Region.rectangle(1)
    assert b.linear_pattern(square, 3, (1, 0)) == b.Region.rectangle(3, 1)
    assert b.grid(square, (2, 3), (1, 1)) == b.Region.rectangle(2, 3)
    assert b.polar_pattern(square, 4) == b.Region.rectangle(2, center=True)


def test_patterns_count_once_in_a_block() -> None:
    with b.union() as u:
        b.linear_pattern(b.cube(1), 3, (2, 0, 0))
    assert u.solid.volume == 3


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: b.rounded_box(1, 0.6), "half of the shortest"),
        (lambda: b.rounded_box(1, -0.1), "at least 0"),
        (lambda: b.rounded_box((1, 2), 0.1), "three"),
        (lambda: b.rounded_box((1, 2, 0), 0.1), "above 0"),
        (lambda: b.rounded_box(1, 0.1, segments=3), "at least 4"),
        (lambda: b.surface([[1, 2]]), "two rows"),
        (lambda: b.surface([[1, 2], [3, math.nan]]), "finite"),
        (lambda: b.surface([[1, 2], [3, 4]], floor=1), "below all heights"),
        (lambda: b.surface([[1, 2], [3, 4]], cell=0), "above 0"),
        (lambda: b.surface([[1, 2], [3, 4]], cell=(1, 2, 3)), "cell must be one number or a pair"),
        (lambda: b.linear_pattern(b.cube(1), 0, (1, 0, 0)), "at least 1"),
        (lambda: b.linear_pattern(b.cube(1), 2, (1, 0)), "three"),
        (lambda: b.linear_pattern(b.Region.circle(1), 2, (1, 0, 1)), "two numbers"),
        (lambda: b.polar_pattern(b.cube(1), 2, axis="w"), "axis"),
        (lambda: b.polar_pattern(b.cube(1), 2, angle=math.inf), "finite"),
        (lambda: b.grid(b.cube(1), cast("Any", 3), cast("Any", 3)), "one number for each axis"),
        (lambda: b.grid(b.cube(1), (1, 2, 3), (1, 1)), "counts and steps"),
        (lambda: b.grid(b.Region.circle(1), (1, 2, 3), (1, 1, 1)), "counts and steps"),
    ],
)
def test_what_makes_no_shape_is_refused(call: Any, word: str) -> None:
    with pytest.raises(b.InvalidParameterError, match=word):
        call()


def test_copies_are_bounded() -> None:
    calls: list[Any] = [
        lambda: b.linear_pattern(b.cube(1), 10**9, (1, 0, 0)),
        lambda: b.grid(b.cube(1), (10**6, 10**6), (1, 1)),
        lambda: b.surface(np.zeros((2000, 2000))),
    ]
    for call in calls:
        with pytest.raises(b.LimitError):
            call()


# Found: `linear_pattern`, `grid` and `align` computed their shifts in doubles, so that copies by
# short decimals were rounded.
def test_copies_by_short_decimals_are_exact() -> None:
    part = b.cube(1) & b.half_space((3, 5, 7), 4)
    row = b.linear_pattern(part, 4, (1.1, 0, 0))
    assert row.volume_exact == 4 * part.volume_exact
    assert row == b.union(part.translate(x, 0, 0) for x in (0, 1.1, 2.2, 3.3))
    grid = b.grid(part, (4, 1), (1.2, 1.1), center=True)
    assert grid.volume_exact == 4 * part.volume_exact
    beside = part.translate(0.1, 0, 0)
    assert beside.align(x="min", to=(0.3, 0, 0)) == beside.translate(0.2, 0, 0)
    with pytest.raises(b.LimitError):
        b.linear_pattern(part, 4, (1e308, 0, 0))


# Found: arcs missed the axes by rounding, so that `revolve` refused some of them.
def test_arcs_end_on_the_axes() -> None:
    assert b.arc((0, 0), 1, 270, 450)[[0, -1]].tolist() == [[0, -1], [0, 1]]
    balls = [b.revolve(b.arc((0, 0), 1, first, first + 180)) for first in (-90, 270)]
    assert balls[0] == balls[1] and balls[0].findings == ()
    turns = np.linspace(-np.pi / 2, np.pi / 2, 17)
    by_hand = b.revolve(np.column_stack([np.cos(turns + 2 * np.pi), np.sin(turns)]))
    assert by_hand.findings == ()
