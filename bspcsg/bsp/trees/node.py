"""Nodes and leaves of a partition tree: views of its arrays that store only an index."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np

from ..._types import FloatArray
from .fragments import Fragments

if TYPE_CHECKING:
    from .tree import PartitionTree

#: The two sides of a hyperplane; minus is inside.
Side = Literal["minus", "plus"]

#: The first entry of a row of ``arrays["cut"]`` if the cut is the hyperplane of a facet.
_PIVOT = -1

#: A bounded convex region: (2,) ends in 1D, (k, 2) corners counterclockwise in 2D, a list of
#: (k, 3) faces counterclockwise seen from outside in 3D.
RegionShape = FloatArray | list[FloatArray]


class Visitor(Protocol):
    """The methods that `PartitionTree.visit` calls on its argument."""

    def node(self, node: "Node") -> None:
        """Receive an inner node."""

    def leaf(self, leaf: "Leaf") -> None:
        """Receive a leaf, which is an empty region."""


@dataclass(frozen=True)
class Node:
    """An inner node v: a region R(v) and the hyperplane H(v) that divides it.

    Parameters
    ----------
    tree : PartitionTree
    index : int
        The node's index in preorder, minus child before plus child; the root is 0.
    """

    tree: "PartitionTree"
    index: int

    @property
    def hyperplane(self) -> tuple[FloatArray, float]:
        """H(v) as unit normal n, (d,) float64, and offset c in model units: n·x = c.

        The minus side is n·x < c. Both are rounded; `coefficients` are exact.
        """
        arrays = self.tree.arrays
        return arrays["normal"][self.index], float(arrays["offset"][self.index])

    @property
    def coefficients(self) -> tuple[int, ...]:
        """The exact integers n, c of H(v): n·x + c = 0 with x in lattice steps."""
        return tuple(self.tree.core.coefficients(self.index) or ())

    @property
    def is_free(self) -> bool:
        """True if the node's cut is axis-parallel or given by the caller, not from a facet."""
        return bool(self.tree.arrays["cut"][self.index, 0] != _PIVOT)

    @property
    def pivot(self) -> int | None:
        """The index of the facet whose supporting hyperplane is H(v), or None for a free cut."""
        axis, piece = self.tree.arrays["cut"][self.index]
        return None if axis != _PIVOT else int(self.tree.core.piece_sources()[piece])

    @property
    def coplanar(self) -> Fragments:
        """S(v): the fragments that lie in the node's hyperplane; empty only for a free cut."""
        arrays = self.tree.arrays
        start, end = arrays["start"][self.index], arrays["end"][self.index]
        return self.tree.fragments.take(np.arange(start, end))

    @property
    def depth(self) -> int:
        """The number of hyperplanes on the path from the root to this node."""
        return int(self.tree.arrays["depth"][self.index])

    @property
    def minus(self) -> "Node | None":
        """The subtree on the minus side, None for an empty region."""
        return self._linked("minus")

    @property
    def plus(self) -> "Node | None":
        """The subtree on the plus side, None for an empty region."""
        return self._linked("plus")

    @property
    def parent(self) -> "Node | None":
        """The parent node, None for the root."""
        return self._linked("parent")

    @property
    def children(self) -> tuple["Node | Leaf", "Node | Leaf"]:
        """The child on the minus side and the child on the plus side, each a node or a leaf."""
        return self.minus or Leaf(self.tree, self, "minus"), self.plus or Leaf(
            self.tree, self, "plus"
        )

    @property
    def region(self) -> RegionShape:
        """The region R(v) of the node, clipped to the facets' box enlarged by the tree's margin."""
        return self.tree.region(self)

    @property
    def span(self) -> FloatArray:
        """The sub-hyperplane: (k, d) corners of the part of H(v) inside R(v).

        Without corners if H(v) misses the interior of R(v).
        """
        return self.tree.core.span(self.index, self.tree.margin)

    def _linked(self, name: Literal["minus", "plus", "parent"]) -> "Node | None":
        index = int(self.tree.arrays[name][self.index])
        return None if index < 0 else Node(self.tree, index)

    def __repr__(self) -> str:
        """Return a text with the node's index, hyperplane and depth."""
        normal, offset = self.hyperplane
        terms = ", ".join(f"{x:.4g}" for x in normal)
        return f"Node({self.index}, normal=({terms}), offset={offset:.6g}, depth={self.depth})"


@dataclass(frozen=True)
class Leaf:
    """A leaf of a partition tree: a convex region without facets.

    Parameters
    ----------
    tree : PartitionTree
    parent : Node or None
        The parent node, None for the only leaf of a tree without facets.
    side : {"minus", "plus"}
        The side of the parent's hyperplane on which the region lies.
    """

    tree: "PartitionTree"
    parent: Node | None
    side: Side

    @property
    def depth(self) -> int:
        """The number of hyperplanes on the path from the root to this leaf."""
        return 0 if self.parent is None else self.parent.depth + 1

    @property
    def region(self) -> RegionShape:
        """The region of the leaf, clipped to the facets' box enlarged by the tree's margin."""
        return self.tree.region(self)
