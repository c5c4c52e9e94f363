"""Binary space partition trees over points, segments and polygons, in one to three dimensions.

The minus side of a hyperplane is its inside. Everything is decided exactly on a decimal lattice
that coordinates are snapped to first; `PartitionTree.pitch` says which.
"""

from .cost import Comparison, PolicyRow, Query, Stats, compare_policies
from .fragments import Fragments
from .node import Leaf, Node
from .policy import POLICIES, Policy
from .tree import PartitionTree

__all__ = [
    "POLICIES",
    "Comparison",
    "Fragments",
    "Leaf",
    "Node",
    "PartitionTree",
    "Policy",
    "PolicyRow",
    "Query",
    "Stats",
    "compare_policies",
]
