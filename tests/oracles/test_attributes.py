"""Attributes after random operations against values computed exactly from the source triangles."""

import random
from fractions import Fraction
from operator import and_, or_, sub, xor
from typing import TypeAlias

import numpy as np
import pytest

import bspcsg as b
from bspcsg._types import FloatArray

Exact: TypeAlias = list[Fraction]

#: Of values of size 1, in fractions of what they are computed from.
CLOSE = 1e-12


class Operand:
    """A mesh with different values at all corners, and its exact position."""

    def __init__(self, number: int, rng: random.Random) -> None:
        shapes = [b.cube(2), b.sphere(1, segments=8), b.cylinder(h=2, r=1, segments=7)]
        mesh = rng.choice(shapes).to_mesh()
        self.vertices = np.round(mesh.vertices, 6)
        self.faces = mesh.faces
        noise = np.random.default_rng(rng.randrange(2**32))
        self.corner = noise.uniform(-1, 1, (len(self.faces), 3, 2))
        self.face = np.column_stack([np.full(len(self.faces), number), np.arange(len(self.faces))])
        self.solid = b.Solid(
            self.vertices,
            self.faces,
            vertex_attributes={"where": self.vertices},
            corner_attributes={"noise": self.corner},
            face_attributes={"face": self.face},
        )
        self.exact = [[Fraction(repr(x)) for x in point] for point in self.vertices.tolist()]

    def moved(self, rng: random.Random) -> None:
        """Move the operand by whole steps and quarter turns, exactly."""
        shift = [rng.randrange(-900, 900) for _ in range(3)]
        self.solid = self.solid.translate(*(k / 1000 for k in shift))
        self.exact = [
            [x + Fraction(k, 1000) for x, k in zip(p, shift, strict=True)] for p in self.exact
        ]
        if rng.random() < 0.5:
            self.solid = self.solid.rotate(90, "z")
            self.exact = [[-y, x, z] for x, y, z in self.exact]
        if rng.random() < 0.3:
            self.solid = self.solid.mirror((0, 1, 0))
            self.exact = [[x, -y, z] for x, y, z in self.exact]


def dot(p: Exact, q: Exact) -> Fraction:
    return sum((x * y for x, y in zip(p, q, strict=True)), Fraction(0))


def weights(point: Exact, corners: list[Exact]) -> Exact:
    """Return the exact barycentric coordinates of a point projected into the plane of corners."""
    a, b_, c = corners
    p = [x - y for x, y in zip(point, a, strict=True)]
    u, v = ([x - y for x, y in zip(end, a, strict=True)] for end in (b_, c))
    uu, uv, vv, pu, pv = dot(u, u), dot(u, v), dot(v, v), dot(p, u), dot(p, v)
    whole = uu * vv - uv * uv
    s, t = (pu * vv - pv * uv) / whole, (pv * uu - pu * uv) / whole
    return [1 - s - t, s, t]


def between(weights: Exact, values: FloatArray) -> FloatArray:
    """Return interpolated values, each rounded once."""
    columns = [[Fraction(value) for value in column] for column in values.T.tolist()]
    return np.array([float(dot(weights, column)) for column in columns])


def chain(rng: random.Random, operands: list[Operand]) -> b.Solid:
    result: b.Solid | None = None
    for operand in operands:
        operand.moved(rng)
        if result is None:
            result = operand.solid
        else:
            operation = rng.choice([or_, sub, and_, xor])
            result = operation(result, operand.solid)
        if rng.random() < 0.3:
            assert result.volume >= 0  # evaluated here, and an operand from now on
    assert result is not None
    return result


# Found: set operations dropped colours and texture coordinates.
@pytest.mark.sampled(3)
@pytest.mark.parametrize("seed", range(20))
def test_values_at_every_corner_are_those_of_the_source_there(seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(10):
        operands = [Operand(number, rng) for number in range(rng.randrange(2, 6))]
        mesh = chain(rng, operands).to_mesh()
        noise, where = mesh.corner_attributes["noise"], mesh.attributes.at_corners("where")
        for triangle, (number, face) in enumerate(mesh.face_attributes["face"].tolist()):
            operand = operands[number]
            corners = [operand.exact[v] for v in operand.faces[face]]
            for corner, vertex in enumerate(mesh.faces[triangle]):
                point = [Fraction(x) for x in mesh.vertices[vertex].tolist()]
                exact = weights(point, corners)
                assert min(exact) > -1e-9
                told = noise[triangle, corner]
                assert np.abs(told - between(exact, operand.corner[face])).max() <= CLOSE
                place = between(exact, operand.vertices[operand.faces[face]])
                assert np.abs(where[triangle, corner] - place).max() <= CLOSE
