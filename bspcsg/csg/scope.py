"""Inheritance of special variables, such as ``$fn``, by the nodes inside a node.

OpenSCAD writes ``$fn``, ``$fa`` and ``$fs`` at every node that needs a number of sides. In a script
written by hand, a node without them inherits the values of the nodes around it.
"""

from dataclasses import replace
from typing import TypeAlias

from .syntax.tree import SPECIAL, Argument, Node

#: The special variables that apply inside a node, as arguments with different names.
Scope: TypeAlias = tuple[Argument, ...]

#: The names of nodes whose number of sides depends on special variables.
_NODES_WITH_SIDES = frozenset(
    {
        "circle", "sphere", "cylinder", "text", "offset", "linear_extrude", "rotate_extrude",
        "import",
    }
)  # fmt: skip


def inherited(scope: Scope, node: Node) -> Scope:
    """Return the special variables that apply inside a node, given the ones around it."""
    own = tuple(argument for argument in node.arguments if argument.name in SPECIAL)
    return own + _missing(scope, node) if own else scope


def with_scope(node: Node, scope: Scope) -> Node:
    """Return a node with inherited special variables as arguments, if it depends on them."""
    missing = _missing(scope, node) if scope and node.name in _NODES_WITH_SIDES else ()
    return replace(node, arguments=node.arguments + missing) if missing else node


def _missing(scope: Scope, node: Node) -> Scope:
    names = {argument.name for argument in node.arguments}
    return tuple(argument for argument in scope if argument.name not in names)
