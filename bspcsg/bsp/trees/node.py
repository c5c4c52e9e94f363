"""Nodes and leaves of a partition tree, as light views of its arrays."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np

from ..._types import FloatArray
from .fragments import Fragments

if TYPE_CHECKING:
    from .tree import PartitionTree

#: The two sides of a hyperplane; minus is inside.
Side = Literal["minus", "plus"]

#: The axis in the rows of cuts if a facet gave the cut.
_PIVOT = -1

#: A bounded convex region: (2,) ends in 1D, (k, 2) corners counterclockwise in 2D, a list of
#: (k, 3) faces counterclockwise seen from outside in 3D.
RegionShape = FloatArray | list[FloatArray]


class Visitor(Protocol):
    """The functions that `PartitionTree.visit` calls."""

    def node(self, node: "Node") -> None:
        """Visit an inner node."""

    def leaf(self, leaf: "Leaf") -> None:
        """Visit an empty region."""


@dataclass(frozen=True)
class Node:
    """An inner node v: a region R(v) and the hyperplane H(v) that divides it.

    Parameters
    ----------
    tree : PartitionTree
    index : int
        Its place in the preorder of the tree, minus before plus; the root is 0.
    """

    tree: "PartitionTree"
    index: int

    @property
    def hyperplane(self) -> tuple[FloatArray, float]:
        """H(v) as unit normal n (d,) and offset c in model units: n·x = c, minus side n·x < c.

        Both are rounded; `coefficients` are exact.
        """
        arrays = self.tree.arrays
        return arrays["normal"][self.index], float(arrays["offset"][self.index])

    @property
    def coefficients(self) -> tuple[int, ...]:
        """The exact integers n, c of H(v): n·x + c = 0 with x in lattice steps."""
        return tuple(self.tree.core.coefficients(self.index) or ())

    @property
    def is_free(self) -> bool:
        """True if H(v) is not from a facet: it is axis-parallel, or given by the caller."""
        return bool(self.tree.arrays["cut"][self.index, 0] != _PIVOT)

    @property
    def pivot(self) -> int | None:
        """The facet whose supporting hyperplane H(v) is, or None for a free cut."""
        axis, piece = self.tree.arrays["cut"][self.index]
        return None if axis != _PIVOT else int(self.tree.core.piece_sources()[piece])

    @property
    def coplanar(self) -> Fragments:
        """S(v): the fragments that lie in H(v); empty only for a free cut."""
        arrays = self.tree.arrays
        start, end = arrays["start"][self.index], arrays["end"][self.index]
        return self.tree.fragments.take(np.arange(start, end))

    @property
    def depth(self) -> int:
        """The number of hyperplanes above."""
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
        """The node above, None for the root."""
        return self._linked("parent")

    @property
    def children(self) -> tuple["Node | Leaf", "Node | Leaf"]:
        """The minus and the plus side, each a node or a leaf."""
        return self.minus or Leaf(self.tree, self, "minus"), self.plus or Leaf(
            self.tree, self, "plus"
        )

    @property
    def region(self) -> RegionShape:
        """R(v), within the box of the facets grown by the tree's margin."""
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
        """Show the position and the cut of the node."""
        normal, offset = self.hyperplane
        terms = ", ".join(f"{x:.4g}" for x in normal)
        return f"Node({self.index}, normal=({terms}), offset={offset:.6g}, depth={self.depth})"


@dataclass(frozen=True)
class Leaf:
    """A region without facets.

    Parameters
    ----------
    tree : PartitionTree
    parent : Node or None
        The node above, None for the only leaf of a tree without facets.
    side : {"minus", "plus"}
        On which side of the parent's hyperplane the region lies.
    """

    tree: "PartitionTree"
    parent: Node | None
    side: Side

    @property
    def depth(self) -> int:
        """The number of hyperplanes above."""
        return 0 if self.parent is None else self.parent.depth + 1

    @property
    def region(self) -> RegionShape:
        """The region, within the box of the facets grown by the tree's margin."""
        return self.tree.region(self)
