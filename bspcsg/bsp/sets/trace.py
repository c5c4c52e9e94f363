"""The trace of merging two sets: the steps of the core, node by node."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

from ..._types import SetOp
from .pieces import SplitCase

if TYPE_CHECKING:
    from ..._core import _MergeRow
    from .objects import ObjectTree

#: A root: a node of an operand in preorder, or a leaf, -1 outside and -2 inside, as in `NodeTable`.
Root: TypeAlias = int

#: The fate of a pair of trees: the second is split by the root of the first; a leaf; one of them as
#: it is, with all its nodes shared, or its complement.
Decision: TypeAlias = Literal[
    "divide",
    "leaf-in",
    "leaf-out",
    "first",
    "first-complement",
    "second",
    "second-complement",
]

#: The ground that decides a pair: one is a leaf, both are the same nodes, or complements.
Because: TypeAlias = Literal["", "first-is-leaf", "second-is-leaf", "same", "complement"]

#: The fate of a node of the first operand: itself; a new node with the same cut; a leaf, because
#: both its sides had become equal ones.
Joined: TypeAlias = Literal["shared", "rebuilt", "collapsed-in", "collapsed-out"]


@dataclass(frozen=True)
class MergePair:
    """The start of combining two trees of one region.

    Parameters
    ----------
    a, b : int
        Their roots, in the first and in the second operand.
    decision, because : str
        The decision about them, and its reason.
    """

    a: Root
    b: Root
    decision: Decision
    because: Because


@dataclass(frozen=True)
class MergeSplit:
    """The start of splitting a part of the second operand by the cut of the last pair.

    Parameters
    ----------
    root : int
        Its root.
    case : str
        The position of the cut, see `ObjectTree.split_case`. In the cases of two sides the subtree
        on the first side is split, and the root stays in the second half.
    """

    root: Root
    case: SplitCase


@dataclass(frozen=True)
class MergeHalves:
    """The end of a split of a part of the second operand.

    Parameters
    ----------
    minus, plus : int
        The roots of its halves.
    """

    minus: Root
    plus: Root


@dataclass(frozen=True)
class MergeJoin:
    """The join of the results on both sides of a node of the first operand.

    Parameters
    ----------
    node : int
        The node.
    joined : str
        Its fate in the result.
    """

    node: Root
    joined: Joined


#: A step of merging.
MergeStep: TypeAlias = MergePair | MergeSplit | MergeHalves | MergeJoin


@dataclass(frozen=True, eq=False)
class MergeTrace:
    """A set operation, step by step.

    A divided pair is followed by the splits of the second tree, each with the splits of its
    subtrees and its halves; then by the pair on the minus side, the pair on the plus side, and the
    join.

    Parameters
    ----------
    first, second, result : ObjectTree
    op : str
    steps : tuple of MergePair, MergeSplit, MergeHalves or MergeJoin
        In the order of the work.
    """

    first: "ObjectTree"
    second: "ObjectTree"
    result: "ObjectTree"
    op: SetOp
    steps: tuple[MergeStep, ...]

    def __len__(self) -> int:
        """Return the number of steps."""
        return len(self.steps)

    def __iter__(self) -> Iterator[MergeStep]:
        """Yield the steps."""
        return iter(self.steps)

    def __repr__(self) -> str:
        """Say how many steps there are; iterating shows them."""
        return f"MergeTrace({self.op}, {len(self)} steps)"

    @property
    def cases(self) -> tuple[SplitCase, ...]:
        """The cases of all splits in their order."""
        return tuple(step.case for step in self.steps if isinstance(step, MergeSplit))


def merge_trace(
    first: "ObjectTree",
    second: "ObjectTree",
    result: "ObjectTree",
    op: SetOp,
    rows: "list[_MergeRow]",
) -> MergeTrace:
    """Return the trace of the core's rows."""
    return MergeTrace(first, second, result, op, tuple(map(_step, rows)))


def _step(row: "_MergeRow") -> MergeStep:
    kind, a, b, what, why = row
    made: MergeStep
    match kind:
        case "pair":
            made = MergePair(a, b, what, why)  # type: ignore[arg-type]
        case "split":
            made = MergeSplit(a, what)  # type: ignore[arg-type]
        case "halves":
            made = MergeHalves(a, b)
        case "join":
            made = MergeJoin(a, what)  # type: ignore[arg-type]
    return made
