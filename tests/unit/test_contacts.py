"""Findings report where a solid touches itself, after any motion and from any file."""

import pickle
from collections.abc import Callable

import numpy as np
import pytest

import bspcsg as b

#: A second cube that touches a unit cube in a corner and along an edge, and what is said of it.
CONTACTS = [((1, 1, 1), "vertex_contact"), ((1, 1, 0), "edge_contact")]

#: Ways to go that change no shape.
WAYS: dict[str, Callable[[b.Solid], b.Solid]] = {
    "as it is": lambda solid: solid,
    "moved": lambda solid: solid.translate(3, 4, 5),
    "turned": lambda solid: solid.rotate([0, 0, 90]),
    "mirrored": lambda solid: solid.mirror([1, 0, 0]),
    "pickled": lambda solid: pickle.loads(pickle.dumps(solid)),
    "on a finer lattice": lambda solid: solid | b.cube(1).translate(9, 0, 1e-9),
    "cut elsewhere": lambda solid: solid.translate(3, 4, 5) - b.cube(0.5).translate(3, 4, 5),
}


def said(solid: b.Solid) -> list[tuple[str, int]]:
    solid.to_mesh()
    return [(finding.code, finding.count) for finding in solid.findings]


# Found: a solid that was moved, refined or pickled lost the findings about contacts with itself.
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(("place", "code"), CONTACTS)
def test_contacts_are_said_on_every_way(place: tuple[int, int, int], code: str, way: str) -> None:
    touching = b.cube(1) | b.cube(1).translate(place)
    assert said(WAYS[way](touching)) == [(code, 1)]


#: Ways on which each vertex is taken by itself: that a contact has split some is not taken along.
TAKEN: dict[str, Callable[[b.Solid], b.Solid]] = {
    "turned": lambda solid: solid.rotate(33, (1, 2, 3)),
    "scaled": lambda solid: solid.scale(1.234),
    "given anew": lambda solid: b.Solid(solid.vertices, solid.faces),
    "given anew and moved": lambda solid: b.Solid(solid.vertices, solid.faces).translate(3, 4, 5),
}


# Found: there was no finding about vertices of an input that have equal coordinates but different
# indices.
@pytest.mark.parametrize("way", TAKEN)
@pytest.mark.parametrize(("place", "count"), [((1, 1, 1), 2), ((1, 1, 0), 4)])
def test_vertices_that_an_input_has_in_one_place_are_said(
    place: tuple[int, int, int], count: int, way: str
) -> None:
    solid = TAKEN[way](b.cube(1) | b.cube(1).translate(place))
    assert said(solid) == [("given_contact", count)]


def test_corners_that_are_welded_touch_nothing() -> None:
    apart = (b.cube(1) | b.cube(1).translate(3, 0, 0)).to_mesh()
    corners = apart.vertices[apart.faces].reshape(-1, 3)
    solid = b.Solid(corners, np.arange(len(corners)).reshape(-1, 3))
    assert said(solid) == [("welded", 1)]
