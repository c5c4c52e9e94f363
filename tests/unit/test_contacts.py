"""A solid says where it touches itself, wherever it is moved and however it comes back."""

import pickle
from collections.abc import Callable

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


# Found: a solid that was moved, refined or pickled no longer said where it touches itself.
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(("place", "code"), CONTACTS)
def test_contacts_are_said_on_every_way(place: tuple[int, int, int], code: str, way: str) -> None:
    touching = b.cube(1) | b.cube(1).translate(place)
    assert said(WAYS[way](touching)) == [(code, 1)]
