"""Trees over facets for ray casting: `AdaptiveTree` grows with the rays, `StaticTree` does not."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..._core import RayTree
from ..._types import IndexArray
from ...errors import core_errors, invalid_parameter
from ...geometry.arrays import doubles
from ...parameters import at_least, not_negative, pitch_exponent, seed_number
from ..trees.node import RegionShape
from ..trees.tree import MARGIN, PartitionTree
from .caster import Hits, hits_of
from .regions import region_of
from .targets import RayTargets, facets_from, ray_arrays
from .trace import LeafDivision, StabNodes, StabTrace, stab_nodes, stab_step


@dataclass(frozen=True, eq=False)
class Tests:
    """The first hits of rays, and the numbers of nodes and facets that each ray visited.

    Parameters
    ----------
    hits : Hits
    nodes : (n,) int64
        The number of inner nodes and leaves that the ray visited: the cost C(T) of the lecture
        notes.
    leaves : (n,) int64
        The number of leaves that the ray visited (stabbed).
    tests : (n,) int64
        The number of facets against which the ray was tested; in lists of more than 4096 facets
        only those whose boxes it meets.
    """

    __test__ = False  # not a test class

    hits: Hits
    nodes: IndexArray
    leaves: IndexArray
    tests: IndexArray


@dataclass(frozen=True)
class StabStats:
    """The numbers of nodes and fragments of a tree, and its counters of rays and visits.

    Parameters
    ----------
    nodes, leaves, depth : int
        The number of inner nodes and leaves together; the number of leaves; the largest number of
        cuts on the path to a leaf.
    fragments : int
        The number of facets and parts of facets in leaves and in cuts.
    subdivisions : int
        The number of leaves that have been divided.
    rays : int
        The number of rays that have been tested.
    visits : int
        The sum of the visit counters T(v) of all nodes.
    """

    nodes: int
    leaves: int
    depth: int
    fragments: int
    subdivisions: int
    rays: int
    visits: int


class StabTree:
    """The base class of `AdaptiveTree` and `StaticTree`, which are the ones to construct."""

    _facets: RayTargets
    _tree: RayTree
    _threshold: int | None = None

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Return facets, cuts and counters for pickling and copying; copies grow independently."""
        with core_errors():
            grown = self._tree.dump()
        return _regrown, (type(self), self._facets, self.pitch, self._threshold, grown)

    @property
    def dimension(self) -> int:
        """The dimension of the facets: 1, 2 or 3."""
        return self._facets.dimension

    @property
    def pitch(self) -> int:
        """The exponent of the lattice step, which is ``10**pitch`` model units."""
        return self._tree.pitch

    def __len__(self) -> int:
        """Return the number of inner nodes and leaves."""
        return self.stats().nodes

    def __repr__(self) -> str:
        """Return a text with the numbers of nodes and fragments."""
        stats = self.stats()
        return f"{type(self).__name__}({stats.nodes} nodes, {stats.fragments} fragments)"

    def stats(self) -> StabStats:
        """Return the numbers of nodes and fragments, and the counters of rays and visits."""
        return StabStats(**self._tree.stats())

    @property
    def nodes(self) -> StabNodes:
        """A snapshot of the nodes: the counters, facets, cuts and children of each node."""
        with core_errors():
            return stab_nodes(self._tree.nodes())

    def trace(self) -> tuple[LeafDivision, ...]:
        """Return the divisions of leaves that made the tree, in order."""
        return self.nodes.divisions

    def trace_ray(self, origin: Any, direction: Any) -> StabTrace:
        """Test one ray like `test_ray`, and return each step of its path.

        The ray increments the counters, and may make an `AdaptiveTree` grow.

        Parameters
        ----------
        origin, direction : (d,) array_like of float
        """
        first, second = ray_arrays(origin, direction, self.dimension)
        if len(first) != 1:
            raise invalid_parameter(
                f"A trace is made for one ray only, but there are {len(first)} rays; pass one"
                " origin and one direction."
            )
        with core_errors():
            columns, counts, rows = self._tree.test_watched(first.ravel(), second.ravel())
        steps = tuple(map(stab_step, rows))
        nodes, leaves, tests = counts.tolist()
        return StabTrace(hits_of(self._facets, columns), nodes, leaves, tests, steps)

    def region(self, node: int, margin: float | None = None) -> RegionShape:
        """Return the region R(v) of a node, clipped to the facets' box enlarged by a margin.

        Parameters
        ----------
        node : int
        margin : float, optional
            In model units; by default a twentieth of the largest extent.

        Returns
        -------
        (2,) float64, (k, 2) float64 or list of (k, 3) float64
            Ends, corners or faces as from `PartitionTree.region`; exact corners, rounded to
            doubles.
        """
        reach = self._margin() if margin is None else not_negative(margin, "margin")
        return region_of(self.nodes, node, self._facets.corners, self.pitch, reach)

    def _margin(self) -> float:
        corners = self._facets.corners.reshape(-1, self.dimension)
        return MARGIN * float(np.ptp(corners, axis=0).max()) if len(corners) else 1.0

    def to_partition_tree(self) -> PartitionTree:
        """Return the partition tree with the same cuts, over the same facets.

        A facet in a leaf becomes a node, since a `PartitionTree` has no facets in leaves.

        Raises
        ------
        InvalidParameterError
            If a leaf stores several facets; cast more rays to divide it, or make a `StaticTree`.
        """
        tree = PartitionTree(
            self._facets.corners.reshape(-1) if self.dimension == 1 else self._facets.corners,
            "first",
            pitch=self.pitch,
            degenerate="drop",
        )
        pieces = {int(facet): k for k, facet in enumerate(tree.core.piece_sources())}
        return tree.with_cuts([(-1, pieces[facet]) for facet in _pivots(self.nodes)])

    def test_ray(self, origins: Any, directions: Any) -> Tests:
        """Return the first hit and the cost of each ray, in the given order.

        Hits equal those of `RayCaster.first_hit` on the same lattice. All rays are checked before
        the first is tested.

        Parameters
        ----------
        origins, directions : (n, d) or (d,) array_like of float

        Raises
        ------
        InvalidMeshError, LimitError
            As for `RayCaster.first_hit`.
        """
        first, second = ray_arrays(origins, directions, self.dimension)
        with core_errors():
            columns, counts = self._tree.test(first.ravel(), second.ravel())
        rows = counts.reshape(-1, 3)
        nodes, leaves, tests = (np.ascontiguousarray(rows[:, k]) for k in range(3))
        return Tests(hits_of(self._facets, columns), nodes, leaves, tests)


