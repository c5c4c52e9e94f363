"""Sewing: making a mesh that is closed only on the lattice closed by vertex index.

On the lattice, a corner of one triangle may lie inside an edge of another (a T-junction), corners
that differ by less than a step coincide, and triangles without area vanish. A transform rounds each
corner separately, which would open the mesh at T-junctions and coinciding corners, and give
vanished triangles an area. So meshes are sewn first.
"""

from dataclasses import dataclass

import numpy as np

from .._core import Tree
from .._types import IndexArray
from ..attributes.transfer import Surface, inherited_attributes, patches_of
from ..errors import core_errors
from .mesh_transform import AttributedMesh


@dataclass(frozen=True, eq=False)
class Sewn:
    """A mesh after sewing: neighbouring triangles share the vertices of each edge by index.

    Parameters
    ----------
    mesh : AttributedMesh
    origins : (m,) int64
        For each triangle, the triangle of the original mesh that contains it, ascending.
    """

    mesh: AttributedMesh
    origins: IndexArray


def sewn(mesh: AttributedMesh, tree: Tree) -> Sewn | None:
    """Return a mesh closed by index, with T-junctions split and corners welded.

    Return None if the mesh stays closed however its corners move.

    Parameters
    ----------
    mesh : AttributedMesh
    tree : Tree
        The tree of the mesh.
    """
    if tree.closes_when_moved:
        return None
    attributes = () if mesh.attributes is None else (mesh.attributes,)
    with core_errors():
        shown = tree.patched(patches_of(attributes)) if attributes else tree
        surface = Surface(*shown.to_mesh(), shown.origins(), shown.flips())
    said = inherited_attributes(surface, attributes, shown.source_arrays) if attributes else None
    order = np.argsort(surface.source[:, 1], kind="stable")
    said = said and said.for_faces(order)
    divided = AttributedMesh(surface.vertices, surface.faces[order], said)
    return Sewn(divided, surface.source[order, 1])
