"""How far points are from triangles, also from such that are much longer than wide."""

import numpy as np

from .._types import FloatArray


def distances_to_triangles(points: FloatArray, corners: FloatArray) -> FloatArray:
    """Return the distance of each point from its triangle, (k,) float64, in model units.

    Parameters
    ----------
    points : (k, 3) float64
    corners : (k, 3, 3) float64

    Notes
    -----
    The distance from the three sides needs no normal. That from the plane counts only where the
    foot of the perpendicular is inside; a needle's normal is all rounding, and leaving it out
    errs by less than the needle is wide.
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


def _to_segments(starts: FloatArray, ends: FloatArray) -> FloatArray:
    """Return the distance of the origin from segments, (…, 3) each."""
    along = ends - starts
    squares = np.einsum("...i,...i->...", along, along)
    dots = -np.einsum("...i,...i->...", starts, along)
    part = np.divide(dots, squares, np.zeros_like(dots), where=squares > 0).clip(0, 1)
    found: FloatArray = np.linalg.norm(starts + part[..., None] * along, axis=-1)
    return found
