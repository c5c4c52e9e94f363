"""Traces of the construction of a tree over facets, and of points and rays in it.

The core records a trace while it works; replaying the trace gives the same tree and the same
result. Traces number the convex pieces of facets; if no facet is a concave polygon, these are the
numbers of the facets. `Construction.facets` has the facet of each piece.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

from ..._types import FloatArray, IndexArray
from .node import Leaf, Node, Side

if TYPE_CHECKING:
    from ..._core import _DivisionRow, _RayEventRow
    from .tree import PartitionTree

#: Why a hyperplane divides a region: the name of the policy that chose it; "median" for an
#: axis-parallel cut through a region with many facets; "given" for a cut that the caller, a file or
#: an earlier tree gave; "asked" for the choice of a callable policy.
Reason: TypeAlias = Literal[
    "first",
    "random",
    "least-splits",
    "balanced",
    "weighted",
    "least-cost",
    "end-points",
    "median",
    "given",
    "asked",
]

_SIDES: dict[int, Side | None] = {-1: "minus", 0: None, 1: "plus"}


@dataclass(frozen=True)
class Candidate:
    """A hyperplane that may divide a region, with the figures by which a policy compares it.

    Parameters
    ----------
    piece : int
        The convex piece of a facet in whose hyperplane the candidate lies.
    minus, plus : int
        The numbers of pieces in the region with a part on the minus side and on the plus side.
    splits : int
        The number of pieces with parts on both sides.
    score : float
        The value that the policy minimises; of equal scores the first candidate wins.
    """

    piece: int
    minus: int
    plus: int
    splits: int
    score: float


@dataclass(frozen=True)
class Division:
    """The division of a region by the hyperplane of a new node.

    Parameters
    ----------
    node : int
        The index of the new node in preorder.
    parent : int or None
        The index of the parent node; None for the root.
    side : {"minus", "plus"} or None
        The side of the parent's hyperplane on which the region lies; None for the root.
    depth : int
        The number of hyperplanes on the path from the root to the region.
    pivot : int or None
        The convex piece whose hyperplane divides the region; None if none does.
    axis : tuple of int or None
        For an axis-parallel cut: the axis perpendicular to it, and its position in lattice steps.
    own : int or None
        For a hyperplane given by the caller: its index in `PartitionTree.own_hyperplanes`.
    reason : str
        Why this hyperplane was chosen, see `Reason`.
    candidates : tuple of Candidate
        The candidates in the order of comparison; empty if there was no choice.
    pieces : tuple of int
        The pieces in the region, in the order in which the construction lists them.
    minus, plus : tuple of int
        The pieces with a part on the minus side, and with a part on the plus side.
    split : tuple of int
        The pieces with parts on both sides.
    coplanar : tuple of int
        The pieces that lie in the hyperplane, S(v).
    """

    node: int
    parent: int | None
    side: Side | None
    depth: int
    pivot: int | None
    axis: tuple[int, int] | None
    own: int | None
    reason: Reason
    candidates: tuple[Candidate, ...]
    pieces: tuple[int, ...]
    minus: tuple[int, ...]
    plus: tuple[int, ...]
    split: tuple[int, ...]
    coplanar: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Construction:
    """The trace of how a tree was built: all divisions in the order in which they were made.

    Parameters
    ----------
    divisions : tuple of Division
    facets : (k,) int64
        The facet that each convex piece is a part of.
    """

    divisions: tuple[Division, ...]
    facets: IndexArray

    def __len__(self) -> int:
        """Return the number of divisions, which equals the number of inner nodes."""
        return len(self.divisions)

    def __iter__(self) -> Iterator[Division]:
        """Yield the divisions in the order in which they were made."""
        return iter(self.divisions)

    def __repr__(self) -> str:
        """Return a text with the numbers of divisions and pieces."""
        return f"Construction({len(self)} divisions, {len(self.facets)} pieces)"

    def __getitem__(self, node: int) -> Division:
        """Return the division that made the inner node with this index."""
        return self.divisions[node]


def division(row: "_DivisionRow") -> Division:
    """Return the `Division` for one row of a construction trace of the core."""
    (node, parent, side, depth, (axis, place), reason), candidates, lists = row
    pieces, minus, plus, split, coplanar = map(tuple, lists)
    return Division(
        node=node,
        parent=None if parent < 0 else parent,
        side=_SIDES[side],
        depth=depth,
        pivot=place if axis == -1 else None,
        axis=(axis, place) if axis >= 0 else None,
        own=place if axis == -2 else None,
        reason=reason,
        candidates=tuple(Candidate(*candidate) for candidate in candidates),
        pieces=pieces,
        minus=minus,
        plus=plus,
        split=split,
        coplanar=coplanar,
    )


@dataclass(frozen=True)
class PointTrace:
    """The path of a point through a tree, from the root downwards.

    Parameters
    ----------
    nodes : tuple of Node
        The inner nodes on the path, the root first.
    sides : tuple of {-1, 0, 1}
        The point's side of each node's hyperplane: -1 minus, 1 plus, 0 on it, which ends the path.
    end : Node or Leaf
        The empty region in which the point lies, or the node in whose hyperplane it lies.
    """

    nodes: tuple[Node, ...]
    sides: tuple[int, ...]
    end: Node | Leaf

    @property
    def cost(self) -> int:
        """C(T): the number of inner nodes and leaves that the point visits."""
        return len(self.nodes) + isinstance(self.end, Leaf)


def point_trace(tree: "PartitionTree", path: list[tuple[int, int]]) -> PointTrace:
    """Return the `PointTrace` for the core's steps, pairs (node index, side of the point)."""
    nodes = tuple(Node(tree, index) for index, _ in path)
    sides = tuple(side for _, side in path)
    if not nodes:
        return PointTrace(nodes, sides, Leaf(tree, None, "minus"))
    last = _SIDES[sides[-1]]
    return PointTrace(nodes, sides, nodes[-1] if last is None else Leaf(tree, nodes[-1], last))


