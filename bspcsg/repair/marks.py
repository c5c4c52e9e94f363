"""The places of all defects of a mesh; a diagnosis names only the first few."""

from dataclasses import dataclass

import numpy as np

from .._types import FloatArray, IndexArray
from ..errors import BspcsgError
from ..formats.raw import RawMesh
from ..mesh.certificate import certify
from ..mesh.mesh import Mesh
from ..mesh.weld import welded
from ..solid.counting import uncounted
from .diagnosis import EdgeUses, connected, flat_faces, repeated_faces


@dataclass(frozen=True, eq=False)
class Marks:
    """A mesh with its corners joined, and the places of its defects.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int64
    open, turned, crowded : (k, 2) int64
        Vertices of the edges with only one triangle, of those whose triangles do not run in
        opposite directions, and of those with more than two triangles.
    holes : (k,) int64
        The number of the hole that each open edge borders.
    crossings : (c, 2) int64
        Pairs of triangles that cross or overlap.
    flat, repeated : (k,) int64
        Triangles without area, and triangles with the same corners as another.
    """

    vertices: FloatArray
    faces: IndexArray
    open: IndexArray
    turned: IndexArray
    crowded: IndexArray
    holes: IndexArray
    crossings: IndexArray
    flat: IndexArray
    repeated: IndexArray


@uncounted
def marks_of(raw: RawMesh) -> Marks:
    """Return the places of the defects of a mesh; coordinates that are not finite cross nothing."""
    vertices, same = welded(raw.vertices) if len(raw.vertices) else (raw.vertices, np.zeros(0, int))
    faces = same[raw.faces]
    edges = EdgeUses(faces, len(vertices))
    mesh = Mesh(vertices, faces, np.zeros((len(faces), 2), dtype=np.int64))
    return Marks(
        vertices,
        faces,
        edges.ends[edges.open],
        edges.ends[edges.turned],
        edges.ends[edges.crowded],
        connected(edges.ends[edges.open]) if len(edges.open) else edges.open,
        _crossings(vertices, faces),
        flat_faces(mesh),
        repeated_faces(faces),
    )


def _crossings(vertices: FloatArray, faces: IndexArray) -> IndexArray:
    proper = np.flatnonzero((faces != np.roll(faces, 1, axis=1)).all(axis=1))
    try:
        found = certify(vertices, faces[proper]).crossings
    except BspcsgError:
        found = ()
    pairs: IndexArray = proper[np.array(found, dtype=np.int64).reshape(-1, 2)]
    return pairs
