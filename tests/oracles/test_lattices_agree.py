"""What is made of a solid is the same, but for rounding, on every lattice that is fine enough."""

from collections.abc import Callable
from random import Random

import numpy as np
import pytest

import bspcsg as b
from support.small import random_set, random_shapes

#: The finest that holds coordinates up to 9 units, two others and the default.
PITCHES = (-15, -13, -11, None)

AXIS = (1, 2, 3)

#: What makes solids and regions of a solid.
VERBS: dict[str, Callable[[b.Solid], b.Solid | b.Region]] = {
    "refine": lambda solid: solid.refine(3),
    "edge length": lambda solid: solid.refine(edge_length=1.0),
    "rotate": lambda solid: solid.rotate(33, AXIS),
    "scale": lambda solid: solid.scale(0.3),
    "mirror": lambda solid: solid.mirror(AXIS),
    "translate": lambda solid: solid.translate(0.5, 0.25, 0.125),
    "simplify": lambda solid: solid.simplify(0.01),
    "warp": lambda solid: solid.warp(lambda points: points * 0.9),
    "hull": b.hull,
    "split": lambda solid: solid.split(AXIS, 4.75)[0],
    "trim": lambda solid: solid.trim(AXIS, 4.75),
    "project": lambda solid: solid.project(),
    "slice": lambda solid: solid.slice(3.5),
    "slanted slice": lambda solid: solid.slice(2.25, AXIS),
    "grown slice": lambda solid: solid.slice(3.5).offset(0.3),
    "shrunk slice": lambda solid: solid.slice(3.5).offset(-0.2),
    "hull of a slice": lambda solid: solid.slice(3.5).hull(),
    "turned slice": lambda solid: solid.slice(3.5).rotate(33),
    "extruded slice": lambda solid: solid.slice(3.5).extrude(1.5),
    "revolved slice": lambda solid: solid.slice(3.5).scale(0.4).revolve(segments=8),
}

#: The same of few faces only.
SLOW_VERBS: dict[str, Callable[[b.Solid], b.Solid]] = {
    "grown": lambda solid: solid.offset(0.25, segments=4),
    "shrunk": lambda solid: solid.offset(-0.1, segments=4),
    "rounded": lambda solid: solid.rounded(0.1, segments=4),
    "rounded inside": lambda solid: solid.rounded(0.1, segments=4, inside=True),
    "sum": lambda solid: b.minkowski(solid, b.cube(0.5)),
}


def on_lattices(seed: int) -> list[b.Solid]:
    random = Random(seed)
    shapes = random_shapes(random)
    state, found = random.getstate(), []
    for pitch in PITCHES:
        random.setstate(state)
        found.append(random_set(random, [b.Solid(*shape, pitch=pitch) for shape in shapes]))
    return found


def sizes(made: b.Solid | b.Region) -> list[float]:
    return [made.volume, made.area] if isinstance(made, b.Solid) else [made.area, made.perimeter]


def assert_alike(solids: list[b.Solid], verb: Callable[[b.Solid], b.Solid | b.Region]) -> None:
    found = [sizes(verb(solid)) for solid in solids]
    assert np.allclose(found, found[0], rtol=1e-6, atol=1e-6), found


@pytest.mark.parametrize("seed", range(30))
def test_verbs_do_not_depend_on_the_lattice(seed: int) -> None:
    solids = [solid for solid in on_lattices(seed) if not solid.is_empty]
    for verb in VERBS.values() if solids else ():
        assert_alike(solids, verb)


@pytest.mark.parametrize("seed", range(30))
def test_sums_and_offsets_do_not_depend_on_the_lattice(seed: int) -> None:
    solids = on_lattices(seed)
    if not solids[0].is_empty and len(solids[0].faces) < 32:
        for verb in SLOW_VERBS.values():
            assert_alike(solids, verb)
