"""Intersections of triangles in exact fractions, without the core."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations
from typing import Any

Vector = tuple[Fraction, ...]
Corners = Sequence[Vector]


def exact(points: Any) -> list[Vector]:
    """Return points of doubles as points of exact fractions."""
    return [tuple(Fraction(float(x)) for x in point) for point in points]


def minus(p: Vector, q: Vector) -> Vector:
    return tuple(x - y for x, y in zip(p, q, strict=True))


def dot(u: Vector, v: Vector) -> Fraction:
    return sum((x * y for x, y in zip(u, v, strict=True)), Fraction(0))


def cross(u: Vector, v: Vector) -> Vector:
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def normal(triangle: Corners) -> Vector:
    a, b, c = triangle
    return cross(minus(b, a), minus(c, a))


def is_flat(triangle: Corners) -> bool:
    return not any(normal(triangle))


def is_on_both_sides(triangle: Corners, plane: Corners) -> bool:
    """Return true if a triangle has corners strictly on both sides of the plane of another one."""
    n = normal(plane)
    heights = [dot(n, minus(p, plane[0])) for p in triangle]
    return min(heights) < 0 < max(heights)


def _holds(triangle: Corners, point: Vector) -> bool:
    """Return true if a point in a triangle's plane lies in the closed triangle."""
    n = normal(triangle)
    edges = zip(triangle, (*triangle[1:], triangle[0]), strict=True)
    return all(dot(cross(minus(q, p), minus(point, p)), n) >= 0 for p, q in edges)


def _cuts(first: Corners, second: Corners) -> set[Vector]:
    """Return the points at which edges of the first triangle meet the second, in another plane."""
    n, found = normal(second), set()
    heights = [dot(n, minus(p, second[0])) for p in first]
    for i, j in ((0, 1), (1, 2), (2, 0)):
        if heights[i] * heights[j] > 0:
            continue
        if heights[i] == heights[j] == 0:
            found |= _within(first[i], first[j], second)
            continue
        t = heights[i] / (heights[i] - heights[j])
        point = tuple(p + t * (q - p) for p, q in zip(first[i], first[j], strict=True))
        if _holds(second, point):
            found.add(point)
    return found


def _within(p: Vector, q: Vector, triangle: Corners) -> set[Vector]:
    """Return the ends of the part of a segment that lies in a triangle of its plane."""
    n, low, high = normal(triangle), Fraction(0), Fraction(1)
    for a, b in zip(triangle, (*triangle[1:], triangle[0]), strict=True):
        inward = cross(n, minus(b, a))
        start, slope = dot(inward, minus(p, a)), dot(inward, minus(q, p))
        if slope > 0:
            low = max(low, -start / slope)
        elif slope < 0:
            high = min(high, -start / slope)
        elif start < 0:
            return set()
    ends = [tuple(x + t * (y - x) for x, y in zip(p, q, strict=True)) for t in (low, high)]
    return set(ends) if low <= high else set()


def _overlap(first: Corners, second: Corners) -> bool:
    """Return true if two triangles in one plane have an area in common."""
    n, rest = normal(second), list(first)
    for a, b in zip(second, (*second[1:], second[0]), strict=True):
        inward = cross(n, minus(b, a))
        clipped: list[Vector] = []
        for p, q in zip(rest, [*rest[1:], *rest[:1]], strict=True):
            hp, hq = dot(inward, minus(p, a)), dot(inward, minus(q, a))
            if hp >= 0:
                clipped.append(p)
            if hp * hq < 0:
                t = hp / (hp - hq)
                clipped.append(tuple(x + t * (y - x) for x, y in zip(p, q, strict=True)))
        rest = clipped
    return len(rest) > 2 and any(
        any(cross(minus(q, rest[0]), minus(r, rest[0]))) for q, r in combinations(rest[1:], 2)
    )


def common_dimension(first: Corners, second: Corners) -> int:
    """Return the dimension of the intersection of two triangles, -1 if it is empty.

    For triangles in one plane it is 2, or -1 if they have no area in common.
    """
    n = normal(second)
    if all(dot(n, minus(p, second[0])) == 0 for p in first):
        return 2 if _overlap(first, second) else -1
    points = _cuts(first, second) | _cuts(second, first)
    return min(len(points), 2) - 1
