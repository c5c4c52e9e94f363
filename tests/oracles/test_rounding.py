"""Triangles that rounding to doubles reverses, counted in exact fractions."""

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from support import drawn

STEP = 10**9
Vector = list[Fraction]


def nearly_equal_cubes(seed: int) -> list[b.Solid]:
    """Return rotated cubes of 100 km or more whose corners differ by lattice steps of 1 nm."""
    rng = np.random.default_rng(seed)
    size = 10.0 ** rng.integers(5, 7)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn[0] *= np.sign(np.linalg.det(turn))
    cube = b.cube(1, center=True).to_mesh()
    corners = cube.vertices @ turn.T * size
    cubes = []
    for _ in range(6):
        shift = rng.normal(size=corners.shape) * 10.0 ** -rng.integers(7, 9)
        vertices = np.round((corners + shift) * STEP) / STEP
        cubes.append(b.Solid(vertices, cube.faces, pitch=-9))
    return cubes


def cross(corners: list[Vector]) -> Vector:
    p, q, r = corners
    u, v = ([y - x for x, y in zip(p, end, strict=True)] for end in (q, r))
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


def exact_normal(solid: b.Solid, face: int) -> Vector:
    """Return the exact normal of a face on the lattice."""
    corners = solid.vertices[solid.faces[face]]
    return cross([[Fraction(round(Fraction(x) * STEP)) for x in corner] for corner in corners])


def turned_triangles(mesh: Any, operands: list[b.Solid]) -> int:
    """Return the number of triangles that face opposite to their source faces."""
    count = 0
    for corners, (operand, face) in zip(mesh.vertices[mesh.faces], mesh.source, strict=True):
        normal = exact_normal(operands[operand], face)
        axis = max(range(3), key=lambda i: abs(normal[i]))
        rounded = cross([[Fraction(x) for x in corner] for corner in corners])
        count += rounded[axis] * normal[axis] <= 0
    return count


def test_turned_triangles_are_repaired_or_reported() -> None:
    swapped = 0
    for seed in drawn(range(120), 3):
        operands = nearly_equal_cubes(seed)
        result = b.union(operands)
        found = {finding.code: finding.count for finding in result.findings}
        left = found.get("turned", 0) + found.get("collapsed", 0)
        assert turned_triangles(result.to_mesh(), operands) == left
        swapped += found.get("swapped", 0)
    assert swapped > 0


@pytest.mark.parametrize("operation", ["union", "intersection"])
def test_well_shaped_results_need_no_repair(operation: str) -> None:
    a, c = b.sphere(1, segments=16), b.sphere(1, segments=16).translate(0.3, 0.2, 0.1)
    result = getattr(b, operation)(a, c)
    assert not {"swapped", "turned", "collapsed"} & {f.code for f in result.findings}
