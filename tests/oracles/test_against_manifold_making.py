"""Shapes that manifold3d can make too have equal volume, area and genus."""

import math
from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import pytest
from manifold3d import CrossSection, Manifold, OpType

import bspcsg as b

Row: TypeAlias = tuple[Callable[[], b.Solid], Callable[[], Manifold]]

SQUARE = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
FRAME = [np.array(SQUARE) * 3, np.array(SQUARE)[::-1]]
STAR = [(math.cos(0.2 * math.pi * k) * (3 - k % 2 * 2), math.sin(0.2 * math.pi * k) * (3 - k % 2 * 2)) for k in range(10)]  # fmt: skip  # noqa: E501
THIN = [(0.0, 0.0), (5.0, 0.0), (5.0, 2.0**-10)]
TOUCHING = [(0.0, 0.0), (2.0, 0.0), (0.0, 2.0), (0.0, 1.0), (1e-3, 1.0), (0.0, 0.5)]
#: The share of its length that a mitre of a ring of 24 sides keeps.
MITRE = math.cos(math.pi / 24)
UP = [(0, 0, 0), (0, 0, 4)]


def prism(points: list[tuple[float, float]], height: float) -> Manifold:
    return Manifold.extrude(CrossSection([points]), height)


def hull(*parts: tuple[list[tuple[float, float]], float]) -> Manifold:
    return Manifold.hull_points([(x, y, z) for loop, z in parts for x, y in loop])


def ring(r: float, sides: int) -> list[tuple[float, float]]:
    return [tuple(point) for point in b.Region.circle(r, sides).to_polygons()[0].tolist()]


def united(parts: list[Manifold]) -> Manifold:
    return Manifold.batch_boolean(parts, OpType.Add)


CUBE = Manifold.cube((1, 1, 1))
POST = Manifold.cylinder(3, 0.5, circular_segments=8).translate((2, 0, 0))
OURS = b.cylinder(3, 0.5, segments=8).translate(2, 0, 0)

