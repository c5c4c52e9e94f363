"""Display of script trees: as indented text, and as graphs for Graphviz."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ...parameters import instance_of
from .tokens import quoted
from .tree import Argument, CsgTree, Node, Value
from .writer import value_text

#: The largest number of characters that are displayed of a value.
_MAX_VALUE_CHARACTERS = 64

#: The largest number of indented levels; nodes at a greater depth display the depth as a number.
_MAX_INDENT_DEPTH = 40


class _DisplayedNode(NamedTuple):
    """A node and its position in a displayed tree.

    Parameters
    ----------
    node : Node
    depth : int
        The depth of the node; top nodes have depth 1.
    ended : tuple of bool
        For each enclosing node, whether it is the last of its siblings.
    is_last : bool
        True if the node is the last of its siblings.
    """

    node: Node
    depth: int
    ended: tuple[bool, ...]
    is_last: bool


def outline(tree: CsgTree) -> str:
    """Return a tree as text: one line per node, indented by depth, with long values shortened."""
    lines = [instance_of(CsgTree, tree, "tree").name]
    for place in _walk(tree):
        indent = "".join("   " if last else "│  " for last in place.ended)
        branch = "└─ " if place.is_last else "├─ "
        number = f"({place.depth}) " if place.depth > _MAX_INDENT_DEPTH else ""
        lines.append(f"{indent}{branch}{number}{_label(place.node)}")
    return "\n".join(lines) + "\n"


def graph(tree: CsgTree) -> str:
    """Return a tree as a graph in Graphviz's language; ``dot -Tsvg`` draws it."""
    lines = ["digraph csg {", "  node [shape=box, fontname=monospace];"]
    path: list[int] = []
    for number, place in enumerate(_walk(instance_of(CsgTree, tree, "tree"))):
        del path[place.depth - 1 :]
        lines.append(f"  n{number} [label={quoted(_label(place.node))}];")
        if path:
            lines.append(f"  n{path[-1]} -> n{number};")
        path.append(number)
    return "\n".join([*lines, "}"]) + "\n"


def _walk(tree: CsgTree) -> Iterator[_DisplayedNode]:
    """Yield the nodes of a tree of any depth, in the order of the script."""
    waiting = _siblings(tree.nodes, 1, ())
    while waiting:
        place = waiting.pop()
        yield place
        ended = (*place.ended, place.is_last)[:_MAX_INDENT_DEPTH]
        waiting += _siblings(place.node.children, place.depth + 1, ended)


def _siblings(nodes: Sequence[Node], depth: int, ended: tuple[bool, ...]) -> list[_DisplayedNode]:
    """Return sibling nodes with their positions, in reverse order."""
    last = len(nodes) - 1
    return [_DisplayedNode(nodes[k], depth, ended, k == last) for k in range(last, -1, -1)]


def _label(node: Node) -> str:
    return f"{node.modifiers}{node.name}({', '.join(map(_argument, node.arguments))})"


def _argument(argument: Argument) -> str:
    value = _short(argument.value)
    return value if argument.name is None else f"{argument.name} = {value}"


def _short(value: Value) -> str:
    if isinstance(value, tuple) and len(value) > _MAX_VALUE_CHARACTERS:
        return f"[{len(value)} values]"
    text = value_text(value)
    if len(text) <= _MAX_VALUE_CHARACTERS:
        return text
    return (
        f"[{len(value)} values]"
        if isinstance(value, tuple)
        else text[: _MAX_VALUE_CHARACTERS - 1] + "…"
    )
