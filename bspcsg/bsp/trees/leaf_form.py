"""Partition trees in the form of the lecture notes: a leaf stores at most one fragment.

A `PartitionTree` divides until no region has a facet, so that every leaf is empty and every
fragment lies in the hyperplane of an inner node. In the notes a region with one fragment is a leaf
that stores it. A `PartitionTree` is such a tree with these leaves divided by their own fragment.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..._types import IndexArray

if TYPE_CHECKING:
    from .tree import PartitionTree

#: An empty leaf in `LeafForm.minus` and `LeafForm.plus`; fragment k is EMPTY - 1 - k.
EMPTY = -1


@dataclass(frozen=True, eq=False)
class LeafForm:
    """A partition tree in which each leaf stores no fragment or one fragment.

    The number of nodes is 2 · leaves - 1, as in any tree whose inner nodes have two children. Let
    n̄ be the number of fragments. If the hyperplane of every inner node contains a fragment, the
    tree has at most 2 n̄ - 1 nodes; it has exactly 2 n̄ - 1 nodes if also exactly one leaf stores a
    fragment and no hyperplane of an inner node contains several. The tree also has exactly 2 n̄ - 1
    nodes if no hyperplane of an inner node contains a fragment and no leaf is empty.

    Parameters
    ----------
    inner : (m,) int64
        The nodes of the `PartitionTree` that are inner nodes here, in preorder.
    minus, plus : (m,) int64
        The children of these nodes on the minus and plus side, as indices into `inner`; -1 for an
        empty leaf, -2 - k for a leaf that stores fragment k of `PartitionTree.fragments`. Without
        inner nodes the tree is one leaf.
    fragments : int
        The number n̄ of fragments of the tree.
    stored : int
        The number of fragments that leaves store.
    """

    inner: IndexArray
    minus: IndexArray
    plus: IndexArray
    fragments: int
    stored: int

    @property
    def leaves(self) -> int:
        """The number of leaves."""
        return len(self.inner) + 1

    @property
    def nodes(self) -> int:
        """The number of inner nodes and leaves together."""
        return len(self.inner) + self.leaves


def leaf_form(tree: "PartitionTree") -> LeafForm:
    """Return a tree in leaf form: a node over a single fragment becomes a leaf that stores it."""
    arrays = tree.arrays
    single = arrays["end"] - arrays["start"] == 1
    stores = single & (arrays["minus"] < 0) & (arrays["plus"] < 0) & (arrays["cut"][:, 0] == -1)
    inner = np.flatnonzero(~stores)
    # The new link for each node; the last entry is for index -1, an empty leaf.
    links = np.full(len(tree) + 1, EMPTY, dtype=np.int64)
    links[inner] = np.arange(len(inner))
    kept = np.flatnonzero(stores)
    links[kept] = EMPTY - 1 - arrays["start"][kept]
    return LeafForm(
        inner,
        links[arrays["minus"][inner]],
        links[arrays["plus"][inner]],
        len(tree.fragments),
        len(kept),
    )
