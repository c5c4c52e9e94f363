"""Methods of regions against manifold3d's CrossSection: areas, outlines, volumes, genus.

Each has ten inputs, five of them degenerate. Both libraries get the same outlines.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import manifold3d as m
import numpy as np
import pytest

import bspcsg as b
from bspcsg import Region

Loops = list[np.ndarray]


def ring(r: float, sides: int, x: float = 0.0, y: float = 0.0) -> np.ndarray:
    turn = np.arange(sides) * math.tau / sides
    return np.column_stack([x + r * np.cos(turn), y + r * np.sin(turn)])


def rectangle(x: float, y: float, width: float, height: float) -> np.ndarray:
    return np.array([(x, y), (x + width, y), (x + width, y + height), (x, y + height)], float)


def star(points: int) -> np.ndarray:
    turn = np.arange(2 * points) * math.pi / points
    radius = np.where(np.arange(2 * points) % 2, 3.0, 8.0)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn)])


FIGURES: dict[str, Loops] = {
    "square": [rectangle(0, 0, 10, 10)],
    "ell": [np.array([(0, 0), (9, 0), (9, 4), (4, 4), (4, 9), (0, 9)], float)],
    "ring": [ring(9, 24), ring(5, 12)[::-1]],
    "star": [star(5)],
    "two": [rectangle(0, 0, 4, 4), ring(3, 9, 20, 1)],
    # From here on something is degenerate.
    "needle": [np.array([(0, 0), (10, 0), (0, 0.01)], float)],
    "corners touch": [rectangle(0, 0, 4, 4), rectangle(4, 4, 4, 4)],
    "edges touch": [rectangle(0, 0, 4, 4), rectangle(4, 0, 4, 4)],
    "on a line": [np.array([(0, 0), (3, 0), (3, 0), (6, 0), (6, 5), (0, 5), (0, 2)], float)],
    "nothing": [],
}


def ours(name: str) -> Region:
    return Region(FIGURES[name])


def theirs(name: str) -> m.CrossSection:
    return m.CrossSection(FIGURES[name], m.FillRule.Positive)


def parts(figure: m.CrossSection) -> int:
    """Return the number of parts of a figure; manifold3d counts an empty one as one part."""
    return 0 if figure.is_empty() else len(figure.decompose())


class Verb(NamedTuple):
    """A method as both libraries have it, and the tolerance of the comparison."""

    ours: Callable[[Region], Any]
    theirs: Callable[[m.CrossSection], Any]
    #: The allowed relative difference of areas and volumes: manifold3d's coordinates are precise to
    #: 1e-8, but the two engines begin arcs at different angles.
    tolerance: float = 1e-6


def bent(points: np.ndarray) -> np.ndarray:
    return np.column_stack([points[:, 0] * 1.5, points[:, 1] + 0.1 * points[:, 0]])


def twisted(figure: m.CrossSection) -> m.Manifold:
    # Manifold turns the other way round, and counts the levels between the ends.
    return figure.extrude(5, 199, -60.0, (0.5, 0.5))


def offset_of(delta: float, join: m.JoinType) -> Callable[[m.CrossSection], m.CrossSection]:
    return lambda figure: figure.offset(delta, join, 1e6, 32)


VERBS: dict[str, Verb] = {
    "offset round": Verb(lambda r: r.offset(1), offset_of(1, m.JoinType.Round), 5e-3),
    "offset miter": Verb(lambda r: r.offset(1, "miter"), offset_of(1, m.JoinType.Miter)),
    "offset square": Verb(lambda r: r.offset(1, "square"), offset_of(1, m.JoinType.Square)),
    "offset bevel": Verb(lambda r: r.offset(1, "bevel"), offset_of(1, m.JoinType.Bevel)),
    "offset inwards": Verb(lambda r: r.offset(-1, "miter"), offset_of(-1, m.JoinType.Miter)),
    "hull": Verb(lambda r: r.hull(), lambda c: c.hull()),
    "simplify": Verb(lambda r: r.simplify(1e-6), lambda c: c.simplify(1e-6)),
    "warp": Verb(lambda r: r.warp(bent), lambda c: c.warp(lambda p: bent(np.array([p]))[0])),
    "decompose": Verb(
        lambda r: Region.compose(r.decompose()),
        lambda c: m.CrossSection.compose(c.decompose()),
    ),
    "translate": Verb(lambda r: r.translate(3, 4), lambda c: c.translate((3, 4))),
    "rotate": Verb(lambda r: r.rotate(30), lambda c: c.rotate(30)),
    "scale": Verb(lambda r: r.scale((2, 3)), lambda c: c.scale((2, 3))),
    "mirror": Verb(lambda r: r.mirror((1, 1)), lambda c: c.mirror((1, 1))),
    "transform": Verb(
        lambda r: r.transform([[1, 2, 3], [0, 1, 4]]),
        lambda c: c.transform(np.array([[1.0, 2, 3], [0, 1, 4]])),
    ),
    "extrude": Verb(lambda r: r.extrude(5), lambda c: c.extrude(5)),
    "extrude twisted": Verb(lambda r: r.extrude(5, twist=60, scale=0.5, slices=200), twisted, 5e-3),
    "revolve": Verb(
        lambda r: r.translate(12, 0).revolve(segments=24),
        lambda c: c.translate((12, 0)).revolve(24),
    ),
}


#: The errors of manifold3d, and the reasons.
WRONG_THERE = {
    ("offset inwards", "needle"): "what is thinner than the offset comes back larger",
    ("extrude twisted", "needle"): "the turned walls cross, which leaves a negative volume",
    ("hull", "nothing"): "the hull of nothing has a part",
}


@pytest.mark.parametrize("name", VERBS)
def test_results_measure_the_same(name: str) -> None:
    for figure in FIGURES:
        assert_same_measures(name, figure)


def assert_same_measures(name: str, figure: str) -> None:
    verb = VERBS[name]
    own, other = verb.ours(ours(figure)), verb.theirs(theirs(figure))
    if (name, figure) in WRONG_THERE:
        assert (own.area if isinstance(own, Region) else own.volume) < 0.2
        return
    if isinstance(own, Region):
        assert own.area == pytest.approx(other.area(), rel=verb.tolerance, abs=1e-6)
        assert len(own.decompose()) == parts(other)
        return
    assert own.volume == pytest.approx(other.volume(), rel=verb.tolerance, abs=1e-6)
    if figure != "corners touch":
        # Manifold takes bodies apart that touch in an edge.
        assert own.is_empty or own.genus == sum(part.genus() for part in other.decompose())


@pytest.mark.parametrize("figure", FIGURES)
def test_the_queries_agree(figure: str) -> None:
    own, other = ours(figure), theirs(figure)
    assert own.area == pytest.approx(other.area(), abs=1e-7)
    assert own.is_empty == other.is_empty()
    assert len(own.decompose()) == parts(other)
    if own.bounds is not None:
        np.testing.assert_allclose(own.bounds.ravel(), other.bounds(), atol=1e-7)


@pytest.mark.parametrize(
    ("rule", "theirs_rule"),
    [
        ("positive", m.FillRule.Positive),
        ("nonzero", m.FillRule.NonZero),
        ("even-odd", m.FillRule.EvenOdd),
        ("negative", m.FillRule.Negative),
    ],
)
def test_the_fill_rules_agree(rule: Any, theirs_rule: m.FillRule) -> None:
    rng = np.random.default_rng(11)
    for _ in range(10):
        loops = [rng.integers(-9, 10, (n, 2)).astype(float) for n in rng.integers(3, 9, 4)]
        expected = m.CrossSection(loops, theirs_rule).area()
        assert Region(loops, winding=rule).area == pytest.approx(expected, abs=1e-5)


def test_hulls_of_points_agree() -> None:
    rng = np.random.default_rng(12)
    for _ in range(10):
        points = rng.integers(-5, 6, (12, 2)).astype(float)
        own = b.Region.compose([Region.rectangle(0.5, 0.5).translate(p) for p in points]).hull()
        corners = [p + d for p in points for d in rectangle(0, 0, 0.5, 0.5)]
        assert own.area == pytest.approx(m.CrossSection.hull_points(np.array(corners)).area())
