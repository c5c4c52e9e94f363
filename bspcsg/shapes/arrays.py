"""Solids from meshes that this package has computed itself."""

import numpy as np

from .._types import FloatArray, IndexArray
from ..solid.leaf import MeshLeaf
from ..solid.solid import Solid, from_leaf


def from_arrays(vertices: FloatArray, faces: IndexArray) -> Solid:
    """Return the solid of a mesh whose faces do not cross.

    The mesh is checked only if snapping to the lattice might make faces cross.
    """
    own = np.ascontiguousarray(vertices, dtype=np.float64), np.ascontiguousarray(faces)
    return from_leaf(MeshLeaf(*own, trusted=_survives_snapping(*own)))


def _survives_snapping(vertices: FloatArray, faces: IndexArray) -> bool:
    """Return True if no triangle is so thin that snapping to the lattice might flip it."""
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    sides = np.array(
        [
            np.linalg.norm(b - a, axis=1),
            np.linalg.norm(c - b, axis=1),
            np.linalg.norm(a - c, axis=1),
        ]
    )
    with np.errstate(all="ignore"):
        altitude = np.linalg.norm(np.cross(b - a, c - a), axis=1) / sides.max(axis=0)
        thickness = min(altitude.min(), np.ptp(vertices, axis=0).min())
        # The limit is a thousand steps of the lattice that suits this extent.
        return bool(thickness > 1e-6 * max(1.0, np.abs(vertices).max() / 1000))