#: Ten of each verb; the last five of each are degenerate: they touch, overlap, vanish or are thin.
ROWS: dict[str, Row] = {
    "sweep 1": (lambda: b.sweep(SQUARE, UP), lambda: prism(SQUARE, 4)),
    "sweep 2": (lambda: b.sweep(STAR, UP), lambda: prism(STAR, 4)),
    "sweep 3": (
        lambda: b.sweep(FRAME, UP),
        lambda: Manifold.extrude(CrossSection(FRAME), 4),
    ),
    "sweep 4": (
        lambda: b.sweep(SQUARE, UP, scale=0.5),
        lambda: Manifold.extrude(CrossSection([SQUARE]), 4, scale_top=(0.5, 0.5)),
    ),
    "sweep 5": (
        lambda: b.sweep(SQUARE, b.helix(9, 0, 1, segments=24)),
        lambda: Manifold.revolve(CrossSection([[(x / MITRE + 9, y) for x, y in SQUARE]]), 24),
    ),
    "sweep 6": (
        lambda: b.sweep(SQUARE, UP, scale=0),
        lambda: Manifold.extrude(CrossSection([SQUARE]), 4, scale_top=(0, 0)),
    ),
    "sweep 7": (lambda: b.sweep(SQUARE, [UP[0], UP[0], UP[1], UP[1]]), lambda: prism(SQUARE, 4)),
    "sweep 8": (lambda: b.sweep(THIN, UP), lambda: prism(THIN, 4)),
    "sweep 9": (
        lambda: b.sweep(SQUARE, [(0, 0, 0), (9, 0, 0), (9, 9, 0), (4, 9, 0), (4, -9, 0)]),
        lambda: united(
            [
                Manifold.cube((10, 2, 2)).translate((0, -1, -1)),
                Manifold.cube((2, 11, 2)).translate((8, -1, -1)),
                Manifold.cube((7, 2, 2)).translate((3, 8, -1)),
                Manifold.cube((2, 19, 2)).translate((3, -9, -1)),
            ]
        ),
    ),
    "sweep 10": (
        lambda: b.sweep(SQUARE, [(k * 0.5, 0, 0) for k in range(9)]),
        lambda: Manifold.cube((4, 2, 2)),
    ),
    "loft 1": (lambda: b.loft([(SQUARE, 0), (SQUARE, 2)]), lambda: prism(SQUARE, 2)),
    "loft 2": (
        lambda: b.loft([(SQUARE, 0), [(0, 0, 2)]]),
        lambda: hull((SQUARE, 0), ([(0, 0)], 2)),
    ),
    "loft 3": (
        lambda: b.loft([(SQUARE, 0), (ring(3, 4), 2)]),
        lambda: hull((SQUARE, 0), (ring(3, 4), 2)),
    ),
    "loft 4": (
        lambda: b.loft([(b.Region.circle(3, 48), 0), (b.Region.rectangle(2, center=True), 2)]),
        lambda: hull((ring(3, 48), 0), (SQUARE, 2)),
    ),
    "loft 5": (
        lambda: b.loft([(FRAME, 0), (FRAME, 2)]),
        lambda: Manifold.extrude(CrossSection(FRAME), 2),
    ),
    "loft 6": (lambda: b.loft([(SQUARE, 2), (SQUARE, 1), (SQUARE, 0)]), lambda: prism(SQUARE, 2)),
    "loft 7": (lambda: b.loft([(THIN, 0), (THIN, 2)]), lambda: prism(THIN, 2)),
    "loft 8": (
        lambda: b.loft([(SQUARE, 0), (SQUARE, 0), (SQUARE, 2)]),
        lambda: prism(SQUARE, 2),
    ),
    "loft 9": (
        lambda: b.loft([(SQUARE, 0), (SQUARE, 2), (SQUARE, 1), (SQUARE, 3)]),
        lambda: prism(SQUARE, 3),
    ),
    "loft 10": (
        lambda: b.loft([[(0, 0, -1)], (SQUARE, 0), [(0, 0, 1)]]),
        lambda: hull(([(0, 0)], -1), (SQUARE, 0), ([(0, 0)], 1)),
    ),
    "linear 1": (
        lambda: b.linear_pattern(b.cube(1), 5, (2, 0, 0)),
        lambda: united([CUBE.translate((2 * k, 0, 0)) for k in range(5)]),
    ),
    "linear 2": (
        lambda: b.linear_pattern(OURS, 5, (0.7, 0.1, 0)),
        lambda: united([POST.translate((0.7 * k, 0.1 * k, 0)) for k in range(5)]),
    ),
    "linear 3": (
        lambda: b.linear_pattern(OURS, 3, (0.25, 0.5, 1)),
        lambda: united([POST.translate((0.25 * k, 0.5 * k, k)) for k in range(3)]),
    ),
    "linear 4": (lambda: b.linear_pattern(OURS, 1, (1, 1, 1)), lambda: POST),
    "linear 5": (
        lambda: b.linear_pattern(OURS, 4, (0, 0, 5)),
        lambda: united([POST.translate((0, 0, 5 * k)) for k in range(4)]),
    ),
    "linear 6": (
        lambda: b.linear_pattern(b.cube(1), 5, (1, 0, 0)),
        lambda: Manifold.cube((5, 1, 1)),
    ),
    "linear 7": (lambda: b.linear_pattern(b.cube(1), 5, (0, 0, 0)), lambda: CUBE),
    "linear 8": (
        lambda: b.linear_pattern(b.cube(1), 9, (0.125, 0, 0)),
        lambda: Manifold.cube((2, 1, 1)),
    ),
    "linear 9": (
        lambda: b.linear_pattern(b.cube(1), 2, (0.5, 0.5, 0)),
        lambda: CUBE + CUBE.translate((0.5, 0.5, 0)),
    ),
    "linear 10": (
        lambda: b.grid(b.cube(1), (3, 3, 3), (1, 1, 1)),
        lambda: Manifold.cube((3, 3, 3)),
    ),
    "polar 1": (
        lambda: b.polar_pattern(OURS, 5),
        lambda: united([POST.rotate((0, 0, 72 * k)) for k in range(5)]),
    ),
    "polar 2": (
        lambda: b.polar_pattern(OURS, 3, axis="x"),
        lambda: united([POST.rotate((120 * k, 0, 0)) for k in range(3)]),
    ),
    "polar 3": (
        lambda: b.polar_pattern(OURS, 4, angle=90),
        lambda: united([POST.rotate((0, 0, 30 * k)) for k in range(4)]),
    ),
    "polar 4": (
        lambda: b.polar_pattern(OURS, 4, center=(1, 0, 0)),
        lambda: united([POST.translate((-1, 0, 0)).rotate((0, 0, 90 * k)) for k in range(4)]),
    ),
    "polar 5": (
        lambda: b.polar_pattern(OURS, 6, angle=-360),
        lambda: united([POST.rotate((0, 0, 60 * k)) for k in range(6)]),
    ),
    "polar 6": (lambda: b.polar_pattern(OURS, 1), lambda: POST),
    "polar 7": (
        lambda: b.polar_pattern(b.cube(1), 4),
        lambda: Manifold.cube((2, 2, 1)),
    ),
    "polar 8": (
        lambda: b.polar_pattern(b.cube(2, center=True), 4),
        lambda: Manifold.cube((2, 2, 2)),
    ),
    "polar 9": (
        lambda: b.polar_pattern(b.box((2, 1, 1)), 8, angle=0, center=(0, 0, 0)),
        lambda: Manifold.cube((2, 1, 1)),
    ),
    "polar 10": (
        lambda: b.polar_pattern(OURS, 40),
        lambda: united([POST.rotate((0, 0, 9 * k)) for k in range(40)]),
    ),
}


