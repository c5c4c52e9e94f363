"""Winding numbers and areas of regions by brute force, in rational arithmetic."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import combinations, pairwise

import numpy as np

Loop = Sequence[tuple[int, int]]
RULES: dict[str, Callable[[int], bool]] = {
    "positive": lambda n: n > 0,
    "nonzero": lambda n: n != 0,
    "even-odd": lambda n: n % 2 == 1,
}


def edges_of(loops: Sequence[Loop]) -> list[tuple[tuple[int, int], tuple[int, int]]]:
    pairs = [pair for loop in loops for pair in zip(loop, [*loop[1:], loop[0]], strict=True)]
    return [(p, q) for p, q in pairs if p != q]


def winding_number(loops: Sequence[Loop], x: Fraction, y: Fraction) -> int:
    """Return the winding number of outlines about a point that lies on no edge."""
    number = 0
    for (ax, ay), (bx, by) in edges_of(loops):
        turn = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
        if ay <= y < by and turn > 0:
            number += 1
        elif by <= y < ay and turn < 0:
            number -= 1
    return number


def area(loops: Sequence[Loop], rule: str) -> Fraction:
    """Return the exact area of a region, by trapezoids between the heights of all vertices."""
    edges = [e for e in edges_of(loops) if e[0][1] != e[1][1]]
    levels = sorted(_levels(edges))
    total = Fraction(0)
    for low, high in pairwise(levels):
        total += _slab(edges, (low + high) / 2, rule) * (high - low)
    return total


def _levels(edges: list[tuple[tuple[int, int], tuple[int, int]]]) -> set[Fraction]:
    levels = {Fraction(p[1]) for edge in edges for p in edge}
    for (a, b), (c, d) in combinations(edges, 2):
        u, v = (b[0] - a[0], b[1] - a[1]), (d[0] - c[0], d[1] - c[1])
        cross = u[0] * v[1] - u[1] * v[0]
        if cross:
            t = Fraction((c[0] - a[0]) * v[1] - (c[1] - a[1]) * v[0], cross)
            levels.add(a[1] + t * u[1])
    return levels


def _slab(edges: list[tuple[tuple[int, int], tuple[int, int]]], y: Fraction, rule: str) -> Fraction:
    """Return the length of a region on a horizontal line through no vertex."""
    crossings = []
    for (ax, ay), (bx, by) in edges:
        if min(ay, by) < y < max(ay, by):
            x = ax + (y - ay) * Fraction(bx - ax, by - ay)
            crossings.append((x, 1 if by < ay else -1))
    number, length, last = 0, Fraction(0), Fraction(0)
    for x, change in sorted(crossings):
        if RULES[rule](number):
            length += x - last
        number, last = number + change, x
    return length


def random_loops(seed: int, count: int, corners: int, size: int) -> list[Loop]:
    rng = np.random.default_rng(seed)
    return [
        [(int(x), int(y)) for x, y in rng.integers(0, size, (corners, 2))] for _ in range(count)
    ]
