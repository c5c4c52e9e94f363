"""Measurements of partition trees against the bounds in the lecture notes.

Fragments of n disjoint segments under a random order: at most n + 2 n ln n expected. The
probability that the line of s_i cuts s_j: at most 1 / (dist(s_i, s_j) + 2), with equality if only
the segments between s_i and s_j can separate them. Construction: n² log n. In space the worst case
is quadratic (`ruled_grid`), surfaces are near linear.

Paterson, Yao 1990, "Efficient binary space partitions for hidden-surface removal and solid
modeling"; de Berg et al., Computational Geometry, section 12.3.
"""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, fields
from fractions import Fraction
from typing import Any

import numpy as np

from ..._types import FloatArray, IndexArray
from ...errors import InvalidMeshError, invalid_parameter
from ...parameters import at_least
from .tree import PartitionTree

#: The side of the square in which random segments with integer coordinates start.
_SQUARE = 1 << 24


@dataclass(frozen=True)
class Growth:
    """The size and build time of the trees over one scene, compared with a bound.

    Parameters
    ----------
    scene : str
    n : int
        The number of facets of the scene.
    fragments : float
        The number of fragments, on average over the trials.
    bound : float
        The bound of `fragments`: n + 2 n ln n for segments, n² for the grid, n for surfaces.
    ratio : float
        ``fragments / bound``.
    depth : float
        The depth of the tree, on average over the trials.
    seconds : float
        The time of one construction, on average over the trials.
    work : float
        The time of one construction in nanoseconds, divided by n² ln n.
    """

    scene: str
    n: int
    fragments: float
    bound: float
    ratio: float
    depth: float
    seconds: float
    work: float


class GrowthTable(list[Growth]):
    """A list of `Growth` rows that prints as a table."""

    def __str__(self) -> str:
        """Return the table as text: a heading and one line for each scene."""
        names = [field.name for field in fields(Growth)]
        cells = [names] + [[_cell(value) for value in asdict(row).values()] for row in self]
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        lines = (zip(row, widths, strict=True) for row in cells)
        return "\n".join("  ".join(cell.rjust(width) for cell, width in line) for line in lines)


def growth_table(
    segments: Sequence[int] = (100, 200, 400, 800),
    grids: Sequence[int] = (16, 32, 64, 128),
    meshes: Sequence[Any] = (),
    *,
    trials: int = 5,
    seed: int = 0,
) -> GrowthTable:
    """Measure the fragments and the build time of trees over scenes of growing size.

    Parameters
    ----------
    segments : sequence of int
        The numbers of segments of random scenes of disjoint segments, built in random order.
    grids : sequence of int
        The even numbers of strips of scenes `ruled_grid`, built in random order.
    meshes : sequence of object
        Surfaces, of any type that `PartitionTree.from_mesh` takes, built with axis-parallel cuts on
        top.
    trials : int
        The number of constructions for each row, each with a seed of its own.
    seed : int

    Returns
    -------
    list of Growth
        As a string it is a table.
    """
    count = at_least(1, trials, "trials")
    table = GrowthTable()
    for n in segments:
        scene = disjoint_segments(n, seed)
        bound = n + 2 * n * math.log(max(n, 1))
        table.append(_measured("disjoint segments", scene, bound, count, seed))
    for n in grids:
        table.append(_measured("ruled grid", ruled_grid(n), float(n * n), count, seed))
    for mesh in meshes:
        table.append(_surface(mesh, count, seed))
    return table


def _measured(name: str, facets: Any, bound: float, trials: int, seed: int) -> Growth:
    def tree_of(k: int) -> PartitionTree:
        return PartitionTree(facets, "random", seed=seed + k)

    return _growth(name, len(facets), bound, trials, tree_of)


def _surface(mesh: Any, trials: int, seed: int) -> Growth:
    def tree_of(k: int) -> PartitionTree:
        return PartitionTree.from_mesh(mesh, "random", seed=seed + k)

    n = len(tree_of(0).core.lattice()[1]) - 1
    return _growth("surface", n, float(n), trials, tree_of)


def _growth(
    name: str, n: int, bound: float, trials: int, tree_of: Callable[[int], PartitionTree]
) -> Growth:
    start = time.perf_counter()
    trees = [tree_of(k) for k in range(trials)]
    seconds = (time.perf_counter() - start) / trials
    figures = [tree.stats() for tree in trees]
    fragments = float(np.mean([s.fragments for s in figures]))
    depth = float(np.mean([s.depth for s in figures]))
    steps = n * n * math.log(max(n, 2))
    ratio = fragments / bound if bound else 0.0
    work = 1e9 * seconds / steps if n else 0.0
    return Growth(name, n, fragments, bound, ratio, depth, seconds, work)


