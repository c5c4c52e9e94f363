"""Partition trees and the sets they stand for, in one, two and three dimensions.

The same definitions hold on the line, in the plane and in space: a hyperplane has a minus side,
which is inside, and a plus side; a tree divides space by hyperplanes into convex regions; its
leaves are in or out of a set.
"""

from .drawing_dxf import load_dxf, save_dxf
from .drawing_svg import load_svg, save_svg
from .interval import Intervals
from .loops import Outline
from .objects import ObjectTree, merge, partition_tree, split_tree
from .pieces import NodeTable, Pieces
from .region import Region
from .slicing import plane_frame, slice_solid

__all__ = [
    "Intervals",
    "NodeTable",
    "ObjectTree",
    "Outline",
    "Pieces",
    "Region",
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
