"""Binary space partition trees over points, segments and polygons, in one to three dimensions.

The minus side of a hyperplane is its inside. Everything is decided exactly on a decimal lattice
that coordinates are snapped to first; `PartitionTree.pitch` says which.
"""

from .camera import Camera
from .cost import Comparison, PolicyRow, Query, Stats, compare_policies
from .fragments import Fragments
from .node import Leaf, Node
from .panorama import panorama
from .picture import Picture, picture
from .policy import POLICIES, Policy
from .tree import PartitionTree

__all__ = [
    "POLICIES",
    "Camera",
    "Comparison",
    "Fragments",
    "Leaf",
    "Node",
    "PartitionTree",
    "Picture",
    "Policy",
    "PolicyRow",
    "Query",
    "Stats",
    "compare_policies",
    "panorama",
    "picture",
]
