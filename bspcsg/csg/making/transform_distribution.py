"""Distribution of transforms to the operands of set operations."""

from dataclasses import replace

import numpy as np

from ..syntax.arguments import is_number
from ..syntax.tree import Node, Value

#: The names of nodes that combine their children without a transform.
COMBINING = frozenset({"group", "union", "color", "render", "difference", "intersection"})

#: The largest number of nested transforms that are distributed to parts. Each part repeats all
#: transforms around it.
_MAX_NESTED_MOVES = 64


def with_transforms_distributed(root: Node) -> Node:
    """Return an equivalent tree with transforms applied to the operands of set operations.

    Matrices that translate, scale, mirror or exchange axes are moved inwards through set
    operations, so that the operands become parts of the model; their axis-aligned faces stay
    axis-aligned. A node under any other rotation stays one part, since snapping would bend the
    faces of its operands. Nodes may be nested to any depth.
    """
    waiting: list[tuple[Node, tuple[Node, ...], bool]] = [(root, (), False)]
    done: list[Node] = []
    while waiting:
        node, moves, is_ready = waiting.pop()
        if is_ready:
            first = len(done) - len(node.children)
            children = tuple(done[first:])
            del done[first:]
            done.append(_combined(node, children))
        elif node.is_ignored:
            done.append(node)
        elif node.name in COMBINING or (len(moves) < _MAX_NESTED_MOVES and _keeps_axes(node)):
            inner = moves if node.name in COMBINING else (*moves, node)
            waiting.append((node, moves, True))
            waiting.extend((child, inner, False) for child in reversed(node.children))
        else:
            for move in reversed(moves):
                node = replace(move, children=(node,))
            done.append(node)
    return done[0]


def _combined(node: Node, children: tuple[Node, ...]) -> Node:
    if node.name in COMBINING:
        return replace(node, children=children)
    return Node("group", (), children, node.modifiers, node.place)


def _keeps_axes(node: Node) -> bool:
    """Return True if a node is a matrix whose linear part has one entry per row and column."""
    if node.name != "multmatrix" or len(node.arguments) != 1:
        return False
    [argument] = node.arguments
    rows = _rows(argument.value)
    if argument.name not in (None, "m") or rows is None or not np.isfinite(rows).all():
        return False
    used = np.array(rows)[:3, :3] != 0
    return bool((used.sum(axis=0) == 1).all() and (used.sum(axis=1) == 1).all())


def _rows(value: Value) -> list[list[float]] | None:
    rows = [row for row in value if isinstance(row, tuple)] if isinstance(value, tuple) else []
    numbers = [[entry for entry in row if is_number(entry)] for row in rows]
    is_matrix = isinstance(value, tuple) and len(value) == len(numbers) and len(numbers) in (3, 4)
    return numbers if is_matrix and all(len(row) == 4 for row in numbers) else None