@dataclass(frozen=True)
class RayStep:
    """A step of a ray on its path through a tree; t is the factor of the ray's direction vector.

    Parameters
    ----------
    kind : {"visit", "test", "leaf"}
        An inner node is visited; a piece in its hyperplane is tested; a leaf is stabbed.
    node : int or None
        The index of the node, or of a leaf's parent; None if the whole tree is a leaf.
    side : {-1, 0, 1}
        Of a visit: the side of the hyperplane on which the ray starts, which is the near child. Of
        a leaf: the side of the node on which it lies.
    piece : int or None
        The piece that is tested.
    start, end : float or None
        The values of t at which the ray enters and leaves the region; `end` is None if it stays
        there.
    at : float or None
        Of a visit: the t at which the ray's line crosses the hyperplane. Of a test: the t at which
        the ray meets the piece. None if there is no such t.
    cost : int
        C(T): the number of nodes and leaves visited up to and including this step.
    """

    kind: Literal["visit", "test", "leaf"]
    node: int | None
    side: int
    piece: int | None
    start: float | None
    end: float | None
    at: float | None
    cost: int

    @property
    def case(self) -> Literal["near", "far", "both", "within"] | None:
        """Of a visit: the children through which the ray continues; None for other steps.

        "near" is the child in which the ray starts, "far" the other one. "within" means that the
        ray runs in the hyperplane and goes through both.


        Notes
        -----
        Havran, Kopal, Bittner, Žára 1997: `side` distinguishes their cases N and P.
        """
        if self.kind != "visit" or self.start is None:
            return None
        if self.at is None:
            return "near" if self.side else "within"
        if self.at < 0 or (self.end is not None and self.at > self.end):
            return "near"
        return "far" if self.at < self.start else "both"


@dataclass(frozen=True)
class RayTrace:
    """The path of a ray through a tree, which ends at the first hit.

    Parameters
    ----------
    facet : int or None
        The index of the facet that the ray meets first; None if it meets none.
    t : float
        The hit point is ``origin + t * direction``; rounded correctly, inf without a hit.
    steps : tuple of RayStep
        The steps in order; at each node the near child, the pieces in the hyperplane, the far
        child.
    """

    facet: int | None
    t: float
    steps: tuple[RayStep, ...]

    @property
    def nodes(self) -> tuple[int, ...]:
        """The indices of the inner nodes visited, in the order of the visits."""
        return tuple(s.node for s in self.steps if s.kind == "visit" and s.node is not None)

    def __repr__(self) -> str:
        """Return a text with the hit, the number of steps and the cost."""
        met = "no facet" if self.facet is None else f"facet {self.facet} at t = {self.t:.6g}"
        return f"RayTrace({met}, {len(self.steps)} steps, cost {self.cost})"

    @property
    def leaves(self) -> int:
        """The number of leaves that the ray stabs."""
        return sum(step.kind == "leaf" for step in self.steps)

    @property
    def tests(self) -> int:
        """The number of pieces that the ray is tested against."""
        return sum(step.kind == "test" for step in self.steps)

    @property
    def cost(self) -> int:
        """C(T): the number of inner nodes and leaves that the ray visits."""
        return self.steps[-1].cost if self.steps else 0


def ray_trace(facet: int | None, t: float, rows: "list[_RayEventRow]") -> RayTrace:
    """Return the `RayTrace` for a hit (facet, t) and the rows of steps from the core."""
    steps: list[RayStep] = []
    for kind, node, piece, side, start, end, at in rows:
        cost = (steps[-1].cost if steps else 0) + (kind != "test")
        where = None if node < 0 else node
        what = None if piece < 0 else piece
        steps.append(RayStep(kind, where, side, what, start, end, at, cost))
    return RayTrace(facet, t, tuple(steps))


@dataclass(frozen=True, eq=False)
class RayCosts:
    """First hits of rays through a `PartitionTree`, and the cost of each ray.

    Parameters
    ----------
    facet : (n,) int64
        The index of the facet that each ray meets first, -1 for none.
    t : (n,) float64
        The hit point is ``origin + t * direction``; rounded correctly, inf without a hit.
    nodes, leaves, tests : (n,) int64
        The numbers of inner nodes visited, leaves stabbed and pieces tested by each ray.
    """

    facet: IndexArray
    t: FloatArray
    nodes: IndexArray
    leaves: IndexArray
    tests: IndexArray

    def __len__(self) -> int:
        """Return the number of rays."""
        return len(self.facet)

    @property
    def cost(self) -> IndexArray:
        """C(T) of each ray, (n,) int64: the number of inner nodes and leaves visited."""
        visited: IndexArray = self.nodes + self.leaves
        return visited
