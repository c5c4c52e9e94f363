"""The quality of a partition tree: the expected cost of a query, and size figures.

The cost of the lecture notes, C(T) = 1 + P⁻ C(T⁻) + P⁺ C(T⁺) with C = 0 for an empty region, is the
expected number of nodes that a query visits: T⁻ and T⁺ are the subtrees on the two sides of the
root's cut, and P⁻ and P⁺ the probabilities that a query visits them. With the region R(v) of a node
v, its size μ(R(v)), and P± = μ(R(T±)) / μ(R(T)), the products along each path telescope: C(T) is
the sum of μ(R(v)) / μ(R(root)) over all nodes v.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from ...errors import core_errors
from ...parameters import not_negative, one_of

if TYPE_CHECKING:
    from .tree import PartitionTree

#: The kind of query that a cost counts: points spread evenly over the root's region, or rays
#: through it.
Query: TypeAlias = Literal["point", "ray"]


def cost(tree: "PartitionTree", query: Query = "point", margin: float | None = None) -> float:
    """Return the expected number of nodes that a query of a tree visits.

    Parameters
    ----------
    tree : PartitionTree
    query : {"point", "ray"}
        "point": points evenly spread over the root's region, μ the volume (area, length).
        "ray": lines of even density that meet the root's region, μ the surface area (perimeter;
        1 in 1D); no facet stops them.
    margin : float, optional
        The distance by which the root's region exceeds the facets' box, in model units; by default
        the tree's own.

    Returns
    -------
    float
        0 for a tree without facets. Regions are divided exactly; only their sizes are rounded, by
        about 1e-14 of the size of the root's region; far from the origin this error grows with
        the region's distance from the origin, divided by the region's extent.

    Raises
    ------
    InvalidParameterError
        If the query is another, or the margin is not finite.

    Notes
    -----
    Naylor 1993, "Constructing good partitioning trees". That a line meets a convex body inside
    another with the ratio of their surfaces is Crofton's formula.
    """
    wanted = one_of(("point", "ray"), query, "query")
    reach = tree.margin if margin is None else not_negative(margin, "margin")
    with core_errors():
        volume, surface, volumes, surfaces = tree.core.measures(reach)
    if wanted == "point":
        return math.fsum(volumes) / volume
    return math.fsum(surfaces) / surface


@dataclass(frozen=True)
class Stats:
    """The numbers of nodes, leaves, fragments and splits of a tree, its depths and its balance.

    Parameters
    ----------
    facets : int
        The number of facets that the tree was built over.
    nodes : int
        The number of inner nodes.
    leaves : int
        The number of leaves, which are empty regions.
    fragments : int
        The number of fragments in all coplanar sets.
    splits : int
        The number of times a node's hyperplane cut a fragment in two.
    depth : int
        The number of hyperplanes on the longest path from the root to a leaf.
    mean_depth : float
        The number of hyperplanes on the path from the root to a leaf, averaged over the leaves.
    balance : float
        log2(leaves) / mean_depth: 1 for a tree whose leaves are all at one depth, towards 0 for a
        chain. (No binary tree has a mean depth below log2 of its leaves.)
    """

    facets: int
    nodes: int
    leaves: int
    fragments: int
    splits: int
    depth: int
    mean_depth: float
    balance: float


def stats(tree: "PartitionTree") -> Stats:
    """Return the numbers of nodes, leaves, fragments and splits of a tree, and its depths."""
    arrays = tree.arrays
    below = arrays["depth"] + 1
    ends = np.concatenate([below[arrays["minus"] < 0], below[arrays["plus"] < 0]])
    mean = float(ends.mean()) if len(ends) else 0.0
    return Stats(
        facets=len(tree.core.lattice()[1]) - 1,
        nodes=len(tree),
        leaves=len(tree) + 1,
        fragments=len(tree.fragments),
        splits=len(tree.splits),
        depth=int(below.max()) if len(tree) else 0,
        mean_depth=mean,
        balance=math.log2(len(tree) + 1) / mean if len(tree) else 1.0,
    )
