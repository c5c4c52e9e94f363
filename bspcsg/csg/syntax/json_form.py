"""Conversion of script trees to JSON and back.

A document is ``{"format": "bspcsg-csg", "version": 1, "nodes": [...]}``; a node is
``{"node": "cube", "arguments": [{"name": "size", "value": [1, 2, 3]}], "children": [...]}``, with
``"modifiers"`` if it has any; an argument without a name is positional. Vectors are arrays, undef
is null. JSON has no infinite numbers: they are ``{"number": "inf"}``, "-inf" or "nan".
"""

import json
import math
from pathlib import Path
from typing import Any, TypeGuard

from ...errors import FormatError
from ...parameters import at_least, file_path, instance_of, text_value
from .tree import KEYWORDS, MAX_VECTOR_DEPTH, Argument, CsgTree, Node, Value, is_name

FORMAT = "bspcsg-csg"
VERSION = 1

#: The largest nesting depth of nodes in JSON; the text form allows any depth. Python's JSON reader,
#: and the code that makes nodes of its result, need up to three nested calls for a node. Python
#: allows 1000 by default, so a third of them remains for the caller.
MAX_NODE_DEPTH = 200

_NON_FINITE = {"inf": math.inf, "-inf": -math.inf, "nan": math.nan}


#: The largest number of spaces by which a level is indented.
_MAX_INDENT = 64


def to_json(tree: CsgTree, *, indent: int | None = None) -> str:
    """Return a tree as a JSON document.

    Raises
    ------
    FormatError
        If nodes are nested deeper than 200, which some JSON readers refuse; code "too_deep".
    """
    steps = None if indent is None else min(at_least(0, indent, "indent"), _MAX_INDENT)
    nodes = [_node_data(node, 1, tree.name) for node in instance_of(CsgTree, tree, "tree").nodes]
    document = {"format": FORMAT, "version": VERSION, "nodes": nodes}
    return json.dumps(document, indent=steps, ensure_ascii=False, allow_nan=False)


def from_json(text: str, name: str = "<json>", folder: str | Path | None = None) -> CsgTree:
    """Return the tree of a JSON document.

    Raises
    ------
    FormatError
        If the text is not JSON, or not a script tree; the message names the wrong entry.
    """
    place = Path() if folder is None else Path(file_path(folder, "folder"))
    text_value(name, "name")
    try:
        data = json.loads(text_value(text, "text").removeprefix("\ufeff"))
    except (ValueError, RecursionError) as error:
        raise FormatError(f"{name}: the file is not valid JSON: {error}.", "syntax") from error
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise FormatError(
            f"{name}: the JSON is not a stored tree: it must be an object whose “format” is"
            f" “{FORMAT}”.",
            "syntax",
        )
    if data.get("version") != VERSION:
        message = (
            f"{name}: the tree has version {data.get('version')!r}, but only version {VERSION} can"
            " be read."
        )
        raise FormatError(message, "syntax")
    nodes = _nodes(data.get("nodes"), "nodes", name, 1)
    return CsgTree(nodes, name, place)


def _node_data(node: Node, depth: int, name: str) -> dict[str, Any]:
    if depth > MAX_NODE_DEPTH:
        message = (
            f"{name}: nodes are nested deeper than {MAX_NODE_DEPTH} levels; write .csg instead of"
            " JSON."
        )
        raise FormatError(message, "too_deep")
    data: dict[str, Any] = {"node": node.name}
    if node.modifiers:
        data["modifiers"] = node.modifiers
    data["arguments"] = [_argument_data(argument) for argument in node.arguments]
    data["children"] = [_node_data(child, depth + 1, name) for child in node.children]
    return data


def _argument_data(argument: Argument) -> dict[str, Any]:
    named = {} if argument.name is None else {"name": argument.name}
    return {**named, "value": _value_data(argument.value)}


def _value_data(value: Value) -> Any:
    if isinstance(value, tuple):
        return [_value_data(entry) for entry in value]
    if not isinstance(value, float):
        return value
    if math.isfinite(value):
        return int(value) if value == int(value) and abs(value) < 2**53 else value
    return {"number": "nan" if math.isnan(value) else "inf" if value > 0 else "-inf"}


def _nodes(data: Any, where: str, name: str, depth: int) -> tuple[Node, ...]:
    if not isinstance(data, list):
        raise _wrong(name, where, "a list of nodes")
    if data and depth > MAX_NODE_DEPTH:
        raise FormatError(
            f"{name}: nodes are nested deeper than {MAX_NODE_DEPTH} levels.", "too_deep"
        )
    return tuple(_node(entry, f"{where}[{k}]", name, depth) for k, entry in enumerate(data))


def _node(data: Any, where: str, name: str, depth: int) -> Node:
    if not isinstance(data, dict) or not is_name(data.get("node")):
        raise _wrong(name, where, "a node with a name")
    modifiers = data.get("modifiers", "")
    if not isinstance(modifiers, str) or set(modifiers) - set("#%!*"):
        raise _wrong(name, f"{where}.modifiers", "a string of the characters # % ! *")
    arguments = data.get("arguments", [])
    if not isinstance(arguments, list):
        raise _wrong(name, f"{where}.arguments", "a list of arguments")
    found = [_argument(a, f"{where}.arguments[{k}]", name) for k, a in enumerate(arguments)]
    children = _nodes(data.get("children", []), f"{where}.children", name, depth + 1)
    return Node(data["node"], tuple(found), children, modifiers)


def _argument(data: Any, where: str, name: str) -> Argument:
    named = data.get("name") if isinstance(data, dict) else None
    if not isinstance(data, dict) or "value" not in data or not (named is None or is_name(named)):
        raise _wrong(name, where, "an argument with a value")
    if named in KEYWORDS:
        raise _wrong(name, f"{where}.name", f"a name, but {named} is a reserved value")
    return Argument(named, _value(data["value"], f"{where}.value", name, 1))


def _value(data: Any, where: str, name: str, depth: int) -> Value:
    if isinstance(data, list) and depth <= MAX_VECTOR_DEPTH:
        return tuple(
            _value(entry, f"{where}[{k}]", name, depth + 1) for k, entry in enumerate(data)
        )
    if (
        isinstance(data, dict)
        and isinstance(data.get("number"), str)
        and data["number"] in _NON_FINITE
    ):
        return _NON_FINITE[data["number"]]
    if isinstance(data, bool) or data is None or _is_text(data):
        return data
    if isinstance(data, (int, float)) and math.isfinite(number := _double(data)):
        return number
    raise _wrong(name, where, "a number, string, true, false, null or array")


def _is_text(data: Any) -> TypeGuard[str]:
    """Return True for text that can be encoded as UTF-8; JSON may contain lone surrogates."""
    try:
        return isinstance(data, str) and data.encode() is not None
    except UnicodeEncodeError:
        return False


def _double(number: int | float) -> float:
    try:
        return float(number)
    except OverflowError:
        return math.inf


def _wrong(name: str, where: str, expected: str) -> FormatError:
    return FormatError(f"{name}: {where} must be {expected}.", "syntax")
