"""Closed outlines in the plane: reading them in any form, and their area, length and motion."""

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
    """A simple closed loop of a region's boundary, with the region on its left.

    Parameters
    ----------
    points : (n, 2) float64
        The corners, starting with the corner of least x, then least y; read-only.
    parent : int
        The index of the outline that directly encloses this one: of an outer outline for a hole, of
        a hole for an island in it; -1 for none.
    """

    points: FloatArray
    parent: int

    @property
    def is_hole(self) -> bool:
        """True if the loop runs clockwise, so that it bounds a hole."""
        before, at, after = self.points[-1], self.points[0], self.points[1]
        # The loop is convex at its first corner, whose turn therefore gives its orientation.
        (ax, ay), (bx, by) = at - before, after - at
        return bool(ax * by - ay * bx < 0)

    @property
    def area(self) -> float:
        """The area that the loop encloses, in square model units; negative for a hole."""
        return polygon.signed_area(self.points)

    @property
    def length(self) -> float:
        """The length of the loop, in model units."""
        steps = np.roll(self.points, -1, axis=0) - self.points
        return math.fsum(np.hypot(steps[:, 0], steps[:, 1]).tolist())


def closed_loops(outlines: Any) -> list[FloatArray]:
    """Return outlines in any form as (n, 2) float64 arrays, in the given order and orientation.

    Raises
    ------
    InvalidMeshError
        If an outline has fewer than three points or another shape, or a coordinate is not finite.
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
    """Return the (n, 2) image of a loop under an affine map; a mirror map reverses the order."""
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
