"""Exact counts of crossings, and the rulings based on them."""

import numpy as np
import pytest

import bspcsg as b
from bspcsg.mesh.pieces import MeshPieces
from bspcsg.verify.referee import Ruling, is_inside, settle
from support.shapes import Arrays, cube, flipped, icosphere, joined, moved


def mesh_of(arrays: Arrays) -> "b.Mesh":
    return b.Mesh(*arrays, np.zeros((len(arrays[1]), 2), np.int64))


@pytest.mark.parametrize(
    ("point", "inside"),
    [
        ((0.25, 0.4, 0.3), True),
        ((0.25, 0.4, 1.3), False),
        ((-0.1, 0.2, 0.3), False),
        ((1.1, 0.2, 0.3), False),
        ((0.5, 0.5, 1e-300), True),
        ((0.5, 0.25, -1e-300), False),
    ],
)
def test_points_of_a_cube(point: tuple[float, float, float], inside: bool) -> None:
    assert is_inside(mesh_of(cube()), point) is inside


def test_winding_numbers() -> None:
    point = (0.75, 0.7, 0.6)
    twice = joined(cube(), moved(cube(), (0.5, 0.5, 0.5)))
    assert is_inside(mesh_of(twice), point) is True
    assert is_inside(mesh_of(joined(twice, flipped(cube()))), point) is True
    assert is_inside(mesh_of(flipped(twice)), point) is False


def test_rays_along_edges_are_not_counted() -> None:
    assert is_inside(mesh_of(cube()), (0.5, 0.5, 0.5)) is None


def test_agrees_with_the_tree() -> None:
    ball = icosphere(2)
    points = np.random.default_rng(5).uniform(-1.1, 1.1, (200, 3))
    sides = b.Solid(*ball).classify(points)
    found = [is_inside(mesh_of(ball), (x, y, z)) for x, y, z in points.tolist()]
    assert [side > 0 for side in sides.tolist()] == found


PROGRAM: list[tuple[str, list[int]]] = [("leaf", [0]), ("leaf", [1]), ("or", [0, 1])]


def test_rulings() -> None:
    first, second = b.cube(1).to_mesh(), b.cube(1).translate(3, 0, 0).to_mesh()
    both = (b.cube(1) | b.cube(1).translate(3, 0, 0)).to_mesh()
    piece = MeshPieces.of(second)
    points = [piece.points_in(piece.thickest)]
    assert settle(PROGRAM, [first, second], both, first, points) is Ruling.OURS
    assert settle(PROGRAM, [first, second], first, both, points) is Ruling.THEIRS
    assert settle(PROGRAM, [first, second], both, both, points) is Ruling.UNCLEAR
    assert settle(PROGRAM, [first, second], both, first, []) is Ruling.UNCLEAR


def test_points_in_thin_pieces() -> None:
    plate = b.box((5, 7, 1e-7)).rotate((10, 20, 30)).to_mesh()
    pieces = MeshPieces.of(plate)
    assert pieces.thickness[pieces.thickest] == pytest.approx(1e-7, rel=1e-3)
    points = pieces.points_in(pieces.thickest)
    assert points and all(is_inside(plate, point) is not False for point in points)
    assert any(is_inside(plate, point) for point in points)


def test_a_shell_is_one_piece() -> None:
    shell = (b.cube(10, center=True) - b.cube(9.998, center=True)).to_mesh()
    pieces = MeshPieces.of(shell)
    assert pieces.thicker_than(0) == [pieces.thickest]
    assert pieces.thickness[pieces.thickest] == pytest.approx(0.001, rel=1e-3)
