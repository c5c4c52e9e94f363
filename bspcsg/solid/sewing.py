"""Meshes that close on the lattice only, closed by index before they are moved.

At a T-junction a corner of one triangle lies inside an edge of another; corners that differ by less
than a step are one; triangles without area are none. Moving a mesh rounds each corner by itself,
which opens it there, and gives such triangles an area.
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
        The triangle of the mesh before that each of these is a part of, ascending.
    """

    mesh: AttributedMesh
    kept: IndexArray


def sewn(mesh: AttributedMesh, tree: Tree) -> Sewn | None:
    """Return a mesh closed by index: with triangles divided at T-junctions, and corners welded.

    None if it closes wherever its corners are moved to.

    Parameters
    ----------
    mesh : AttributedMesh
    tree : Tree
        The one that was made from it.
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
