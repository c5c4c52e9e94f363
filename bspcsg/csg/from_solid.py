"""Conversion of solids to script trees: the expression that made a solid, as far as it is stored.

A solid that has not been evaluated stores its whole expression. After evaluation it stores only the
last operation and its operands (see `Solid.last_operation`). Leaves become polyhedra, transforms
multmatrix nodes. The language has no complement: an unbounded set is represented by its complement
and a flag, until an intersection with a bounded set turns it into a difference.
"""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ..errors import Finding, UnboundedError
from ..geometry.chain import IDENTITY_CHAIN, FactorChain
from ..geometry.transform import Factor
from ..parameters import instance_of, truth_value
from ..solid import expression
from ..solid.expression import Pending, PlacedNode, Plan, make_plan
from ..solid.leaf import ConstantLeaf, PlaneLeaf, TreeLeaf
from ..solid.ledger import uncounted
from ..solid.solid import Solid, expression_of, from_node
from .syntax.tree import Argument, CsgTree, Node, Value

#: The largest number of corners and triangles of an expression that is written; a larger expression
#: becomes one polyhedron. Each takes about 60 bytes, so this many fill half of the largest script
#: that can be read.
_MAX_BODY_SIZE = 2_000_000


class _Body(NamedTuple):
    """A set as a script node, or as the complement of a node.

    Parameters
    ----------
    node : Node or None
        The node; None for the empty set.
    negated : bool
        True if the set is the complement of the node.
    size : int
        The number of corners and triangles in the written node.
    """

    node: Node | None
    negated: bool = False
    size: int = 0


_EMPTY = _Body(None)


@uncounted
def tree_of(solid: Solid, *, flat: bool = False) -> CsgTree:
    """Return a script tree that evaluates to a given solid; for the empty solid, without nodes.

    Parameters
    ----------
    solid : Solid
    flat : bool
        True for one polyhedron, the reduced boundary, instead of the expression that made the
        solid.

    Raises
    ------
    UnboundedError
        If the solid reaches to infinity.

    Notes
    -----
    A polyhedron replaces the expression if the language cannot represent it, as for half-spaces, or
    if it would have more than two million corners and triangles: repeated parts are written each
    time, and symmetric differences repeat both operands.
    """
    instance_of(Solid, solid, "solid")
    body = (
        _polyhedron(solid)
        if truth_value(flat, "flat")
        else _ExpressionConverter().body(*expression_of(solid))
    )
    if body is None or body.size > _MAX_BODY_SIZE or body.negated:
        body = _polyhedron(solid)
    if body is None or body.negated:
        message = (
            "The solid reaches to infinity, so it cannot be written as a script; intersect it"
            " with a box first."
        )
        raise UnboundedError(message, "unbounded")
    return CsgTree(() if body.node is None else (body.node,))


def lost_attributes(solids: Iterable[Solid]) -> tuple[Finding, ...]:
    """Return the finding that scripts cannot store the attributes of solids, if they have any.

    No solid is evaluated.
    """
    names: set[str] = set()
    waiting = [expression_of(solid).node for solid in solids]
    seen = set(waiting)
    while waiting:
        content = waiting.pop().content
        if isinstance(content, Pending):
            inner = {operand.node for operand in content.operands} - seen
            seen |= inner
            waiting.extend(inner)
            continue
        names.update(
            name for said in content.source_attributes if said is not None for name in said.names
        )
    if not names:
        return ()
    told = ", ".join(f"“{name}”" for name in sorted(names))
    message = f".csg scripts cannot store attributes; {told} were left out."
    return (Finding("attributes_left_out", "warning", message, (), len(names)),)


def _polyhedron(solid: Solid) -> _Body | None:
    """Return a solid or its complement as one polyhedron; None if both reach to infinity."""
    negated = not solid.is_bounded
    inner = ~solid if negated else solid
    if not inner.is_bounded:
        return None
    if inner.is_empty:
        return _Body(None, negated)
    mesh = inner.normalized().to_mesh()
    points = tuple(tuple(point) for point in mesh.vertices.tolist())
    # Faces of polyhedra are clockwise in scripts, and all numbers are doubles.
    faces = tuple(tuple(face) for face in mesh.faces[:, ::-1].astype(np.float64).tolist())
    node = Node("polyhedron", (Argument("points", points), Argument("faces", faces)))
    return _Body(node, negated, len(points) + len(faces))


