"""Projections of solids onto the plane z = 0."""

import numpy as np

from ...bsp import Region
from ...solid.solid import Solid


def shadow(body: Solid) -> Region:
    """Return the projection of a solid along z, as a region.

    It is the union of the projected triangles that face upwards; their common edges cancel.
    """
    mesh = body.normalized().to_mesh()
    a, b, c = (mesh.vertices[mesh.faces[:, k]][:, :2] for k in range(3))
    p, q = b - a, c - a
    faces = mesh.faces[p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0] > 0]
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    keys = edges[:, 0] * len(mesh.vertices) + edges[:, 1]
    back = edges[:, 1] * len(mesh.vertices) + edges[:, 0]
    segments = mesh.vertices[edges[~np.isin(keys, back)]][:, :, :2]
    proper = (segments[:, 0] != segments[:, 1]).any(axis=1)
    return Region.from_segments(segments[proper], pitch=body.tree.pitch)
