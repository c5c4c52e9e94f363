"""The distance of points from triangles, accurate for long thin triangles (needles), too."""

import numpy as np

from .._types import FloatArray


def distances_to_triangles(points: FloatArray, corners: FloatArray) -> FloatArray:
    """Return the distance of point i from triangle i, for k pairs, (k,) float64, in model units.

    Parameters
    ----------
    points : (k, 3) float64
    corners : (k, 3, 3) float64

    Notes
    -----
    The distance from the three sides needs no normal. The distance from the plane counts only if
    the foot of the perpendicular is inside the triangle. The normal of a needle (a long thin
    triangle) consists mainly of rounding errors; ignoring its plane causes an error below the
    needle's width.
    """
    local = corners - points[:, None]
    starts, ends = local, np.roll(local, -1, axis=1)
    nearest: FloatArray = _to_segments(starts, ends).min(axis=1)
    normals = np.cross(local[:, 1] - local[:, 0], local[:, 2] - local[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    sides = np.einsum("kij,kj->ki", np.cross(starts, ends), normals)
    inside = (sides > 0).all(axis=1) & (lengths > 0)
    height = np.abs(np.einsum("kj,kj->k", local[:, 0], normals))
    planes = np.divide(height, lengths, np.full_like(height, np.inf), where=inside)
    found: FloatArray = np.minimum(nearest, planes)
    return found


def nearest_on_triangles(points: FloatArray, corners: FloatArray) -> FloatArray:
    """Return the point of triangle i that is nearest to point i, for k pairs, (k, 3) float64.

    Parameters
    ----------
    points : (k, 3) float64
    corners : (k, 3, 3) float64
    """
    local = corners - points[:, None]
    starts, ends = local, np.roll(local, -1, axis=1)
    feet = _nearest_to_origin(starts, ends)
    which = np.linalg.norm(feet, axis=2).argmin(axis=1)
    normals = np.cross(local[:, 1] - local[:, 0], local[:, 2] - local[:, 0])
    squares = np.einsum("ki,ki->k", normals, normals)
    sides = np.einsum("kij,kj->ki", np.cross(starts, ends), normals)
    inside = (sides > 0).all(axis=1) & (squares > 0)
    height = np.einsum("ki,ki->k", local[:, 0], normals)
    part = np.divide(height, squares, np.zeros_like(height), where=inside)
    found: FloatArray = np.where(
        inside[:, None], part[:, None] * normals, feet[np.arange(len(feet)), which]
    )
    return points + found


def _to_segments(starts: FloatArray, ends: FloatArray) -> FloatArray:
    """Return the distance of the origin from each segment; start and end points are (…, 3)."""
    found: FloatArray = np.linalg.norm(_nearest_to_origin(starts, ends), axis=-1)
    return found


def _nearest_to_origin(starts: FloatArray, ends: FloatArray) -> FloatArray:
    """Return the point of each segment that is nearest to the origin, (…, 3)."""
    along = ends - starts
    squares = np.einsum("...i,...i->...", along, along)
    dots = -np.einsum("...i,...i->...", starts, along)
    part = np.divide(dots, squares, np.zeros_like(dots), where=squares > 0).clip(0, 1)
    found: FloatArray = starts + part[..., None] * along
    return found