class AdaptiveTree(StabTree):
    """A BSP tree over facets that divides its leaves where rays visit them often.

    It starts as one preliminary leaf v with all facets in its list L(v). Each ray increments the
    visits T(v) of nodes and, in the leaves it visits, the hits T(p) of facets. A leaf visited more
    than `threshold` times is divided by the hyperplane of the facet with most hits (L(v) is a heap;
    ties go to the first of the input). The other facets of the leaf are split exactly, and the
    parts of a split facet inherit its counter. So facets that are hit often are near the root.

    Threads can share an object and cast rays concurrently; they wait for each other only to count
    hits and to divide a leaf. The growth of the tree depends on the order of rays; hits do not. In
    lists of more than 4096 facets, only those whose boxes a ray meets are tested. Pickles and
    copies keep the tree with its counters, and continue to grow from there.

    Parameters
    ----------
    facets : array_like, Solid, or mesh
        As for `RayCaster`.
    threshold : int
        The largest number of visits of an undivided leaf, at least 0.
    pitch : int, optional
        As for `RayCaster`.

    Raises
    ------
    InvalidMeshError, LimitError
        As for `RayCaster`, and for a threshold that is no natural number.

    Notes
    -----
    Ar, Montag, Tal 2002, "Deferred, self-organizing BSP trees"; lecture notes, "Augmented
    BSP-Tree".

    Examples
    --------
    >>> from bspcsg import bsp
    >>> tree = bsp.AdaptiveTree([[[0, 0], [0, 1]], [[1, 0], [1, 1]], [[2, 0], [2, 1]]], threshold=3)
    >>> tests = tree.test_ray([[-1.0, 0.5]] * 5, [1.0, 0.0])
    >>> tests.tests.tolist(), tests.nodes.tolist()
    ([3, 3, 3, 3, 1], [1, 1, 1, 1, 2])
    """

    def __init__(self, facets: Any, *, threshold: int = 64, pitch: int | None = None) -> None:
        self._facets = facets_from(facets)
        self._threshold = min(at_least(0, threshold, "threshold"), 2**63)
        step = self._facets.pitch if pitch is None else pitch_exponent(pitch)
        with core_errors():
            self._tree = RayTree(
                self.dimension,
                self._facets.corners.ravel(),
                step,
                threshold=self._threshold,
            )


