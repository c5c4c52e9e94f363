"""The convex regions of nodes of adaptive and static trees."""

import numpy as np

from ..._types import FloatArray
from ...errors import invalid_parameter
from ...geometry.polytope import Polytope
from ...parameters import at_least, shown
from ..trees.node import RegionShape
from .trace import StabNodes


def region_of(
    nodes: StabNodes, node: int, corners: FloatArray, pitch: int, margin: float
) -> RegionShape:
    """Return the region R(v) of a node, clipped to the facets' box enlarged by a margin.

    The margin is in model units. Without facets, a box around the origin is used.

    Raises
    ------
    InvalidParameterError
        If the tree has no node with this index.
    """
    step = 10.0**pitch
    points = corners.reshape(-1, corners.shape[-1])
    if not len(points):
        points = np.zeros((1, corners.shape[-1]))
    low = np.floor((points.min(axis=0) - margin) / step).astype(np.int64) - 1
    high = np.ceil((points.max(axis=0) + margin) / step).astype(np.int64) + 1
    region: Polytope | None = Polytope.box(low.tolist(), high.tolist())
    for above, side in _path_from_root(nodes, node):
        region = region and region.clipped(nodes.coefficients[above], side)
    dimension = corners.shape[-1]
    if region is None:
        return [] if dimension == 3 else np.zeros((0, 2) if dimension == 2 else 0)
    return region.shape(step)


def _path_from_root(nodes: StabNodes, node: int) -> list[tuple[int, int]]:
    """Return a node's ancestors, root first, each with the side (-1, 1) that leads to the node."""
    if at_least(0, node, "node") >= len(nodes):
        raise invalid_parameter(
            f"There is no node {shown(node)}; the tree has nodes 0 to {len(nodes) - 1}."
        )
    parents = {}
    for side, children in ((-1, nodes.minus), (1, nodes.plus)):
        for parent in np.flatnonzero(children >= 0):
            parents[int(children[parent])] = int(parent), side
    way = []
    while node in parents:
        node, side = parents[node]
        way.append((node, side))
    return way[::-1]
