"""Lazy set expressions: the graph of operations over leaves, and its evaluation.

Building an expression costs nothing. Evaluating a node flattens the graph below it into one program
for the core, which executes it in a single descent; then the node becomes a leaf and the graph
below is released. A node under a transform is evaluated separately first, because the transform
acts on its whole result. The code is not recursive, so expressions may have any depth.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple
from weakref import WeakKeyDictionary

from .._types import ProgramLine
from ..caching import LazyValue
from ..errors import internal
from ..geometry.chain import IDENTITY_CHAIN, FactorChain
from .leaf import ExpressionLeaf, Record, TreeLeaf, evaluated_record
from .program import Operator


class PlacedNode(NamedTuple):
    """A node of the expression graph, with the transform that is applied to its result."""

    node: "ExpressionNode"
    factors: FactorChain


@dataclass(frozen=True, eq=False)
class Pending:
    """A set operation that has not been evaluated, with its operands."""

    operator: Operator
    operands: tuple[PlacedNode, ...]
    result: LazyValue[ExpressionLeaf] = field(default_factory=LazyValue, init=False, repr=False)


class ExpressionNode:
    """A node of the expression graph, compared by identity.

    `content` changes once, from a `Pending` operation to the leaf that is its result. It is one
    attribute, so other threads see either the whole operation or the whole result.
    """

    __slots__ = ("__weakref__", "_moved", "content")

    def __init__(self, content: Pending | ExpressionLeaf) -> None:
        self.content = content
        self._moved: LazyValue[WeakKeyDictionary[FactorChain, ExpressionLeaf]] = LazyValue()

    def placed(self, factors: FactorChain) -> ExpressionLeaf:
        """Return the node's evaluated leaf after a transform, cached for each transform in use.

        So all operations on a transformed solid share one mesh.
        """
        leaf = _evaluated(self.content)
        if not factors:
            return leaf
        known = self._moved.get(WeakKeyDictionary)
        moved = known.get(factors)
        return known.setdefault(factors, leaf.placed(factors)) if moved is None else moved


def complement(placed: PlacedNode) -> PlacedNode:
    """Return the complement of a node under a transform; twice gives the original node."""
    content = placed.node.content
    if isinstance(content, Pending) and content.operator == "not":
        inner = content.operands[0]
        return PlacedNode(inner.node, placed.factors.around(inner.factors))
    # Move the transform outwards: M(not X) and not M(X) are the same set.
    return PlacedNode(
        ExpressionNode(Pending("not", (PlacedNode(placed.node, IDENTITY_CHAIN),))), placed.factors
    )


def operation(operator: Operator, operands: Sequence[PlacedNode]) -> ExpressionNode:
    """Return a new node, not evaluated, that combines the operands by a set operation."""
    return ExpressionNode(
        Pending(operator, tuple(_normalized_operand(operand) for operand in operands))
    )


def _normalized_operand(placed: PlacedNode) -> PlacedNode:
    """Return an operand; a transformed complement becomes the complement of a transformed solid.

    The solid inside the complement is usually bounded, so it has a mesh to transform.
    """
    content = placed.node.content
    if not placed.factors or not isinstance(content, Pending) or content.operator != "not":
        return placed
    inner = content.operands[0]
    below = PlacedNode(inner.node, placed.factors.around(inner.factors))
    return PlacedNode(ExpressionNode(Pending("not", (below,))), IDENTITY_CHAIN)


def evaluate(root: ExpressionNode) -> ExpressionLeaf:
    """Evaluate a node, with the graph below it, and return the leaf that is its result.

    Raises
    ------
    BspcsgError
        Any error of the core or of transforming a leaf; the node then stays unevaluated.
    """
    waiting: list[tuple[ExpressionNode, Plan | None]] = [(root, None)]
    while waiting:
        node, plan = waiting.pop()
        content = node.content
        if not isinstance(content, Pending):
            continue
        if plan is not None:
            node.content = content.result.get(plan.execute)
            continue
        plan = make_plan(node)
        waiting.append((node, plan))
        waiting.extend((operand.node, None) for operand in reversed(plan.operands))
    return _evaluated(root.content)


@dataclass
class Plan:
    """A program for the core, and the operands to which its lines ``("leaf", [k])`` refer."""

    program: list[ProgramLine] = field(default_factory=list)
    operands: list[PlacedNode] = field(default_factory=list)

    def execute(self) -> ExpressionLeaf:
        """Execute the program and return its result; all operands must have been evaluated."""
        leaves = [_operand_leaf(operand) for operand in self.operands]
        return evaluated_record(Record(self.program, tuple(leaves)))


def make_plan(root: ExpressionNode) -> Plan:
    """Flatten the expression below a node into a program, with operands in reading order."""
    uses = _count_uses(root)
    plan = Plan()
    lines: dict[PlacedNode, int] = {}
    waiting: list[tuple[PlacedNode, list[PlacedNode] | None]] = [
        (PlacedNode(root, IDENTITY_CHAIN), None)
    ]
    while waiting:
        placed, arguments = waiting.pop()
        if placed in lines:
            continue
        pending = _open_operation(placed)
        if pending is None:
            lines[placed] = len(plan.program)
            plan.program.append(("leaf", [len(plan.operands)]))
            plan.operands.append(placed)
        elif arguments is None:
            arguments = _arguments(pending, uses)
            waiting.append((placed, arguments))
            waiting.extend((argument, None) for argument in reversed(arguments))
        else:
            lines[placed] = len(plan.program)
            plan.program.append((pending.operator, [lines[argument] for argument in arguments]))
    return plan


def _evaluated(content: Pending | ExpressionLeaf) -> ExpressionLeaf:
    if isinstance(content, Pending):
        raise internal("an operand has not been evaluated")
    return content


def _operand_leaf(placed: PlacedNode) -> ExpressionLeaf:
    leaf = placed.node.placed(placed.factors)
    # Operands must not keep their own records, or a chain would keep all of its history.
    return leaf.without_record() if isinstance(leaf, TreeLeaf) else leaf


def _open_operation(placed: PlacedNode) -> Pending | None:
    """Return a node's operation, or None if the node is evaluated or under a transform."""
    content = placed.node.content
    return content if isinstance(content, Pending) and not placed.factors else None


def _arguments(pending: Pending, uses: dict[ExpressionNode, int]) -> list[PlacedNode]:
    """Return an operation's operands, those of nested unions or intersections included.

    A union in a union or an intersection in an intersection is replaced by its operands, unless the
    program uses it several times: then it keeps its own line.
    """
    arguments: list[PlacedNode] = []
    waiting = list(reversed(pending.operands))
    while waiting:
        placed = waiting.pop()
        inner = _open_operation(placed)
        nested = inner is not None and inner.operator == pending.operator in ("or", "and")
        if inner is not None and nested and uses.get(placed.node) == 1:
            waiting.extend(reversed(inner.operands))
        else:
            arguments.append(placed)
    return arguments


def _count_uses(root: ExpressionNode) -> dict[ExpressionNode, int]:
    """Count how often the program below a node refers to each node."""
    uses: dict[ExpressionNode, int] = {}
    open_nodes = {root}
    waiting = [root]
    while waiting:
        content = waiting.pop().content
        for node, factors in content.operands if isinstance(content, Pending) else ():
            uses[node] = uses.get(node, 0) + 1
            if not factors and node not in open_nodes:
                open_nodes.add(node)
                waiting.append(node)
    return uses
