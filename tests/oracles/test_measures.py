"""Measures of meshes in doubles beside exact ones."""

from fractions import Fraction

import numpy as np
import pytest

import bspcsg as b
from support.shapes import icosphere, joined, moved

EPSILON = float(np.finfo(np.float64).eps)


def exact_volume(mesh: b.Mesh) -> Fraction:
    """Return the volume of the mesh as its doubles are."""
    vertices = [tuple(map(Fraction, row)) for row in mesh.vertices.tolist()]
    sixfold = Fraction(0)
    for p, q, r in mesh.faces.tolist():
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = vertices[p], vertices[q], vertices[r]
        sixfold += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return sixfold / 6


def small_parts(size: float, distance: float) -> b.Mesh:
    """Return two turned balls of some size on a diagonal."""
    vertices, faces = icosphere(2)
    ball = vertices * size, faces
    far = np.array([0.5, 0.3, -0.8]) * distance
    both = joined(ball, moved(ball, far))
    return b.Mesh(*both, np.zeros((len(both[1]), 2), np.int64))


@pytest.mark.parametrize("size", [1.0, 1e-3, 1e-7])
@pytest.mark.parametrize("distance", [10.0, 1e4, 1e8])
def test_volumes_of_small_parts_far_from_each_other(size: float, distance: float) -> None:
    """The error is that of one multiplication with the distance, not of its third power."""
    mesh = small_parts(size, distance)
    error = abs(Fraction(mesh.volume) - exact_volume(mesh))
    assert error <= 4 * EPSILON * distance * mesh.area


@pytest.mark.parametrize("distance", [10.0, 1e4])
def test_the_centroid_of_small_parts_far_from_each_other(distance: float) -> None:
    mesh = small_parts(1e-3, distance)
    middle = np.array([0.25, 0.15, -0.4]) * distance
    assert np.abs(mesh.centroid - middle).max() <= 1e-9 * distance
