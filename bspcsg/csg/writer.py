"""Trees as text."""

import math

from .tokens import quoted
from .tree import Argument, CsgTree, Node, Value

#: Lines are indented no further, so that a deep tree does not become mostly white.
_DEEPEST_INDENT = 40


def written(tree: CsgTree) -> str:
    """Return a tree as a `.csg` script; reading it gives an equal tree.

    Numbers are written so that reading them gives the same doubles: OpenSCAD itself writes six
    digits, but reads all.
    """
    lines: list[str] = []
    waiting: list[Node | str] = list(reversed(tree.nodes))
    depth = 0
    while waiting:
        node = waiting.pop()
        if isinstance(node, str):
            depth -= 1
            lines.append(_indent(depth) + node)
            continue
        head = _indent(depth) + node.modifiers + _call(node)
        lines.append(head + (" {" if node.children else ";"))
        if node.children:
            depth += 1
            waiting.append("}")
            waiting.extend(reversed(node.children))
    return "\n".join(lines) + "\n" if lines else ""


def _indent(depth: int) -> str:
    return "\t" * min(depth, _DEEPEST_INDENT)


def _call(node: Node) -> str:
    return f"{node.name}({', '.join(map(_argument, node.arguments))})"


def _argument(argument: Argument) -> str:
    value = value_text(argument.value)
    return value if argument.name is None else f"{argument.name} = {value}"


def value_text(value: Value) -> str:
    """Return a value as a script writes it."""
    if isinstance(value, tuple):
        return f"[{', '.join(map(value_text, value))}]"
    if isinstance(value, bool) or value is None:
        return {True: "true", False: "false", None: "undef"}[value]
    return quoted(value) if isinstance(value, str) else number_text(value)


def number_text(value: float) -> str:
    """Return a number in as few digits as give the same double again."""
    if math.isfinite(value):
        return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(value)
    return "nan" if math.isnan(value) else "-inf" if value < 0 else "inf"
