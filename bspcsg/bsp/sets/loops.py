"""Closed outlines in the plane: input, nesting, transforms."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..._types import FloatArray
from ...errors import InvalidMeshError, invalid_parameter
from ...geometry import polygon, transform
from ...geometry.arrays import axes_of, doubles


@dataclass(frozen=True, eq=False)
class Outline:
    """A simple closed loop of a region's boundary, the region on its left.

    Parameters
    ----------
    points : (n, 2) float64
        The corners, starting with the one smallest in x, then y; read-only.
    parent : int
        The number of the enclosing outline: that of the region for a hole, that of the hole for an
        island; -1 if there is none.
    """

    points: FloatArray
    parent: int

    @property
    def is_hole(self) -> bool:
        """True if the loop runs clockwise."""
        before, at, after = self.points[-1], self.points[0], self.points[1]
        # The first corner is convex, so its turn gives the orientation of the loop.
        (ax, ay), (bx, by) = at - before, after - at
        return bool(ax * by - ay * bx < 0)

    @property
    def area(self) -> float:
        """Area inside, in square model units; negative for a hole."""
        return polygon.signed_area(self.points)

    @property
    def length(self) -> float:
        """Length in model units."""
        steps = np.roll(self.points, -1, axis=0) - self.points
        return math.fsum(np.hypot(steps[:, 0], steps[:, 1]).tolist())


def closed_loops(outlines: Any) -> list[FloatArray]:
    """Return the outlines as (n, 2) float64 arrays, in the given order and orientation.

    Raises
    ------
    InvalidMeshError
        If one has fewer than three points or another shape, or a coordinate is not finite.
    """
    shapes = polygon.shape_contours(outlines)
    if shapes is not None:
        return shapes
    if hasattr(outlines, "to_polygons"):
        outlines = outlines.to_polygons()
    try:
        items = list(outlines)
        single = bool(items) and axes_of(items[0][0]) == 0
    except (TypeError, LookupError) as error:
        raise invalid_parameter(
            "outlines must be a list of outlines, each of them a list of (x, y) points."
        ) from error
    whole = outlines if isinstance(outlines, np.ndarray) else items
    return [_loop(item, k) for k, item in enumerate([whole] if single else items)]


def loop_segments(loops: list[FloatArray]) -> FloatArray:
    """Return the (n, 2, 2) segments of closed loops, one loop after another."""
    if not loops:
        return np.zeros((0, 2, 2))
    return np.concatenate([np.stack([p, np.roll(p, -1, axis=0)], axis=1) for p in loops])


def moved_points(factor: transform.Factor, points: FloatArray) -> FloatArray:
    """Return (n, 2) points moved by an affine map, in reverse order if it mirrors."""
    space = np.column_stack([points, np.zeros(len(points))])
    moved = transform.apply(factor.matrix, space)[:, :2]
    return moved[::-1] if transform.determinant_sign(factor.matrix) < 0 else moved


def _loop(points: Any, place: int) -> FloatArray:
    array = doubles(
        points,
        InvalidMeshError(f"Outline {place} must be a list of (x, y) points.", "shape", [place]),
    )
    if array.ndim != 2 or array.shape[1] != 2 or len(array) < 3:
        raise InvalidMeshError(
            f"Outline {place} must have shape (n, 2) with n at least 3, not {array.shape}.",
            "shape",
            [place],
        )
    if not np.isfinite(array).all():
        raise InvalidMeshError(
            f"Outline {place} has a coordinate that is not a finite number.", "non_finite", [place]
        )
    return array
