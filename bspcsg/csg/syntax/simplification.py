"""Removal of nodes that do not change the solid of a script tree."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...parameters import instance_of
from .tree import CsgTree, Node

#: The names of nodes that only unite their children, unless they have arguments.
_PLAIN = frozenset({"group", "union"})

#: The names of nodes that unite their children, so that a union among them can be replaced by its
#: operands.
_UNITING = frozenset({*_PLAIN, "color", "multmatrix", "render"})

#: The names of nodes that make plane figures, and of nodes with the dimension of their first child.
_FIGURES = frozenset({"square", "circle", "polygon", "text", "offset", "projection", "fill"})
_KEEPING = _UNITING | {"difference", "intersection", "hull", "minkowski", "resize"}


def simplified(tree: CsgTree) -> CsgTree:
    """Return a tree with fewer nodes that evaluates to the same solid.

    It omits nodes that modifiers remove from the model, groups and unions that have one child or
    are inside other unions, and identity matrices. All other nodes and all arguments remain, even
    if they cannot be evaluated.
    """
    roots = instance_of(CsgTree, tree, "tree").roots()
    return replace(tree, nodes=_with_children(Node("union", (), roots)))


class _SimplifiedNode(NamedTuple):
    """A simplified node, and the dimension of its geometry.

    Parameters
    ----------
    node : Node
    is_flat : bool or None
        True for a plane figure, False for a solid, None without geometry.
    is_mixed : bool
        True if there are plane figures and solids among its children, of which one kind is ignored.
    """

    node: Node
    is_flat: bool | None
    is_mixed: bool


def _with_children(root: Node) -> tuple[Node, ...]:
    """Return the simplified children of a node that unites them, at any depth."""
    done: list[_SimplifiedNode] = []
    waiting: list[tuple[Node, bool]] = [(root, False)]
    while waiting:
        node, children_done = waiting.pop()
        children = [child for child in node.children if not child.is_ignored]
        if not children_done:
            waiting.append((node, True))
            waiting.extend((child, False) for child in reversed(children))
            continue
        first = len(done) - len(children)
        made = done[first:]
        del done[first:]
        kinds = [child.is_flat for child in made if child.is_flat is not None]
        rebuilt = _rebuilt(node, made, at_top=not waiting)
        is_mixed = len(set(kinds)) > 1 or any(
            child.is_mixed and child.node is rebuilt for child in made
        )
        done.append(_SimplifiedNode(rebuilt, _is_flat(node, kinds), is_mixed))
    return done[0].node.children


def _rebuilt(node: Node, made: Sequence[_SimplifiedNode], at_top: bool) -> Node:
    children = tuple(child.node for child in made)
    if node.name in _UNITING:
        children = tuple(part for child in made for part in _parts(child))
    if not at_top and _is_plain(node) and len(children) == 1:
        return children[0]
    modifiers = node.modifiers.replace("!", "")
    return Node(node.name, node.arguments, children, modifiers, node.place)


def _is_flat(node: Node, kinds: Sequence[bool]) -> bool | None:
    """Return True if a node makes a plane figure, False for a solid, None without geometry.

    `kinds` are the same values for the node's children.
    """
    if node.name in _KEEPING:
        return kinds[0] if kinds else None
    texts = [argument.value for argument in node.arguments if isinstance(argument.value, str)]
    is_drawing = any(text.lower().endswith((".dxf", ".svg")) for text in texts)
    return node.name in _FIGURES or (node.name == "import" and is_drawing)


def _parts(child: _SimplifiedNode) -> tuple[Node, ...]:
    """Return the nodes that replace a child of a uniting node: its children if it unites, too."""
    is_loose = _is_plain(child.node) and not child.is_mixed
    return child.node.children if is_loose else (child.node,)


def _is_plain(node: Node) -> bool:
    if node.modifiers.replace("!", ""):
        return False
    return (node.name in _PLAIN and not node.arguments) or _is_identity(node)


def _is_identity(node: Node) -> bool:
    if node.name != "multmatrix" or len(node.arguments) != 1:
        return False
    value = node.arguments[0].value
    return isinstance(value, tuple) and value == tuple(map(tuple, np.eye(4).tolist()))
