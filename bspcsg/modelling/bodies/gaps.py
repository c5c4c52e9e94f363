"""The distance of solids, and their nearest points."""

import math
from fractions import Fraction

import numpy as np

from ..._types import FloatArray, IndexArray
from ...errors import LimitError, invalid_parameter
from ...geometry.hyperplane import exact_number
from ...mesh.box_tree import BoxTree, NearPairSearch, squared_gaps
from ...parameters import instance_of
from ...solid.ledger import uncounted
from ...solid.solid import Solid, surfaces_meet
from .triangle_distance import least_gaps, nearest_points

#: The largest error of a computed distance, relative to the largest absolute coordinate. It allows
#: for about 50 roundings of doubles.
_NOISE = 1e-14

#: A bound of the distance between a solid and its mesh in doubles, relative to the largest absolute
#: coordinate.
_ROUNDING = 1e-9

#: The largest number of pairs of triangles whose distances are compared in fractions because
#: doubles cannot tell which is less. Each takes about a millisecond.
_MAX_EXACT_PAIRS = 64

#: The number of pairs of triangles whose distances are computed in one batch, which bounds the
#: memory to about 100 MB.
_PAIRS_PER_BATCH = 1 << 16


@uncounted
def min_gap(solid: Solid, other: Solid) -> float:
    """Return the least distance between two solids; 0 if they touch, infinity if one is empty."""
    if solid.is_empty or instance_of(Solid, other, "other").is_empty:
        return math.inf
    found = _nearest(solid, other)
    return 0.0 if found is None else math.sqrt(found[0])


@uncounted
def closest_points(solid: Solid, other: Solid) -> tuple[FloatArray, FloatArray]:
    """Return the point of each solid that is nearest to the other solid, two (3,) arrays."""
    if solid.is_empty or instance_of(Solid, other, "other").is_empty:
        raise invalid_parameter(
            "One of the two solids is empty, so it has no closest point; pass solids that are not"
            " empty."
        )
    found = _nearest(solid, other)
    if found is None:
        common = _common_point(solid & other)
        return common, common.copy()
    return _rounded(found[1]), _rounded(found[2])


def _common_point(common: Solid) -> FloatArray:
    vertices = common.vertices
    if len(vertices) == 0:
        message = (
            "The solids overlap, but their common part is so thin that no point inside it can be"
            " represented in doubles."
        )
        raise LimitError(message, "too_large")
    return np.array(vertices[0])


@uncounted
def intersects(solid: Solid, other: Solid) -> bool:
    """Return True if two solids have a point in common, also if they only touch."""
    if solid.is_empty or instance_of(Solid, other, "other").is_empty:
        return False
    return not _are_boxes_apart(solid, other) and (
        not solid.isdisjoint(other) or surfaces_meet(solid, other)
    )


def _are_boxes_apart(solid: Solid, other: Solid) -> bool:
    """Return True if the bounding boxes of two solids lie apart by more than rounding errors."""
    (low, high), (low_b, high_b) = (_box(one) for one in (solid, other))
    doubt = _ROUNDING * max(float(np.abs(box).max()) for box in (low, high, low_b, high_b))
    return bool((low > high_b + doubt).any() or (low_b > high + doubt).any())


def _box(solid: Solid) -> FloatArray:
    bounds = solid.bounds
    return np.zeros((2, 3)) if bounds is None else bounds


def _nearest(solid: Solid, other: Solid) -> tuple[Fraction, FloatArray, FloatArray] | None:
    """Return the squared distance of two solids and their nearest points, all as fractions.

    None means that the interiors of the solids overlap.
    """
    if not solid.isdisjoint(other):
        return None
    triangles = [_corners(one) for one in (solid, other)]
    first, second = _candidates(*triangles)
    corners = (_exact(triangles[0][first]), _exact(triangles[1][second]))
    gaps, p, q = nearest_points(*corners)
    best = min(range(len(gaps)), key=lambda k: (gaps[k], k))
    scale = max(float(np.abs(one).max()) for one in triangles)
    if 0 < gaps[best] <= _bounded(0.0, scale) and surfaces_meet(solid, other):
        # The solids touch at points that doubles cannot represent.
        return Fraction(0), p[best], p[best]
    return gaps[best], p[best], q[best]


