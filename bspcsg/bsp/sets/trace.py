"""`MergeTrace`: the steps of the core when it merges two trees, node by node."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

from ..._types import SetOp
from .pieces import SplitCase

if TYPE_CHECKING:
    from ..._core import _MergeRow
    from .objects import ObjectTree

#: The root of a subtree: the preorder index of a node of an operand, or -1 for a leaf outside and
#: -2 for a leaf inside, as in `NodeTable`.
Root: TypeAlias = int

#: The result of merging a pair of trees. "divide": the second is split by the root's cut of the
#: first, and both halves are merged; "leaf-in", "leaf-out": a leaf; otherwise one of the two trees,
#: with all its nodes shared, or its complement.
Decision: TypeAlias = Literal[
    "divide",
    "leaf-in",
    "leaf-out",
    "first",
    "first-complement",
    "second",
    "second-complement",
]

#: Why a pair of trees is not divided: one is a leaf, both share all nodes, or they are complements;
#: empty if it is divided.
Because: TypeAlias = Literal["", "first-is-leaf", "second-is-leaf", "same", "complement"]

#: What a node of the first operand becomes in the result. "shared": the node itself; "rebuilt": a
#: new node with the same cut; "collapsed-…": a leaf, because both sides became equal leaves.
Joined: TypeAlias = Literal["shared", "rebuilt", "collapsed-in", "collapsed-out"]


@dataclass(frozen=True)
class MergePair:
    """The step that starts to merge two subtrees over one region.

    Parameters
    ----------
    a, b : int
        The roots of the subtrees, in the first and in the second operand.
    decision, because : str
        How the pair is merged, see `Decision`, and why, see `Because`.
    """

    a: Root
    b: Root
    decision: Decision
    because: Because


@dataclass(frozen=True)
class MergeSplit:
    """The step that starts to split a subtree of the second operand by a cut of the first one.

    The cut is that of the node `a` of the last `MergePair`.

    Parameters
    ----------
    root : int
        The root of the subtree.
    case : str
        How the root's cut lies relative to the splitting cut, see `ObjectTree.split_case`. In a
        case such as "minus-plus", the root's child on the first side (minus) is split further, and
        the root goes to the half on the second side (plus).
    """

    root: Root
    case: SplitCase


@dataclass(frozen=True)
class MergeHalves:
    """The step that ends the split of a subtree of the second operand.

    Parameters
    ----------
    minus, plus : int
        The roots of the half on the minus side and of the half on the plus side.
    """

    minus: Root
    plus: Root


@dataclass(frozen=True)
class MergeJoin:
    """The step that joins the merged minus and plus sides of a node of the first operand.

    Parameters
    ----------
    node : int
        The index of the node in the first operand.
    joined : str
        What the node becomes in the result, see `Joined`.
    """

    node: Root
    joined: Joined


#: A step of merging two trees.
MergeStep: TypeAlias = MergePair | MergeSplit | MergeHalves | MergeJoin


@dataclass(frozen=True, eq=False)
class MergeTrace:
    """The trace of a set operation on two trees, step by step.

    After a `MergePair` with the decision "divide" come the steps that split the second tree
    (`MergeSplit`, `MergeHalves`), then the steps of the pair on the minus side and of the pair on
    the plus side, then a `MergeJoin`.

    Parameters
    ----------
    first, second, result : ObjectTree
    op : str
    steps : tuple of MergePair, MergeSplit, MergeHalves or MergeJoin
        The steps in order.
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
        """Yield the steps in order."""
        return iter(self.steps)

    def __repr__(self) -> str:
        """Return a text with the operation and the number of steps."""
        return f"MergeTrace({self.op}, {len(self)} steps)"

    @property
    def cases(self) -> tuple[SplitCase, ...]:
        """The split cases of all `MergeSplit` steps, in order."""
        return tuple(step.case for step in self.steps if isinstance(step, MergeSplit))


def merge_trace(
    first: "ObjectTree",
    second: "ObjectTree",
    result: "ObjectTree",
    op: SetOp,
    rows: "list[_MergeRow]",
) -> MergeTrace:
    """Return the `MergeTrace` for two operands, their result and the core's rows of steps."""
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