@pytest.mark.parametrize("name", ROWS)
def test_manifold_makes_the_same(name: str) -> None:
    make, made = ROWS[name]
    ours, theirs = make(), made()
    assert ours.volume == pytest.approx(theirs.volume(), rel=1e-6, abs=1e-9)
    assert ours.area == pytest.approx(theirs.surface_area(), rel=1e-6)
    assert 1 - ours.normalized().to_mesh().euler_number // 2 == theirs.genus()


@pytest.mark.parametrize("size", [2, (4, 3, 2), (1, 1, 9), (2, 2, 4), (0.1, 1, 10)])
@pytest.mark.parametrize("share", [1, 0.999, 0.5, 0.1, 1e-6])
def test_round_boxes_are_their_own_hull(size: float | tuple[float, ...], share: float) -> None:
    box = b.rounded_box(size, share * np.min(size) / 2, segments=16)
    hulled = Manifold.hull_points(box.vertices)
    assert box.volume == pytest.approx(hulled.volume(), rel=1e-6)
    assert box.area == pytest.approx(hulled.surface_area(), rel=1e-6)
    assert box.genus == 0


PRISMS = [(3, 2.0, 3.0), (4, 1.0, 1.0), (5, 4.0, 1.0), (8, 1.0, 9.0), (24, 2.0, 1.0)]


@pytest.mark.sampled(3)
@pytest.mark.parametrize("sides, r, h", PRISMS)
@pytest.mark.parametrize("share", [0.3, 1e-4])
def test_convex_solids_without_edges_are_their_own_hull(
    sides: int, r: float, h: float, share: float
) -> None:
    prism = b.prism(sides, h, r).rotate((0, 0, 15))
    inner = r * math.cos(math.pi / sides)
    size = share * min(inner * math.tan(math.pi / sides), h / 2)
    edges = prism.edges()
    part = prism.chamfer(edges, size)
    hulled = Manifold.hull_points(part.vertices)
    assert part.volume == pytest.approx(hulled.volume(), rel=1e-6)
    assert part.area == pytest.approx(hulled.surface_area(), rel=1e-6)
    assert part.genus == 0
    # Chords of a ball between planes at odd angles need not be convex.
    soft = prism.fillet(edges, size / 2, 12)
    assert soft.volume == pytest.approx(Manifold.hull_points(soft.vertices).volume(), rel=1e-5)
    assert soft.genus == 0