def _corners(solid: Solid) -> FloatArray:
    mesh = solid.normalized().to_mesh()
    corners: FloatArray = mesh.vertices[mesh.faces]
    return corners


def _candidates(first: FloatArray, second: FloatArray) -> tuple[IndexArray, IndexArray]:
    """Return the pairs of triangles, one of each list, that may be nearest, up to rounding.

    A pair is a row of `first` and a row of `second`. The pairs, at most `_MAX_EXACT_PAIRS`, are
    sorted by computed distance.
    """
    scale = max(float(np.abs(first).max()), float(np.abs(second).max()))
    trees = BoxTree.over(first), BoxTree.over(second)
    search = NearPairSearch(*trees, _bounded(_gap_upper_bound(first, second), scale))
    boxes = [(corners.min(axis=1), corners.max(axis=1)) for corners in (first, second)]
    best, found = np.inf, []
    for leaves in search.leaves():
        pairs = _pairs(trees, leaves)
        for k in range(0, len(pairs[0]), _PAIRS_PER_BATCH):
            i, j = (one[k : k + _PAIRS_PER_BATCH] for one in pairs)
            (low, high), (low_b, high_b) = boxes
            near = squared_gaps(low[i], high[i], low_b[j], high_b[j]) <= search.limit
            i, j = i[near], j[near]
            near = least_gaps(first[i], second[j]) <= search.limit
            i, j = i[near], j[near]
            if len(i):
                gaps, _, _ = nearest_points(first[i], second[j])
                best = min(best, float(gaps.min()))
                search.limit = min(search.limit, _bounded(best, scale))
                kept = gaps <= search.limit
                found.append((gaps[kept], i[kept], j[kept]))
    gaps, i, j = (np.concatenate(column) for column in zip(*found, strict=True))
    order = np.lexsort((j, i, gaps))
    order = order[gaps[order] <= _bounded(best, scale)][:_MAX_EXACT_PAIRS]
    return i[order], j[order]


def _bounded(gap: float, scale: float) -> float:
    """Return the squared distance `gap`, enlarged by the largest rounding error of doubles.

    `scale` is the largest absolute coordinate.
    """
    return (math.sqrt(gap) + _NOISE * scale) ** 2


def _gap_upper_bound(first: FloatArray, second: FloatArray) -> float:
    """Return an upper bound of the squared distance of two lists of triangles.

    It is the squared distance between a corner of one list and a nearby corner of the other.
    """
    points, others = first.reshape(-1, 3), second.reshape(-1, 3)
    point = others.mean(axis=0)
    gap = np.inf
    for cloud in (points, others, points, others):
        gaps = np.einsum("ij,ij->i", cloud - point, cloud - point)
        point, gap = cloud[int(gaps.argmin())], float(gaps.min())
    return gap


def _pairs(trees: tuple[BoxTree, BoxTree], leaves: IndexArray) -> tuple[IndexArray, IndexArray]:
    """Return all pairs of a triangle in one leaf and a triangle in the other, for pairs of leaves.

    The (n, 2) `leaves` are the leaf numbers in the first and the second tree.
    """
    members, rows = trees[0].members(leaves[:, 0])
    others, other_rows = trees[1].members(leaves[:, 1])
    counts = np.bincount(other_rows, minlength=len(leaves))
    starts = np.cumsum(counts) - counts
    i = np.repeat(members, counts[rows])
    within = np.arange(len(i)) - np.repeat(np.cumsum(counts[rows]) - counts[rows], counts[rows])
    return i, others[np.repeat(starts[rows], counts[rows]) + within]


def _exact(corners: FloatArray) -> FloatArray:
    """Return coordinates as fractions equal to their shortest decimals, such as 1/10 for 0.1."""
    numbers = [exact_number(x) for x in corners.ravel().tolist()]
    return np.array(numbers, dtype=object).reshape(corners.shape)


def _rounded(point: FloatArray) -> FloatArray:
    return np.array([float(x) for x in point])
