"""Traces of the construction of a tree over facets, and of points and rays in it.

The core records a trace while it works; replaying it takes a few lines and gives the same tree and
the same answer. Convex pieces are numbered; if no facet is a concave polygon, the numbers are those
of the facets. `Construction.facets` has the facet of each piece.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

from ..._types import FloatArray, IndexArray
from .node import Leaf, Node, Side

if TYPE_CHECKING:
    from ..._core import _DivisionRow, _RayEventRow
    from .tree import PartitionTree

#: The reason of a hyperplane to divide a region: a policy's name; "median" for an axis-parallel cut
#: of a long list; "given" for one that was there; "asked" for the choice of a callable.
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
    """A hyperplane that might have been chosen.

    Parameters
    ----------
    piece : int
        The piece whose hyperplane it is.
    minus, plus : int
        The numbers of pieces with parts on either side.
    splits : int
        The number of those with parts on both.
    score : float
        The value that the policy minimises; of equal ones the first is taken.
    """

    piece: int
    minus: int
    plus: int
    splits: int
    score: float


@dataclass(frozen=True)
class Division:
    """The division of a region by a new node.

    Parameters
    ----------
    node : int
        Its place in preorder.
    parent : int or None
        The node above.
    side : {"minus", "plus"} or None
        On which side of it.
    depth : int
        Hyperplanes above.
    pivot : int or None
        The piece whose hyperplane it is.
    axis : tuple of int or None
        Instead of a pivot: the axis perpendicular to the cut, and its position in lattice steps.
    own : int or None
        Instead of both: the place in `PartitionTree.own_hyperplanes`.
    reason : str
        The reason for this one.
    candidates : tuple of Candidate
        The candidates compared, in their order; none if there was no choice.
    pieces : tuple of int
        The pieces in the region, in the order of its list.
    minus, plus : tuple of int
        Those with a part on either side.
    split : tuple of int
        Those with parts on both.
    coplanar : tuple of int
        Those in the hyperplane: S(v).
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
    """The making of a tree: its divisions in the order in which they were made.

    Parameters
    ----------
    divisions : tuple of Division
    facets : (k,) int64
        The facet that each convex piece is a part of.
    """

    divisions: tuple[Division, ...]
    facets: IndexArray

    def __len__(self) -> int:
        """Return the number of divisions, which is that of nodes."""
        return len(self.divisions)

    def __iter__(self) -> Iterator[Division]:
        """Yield the divisions."""
        return iter(self.divisions)

    def __repr__(self) -> str:
        """Say how many divisions there are; iterating shows them."""
        return f"Construction({len(self)} divisions, {len(self.facets)} pieces)"

    def __getitem__(self, node: int) -> Division:
        """Return the division that made a node."""
        return self.divisions[node]


def division(row: "_DivisionRow") -> Division:
    """Return a division of the core's row."""
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
    """The path of a point from the root down.

    Parameters
    ----------
    nodes : tuple of Node
        The inner nodes that it passes.
    sides : tuple of {-1, 0, 1}
        Its side of each hyperplane; only the last can be 0.
    end : Node or Leaf
        The empty region in which the point lies, or the node in whose hyperplane it lies.
    """

    nodes: tuple[Node, ...]
    sides: tuple[int, ...]
    end: Node | Leaf

    @property
    def cost(self) -> int:
        """C(T): the number of nodes visited, the leaf among them."""
        return len(self.nodes) + isinstance(self.end, Leaf)


def point_trace(tree: "PartitionTree", path: list[tuple[int, int]]) -> PointTrace:
    """Return the way of a point of the core's steps."""
    nodes = tuple(Node(tree, index) for index, _ in path)
    sides = tuple(side for _, side in path)
    if not nodes:
        return PointTrace(nodes, sides, Leaf(tree, None, "minus"))
    last = _SIDES[sides[-1]]
    return PointTrace(nodes, sides, nodes[-1] if last is None else Leaf(tree, nodes[-1], last))


@dataclass(frozen=True)
class RayStep:
    """A step of a ray on its path; parameters are in lengths of its direction.

    Parameters
    ----------
    kind : {"visit", "test", "leaf"}
        An inner node is visited; a piece in its hyperplane is tested; a leaf is stabbed.
    node : int or None
        The node, or the one above the leaf; None if the whole tree is a leaf.
    side : {-1, 0, 1}
        Of a visit: the side of the hyperplane on which the ray starts, which is the near child. Of
        a leaf: the side of the node on which it lies.
    piece : int or None
        The piece that is tested.
    start, end : float or None
        The parameters at which the ray enters and leaves the region; no end if it stays there.
    at : float or None
        Of a visit: where the ray's line crosses the hyperplane. Of a test: where the ray meets the
        piece. None if it does not.
    cost : int
        C(T) so far: the nodes and leaves visited.
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
        """Of a visit: the children through which the ray goes on; None for other steps.

        The near child is where the ray starts. "within" is a ray that runs in the hyperplane, and
        goes through both.

        Notes
        -----
        Havran, Kopal, Bittner, Žára 1997: their cases N and P are told apart by `side`.
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
    """The path of a ray through a tree, up to its first hit.

    Parameters
    ----------
    facet : int or None
        The facet that it meets first.
    t : float
        The parameter there, rounded correctly; inf for nothing.
    steps : tuple of RayStep
        In their order: near child, what lies in the hyperplane, far child.
    """

    facet: int | None
    t: float
    steps: tuple[RayStep, ...]

    @property
    def nodes(self) -> tuple[int, ...]:
        """The inner nodes visited, in their order."""
        return tuple(s.node for s in self.steps if s.kind == "visit" and s.node is not None)

    def __repr__(self) -> str:
        """Show the hit and the cost; `steps` has the path."""
        met = "no facet" if self.facet is None else f"facet {self.facet} at t = {self.t:.6g}"
        return f"RayTrace({met}, {len(self.steps)} steps, cost {self.cost})"

    @property
    def leaves(self) -> int:
        """The number of leaves that are stabbed."""
        return sum(step.kind == "leaf" for step in self.steps)

    @property
    def tests(self) -> int:
        """The number of pieces that are tested."""
        return sum(step.kind == "test" for step in self.steps)

    @property
    def cost(self) -> int:
        """C(T): all nodes visited, leaves among them."""
        return self.steps[-1].cost if self.steps else 0


def ray_trace(facet: int | None, t: float, rows: "list[_RayEventRow]") -> RayTrace:
    """Return the way of a ray of the core's rows."""
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
        -1 for none.
    t : (n,) float64
        The exact parameter rounded correctly; inf for none.
    nodes, leaves, tests : (n,) int64
        Inner nodes visited, leaves stabbed, pieces tested.
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
        """C(T) of each ray: all nodes visited, leaves among them."""
        visited: IndexArray = self.nodes + self.leaves
        return visited
