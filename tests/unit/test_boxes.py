"""Boxes in boxes: solids with many separate voids."""

import time

import numpy as np
import pytest

import bspcsg as b
from bspcsg.io import RawMesh
from bspcsg.mesh.boxes import boxes_around, boxes_of
from bspcsg.mesh.mesh import Mesh
from bspcsg.mesh.pieces import MeshPieces
from bspcsg.repair.repair import _facing_inwards
from support.shapes import Arrays, cuboid, flipped, joined


def voids(count: int) -> list[Arrays]:
    """Return unit cubes, two units apart in rows of 40."""
    at = [(2 * (k % 40), 2 * (k // 40), 0) for k in range(count)]
    return [cuboid((x, y, z), (x + 1, y + 1, z + 1)) for x, y, z in at]


def block(count: int) -> Arrays:
    """Return a block around the cubes of `voids`."""
    return cuboid((-1, -1, -1), (80, 2 * (count // 40) + 2, 2))


def test_boxes_that_hold_others_are_those_that_all_pairs_say() -> None:
    rng = np.random.default_rng(0)
    low = rng.integers(0, 6, (500, 3)).astype(float)
    boxes = np.stack([low, low + rng.integers(0, 6, (500, 3))], axis=1)
    is_past = boxes[:, None, 0] >= boxes[None, :, 0]
    holds = np.all(is_past & (boxes[:, None, 1] <= boxes[None, :, 1]), axis=2)
    expected = [np.flatnonzero(holds[k]) for k in range(len(boxes))]
    found = list(boxes_around(boxes, boxes))
    assert all(map(np.array_equal, found, expected)) and max(map(len, found)) > 10
    assert [len(numbers) for numbers in boxes_around(boxes[:3], boxes[:0])] == [0, 0, 0]
    assert not list(boxes_around(boxes[:0], boxes))


def test_boxes_of_owners() -> None:
    vertices, faces = joined(cuboid((0, 0, 0), (1, 2, 3)), cuboid((4, 4, 4), (5, 5, 6)))
    owner = np.repeat([1, 0], 12)
    expected = [[[4, 4, 4], [5, 5, 6]], [[0, 0, 0], [1, 2, 3]]]
    assert boxes_of(vertices[faces], owner).tolist() == expected


def test_shells_are_turned_outwards_but_for_those_in_others() -> None:
    # The block holds the first row of 40 and not the second.
    shells = [*voids(80), block(0)]
    is_turned = np.arange(len(shells)) % 3 == 0
    mesh = joined(
        *[flipped(one) if turn else one for one, turn in zip(shells, is_turned, strict=True)]
    )
    inward = _facing_inwards(Mesh(*mesh, mesh[1][:, :2])).reshape(-1, 12)
    assert not inward[:40].any()
    assert (inward[40:] == is_turned[40:, None]).all()


# Found: the time of `decompose` and of reports grew with the square of the number of cavities, that
# of `repair` with the square of the number of parts.
@pytest.mark.deep
def test_many_cavities_cost_each_alike() -> None:
    times = {}
    for count in (2000, 8000):
        mesh = joined(block(count), *map(flipped, voids(count)))
        solid = b.Solid(*mesh)
        solid.to_mesh()
        began = time.process_time()
        assert len(solid.decompose()) == 1
        assert len(np.unique(MeshPieces.of(solid.to_mesh()).owner)) == 1
        assert not _facing_inwards(Mesh(*mesh, mesh[1][:, :2])).any()
        times[count] = time.process_time() - began
    assert times[8000] < 8 * times[2000]


def test_nested_shells_stay_as_they_are_when_repaired() -> None:
    shells = [cuboid((k, k, k), (20 - k, 20 - k, 20 - k)) for k in range(6)]
    mesh = joined(*[shell if k % 2 == 0 else flipped(shell) for k, shell in enumerate(shells)])
    raw = RawMesh(*mesh)
    assert not _facing_inwards(Mesh(raw.vertices, raw.faces, raw.faces[:, :2])).any()
    assert len(b.Solid(*mesh).decompose()) == 3
