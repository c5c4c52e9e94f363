"""Measuring the thickness of a solid at each of its faces by rays."""

import numpy as np

from ..._types import FloatArray, IndexArray
from ...bsp import RayCaster

#: The distance behind a face at which its ray begins, so that the ray does not hit that face, as a
#: share of the mesh's longest side.
_INSIDE = 1e-7


def thickness(vertices: FloatArray, faces: IndexArray) -> FloatArray:
    """Return the distance from each face's centroid through the solid to the opposite side, (m,).

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int64
        Faces whose normals point outwards.

    Returns
    -------
    (m,) float64
        In model units; NaN if there is no opposite side, or the face has no area.
    """
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    sound = np.flatnonzero(lengths > 0)
    found = np.full(len(faces), np.nan)
    if not len(sound):
        return found
    inwards = -normals[sound] / lengths[sound, None]
    step = _INSIDE * float(np.ptp(vertices, axis=0).max())
    hits = RayCaster((vertices, faces)).first_hit(
        corners[sound].mean(axis=1) + step * inwards, inwards
    )
    found[sound] = np.where(np.isfinite(hits.t), hits.t + step, np.nan)
    return found
