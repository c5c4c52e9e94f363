"""Removes nodes that make no difference from trees."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...parameters import of_kind
from .tree import CsgTree, Node

#: Nodes that only unite their children, unless they have arguments.
_PLAIN = frozenset({"group", "union"})

#: Nodes that unite their children, so a child may be replaced by the parts of its union.
_UNITING = frozenset({*_PLAIN, "color", "multmatrix", "render"})

#: Nodes that make plane figures, and nodes that make whatever their first child is.
_FIGURES = frozenset({"square", "circle", "polygon", "text", "offset", "projection", "fill"})
_KEEPING = _UNITING | {"difference", "intersection", "hull", "minkowski", "resize"}


def simplified(tree: CsgTree) -> CsgTree:
    """Return a tree of the same solid with fewer nodes.

    It leaves out nodes that modifiers remove from the model, groups and unions of one child or
    inside others, and matrices that move nothing. Other nodes and all arguments stay, even if they
    cannot be evaluated.
    """
    roots = of_kind(CsgTree, tree, "tree").roots()
    return replace(tree, nodes=_with_children(Node("union", (), roots)))


class _SimplifiedNode(NamedTuple):
    """A simplified node.

    Parameters
    ----------
    node : Node
    is_flat : bool or None
        True for a plane figure, False for a solid, None for nothing.
    is_mixed : bool
        True if its children have both dimensions, so that some of them are ignored.
    """

    node: Node
    is_flat: bool | None
    is_mixed: bool


def _with_children(root: Node) -> tuple[Node, ...]:
    """Return the simplified children of a node that unites; trees may be any depth."""
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
    """Say whether a node with children of these kinds makes a plane figure."""
    if node.name in _KEEPING:
        return kinds[0] if kinds else None
    texts = [argument.value for argument in node.arguments if isinstance(argument.value, str)]
    is_drawing = any(text.lower().endswith((".dxf", ".svg")) for text in texts)
    return node.name in _FIGURES or (node.name == "import" and is_drawing)


def _parts(child: _SimplifiedNode) -> tuple[Node, ...]:
    """Return the nodes that may replace a child of a node that unites."""
    is_loose = _is_plain(child.node) and not child.is_mixed
    return child.node.children if is_loose else (child.node,)


def _is_plain(node: Node) -> bool:
    if node.modifiers.replace("!", ""):
        return False
    return (node.name in _PLAIN and not node.arguments) or _moves_nothing(node)


def _moves_nothing(node: Node) -> bool:
    if node.name != "multmatrix" or len(node.arguments) != 1:
        return False
    value = node.arguments[0].value
    return isinstance(value, tuple) and value == tuple(map(tuple, np.eye(4).tolist()))
