"""Writing of script trees as text."""

import math
from collections.abc import Mapping

from ...parameters import instance_of, truth_value
from .tokens import quoted
from .tree import Argument, CsgTree, Node, Value

#: The largest number of levels that are indented; with more, the text of a deep tree would be
#: mostly tabs.
_MAX_INDENT_DEPTH = 40


#: The texts of numbers that are not finite, in `.csg` scripts and in OpenSCAD's own language.
_IN_CSG = {math.inf: "inf", -math.inf: "-inf", math.nan: "nan"}
_IN_SCAD = {math.inf: "1 / 0", -math.inf: "-1 / 0", math.nan: "0 / 0"}


def written(tree: CsgTree, *, scad: bool = False) -> str:
    """Return a tree as the text of a `.csg` script; parsing it gives an equal tree.

    Numbers are written with enough digits to identify the doubles: OpenSCAD itself writes six
    digits, but reads all.

    Parameters
    ----------
    tree : CsgTree
    scad : bool
        True for OpenSCAD's own language, in which infinity has no name.
    """
    odd = _IN_SCAD if truth_value(scad, "scad") else _IN_CSG
    lines: list[str] = []
    waiting: list[Node | str] = list(reversed(instance_of(CsgTree, tree, "tree").nodes))
    depth = 0
    while waiting:
        node = waiting.pop()
        if isinstance(node, str):
            depth -= 1
            lines.append(_indent(depth) + node)
            continue
        head = _indent(depth) + node.modifiers + _call(node, odd)
        lines.append(head + (" {" if node.children else ";"))
        if node.children:
            depth += 1
            waiting.append("}")
            waiting.extend(reversed(node.children))
    return "\n".join(lines) + "\n" if lines else ""


def _indent(depth: int) -> str:
    return "\t" * min(depth, _MAX_INDENT_DEPTH)


def _call(node: Node, odd: Mapping[float, str]) -> str:
    return f"{node.name}({', '.join(_argument(argument, odd) for argument in node.arguments)})"


def _argument(argument: Argument, odd: Mapping[float, str]) -> str:
    value = value_text(argument.value, odd)
    return value if argument.name is None else f"{argument.name} = {value}"


def value_text(value: Value, odd: Mapping[float, str] = _IN_CSG) -> str:
    """Return the text of a value in the script language."""
    if isinstance(value, tuple):
        return f"[{', '.join(value_text(entry, odd) for entry in value)}]"
    if isinstance(value, bool) or value is None:
        return {True: "true", False: "false", None: "undef"}[value]
    return quoted(value) if isinstance(value, str) else number_text(value, odd)


def number_text(value: float, odd: Mapping[float, str] = _IN_CSG) -> str:
    """Return a number as text, with the fewest digits that identify the double."""
    if math.isfinite(value):
        return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(float(value))
    # NaN is not equal to itself, so look up the object `math.nan`.
    return odd[math.nan if math.isnan(value) else value]
