"""Results are the same on every lattice, at every scale and position, and from any mesh."""

import pickle
from collections.abc import Callable, Iterable
from random import Random
from typing import TypeAlias

import numpy as np
import pytest

import bspcsg as b
from support.shapes import Arrays
from support.small import random_set, random_shapes

#: The finest pitch whose lattice has room for coordinates up to 9 units, two others, the default.
PITCHES = (-15, -13, -11, None)

AXIS = (1, 2, 3)

#: What a verb returns; it takes a solid, the length of the solid's unit, and its origin.
Made: TypeAlias = b.Solid | b.Region | list[b.Solid]
Verb: TypeAlias = Callable[[b.Solid, float, np.ndarray], Made]


def along(at: np.ndarray, offset: float, unit: float) -> float:
    """Return the offset of a plane along the axis, given in units from the origin `at`."""
    return float(offset * unit + np.dot(AXIS, at))


def slice_of(solid: b.Solid, unit: float, at: np.ndarray) -> b.Region:
    region: b.Region = solid.slice(float(3.5 * unit + at[2]))
    return region


VERBS: dict[str, Verb] = {
    "itself": lambda solid, unit, at: solid,
    "parts": lambda solid, unit, at: solid.decompose(),
    "refine": lambda solid, unit, at: solid.refine(3),
    "edge length": lambda solid, unit, at: solid.refine(edge_length=unit),
    "rotate": lambda solid, unit, at: solid.rotate(33, AXIS),
    "scale": lambda solid, unit, at: solid.scale(0.3),
    "mirror": lambda solid, unit, at: solid.mirror(AXIS),
    "translate": lambda solid, unit, at: solid.translate(0.5 * unit, 0.25 * unit, 0.125 * unit),
    "warp": lambda solid, unit, at: solid.warp(lambda points: points * 0.9),
    "hull": lambda solid, unit, at: b.hull(solid),
    "split": lambda solid, unit, at: solid.split(AXIS, along(at, 4.75, unit))[0],
    "trim": lambda solid, unit, at: solid.trim(AXIS, along(at, 4.75, unit)),
    "project": lambda solid, unit, at: solid.project(),
    "slice": slice_of,
    "slanted slice": lambda solid, unit, at: solid.slice(along(at, 2.25, unit), AXIS),
    "grown slice": lambda solid, unit, at: slice_of(solid, unit, at).offset(0.3 * unit),
    "shrunk slice": lambda solid, unit, at: slice_of(solid, unit, at).offset(-0.2 * unit),
    "hull of a slice": lambda solid, unit, at: slice_of(solid, unit, at).hull(),
    "turned slice": lambda solid, unit, at: slice_of(solid, unit, at).rotate(33),
    "extruded slice": lambda solid, unit, at: slice_of(solid, unit, at).extrude(1.5 * unit),
}

#: Slow verbs, which are tried on solids of few faces only.
SLOW_VERBS: dict[str, Verb] = {
    "grown": lambda solid, unit, at: solid.offset(0.25 * unit, segments=4),
    "shrunk": lambda solid, unit, at: solid.offset(-0.1 * unit, segments=4),
    "rounded": lambda solid, unit, at: solid.rounded(0.1 * unit, segments=4),
    "filled": lambda solid, unit, at: solid.rounded(0.1 * unit, segments=4, inside=True),
    "sum": lambda solid, unit, at: b.minkowski(solid, b.cube(0.5 * unit)),
}

#: Functions that return the same set of points with another mesh or tree.
FORMS: dict[str, Callable[[b.Solid], b.Solid]] = {
    "read from a pickle": lambda solid: pickle.loads(pickle.dumps(solid)),
    "united with itself": lambda solid: solid | solid,
    "cut by a box around it": lambda solid: solid & b.cube(99, center=True),
    "inside out twice": lambda solid: ~~solid,
    "split and united": lambda solid: b.union(solid.split(AXIS, 9.5)),
    "with a cube twice exchanged": lambda solid: (solid ^ b.cube(3.25)) ^ b.cube(3.25),
    "its mesh": lambda solid: b.Solid.from_mesh(solid.to_mesh()),
    "moved there and back": lambda solid: solid.translate(1, 2, 3).translate(-1, -2, -3),
}


def made(
    seed: int, pitch: int | None = None, unit: float = 1.0, at: Iterable[float] = (0, 0, 0)
) -> b.Solid:
    """Return a random solid on a lattice, scaled by `unit` and translated to `at`."""
    random = Random(seed)

    def placed(shape: Arrays) -> b.Solid:
        return b.Solid(shape[0] * unit + np.array(list(at)), shape[1], pitch=pitch)

    return random_set(random, [placed(shape) for shape in random_shapes(random)])


def sizes(of: Made, unit: float) -> list[float]:
    """Return volume and area, or area, of results, in units.

    The perimeter is left out, since rounding leaves slits in projections.
    """
    if isinstance(of, list):
        return [float(len(of)), *(size for solid in of for size in sizes(solid, unit))]
    if isinstance(of, b.Solid):
        return [of.volume / unit**3, of.area / unit**2]
    return [of.area / unit**2]


def assert_alike(solids: list[tuple[b.Solid, float, Iterable[float]]], doubt: float = 1e-6) -> None:
    """Assert that all methods give the same for one set in several scales and positions."""
    first = solids[0][0]
    if first.is_empty:
        return
    verbs = [*VERBS.values(), *(SLOW_VERBS.values() if len(first.faces) < 32 else ())]
    for verb in verbs:
        found = [sizes(verb(solid, unit, np.array(list(at))), unit) for solid, unit, at in solids]
        assert all(np.size(one) == np.size(found[0]) for one in found), found
        assert np.allclose(found, found[0], rtol=doubt, atol=doubt), found


HERE = (0, 0, 0)


# Found: `offset` inwards and `rounded` of bodies that are not convex left shells a step thin
# beside them (7 of 9 random ones failed, one by a `ZeroDivisionError`), which `rounded` made
# thick; of convex ones narrow faces could cut away most.
@pytest.mark.sampled(3)
@pytest.mark.parametrize("seed", range(24))
def test_verbs_do_not_depend_on_the_lattice(seed: int) -> None:
    assert_alike([(made(seed, pitch), 1, HERE) for pitch in PITCHES])


@pytest.mark.sampled(3)
@pytest.mark.parametrize("seed", range(30, 40))
def test_verbs_do_not_depend_on_the_size(seed: int) -> None:
    units = (1, 1e3, 1e-3, 1e9, 1e-9)
    assert_alike([(made(seed, unit=unit), unit, HERE) for unit in units], 1e-5)


# Found: `warp` refused solids that touch themselves, by less than rounding.
@pytest.mark.sampled(3)
@pytest.mark.parametrize("seed", range(45, 55))
def test_verbs_do_not_depend_on_the_place(seed: int) -> None:
    places = (HERE, (1000, -2000, 500), (1e5, 1e5, -1e5))
    assert_alike([(made(seed, at=at), 1, at) for at in places], 1e-5)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("seed", range(60, 70))
def test_verbs_do_not_depend_on_where_a_set_comes_from(seed: int) -> None:
    solid = made(seed)
    assert_alike([(solid, 1, HERE), *((form(solid), 1, HERE) for form in FORMS.values())])
