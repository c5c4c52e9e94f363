"""Closing by index of meshes that are closed only on the lattice, before they are moved.

On the lattice, a T-junction has a corner of one triangle inside an edge of another, corners that
differ by less than a step coincide, and triangles without area vanish. Moving a mesh rounds each
corner separately, which opens it at such places, and gives such triangles an area.
"""

from dataclasses import dataclass

import numpy as np

from .._core import Tree
from .._types import IndexArray
from ..attributes.carrying import Surface, carried, patches_of
from ..errors import core_errors
from .moving import AttributedMesh


@dataclass(frozen=True, eq=False)
class Sewn:
    """A mesh that was closed by index.

    Parameters
    ----------
    mesh : AttributedMesh
    kept : (m,) int64
        For each triangle, the triangle of the original mesh that contains it, ascending.
    """

    mesh: AttributedMesh
    kept: IndexArray


def sewn(mesh: AttributedMesh, tree: Tree) -> Sewn | None:
    """Return a mesh closed by index, with T-junctions split and corners welded.

    Return None if the mesh stays closed wherever its corners move.

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
    said = carried(surface, attributes, shown.source_arrays) if attributes else None
    order = np.argsort(surface.source[:, 1], kind="stable")
    said = said and said.taken(order)
    divided = AttributedMesh(surface.vertices, surface.faces[order], said)
    return Sewn(divided, surface.source[order, 1])