class StaticTree(StabTree):
    """An autopartition that is built completely at once and that rays do not change.

    Every leaf stores at most one facet; only the coplanar set of a cut may have several. Each cut
    is the hyperplane of the facet in its region that comes first in the order.

    Parameters
    ----------
    facets : array_like, Solid, or mesh
        As for `RayCaster`.
    order : "given", "random", or (n,) array_like of int
        The order of the facets, first cut first; an array must be a permutation.
    seed : int
        The seed of the random order.
    pitch : int, optional
        As for `AdaptiveTree`.
    max_nodes : int
        The largest number of nodes; the construction raises an error if the tree needs more.

    Raises
    ------
    InvalidMeshError
        As for `RayCaster`, and for an order that is no permutation.
    LimitError
        As for `RayCaster`, and if the tree needs more nodes.
    """

    def __init__(
        self,
        facets: Any,
        *,
        order: Any = "random",
        seed: int = 0,
        pitch: int | None = None,
        max_nodes: int = 4_000_000,
    ) -> None:
        self._facets = facets_from(facets)
        permutation = _permutation(order, seed_number(seed), len(self._facets.corners))
        step = self._facets.pitch if pitch is None else pitch_exponent(pitch)
        # The heap pops the facet with most hits first.
        hits = np.zeros(len(permutation), dtype=np.int64)
        hits[permutation] = np.arange(len(permutation), 0, -1)
        with core_errors():
            self._tree = RayTree(
                self.dimension,
                self._facets.corners.ravel(),
                step,
                hits=hits.tolist(),
                limit=min(at_least(1, max_nodes, "max_nodes"), _UNLIMITED),
            )


#: A number of nodes that does not fit in memory, for no limit.
_UNLIMITED = 2**62


def _pivots(nodes: StabNodes) -> Iterator[int]:
    """Yield the facets whose hyperplanes are the cuts of the equal `PartitionTree`, in preorder.

    They include facets that are alone in a leaf; a leaf with several facets is an error.
    """
    pending = [0]
    while pending:
        node = pending.pop()
        held = nodes.held(node)
        if not nodes.is_leaf(node):
            yield int(held[0])
            pending += [int(nodes.plus[node]), int(nodes.minus[node])]
        elif len(held) > 1:
            raise invalid_parameter(
                f"Leaf {node} contains {len(held)} facets, but at most one is allowed here; build"
                " the tree with at most one facet in each leaf."
            )
        else:
            yield from held.tolist()


def _regrown(
    kind: type[StabTree], facets: RayTargets, pitch: int, threshold: int | None, grown: bytes
) -> StabTree:
    tree = kind.__new__(kind)
    tree._facets, tree._threshold = facets, threshold
    with core_errors():
        corners = facets.corners.ravel()
        tree._tree = RayTree(facets.dimension, corners, pitch, threshold=threshold, grown=grown)
    return tree


def _permutation(order: Any, seed: int, count: int) -> IndexArray:
    if isinstance(order, str):
        if order == "given":
            return np.arange(count)
        if order == "random":
            return np.random.default_rng(seed).permutation(count)
        raise invalid_parameter(
            f"Unknown order {order!r}; use 'given', 'random' or an array of facet indices."
        )
    places = doubles(
        order, invalid_parameter("order must be 'given', 'random' or an array of facet indices.")
    )
    if places.shape != (count,) or (np.sort(places) != np.arange(count)).any():
        raise invalid_parameter(
            f"order must contain each of the facet indices from 0 to {count - 1} exactly once."
        )
    return places.astype(np.int64)
