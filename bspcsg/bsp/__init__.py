"""Binary space partition trees and their sets, in one, two and three dimensions.

The same definitions hold on the line, in the plane and in space: a hyperplane has a minus side,
which is inside, and a plus side; a tree divides space by hyperplanes into convex regions; its
leaves are in or out of a set. Coordinates are first snapped to a decimal lattice; all decisions
after that are exact.
"""

from .drawings.dxf import load_dxf, save_dxf
from .drawings.svg import load_svg, save_svg
from .drawings.unread_content import DrawingWarning
from .painting.camera import Camera
from .painting.panorama import panorama
from .painting.picture import Picture, picture
from .rays.adaptive import AdaptiveTree, StabStats, StabTree, StaticTree, Tests
from .rays.caster import (
    EDGE,
    INTERIOR,
    MISS,
    VERTEX,
    CasterNodes,
    HitLists,
    Hits,
    InsideSpans,
    RayCaster,
)
from .rays.distribution import optimised_tree, scores
from .rays.trace import LeafDivision, StabNodes, StabStep, StabTrace
from .sets.interval import Intervals
from .sets.loops import Outline
from .sets.objects import ObjectTree, merge, partition_tree, split_tree
from .sets.paths import BoundaryPath, boundary_paths
from .sets.pieces import NodeTable, Pieces
from .sets.region import Region
from .sets.slicing import plane_frame, slice_solid
from .sets.spherical import SphericalRegion, visible_sky
from .sets.sub_hyperplane import SubHyperplane
from .sets.trace import MergeHalves, MergeJoin, MergePair, MergeSplit, MergeTrace
from .sets.visibility import visibility_polygon, visibility_volume
from .trees import analysis as analysis
from .trees.attributes import AttributeTree, LabelledRegion
from .trees.chosen_cuts import Choice
from .trees.cost import Query, Stats
from .trees.fragments import Fragments
from .trees.leaf_form import LeafForm
from .trees.node import Leaf, Node
from .trees.policies import Comparison, PolicyRow, compare_policies
from .trees.policy import POLICIES, Policy
from .trees.trace import (
    Candidate,
    Construction,
    Division,
    PointTrace,
    RayCosts,
    RayStep,
    RayTrace,
)
from .trees.tree import PartitionTree

__all__ = [
    "EDGE",
    "INTERIOR",
    "MISS",
    "POLICIES",
    "VERTEX",
    "AdaptiveTree",
    "AttributeTree",
    "BoundaryPath",
    "Camera",
    "Candidate",
    "CasterNodes",
    "Choice",
    "Comparison",
    "Construction",
    "Division",
    "DrawingWarning",
    "Fragments",
    "HitLists",
    "Hits",
    "InsideSpans",
    "Intervals",
    "LabelledRegion",
    "Leaf",
    "LeafDivision",
    "LeafForm",
    "MergeHalves",
    "MergeJoin",
    "MergePair",
    "MergeSplit",
    "MergeTrace",
    "Node",
    "NodeTable",
    "ObjectTree",
    "Outline",
    "PartitionTree",
    "Picture",
    "Pieces",
    "PointTrace",
    "Policy",
    "PolicyRow",
    "Query",
    "RayCaster",
    "RayCosts",
    "RayStep",
    "RayTrace",
    "Region",
    "SphericalRegion",
    "StabNodes",
    "StabStats",
    "StabStep",
    "StabTrace",
    "StabTree",
    "StaticTree",
    "Stats",
    "SubHyperplane",
    "Tests",
    "analysis",
    "boundary_paths",
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
    "visibility_polygon",
    "visibility_volume",
    "visible_sky",
]
