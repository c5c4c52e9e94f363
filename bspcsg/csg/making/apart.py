"""Trees in which moves stand around single parts."""

from dataclasses import replace

import numpy as np

from ..syntax.arguments import is_number
from ..syntax.tree import Node, Value

#: Nodes that combine their children where they stand.
COMBINING = frozenset({"group", "union", "color", "render", "difference", "intersection"})

#: The largest number of moves inside one another that are taken apart: each part repeats all of the
#: moves around it.
_MAX_NESTED_MOVES = 64


def moved_apart(root: Node) -> Node:
    """Return a tree that says the same, in which what is combined is moved part by part.

    Moves go through set operations. So do maps that scale, mirror or swap axes, and flatten none:
    the parts inside of them are parts of the model, and faces across axes stay such. What is turned
    otherwise stays one part, whose faces would be bent by a lattice. Nodes may nest to any depth.
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
    """Say whether a node only moves its children by a matrix that has one number for each axis."""
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
