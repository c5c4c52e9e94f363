"""Step-by-step traces of rays in adaptive and static trees, and snapshots of their nodes."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from ..._types import IndexArray
from ...errors import invalid_parameter
from .caster import Hits

if TYPE_CHECKING:
    from ..._core import StabArrays, _StabRow


@dataclass(frozen=True)
class StabStep:
    """A step of a ray through an `AdaptiveTree` or a `StaticTree`.

    Parameters
    ----------
    kind : {"visit", "leaf", "test", "count", "divide"}
        An inner node or a leaf is visited; a facet is tested; a hit in a leaf is counted; a leaf is
        divided, after the ray.
    node : int
        The index of the inner node or leaf.
    facet : int or None
        The facet that is tested or hit, or whose hyperplane divides the leaf.
    count : int
        The node's visit counter T(v) after a visit; 1 or 0 for a test that hits or misses; the
        facet's hit counter T(p) after a hit; for a division, the index of the new leaf on the minus
        side (the leaf on the plus side has the next index).
    coplanar, minus, plus : tuple of int
        For a division: the facets in the cut, and the facets of each of the two new leaves.
    """

    kind: Literal["visit", "leaf", "test", "count", "divide"]
    node: int
    facet: int | None
    count: int
    coplanar: tuple[int, ...] = ()
    minus: tuple[int, ...] = ()
    plus: tuple[int, ...] = ()


@dataclass(frozen=True, eq=False)
class StabTrace:
    """The path of one ray through an `AdaptiveTree` or a `StaticTree`.

    Parameters
    ----------
    hits : Hits
        One row.
    nodes, leaves, tests : int
        As in `Tests`.
    steps : tuple of StabStep
    """

    hits: Hits
    nodes: int
    leaves: int
    tests: int
    steps: tuple[StabStep, ...]

    def __repr__(self) -> str:
        """Return a text with the hit and the numbers of nodes, leaves, tests and steps."""
        counts = f"{self.nodes} nodes, {self.leaves} leaves, {self.tests} tests"
        return f"StabTrace({self.hits!r}, {counts}, {len(self.steps)} steps)"


def stab_step(row: "_StabRow") -> StabStep:
    """Return the `StabStep` for one row of a trace of the core."""
    kind, node, facet, count, lists = row
    parts = [tuple(part) for part in lists or ((), (), ())]
    return StabStep(kind, node, None if facet < 0 else facet, count, *parts)


@dataclass(frozen=True)
class LeafDivision:
    """The division of a leaf of an adaptive or static tree into two leaves.

    Parameters
    ----------
    node : int
        The index of the divided leaf, which became an inner node.
    facet : int
        The facet whose hyperplane is the cut.
    minus, plus : int
        The indices of the new leaves on the minus and the plus side.
    """

    node: int
    facet: int
    minus: int
    plus: int


@dataclass(frozen=True, eq=False)
class StabNodes:
    """A snapshot of the nodes of an `AdaptiveTree` or `StaticTree`, in order of creation.

    Parameters
    ----------
    visits : (n,) int64
        The counter T(v): how many rays visited the node.
    depth : (n,) int64
        The number of cuts on the path from the root to the node.
    minus, plus : (n,) int64
        The children on the minus and plus side, -1 for a leaf.
    offsets : (n + 1,) int64
        Node v stores ``facets[offsets[v]:offsets[v + 1]]``.
    facets : (k,) int64
        L(v) of a leaf, as a heap by T(p); S(v) of an inner node, with the facet of the cut first.
    hits : (k,) int64
        The counter T(p): how often rays hit the facet in its leaf; 0 for facets in cuts.
    coefficients : tuple of tuple of int
        The hyperplane H(v) as integers (*n, c) with n·x = c, x in lattice steps, and the minus side
        n·x < c; () for a leaf.
    """

    visits: IndexArray
    depth: IndexArray
    minus: IndexArray
    plus: IndexArray
    offsets: IndexArray
    facets: IndexArray
    hits: IndexArray
    coefficients: tuple[tuple[int, ...], ...]

    def __len__(self) -> int:
        """Return the number of nodes."""
        return len(self.visits)

    def is_leaf(self, node: int) -> bool:
        """Return true if a node is a leaf."""
        return bool(self.minus[self._checked(node)] < 0)

    def held(self, node: int) -> IndexArray:
        """Return a node's facets: the list L(v) of a leaf, or the set S(v) of an inner node."""
        return self.facets[self._range(node)]

    def counts(self, node: int) -> IndexArray:
        """Return the hit counter T(p) of each facet that `held` returns for a node."""
        return self.hits[self._range(node)]

    def facet_hits(self, count: int) -> IndexArray:
        """Return the hits T(p) of facets 0 to `count` - 1, each summed over all leaves."""
        return np.bincount(self.facets, weights=self.hits, minlength=count).astype(np.int64)

    @property
    def divisions(self) -> tuple[LeafDivision, ...]:
        """The divisions of leaves, in the order in which they happened."""
        inner = np.flatnonzero(self.minus >= 0)
        order = inner[np.argsort(self.minus[inner], kind="stable")]
        return tuple(
            LeafDivision(int(v), int(self.held(int(v))[0]), int(self.minus[v]), int(self.plus[v]))
            for v in order
        )

    def _range(self, node: int) -> slice:
        at = self._checked(node)
        return slice(int(self.offsets[at]), int(self.offsets[at + 1]))

    def _checked(self, node: int) -> int:
        if not 0 <= node < len(self):
            raise invalid_parameter(
                f"There is no node {node}; the trace has nodes 0 to {len(self) - 1}."
            )
        return node


def stab_nodes(arrays: "StabArrays") -> StabNodes:
    """Return the `StabNodes` for the core's arrays of nodes."""
    return StabNodes(
        visits=arrays["visits"],
        depth=arrays["depth"],
        minus=arrays["minus"],
        plus=arrays["plus"],
        offsets=arrays["offsets"],
        facets=arrays["facets"],
        hits=arrays["hits"],
        coefficients=tuple(map(tuple, arrays["hyperplanes"])),
    )
