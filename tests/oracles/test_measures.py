"""Measures of meshes in doubles, compared with exact ones."""

from fractions import Fraction

import numpy as np
import pytest

import bspcsg as b
from support.shapes import icosphere, joined, moved

EPSILON = float(np.finfo(np.float64).eps)


def exact_volume(mesh: b.Mesh) -> Fraction:
    """Return the exact volume of a mesh of doubles."""
    vertices = [tuple(map(Fraction, row)) for row in mesh.vertices.tolist()]
    sixfold = Fraction(0)
    for p, q, r in mesh.faces.tolist():
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = vertices[p], vertices[q], vertices[r]
        sixfold += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return sixfold / 6


def small_parts(size: float, distance: float) -> b.Mesh:
    """Return a mesh of two balls, `distance` apart."""
    vertices, faces = icosphere(2)
    ball = vertices * size, faces
    far = np.array([0.5, 0.3, -0.8]) * distance
    both = joined(ball, moved(ball, far))
    return b.Mesh(*both, np.zeros((len(both[1]), 2), np.int64))


# Found: volumes of small parts far from each other lost their digits when computed from the mesh.
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


def exact_moments(mesh: b.Mesh) -> tuple[list[Fraction], list[list[Fraction]]]:
    """Return the exact centroid of a mesh of doubles, and the second moments about it."""
    vertices = [tuple(map(Fraction, row)) for row in mesh.vertices.tolist()]
    volume, first = Fraction(0), [Fraction(0)] * 3
    second = [[Fraction(0)] * 3 for _ in range(3)]
    for p, q, r in mesh.faces.tolist():
        a, c, d = vertices[p], vertices[q], vertices[r]
        six = a[0] * (c[1] * d[2] - c[2] * d[1]) + a[1] * (c[2] * d[0] - c[0] * d[2])
        six += a[2] * (c[0] * d[1] - c[1] * d[0])
        points = [a, c, d, tuple(x + y + z for x, y, z in zip(a, c, d, strict=True))]
        volume += six / 6
        for i in range(3):
            first[i] += six * points[3][i] / 24
            for j in range(3):
                second[i][j] += six * sum(point[i] * point[j] for point in points) / 120
    centroid = [part / volume for part in first]
    about = [
        [second[i][j] - volume * centroid[i] * centroid[j] for j in range(3)] for i in range(3)
    ]
    return centroid, about


# Found: rounding spoiled the centroid, inertia and volume of meshes that are far larger than thick:
# the centroid was far outside the body.
@pytest.mark.parametrize("sides", [(1e6, 1e-6, 3), (1e6, 1e-4, 1e-4), (1e3, 1e3, 1e-8)])
def test_measures_of_what_is_far_larger_than_thick(sides: tuple[float, float, float]) -> None:
    solid = b.box(*sides).rotate(45, (1, 1, 0)).translate(0.1, 0.2, 0.3)
    mesh = solid.to_mesh()
    volume, (centroid, second) = exact_volume(mesh), exact_moments(mesh)
    assert abs(Fraction(mesh.volume) / volume - 1) < 1e-9
    assert np.allclose(solid.centroid, np.array(centroid, dtype=np.float64), rtol=1e-14, atol=1e-9)
    moments = np.array(second, dtype=np.float64)
    wanted = np.trace(moments) * np.eye(3) - moments
    assert np.allclose(solid.inertia, wanted, rtol=1e-12, atol=1e-12 * np.abs(wanted).max())
