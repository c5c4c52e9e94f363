"""Special variables, which nodes pass down to the nodes inside them.

OpenSCAD's own dumps write ``$fn``, ``$fa`` and ``$fs`` at every node that needs a number of sides.
In a script written by hand a node without them inherits those of the nodes around it.
"""

from dataclasses import replace
from typing import TypeAlias

from .syntax.tree import SPECIAL, Argument, Node

#: The special variables that apply inside a node, at most one argument of each name.
Scope: TypeAlias = tuple[Argument, ...]

#: Nodes whose number of sides depends on them.
_SIDED = frozenset(
    {
        "circle", "sphere", "cylinder", "text", "offset", "linear_extrude", "rotate_extrude",
        "import",
    }
)  # fmt: skip


def inherited(scope: Scope, node: Node) -> Scope:
    """Return the scope inside a node, given the scope around it."""
    own = tuple(argument for argument in node.arguments if argument.name in SPECIAL)
    return own + _missing(scope, node) if own else scope


def with_scope(node: Node, scope: Scope) -> Node:
    """Return the node with the special variables that it inherits."""
    missing = _missing(scope, node) if scope and node.name in _SIDED else ()
    return replace(node, arguments=node.arguments + missing) if missing else node


def _missing(scope: Scope, node: Node) -> Scope:
    names = {argument.name for argument in node.arguments}
    return tuple(argument for argument in scope if argument.name not in names)
