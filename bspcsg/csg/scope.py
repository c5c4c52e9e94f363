"""Special variables that nodes hand down to the nodes in them.

OpenSCAD's own dumps give ``$fn``, ``$fa`` and ``$fs`` to every node that is made of sides; in a
script written by hand a node without them takes those of the nodes around it.
"""

from dataclasses import replace
from typing import TypeAlias

from .syntax.tree import SPECIAL, Argument, Node

#: The special variables that hold inside a node, at most one argument of each name.
Scope: TypeAlias = tuple[Argument, ...]

#: Nodes whose number of sides depends on them.
_SIDED = frozenset(
    {
        "circle", "sphere", "cylinder", "text", "offset", "linear_extrude", "rotate_extrude",
        "import",
    }
)  # fmt: skip


def inherited(scope: Scope, node: Node) -> Scope:
    """Return what holds inside a node that stands where `scope` holds."""
    own = tuple(argument for argument in node.arguments if argument.name in SPECIAL)
    return own + _missing(scope, node) if own else scope


def with_scope(node: Node, scope: Scope) -> Node:
    """Return the node with the special variables that it leaves out."""
    missing = _missing(scope, node) if scope and node.name in _SIDED else ()
    return replace(node, arguments=node.arguments + missing) if missing else node


def _missing(scope: Scope, node: Node) -> Scope:
    names = {argument.name for argument in node.arguments}
    return tuple(argument for argument in scope if argument.name not in names)
