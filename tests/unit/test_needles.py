"""Solids with thousands of needle faces: their cost and their exactness."""

from collections.abc import Callable

import numpy as np
import pytest

import bspcsg as b
from bspcsg._types import FloatArray, IndexArray, WindingRule
from support.timing import seconds

TURN = (30, 20, 10)


def comb(teeth: int) -> b.Solid:
    """Return a bar with teeth; all needles of a cap share two corners."""
    x = 2.0 * np.arange(teeth)
    steps = [(x, 0 * x), (x + 1, 0 * x), (x + 1, 0 * x + 9), (x + 2, 0 * x + 9)]
    points = np.stack([np.column_stack(pair) for pair in steps], axis=1).reshape(-1, 2)
    return b.extrude(np.concatenate([points, [(2.0 * teeth, 10.0), (0.0, 10.0)]]), 2)


def cut_cylinder(sides: int, turn: tuple[int, int, int]) -> b.Mesh:
    """Return the mesh of a rotated cylinder with a notch."""
    notch = b.cube(3).translate(8.5, -1.5, -1)
    return (b.cylinder(1, 10, segments=sides).rotate(turn) - notch.rotate(turn)).to_mesh()


SQUARE = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])


def turned_square(rows: int, turn: float, height: float) -> FloatArray:
    """Return the corners of a square in each row, rotated by `turn` degrees per row."""
    turns = turn * np.radians(np.arange(rows))[:, None]
    x, y = SQUARE.T
    place = [x * np.cos(turns) + y * np.sin(turns), y * np.cos(turns) - x * np.sin(turns)]
    up = np.broadcast_to(np.linspace(0, height, rows)[:, None], (rows, 4))
    return np.stack([*place, up], axis=2).reshape(-1, 3)


def stack(rows: int, turn: float, height: float) -> tuple[FloatArray, IndexArray]:
    """Return the mesh of a square that twists while it rises."""
    first, following = np.arange(4), np.roll(np.arange(4), -1)
    wall = np.concatenate(
        [
            np.stack(three, axis=1)
            for three in [(first, following, following + 4), (first, following + 4, first + 4)]
        ]
    )
    walls = [wall + 4 * row for row in range(rows - 1)]
    top = np.array([(0, 1, 2), (0, 2, 3)]) + 4 * (rows - 1)
    return turned_square(rows, turn, height), np.concatenate([[(0, 2, 1), (0, 3, 2)], *walls, top])


def beside(mesh: tuple[FloatArray, IndexArray], other: b.Mesh) -> tuple[FloatArray, IndexArray]:
    """Return a mesh that contains both meshes."""
    vertices, faces = mesh
    more = other.faces + len(vertices)
    return np.concatenate([vertices, other.vertices]), np.concatenate([faces, more])


# Found: a sheet of slivers of one step took minutes to be looked at: doubles could not tell that
# it is convex, that slivers have area, or that two with a common edge are clear of each other.
def test_a_sheet_of_slivers_is_looked_at_at_once() -> None:
    points = turned_square(400, 1 / 400, 5) * (2.1e9, 1, 2.1e9)
    sheet = b.hull(points.round(3)).to_mesh()
    alone = sheet.vertices, sheet.faces
    for mesh in (alone, beside(alone, b.cube(1).translate(-9, 0, 0).to_mesh())):
        solid = b.Solid.from_mesh(mesh, pitch=-3)
        assert seconds(solid.normalized) < 2


# Found: a mesh in one plane that crosses itself took time proportional to the number of crossings,
# though it bounds nothing.
@pytest.mark.parametrize("winding", ["positive", "nonzero", "even-odd"])
def test_what_lies_in_one_plane_and_crosses_itself_bounds_nothing(winding: WindingRule) -> None:
    flat = stack(40, 111, 0)
    nothing = b.Solid.from_mesh(flat, winding=winding)
    cube = b.Solid.from_mesh(beside(flat, b.cube(1).to_mesh()), winding=winding)
    assert seconds(lambda: nothing.is_empty) < 2
    assert nothing.is_empty
    tip = b.cube(1) - b.Solid.from_mesh(flat, winding=winding)
    assert seconds(lambda: tip.volume_exact) < 2 and tip.equals(b.cube(1))
    assert seconds(lambda: cube.volume_exact) < 2
    assert cube.equals(b.cube(1))
    twice = beside(beside(flat, b.cube(1).to_mesh()), b.cube(1).to_mesh())
    assert b.Solid.from_mesh(twice, winding=winding).volume == (winding != "even-odd")


# Found: uniting a mesh of many sheets that cross each other nearly in one plane took the cube of
# their number: 15 to 80 s for 636 triangles.
def test_sheets_turned_on_each_other_in_one_plane_are_united_at_once() -> None:
    solid = b.Solid.from_mesh(stack(80, 111.3, 1e-9))
    assert seconds(solid.normalized) < 5
    united = solid.normalized()
    assert len(united.to_mesh().faces) == 12
    # Halves are cut out of the sheets as they were given.
    assert sum(half.volume_exact for half in solid.split("x", 0.125)) == united.volume_exact


# Found: thin layers combined with what has a plane in common with them were divided into cells as
# small as the layers are thin (556 triangles and a cube: 12 s).
def test_thin_layers_with_a_plane_in_common_are_combined_at_once() -> None:
    def rest(rows: int) -> b.Solid:
        return b.Solid.from_mesh(stack(rows, 33, 1e-3)) ^ b.cube(1)

    assert seconds(lambda: rest(80).volume_exact) < 2
    assert seconds(lambda: rest(160).volume_exact) < 4


# Found: the time of checks of meshes and results grew with the square of the number of needles,
# rotated or not.
@pytest.mark.deep
@pytest.mark.parametrize(
    ("few", "make"),
    [
        (500, lambda count: comb(count).normalized()),
        (500, lambda count: comb(count).rotate(TURN).normalized()),
        (2_500, lambda count: cut_cylinder(count, TURN)),
        (10_000, lambda count: cut_cylinder(count, (0, 0, 0))),
    ],
)
def test_many_needles_cost_each_alike(few: int, make: Callable[[int], object]) -> None:
    assert seconds(lambda: make(4 * few), 2) < 10 * seconds(lambda: make(few), 2)


# Found: a cut at a corner of more than 2 000 needles did not end within a minute.
@pytest.mark.parametrize("teeth", [500, pytest.param(2500, marks=pytest.mark.deep)])
def test_a_corner_of_thousands_of_needles_is_cut_at_once(teeth: int) -> None:
    part = comb(teeth) - b.cube(3).translate(0, 7, 1)
    assert seconds(lambda: part.volume_exact) < 20
    assert part.volume_exact == 22 * teeth - 7
    assert part.to_mesh().certificate.ok