def _cell(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


# What rays cost


@dataclass(frozen=True, eq=False)
class VisitBound:
    """The cost of rays, compared with the bound C(T) ≤ depth(T) · stabbed leaves of the notes.

    The level of a leaf is the number of nodes on its path, and every node that a ray visits is
    above a leaf that it stabs.

    Parameters
    ----------
    cost : (n,) int64
        C(T) of each ray: the number of inner nodes and leaves visited.
    leaves : (n,) int64
        The number of leaves that each ray stabs.
    levels : int
        depth(T): the number of nodes on the longest path from the root to a leaf, both included.
    """

    cost: IndexArray
    leaves: IndexArray
    levels: int

    @property
    def bound(self) -> IndexArray:
        """The largest possible cost of each ray, ``levels * leaves``, (n,) int64."""
        most: IndexArray = self.levels * self.leaves
        return most

    @property
    def holds(self) -> bool:
        """True if no ray costs more than its bound."""
        return bool((self.cost <= self.bound).all())


def visit_bound(tree: PartitionTree, origins: Any, directions: Any) -> VisitBound:
    """Cast rays through a tree, and compare the cost of each with depth · stabbed leaves.

    Parameters
    ----------
    tree : PartitionTree
    origins, directions
        As for `PartitionTree.test_ray`.
    """
    costs = tree.test_ray(origins, directions)
    return VisitBound(costs.cost, costs.leaves, tree.stats().depth + 1)


# Scenes


def disjoint_segments(n: int, seed: int = 0) -> FloatArray:
    """Return (n, 2, 2) random segments with whole coordinates, no two of which meet.

    The segments are about as long as neighbours are apart.
    """
    count = at_least(0, n, "n")
    random = np.random.default_rng(seed)
    reach = max(int(_SQUARE / math.sqrt(max(count, 1))), 2)
    kept = np.zeros((count, 2, 2), dtype=np.int64)
    found = 0
    while found < count:
        start = random.integers(0, _SQUARE, 2)
        end = start + random.integers(-reach, reach + 1, 2)
        if (start != end).any() and not _do_meet(kept[:found], np.stack([start, end])).any():
            kept[found] = start, end
            found += 1
    return kept.astype(np.float64)


def ruled_grid(n: int) -> FloatArray:
    """Return (n, 4, 3) thin strips whose every partition has a quadratic number of fragments.

    The strips follow the two rulings of the hyperbolic paraboloid z = xy: half of them the lines y
    = i, the other half, just below, the lines x = j. At a crossing, only planes close to the
    tangent plane separate the two strips without a cut, and such a plane crosses all other strips
    of this row and column.

    Parameters
    ----------
    n : int
        The number of strips, even.

    Notes
    -----
    Paterson, Yao 1990, section 5, for the bound; Chazelle 1984, "Convex partitions of polyhedra",
    for the surface.
    """
    if at_least(0, n, "n") % 2:
        raise invalid_parameter(f"n must be even, not {n}.")
    k = n // 2
    gap, height = 1 / 8, 1 / 32
    strips = []
    for i in range(1, k + 1):
        for lift, swap in ((gap, False), (0.0, True)):
            ends = [(0.0, lift), (k + 1.0, i * (k + 1.0) + lift)]
            low = [(x, float(i), z) for x, z in ends]
            high = [(x, y, z + height) for x, y, z in reversed(low)]
            corners = np.array(low + high)
            strips.append(corners[:, [1, 0, 2]] if swap else corners)
    return np.array(strips).reshape(-1, 4, 3)


# Who cuts whom


@dataclass(frozen=True)
class CutFrequency:
    """How often the line of one segment cuts another segment, over random orders.

    Parameters
    ----------
    cutter, cut : int
        The indices of the segment whose line cuts and of the segment that is cut.
    distance : int
        The number of segments between the two on the cutter's line, see `shielding_distance`.
    bound : float
        ``1 / (distance + 2)``.
    frequency : float
        The fraction of the random orders in which the cut happens.
    """

    cutter: int
    cut: int
    distance: int
    bound: float
    frequency: float


def cut_frequencies(segments: Any, trials: int = 1000, seed: int = 0) -> list[CutFrequency]:
    """Count over random orders how often each segment's line cuts each other segment.

    Parameters
    ----------
    segments : (n, 2, 2) array_like
        Whole numbers below 2^25 in magnitude, no two segments crossing.
    trials : int
        The number of random orders, with the seeds ``seed, seed + 1, …``.

    Returns
    -------
    list of CutFrequency
        One row for each ordered pair of segments with finite distance, in the order of the indices.
    """
    count = at_least(1, trials, "trials")
    whole = _whole(segments)
    hits = np.zeros((len(whole), len(whole)), dtype=np.int64)
    for k in range(count):
        tree = PartitionTree(whole.astype(np.float64), "random", seed=seed + k, pitch=0)
        nodes, cut = tree.splits.T
        pairs = np.unique(np.column_stack([tree.arrays["cut"][nodes, 1], cut]), axis=0)
        hits[pairs[:, 0], pairs[:, 1]] += 1
    rows = []
    for i in range(len(whole)):
        distances = shielding_distance(whole, i)
        for j in np.flatnonzero(distances >= 0):
            near = int(distances[j])
            rows.append(CutFrequency(i, int(j), near, 1 / (near + 2), hits[i, j] / count))
    return rows


def shielding_distance(segments: Any, i: int) -> IndexArray:
    """Return dist(s_i, s_j) for all j: the number of segments that s_i's line crosses before s_j.

    Parameters
    ----------
    segments : (n, 2, 2) array_like
        Whole numbers below 2^25 in magnitude, no two segments crossing.
    i : int

    Returns
    -------
    (n,) int64
        -1 stands for infinity: the line of s_i does not cross the relative interior of s_j. A
        segment that the line only touches, or that lies in the line, does not count.

    Notes
    -----
    The distance of the lecture notes and of de Berg et al., section 12.3. In a random order of s_i,
    s_j and the `dist` segments between them, s_i comes first with probability 1 / (dist + 2); if
    one of the segments between comes first, it shields s_j from the line of s_i.
    """
    whole = _whole(segments)
    (x, y), end = whole[i]
    u, v = int(end[0] - x), int(end[1] - y)
    places: list[tuple[int, tuple[int, int]]] = []
    for j, ((ax, ay), (bx, by)) in enumerate(whole.tolist()):
        a = u * (ay - int(y)) - v * (ax - int(x))
        b = u * (by - int(y)) - v * (bx - int(x))
        if a * b < 0:
            # The line meets s_j at top / (a - b) along s_i's direction.
            top = a * ((bx - int(x)) * u + (by - int(y)) * v)
            top -= b * ((ax - int(x)) * u + (ay - int(y)) * v)
            places.append((j, (top, a - b) if a > b else (-top, b - a)))
    return _counted(len(whole), places, u * u + v * v)


def _counted(count: int, places: list[tuple[int, tuple[int, int]]], length: int) -> IndexArray:
    """Return for each crossed segment the number of segments crossed between it and the cutter.

    `places` has the index of each crossed segment and its position along the line as a fraction; -1
    for segments that are not crossed.
    """
    distances: IndexArray = np.full(count, -1, dtype=np.int64)
    along = [(Fraction(top, bottom), j) for j, (top, bottom) in places]
    for ahead in (True, False):
        side = [(t if ahead else -t, j) for t, j in along if (t >= length if ahead else t <= 0)]
        ranks = {t: rank for rank, (t, _) in reversed(list(enumerate(sorted(side))))}
        for t, j in side:
            distances[j] = ranks[t]
    return distances


def _whole(segments: Any) -> IndexArray:
    array = np.asarray(segments)
    whole: IndexArray = array.astype(np.int64)
    if whole.ndim != 3 or whole.shape[1:] != (2, 2) or not np.array_equal(whole, array):
        message = "segments must be an array of integers of shape (n, 2, 2)."
        raise InvalidMeshError(message, "shape")
    if whole.size and np.abs(whole).max() >= 1 << 25:
        raise invalid_parameter(
            "The coordinates of the segments must be below 2^25 in magnitude; scale them down."
        )
    return whole


def _do_meet(segments: IndexArray, other: IndexArray) -> Any:
    """Return for each segment whether it has a point in common with `other`, as (n,) bool.

    Exact for coordinates below 2^25.
    """
    p, q = segments[:, 0], segments[:, 1]
    r, s = other

    def turn(a: Any, b: Any, c: Any) -> Any:
        d, e = b - a, c - a
        return np.sign(d[..., 0] * e[..., 1] - d[..., 1] * e[..., 0])

    overlap = (np.minimum(p, q) <= np.maximum(r, s)) & (np.maximum(p, q) >= np.minimum(r, s))
    across = turn(p, q, r) * turn(p, q, s) <= 0
    return across & (turn(r, s, p) * turn(r, s, q) <= 0) & overlap.all(axis=1)
