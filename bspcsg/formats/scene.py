"""`SceneNode`: a node in the tree of nested objects of a file, as read or to be written."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .._types import FloatArray
from ..attributes.attributes import Attributes
from .raw import RawMesh


@dataclass(frozen=True, eq=False)
class SceneNode:
    """A named node with a transform, and with a mesh or with children.

    Parameters
    ----------
    name : str
    matrix : (4, 4) float64
        From this node to its parent, for column vectors; millimetres, z upwards.
    mesh : RawMesh or None
        Nodes that show the same mesh have the same object.
    color : tuple of float or None
    children : tuple of SceneNode
    """

    name: str
    matrix: FloatArray
    mesh: RawMesh | None = None
    color: tuple[float, ...] | None = None
    children: "tuple[SceneNode, ...]" = ()

    def walk(self) -> "Iterator[SceneNode]":
        """Yield the node and all its descendants, parents before children."""
        waiting = [self]
        while waiting:
            node = waiting.pop()
            yield node
            waiting.extend(reversed(node.children))


def are_equal_trees(one: SceneNode, other: SceneNode) -> bool:
    """Say whether two trees have equal names, matrices, colours and meshes, shared equally."""
    pairs = list(zip(one.walk(), other.walk(), strict=False))
    if len(pairs) != sum(1 for _ in one.walk()) or len(pairs) != sum(1 for _ in other.walk()):
        return False
    shared: dict[tuple[int, tuple[float, ...] | None], int] = {}
    for a, b in pairs:
        same = a.name == b.name and len(a.children) == len(b.children) and a.color == b.color
        if not same or not np.array_equal(a.matrix, b.matrix):
            return False
        if (a.mesh is None) != (b.mesh is None):
            return False
        if a.mesh is None or b.mesh is None:
            continue
        # A mesh that nodes show in two colours is stored as two meshes.
        known = shared.setdefault((id(a.mesh), a.color), id(b.mesh))
        if known != id(b.mesh) or not _same(a.mesh, b.mesh):
            return False
    return True


def _same(one: RawMesh, other: RawMesh) -> bool:
    return np.array_equal(one.vertices[one.faces], other.vertices[other.faces])


def have_equal_attributes(one: SceneNode, other: SceneNode) -> bool:
    """Say whether the meshes of two trees of equal structure have equal attributes.

    Meshes of nodes with a colour are not compared.
    """
    pairs = zip(one.walk(), other.walk(), strict=False)
    return all(
        _equal_attributes(a.mesh.attributes, b.mesh.attributes)
        for a, b in pairs
        if a.mesh is not None and b.mesh is not None and a.color is None
    )


def _equal_attributes(one: Attributes | None, other: Attributes | None) -> bool:
    names = set() if one is None else set(one.names)
    if names != (set() if other is None else set(other.names)):
        return False
    if one is None or other is None:
        return True
    values = ((one.at_corners(name), other.at_corners(name)) for name in names)
    same = all(np.array_equal(a, b, equal_nan=a.dtype.kind == "f") for a, b in values)
    return same and all(other.materials.get(name) == it for name, it in one.materials.items())
