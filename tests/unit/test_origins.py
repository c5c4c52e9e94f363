"""The source faces of triangles in planes with many faces."""

import time

import numpy as np
import pytest

import bspcsg as b
from bspcsg._types import FloatArray


def plate(rows: int, columns: int) -> b.Solid:
    """Return a plate with square holes, whose triangles include long needles."""
    square = np.array([(0, 0), (0, 1), (1, 1), (1, 0)])
    holes = [square + (2 * x + 1, 2 * y + 1) for x in range(columns) for y in range(rows)]
    wide, high = 2 * columns + 1, 2 * rows + 1
    rim = np.array([(0, 0), (wide, 0), (wide, high), (0, high)])
    return b.extrude(b.Region([rim, *holes]), 1)


def shares(triangles: FloatArray, points: FloatArray) -> FloatArray:
    """Return the barycentric coordinates of points in triangles of space, (n, 3)."""
    a, b, c = (triangles[:, k] for k in range(3))
    normal = np.cross(b - a, c - a)
    size = np.einsum("ij,ij->i", normal, normal)
    parts = [np.cross(q - p, points - p) for p, q in ((b, c), (c, a), (a, b))]
    return np.stack([np.einsum("ij,ij->i", part, normal) / size for part in parts], axis=1)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_triangles_name_faces_that_hold_their_centres(axis: int) -> None:
    meshes = [plate(10, 25).to_mesh(), b.cube(7.5).translate(3, 3, -2).to_mesh()]
    first, second = ((np.roll(mesh.vertices, axis, axis=1), mesh.faces) for mesh in meshes)
    mesh = (b.Solid(*first) - b.Solid(*second)).to_mesh()
    places = np.concatenate([vertices[faces] for vertices, faces in (first, second)])
    named = places[np.array([0, len(first[1])])[mesh.source[:, 0]] + mesh.source[:, 1]]
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    assert len(centres) > 1500 and shares(named, centres).min() > -1e-6


# Found: the time to make the mesh of a plate grew with the square of the number of its holes.
@pytest.mark.deep
def test_many_holes_cost_each_alike() -> None:
    times = {}
    for rows in (15, 60):
        made = plate(rows, 100)
        solid = b.Solid(made.vertices, made.faces) - b.cube(0.5)
        assert not solid.is_empty
        began = time.process_time()
        assert len(solid.faces) > 2000
        times[rows] = time.process_time() - began
    assert times[60] < 8 * times[15]
