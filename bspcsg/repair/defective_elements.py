"""All edges and triangles of a mesh that have a defect; a diagnosis names only the first ones."""

from dataclasses import dataclass

import numpy as np

from .._types import FloatArray, IndexArray
from ..errors import BspcsgError
from ..formats.raw import RawMesh
from ..mesh.certificate import certify
from ..mesh.mesh import Mesh
from ..mesh.weld import welded
from ..solid.ledger import uncounted
from .diagnosis import EdgeUses, connected, flat_faces, repeated_faces


@dataclass(frozen=True, eq=False)
class DefectiveElements:
    """A mesh whose equal vertices are joined, and all edges and triangles that have a defect.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int64
    open, turned, crowded : (k, 2) int64
        The two vertices of each edge with only one triangle, of each edge whose triangles do not
        run in opposite directions, and of each edge with more than two triangles.
    holes : (k,) int64
        For each open edge, the number of the hole that it borders.
    crossings : (c, 2) int64
        Pairs of triangles that cross or overlap.
    flat, repeated : (k,) int64
        Triangles without area, and triangles with the same corners as an earlier one.
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
def defective_elements_of(raw: RawMesh) -> DefectiveElements:
    """Return all edges and triangles of a mesh that have a defect.

    If a coordinate is not finite, no crossings are found.
    """
    vertices, same = welded(raw.vertices) if len(raw.vertices) else (raw.vertices, np.zeros(0, int))
    faces = same[raw.faces]
    edges = EdgeUses(faces, len(vertices))
    mesh = Mesh(vertices, faces, np.zeros((len(faces), 2), dtype=np.int64))
    return DefectiveElements(
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
