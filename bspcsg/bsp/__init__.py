"""Binary space partition trees over points, segments and polygons, in one to three dimensions.

The minus side of a hyperplane is its inside. Everything is decided exactly on a decimal lattice
that coordinates are snapped to first; `PartitionTree.pitch` says which.
"""

from .cost import Comparison, PolicyRow, Query, Stats, compare_policies
from .drawing_dxf import load_dxf, save_dxf
from .drawing_svg import load_svg, save_svg
from .fragments import Fragments
from .interval import Intervals
from .loops import Outline
from .node import Leaf, Node
from .objects import ObjectTree, merge, partition_tree, split_tree
from .pieces import NodeTable, Pieces
from .policy import POLICIES, Policy
from .region import Region
from .slicing import plane_frame, slice_solid
from .tree import PartitionTree

__all__ = [
    "POLICIES",
    "Comparison",
    "Fragments",
    "Intervals",
    "Leaf",
    "Node",
    "NodeTable",
    "ObjectTree",
    "Outline",
    "PartitionTree",
    "Pieces",
    "Policy",
    "PolicyRow",
    "Query",
    "Region",
    "Stats",
    "compare_policies",
    "load_dxf",
    "load_svg",
    "merge",
    "partition_tree",
    "plane_frame",
    "save_dxf",
    "save_svg",
    "slice_solid",
    "split_tree",
]