class _ExpressionConverter:
    """Converter of an expression to script nodes; each node of the expression is converted once."""

    def __init__(self) -> None:
        self._known: dict[expression.ExpressionNode, _Body | None] = {}

    def body(self, root: expression.ExpressionNode, factors: FactorChain) -> _Body | None:
        """Return the set of an expression node under a transform; None if it cannot be written."""
        waiting: list[tuple[expression.ExpressionNode, Plan | None]] = [(root, None)]
        while waiting:
            node, plan = waiting.pop()
            if node in self._known:
                continue
            if plan is not None:
                self._known[node] = self._combined(node, plan)
                continue
            plan = _plan_of(node)
            if plan is None:
                self._known[node] = _leaf(node)
                continue
            waiting.append((node, plan))
            waiting.extend((operand.node, None) for operand in plan.operands)
        return _moved(self._known[root], factors)

    def _combined(self, node: expression.ExpressionNode, plan: Plan) -> _Body | None:
        lines: list[_Body | None] = []
        for operator, arguments in plan.program:
            if operator == "leaf":
                operand = plan.operands[arguments[0]]
                lines.append(_moved(self._known[operand.node], operand.factors))
            else:
                lines.append(_operation(operator, [lines[line] for line in arguments]))
        made = lines[-1]
        if made is None or made.size > _MAX_BODY_SIZE:
            return _polyhedron(from_node(node))
        return made


def _plan_of(node: expression.ExpressionNode) -> Plan | None:
    """Return the operations and operands that made an expression node; None for a leaf."""
    content = node.content
    if isinstance(content, Pending):
        return make_plan(node)
    if not isinstance(content, TreeLeaf) or content.record is None:
        return None
    record = content.record
    return Plan(
        record.program,
        [PlacedNode(expression.ExpressionNode(leaf), IDENTITY_CHAIN) for leaf in record.leaves],
    )


def _leaf(node: expression.ExpressionNode) -> _Body | None:
    content = node.content
    if isinstance(content, ConstantLeaf):
        return _Body(None, content.full)
    return None if isinstance(content, PlaneLeaf) else _polyhedron(from_node(node))


def _moved(body: _Body | None, factors: FactorChain) -> _Body | None:
    if body is None or body.node is None:
        return body
    node = body.node
    for factor in reversed(list(factors)):
        node = Node("multmatrix", (_matrix(factor),), (node,))
    return body._replace(node=node)


def _matrix(factor: Factor) -> Argument:
    rows: Value = tuple(tuple(row) for row in factor.matrix.tolist())
    return Argument(None, rows)


def _operation(operator: str, operands: Sequence[_Body | None]) -> _Body | None:
    given = [operand for operand in operands if operand is not None]
    if len(given) < len(operands):
        return None
    if operator == "not":
        return given[0]._replace(negated=not given[0].negated)
    if operator == "xor":
        return _symmetric_difference(given)
    if operator == "and":
        return _intersection(given)
    # A union is the complement of the intersection of the complements.
    outside = _intersection([body._replace(negated=not body.negated) for body in given])
    return outside._replace(negated=not outside.negated)


def _intersection(bodies: Sequence[_Body]) -> _Body:
    """Return the intersection of sets: the plain nodes minus the nodes of negated sets."""
    positive = [body for body in bodies if not body.negated]
    negative = [body for body in bodies if body.negated]
    if not positive:
        return _combined_node("union", negative)._replace(negated=True)
    first = _combined_node("intersection", positive)
    rest = [body._replace(negated=False) for body in negative if body.node is not None]
    return _combined_node("difference", [first, *rest])


def _symmetric_difference(bodies: Sequence[_Body]) -> _Body:
    """Return the symmetric difference of sets; each negated set inverts the result."""
    made = _EMPTY
    for body in bodies:
        plain = body._replace(negated=False)
        one, other = (_combined_node("difference", pair) for pair in ((made, plain), (plain, made)))
        made = _combined_node("union", [one, other])
        if made.size > _MAX_BODY_SIZE:
            break
    return made._replace(negated=sum(body.negated for body in bodies) % 2 == 1)


def _combined_node(name: str, bodies: Sequence[_Body]) -> _Body:
    """Return the node of a set operation, without empty operands that do not change the result."""
    nodes = [body.node for body in bodies if body.node is not None]
    size = sum(body.size for body in bodies)
    if not nodes or (name == "intersection" and len(nodes) < len(bodies)):
        return _EMPTY
    if name == "difference" and bodies[0].node is None:
        return _EMPTY
    return _Body(nodes[0] if len(nodes) == 1 else Node(name, (), tuple(nodes)), size=size)
