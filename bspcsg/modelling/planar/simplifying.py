"""Simplification of outlines."""

import numpy as np

from ..._types import FloatArray, Scalar
from ...bsp import Region
from ...parameters import not_negative


def simplify_region(figure: Region, tolerance: Scalar) -> Region:
    """Return a region with fewer corners, whose outlines deviate by at most `tolerance`."""
    limit = not_negative(tolerance, "tolerance")
    if limit == 0 or figure.is_empty or figure.is_full:
        return figure
    if not figure.is_bounded and (~figure).is_bounded:
        return ~simplify_region(~figure, limit)
    thinned = [thinned_loop(loop, limit) for loop in figure.to_polygons()]
    return Region([loop for loop in thinned if len(loop) >= 3], pitch=figure.pitch)


def thinned_loop(loop: FloatArray, tolerance: float) -> FloatArray:
    """Return the corners, (k, 2), of a simplified loop that deviates by at most `tolerance`.

    Notes
    -----
    The loop is cut at its first corner and the corner farthest from it. Each half is divided at the
    corner farthest from its chord, until all corners are within the tolerance (Ramer 1972, Douglas
    and Peucker 1973). Distances are measured to the chord as a segment, not to its infinite line,
    so the tolerance holds for every point of both loops.
    """
    count = len(loop)
    far = int(np.linalg.norm(loop - loop[0], axis=1).argmax())
    ring = np.concatenate([loop, loop[:1]])
    kept = np.zeros(count + 1, dtype=bool)
    kept[[0, far]] = True
    waiting = [(0, far), (far, count)]
    while waiting:
        start, end = waiting.pop()
        if end - start < 2:
            continue
        away = _distances(ring[start + 1 : end], ring[start], ring[end])
        farthest = int(away.argmax())
        if away[farthest] > tolerance:
            middle = start + 1 + farthest
            kept[middle] = True
            waiting += [(start, middle), (middle, end)]
    return np.asarray(loop[kept[:-1]])


def _distances(points: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Return the distance of each point from the segment between `start` and `end`, (n,)."""
    along = end - start
    length = float(along @ along)
    part = np.clip((points - start) @ along / length, 0, 1) if length else np.zeros(len(points))
    return np.asarray(np.linalg.norm(points - start - part[:, None] * along, axis=1))
