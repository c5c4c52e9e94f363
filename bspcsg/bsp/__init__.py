"""Binary space partition trees and the sets they stand for, in one, two and three dimensions.

The same definitions hold on the line, in the plane and in space: a hyperplane has a minus side,
which is inside, and a plus side; a tree divides space by hyperplanes into convex regions; its
leaves are in or out of a set. Everything is decided exactly on a decimal lattice that coordinates
are snapped to first.
"""

from .adaptive import AdaptiveTree, StabStats, StabTree, StaticTree, Tests
from .camera import Camera
from .cost import Comparison, PolicyRow, Query, Stats, compare_policies
from .distribution import optimised_tree, scores
from .drawing_dxf import load_dxf, save_dxf
from .drawing_svg import load_svg, save_svg
from .fragments import Fragments
from .interval import Intervals
from .loops import Outline
from .node import Leaf, Node
from .objects import ObjectTree, merge, partition_tree, split_tree
from .panorama import panorama
from .picture import Picture, picture
from .pieces import NodeTable, Pieces
from .policy import POLICIES, Policy
from .rays import EDGE, INTERIOR, MISS, VERTEX, HitLists, Hits, InsideSpans, RayCaster
from .region import Region
from .slicing import plane_frame, slice_solid
from .tree import PartitionTree

__all__ = [
    "EDGE",
    "INTERIOR",
    "MISS",
    "POLICIES",
    "VERTEX",
    "AdaptiveTree",
    "Camera",
    "Comparison",
    "Fragments",
    "HitLists",
    "Hits",
    "InsideSpans",
    "Intervals",
    "Leaf",
    "Node",
    "NodeTable",
    "ObjectTree",
    "Outline",
    "PartitionTree",
    "Picture",
    "Pieces",
    "Policy",
    "PolicyRow",
    "Query",
    "RayCaster",
    "Region",
    "StabStats",
    "StabTree",
    "StaticTree",
    "Stats",
    "Tests",
    "compare_policies",
    "load_dxf",
    "load_svg",
    "merge",
    "optimised_tree",
    "panorama",
    "partition_tree",
    "picture",
    "plane_frame",
    "save_dxf",
    "save_svg",
    "scores",
    "slice_solid",
    "split_tree",
]
