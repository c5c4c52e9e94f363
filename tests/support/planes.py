"""Exact points and hyperplanes in fractions, with which half-spaces are compared."""

import random
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import combinations

#: A normal and its product with the points of the hyperplane.
Plane = tuple[list[Fraction], Fraction]

#: A source of random numbers of one kind.
Entry = Callable[[random.Random], Fraction]


def entries(size: int, places: int = 0) -> Entry:
    """Return a source of random decimals with `places` places, up to `size` units of the last."""
    return lambda rng: Fraction(rng.randint(-size, size), 10**places)


def vector(rng: random.Random, entry: Entry, dimension: int = 3) -> list[Fraction]:
    """Return a random vector of fractions that is not zero."""
    while True:
        row = [entry(rng) for _ in range(dimension)]
        if any(row):
            return row


def dot(a: Sequence[Fraction], b: Sequence[Fraction]) -> Fraction:
    """Return the exact inner product of two vectors."""
    return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))


def side(plane: Plane, point: Sequence[Fraction]) -> int:
    """Return 1 for a point inside a half-space, 0 on its boundary, -1 outside."""
    value = plane[1] - dot(plane[0], point)
    return (value > 0) - (value < 0)


def determinant(rows: Sequence[Sequence[Fraction]]) -> Fraction:
    """Return the exact determinant of a square matrix."""
    if not rows:
        return Fraction(1)
    total = Fraction(0)
    for k, entry in enumerate(rows[0]):
        minor = [[*row[:k], *row[k + 1 :]] for row in rows[1:]]
        total += (-1) ** k * entry * determinant(minor)
    return total


def meet(planes: Sequence[Plane]) -> list[Fraction]:
    """Return the common point of d hyperplanes in d dimensions."""
    whole = determinant([normal for normal, _ in planes])
    replaced = [
        [[*normal[:k], offset, *normal[k + 1 :]] for normal, offset in planes]
        for k in range(len(planes))
    ]
    return [determinant(rows) / whole for rows in replaced]


def corners(planes: Sequence[Plane]) -> list[list[Fraction]]:
    """Return the corners of the simplex that d + 1 hyperplanes in d dimensions bound."""
    return [meet(some) for some in combinations(planes, len(planes) - 1)]


def simplex_measure(points: Sequence[Sequence[Fraction]]) -> Fraction:
    """Return the exact length, area or volume of a simplex."""
    edges = [[x - y for x, y in zip(p, points[0], strict=True)] for p in points[1:]]
    return abs(determinant(edges)) / {1: 1, 2: 2, 3: 6}[len(edges)]


def simplex_around(rng: random.Random, entry: Entry, dimension: int) -> list[Plane]:
    """Return d + 1 random hyperplanes that bound a simplex around the origin."""
    while True:
        normals = [vector(rng, entry, dimension) for _ in range(dimension)]
        if determinant(normals) == 0:
            continue
        normals.append([-sum(column, Fraction(0)) for column in zip(*normals, strict=True)])
        planes = [(normal, dot(normal, _outwards(rng, normal))) for normal in normals]
        if max(abs(x) for point in corners(planes) for x in point) < 1000:
            return planes


def _outwards(rng: random.Random, normal: list[Fraction]) -> list[Fraction]:
    while True:
        point = vector(rng, entries(9), len(normal))
        if dot(normal, point) > 0:
            return point
