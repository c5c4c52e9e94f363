"""The work of a ray on a tree that counts, step by step, and the tree after it."""

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
    """A step of a ray through a tree that counts.

    Parameters
    ----------
    kind : {"visit", "leaf", "test", "count", "divide"}
        An inner node or a leaf is visited; a facet is tested; a hit in a leaf is counted; a leaf is
        divided, after the ray.
    node : int
        The node.
    facet : int or None
        The facet that is tested or hit, or whose hyperplane divides the leaf.
    count : int
        T(v) after a visit; 1 or 0 for a test that hits or not; T(p) after a hit; of a division the
        number of the new leaf on the minus side, that on the plus side being the next.
    coplanar, minus, plus : tuple of int
        Of a division: the facets in the cut, and L(v) of the two new leaves.
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
    """The way of one ray through an `AdaptiveTree` or a `StaticTree`.

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
        """Say what the ray met and cost; `steps` shows the way."""
        counts = f"{self.nodes} nodes, {self.leaves} leaves, {self.tests} tests"
        return f"StabTrace({self.hits!r}, {counts}, {len(self.steps)} steps)"


def stab_step(row: "_StabRow") -> StabStep:
    """Return a step of the core's row."""
    kind, node, facet, count, lists = row
    parts = [tuple(part) for part in lists or ((), (), ())]
    return StabStep(kind, node, None if facet < 0 else facet, count, *parts)


@dataclass(frozen=True)
class LeafDivision:
    """A leaf was divided.

    Parameters
    ----------
    node : int
        The leaf, an inner node since then.
    facet : int
        The facet whose hyperplane its cut is.
    minus, plus : int
        The nodes made.
    """

    node: int
    facet: int
    minus: int
    plus: int


@dataclass(frozen=True, eq=False)
class StabNodes:
    """The nodes of an `AdaptiveTree` or `StaticTree` as they are now, in the order of their making.

    Parameters
    ----------
    visits : (n,) int64
        T(v).
    depth : (n,) int64
        Cuts above.
    minus, plus : (n,) int64
        The children, -1 for a leaf.
    offsets : (n + 1,) int64
        Node v holds ``facets[offsets[v]:offsets[v + 1]]``.
    facets : (k,) int64
        Of a leaf L(v), as a heap by T(p); of an inner node S(v), the facet that gave the cut first.
    hits : (k,) int64
        T(p) in the leaf; 0 in cuts.
    coefficients : tuple of tuple of int
        H(v) as whole numbers n, c with n·x = c, x in lattice steps, the minus side where the
        product is smaller; () for a leaf.
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
        """Return L(v) of a leaf, S(v) of an inner node."""
        return self.facets[self._range(node)]

    def counts(self, node: int) -> IndexArray:
        """Return T(p) of the facets of `held`."""
        return self.hits[self._range(node)]

    def facet_hits(self, count: int) -> IndexArray:
        """Return T(p) of the facets 0 to `count`, added up over the leaves."""
        return np.bincount(self.facets, weights=self.hits, minlength=count).astype(np.int64)

    @property
    def divisions(self) -> tuple[LeafDivision, ...]:
        """The divisions so far, in their order."""
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
            raise invalid_parameter(f"There are {len(self)} nodes, none is number {node}.")
        return node


def stab_nodes(arrays: "StabArrays") -> StabNodes:
    """Return the nodes of the core's columns."""
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
