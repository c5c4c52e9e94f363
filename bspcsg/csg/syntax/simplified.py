"""Trees without the nodes that make no difference."""

from dataclasses import replace

import numpy as np

from ...parameters import of_kind
from .tree import CsgTree, Node

#: Nodes that only unite their children, unless they have arguments.
_PLAIN = frozenset({"group", "union"})

#: Nodes whose children may be several instead of their union.
_UNITING = frozenset({*_PLAIN, "color", "multmatrix", "render"})


def simplified(tree: CsgTree) -> CsgTree:
    """Return a tree of the same solid with fewer nodes.

    Left out are nodes that modifiers take out of the model, groups and unions of one child or
    within others, and matrices that move nothing. Other nodes and their arguments stay, those that
    cannot be evaluated as well.
    """
    roots = of_kind(CsgTree, tree, "tree").roots()
    return replace(tree, nodes=_with_children(Node("union", (), roots)))


def _with_children(root: Node) -> tuple[Node, ...]:
    """Return the simplified children of a node that unites; trees may be any depth."""
    done: list[Node] = []
    waiting: list[tuple[Node, bool]] = [(root, False)]
    while waiting:
        node, children_done = waiting.pop()
        children = [child for child in node.children if not child.is_ignored]
        if not children_done:
            waiting.append((node, True))
            waiting.extend((child, False) for child in reversed(children))
            continue
        first = len(done) - len(children)
        made = tuple(done[first:])
        del done[first:]
        done.append(_rebuilt(node, made, at_top=not waiting))
    return done[0].children


def _rebuilt(node: Node, children: tuple[Node, ...], at_top: bool) -> Node:
    if node.name in _UNITING:
        children = tuple(part for child in children for part in _parts(child))
    if not at_top and _is_plain(node) and len(children) == 1:
        return children[0]
    modifiers = node.modifiers.replace("!", "")
    return Node(node.name, node.arguments, children, modifiers, node.place)


def _parts(node: Node) -> tuple[Node, ...]:
    """Return what a child of a node that unites may be replaced by."""
    return node.children if _is_plain(node) else (node,)


def _is_plain(node: Node) -> bool:
    if node.modifiers.replace("!", ""):
        return False
    return (node.name in _PLAIN and not node.arguments) or _moves_nothing(node)


def _moves_nothing(node: Node) -> bool:
    if node.name != "multmatrix" or len(node.arguments) != 1:
        return False
    value = node.arguments[0].value
    return isinstance(value, tuple) and value == tuple(map(tuple, np.eye(4).tolist()))
