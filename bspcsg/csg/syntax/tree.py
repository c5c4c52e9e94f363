"""The tree of a script: immutable nodes with arguments and children."""

import math
import re
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from numbers import Real
from pathlib import Path
from types import NoneType
from typing import Any, NamedTuple, TypeAlias, TypeGuard, TypeVar

from ...errors import BspcsgError, invalid_parameter
from ...parameters import shown
from .intermediate import Intermediate

#: The value of an argument: a number, text, truth value, undef (None), or a vector of values.
Value: TypeAlias = "float | str | bool | tuple[Value, ...] | None"

#: Keywords that denote values, and so cannot be names of arguments.
KEYWORDS: dict[str, Value] = {
    "true": True,
    "false": False,
    "undef": None,
    "inf": math.inf,
    "nan": math.nan,
}

#: The largest nesting depth of vectors. OpenSCAD writes a depth of two, for matrices and paths.
MAX_VECTOR_DEPTH = 64

_SCALAR = frozenset({float, str, bool, NoneType})
_NAME = re.compile(r"\$?[A-Za-z_]\w*")
_Part = TypeVar("_Part")


class Place(NamedTuple):
    """A line and a column of a script, both from 1; (0, 0) if unknown."""

    line: int
    column: int


NOWHERE = Place(0, 0)

#: The special variables for numbers of sides, which nodes inherit from enclosing nodes.
SPECIAL = ("$fn", "$fa", "$fs", "$fe")


def is_name(name: Any) -> TypeGuard[str]:
    """Return True if a value is a text that may be the name of a node or argument."""
    return isinstance(name, str) and _NAME.fullmatch(name) is not None


def _plain(value: Any, depth: int = 0) -> "Value":
    """Convert a value to the types of trees: numbers to floats, lists and arrays to tuples.

    Raise `InvalidParameterError` for a value that scripts cannot represent.
    """
    if type(value) in _SCALAR:
        return value  # type: ignore[no-any-return]
    if isinstance(value, (tuple, list)) and depth < MAX_VECTOR_DEPTH:
        if isinstance(value, tuple) and _SCALAR.issuperset(map(type, value)):
            return value
        return tuple([_plain(entry, depth + 1) for entry in value])
    if hasattr(value, "tolist"):  # NumPy's
        return _plain(value.tolist(), depth)
    if isinstance(value, str):
        return str(value)
    with suppress(OverflowError):
        if isinstance(value, Real):
            return float(value)
    raise invalid_parameter(
        "A value in a script must be a number, string, bool, None or a vector of these,"
        f" nested at most {MAX_VECTOR_DEPTH} levels, not {shown(value)}."
    )


def _parts(kind: type[_Part], given: Any, what: str) -> tuple[_Part, ...]:
    """Return a tuple of entries of type `kind`; raise an error for any other entry."""
    parts = tuple(given) if isinstance(given, (tuple, list)) else None
    if parts is None or not all(isinstance(part, kind) for part in parts):
        raise invalid_parameter(f"{what} must be a tuple of {kind.__name__}, not {shown(given)}.")
    return parts


def _are_same(one: "Value", other: "Value") -> bool:
    """Return True if two values are equal; unlike in Python, true does not equal 1."""
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(_are_same, one, other))
    return isinstance(one, bool) == isinstance(other, bool) and (one is other or one == other)


@dataclass(frozen=True, slots=True, eq=False)
class Argument:
    """One argument of a node: its name and value.

    Parameters
    ----------
    name : str or None
        A name such as ``"size"`` or ``"$fn"``; None for a positional argument.
    value : Value
        The value; lists become tuples, and all numbers floats.

    Raises
    ------
    InvalidParameterError
        If a script cannot represent the name or the value.
    """

    name: str | None
    value: Value

    def __post_init__(self) -> None:
        if self.name is not None and (not is_name(self.name) or self.name in KEYWORDS):
            raise invalid_parameter(
                f"{shown(self.name)} is not a valid argument name; use letters, digits and"
                " underscores, and no reserved word."
            )
        object.__setattr__(self, "value", _plain(self.value))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Argument):
            return NotImplemented
        return self.name == other.name and _are_same(self.value, other.value)

    def __hash__(self) -> int:
        return hash((self.name, self.value))


#: A node as a tuple with the numbers of its children, for pickling.
_Row: TypeAlias = tuple[str, tuple[Argument, ...], list[int], str, Place]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Node:
    """A node of a script tree: a primitive, or a transform of or an operation on its children.

    Parameters
    ----------
    name : str
        A name such as ``"cube"`` or ``"difference"``; it need not be one that can be evaluated.
    arguments : tuple of Argument
        The arguments, in the order of the script.
    children : tuple of Node
        The nodes inside this node, nested to any depth.
    modifiers : str
        Any of ``#`` (no effect), ``%`` and ``*`` (the node is ignored) and ``!`` (all other nodes
        are ignored).
    place : Place
        The line and column of the name, which are ignored when nodes are compared.

    Raises
    ------
    InvalidParameterError
        If a script cannot represent the node.
    """

    name: str
    arguments: tuple[Argument, ...] = ()
    children: tuple["Node", ...] = ()
    modifiers: str = ""
    place: Place = field(default=NOWHERE, compare=False)

    def __post_init__(self) -> None:
        if not is_name(self.name):
            raise invalid_parameter(
                f"{shown(self.name)} is not a valid node name; use letters, digits and underscores."
            )
        if not isinstance(self.modifiers, str) or set(self.modifiers) - set("#%!*"):
            raise invalid_parameter(
                "modifiers must be a string of the characters # % ! *, not"
                f" {shown(self.modifiers)}."
            )
        object.__setattr__(self, "arguments", _parts(Argument, self.arguments, "Arguments"))
        object.__setattr__(self, "children", _parts(Node, self.children, "Children"))

    @property
    def is_ignored(self) -> bool:
        """True if a modifier ``%`` or ``*`` removes the node from the model."""
        return "%" in self.modifiers or "*" in self.modifiers

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Node):
            return NotImplemented
        waiting, seen = [(self, other)], set()
        while waiting:
            a, b = waiting.pop()
            if a is b or (id(a), id(b)) in seen:
                continue
            seen.add((id(a), id(b)))
            if _head(a) != _head(b):
                return False
            waiting.extend(zip(a.children, b.children, strict=True))
        return True

    def __hash__(self) -> int:
        made: dict[int, int] = {}
        for node in _distinct(self):
            made[id(node)] = hash((_head(node), tuple(made[id(child)] for child in node.children)))
        return made[id(self)]

    def __repr__(self) -> str:
        """Return a text with all fields, as for other dataclasses, at any depth of the tree."""
        parts: list[str] = []
        waiting: list[Node | str] = [self]
        while waiting:
            item = waiting.pop()
            if isinstance(item, str):
                parts.append(item)
                continue
            parts.append(f"Node(name={item.name!r}, arguments={item.arguments!r}, children=(")
            end = "," if len(item.children) == 1 else ""
            waiting.append(f"{end}), modifiers={item.modifiers!r}, place={item.place!r})")
            for number, child in reversed(list(enumerate(item.children))):
                waiting += [child, ", "] if number else [child]
        return "".join(parts)

    def __copy__(self) -> "Node":
        """Return the node itself, which never changes."""
        return self

    def __deepcopy__(self, memo: dict[int, object]) -> "Node":
        """Return the node itself, which never changes."""
        return self

    def __reduce__(self) -> tuple[Callable[[list[_Row]], "Node"], tuple[list[_Row]]]:
        """Return what pickle needs: all nodes in a list, each after its children."""
        nodes = _distinct(self)
        numbers = {id(node): number for number, node in enumerate(nodes)}
        return _planted, (
            [
                (n.name, n.arguments, [numbers[id(c)] for c in n.children], n.modifiers, n.place)
                for n in nodes
            ],
        )


def _head(node: Node) -> tuple[str, tuple[Argument, ...], str, int]:
    """Return a node's name, arguments and modifiers, and the number of its children."""
    return node.name, node.arguments, node.modifiers, len(node.children)


def _distinct(root: Node) -> list[Node]:
    """Return the nodes of a tree without repetition, each after its children."""
    waiting: list[tuple[Node, bool]] = [(root, False)]
    done: dict[int, Node] = {}
    while waiting:
        node, is_ready = waiting.pop()
        if is_ready:
            done.setdefault(id(node), node)
        elif id(node) not in done:
            waiting.append((node, True))
            waiting.extend((child, False) for child in node.children)
    return list(done.values())


def _planted(rows: list[_Row]) -> Node:
    """Return the tree of pickled rows: the last row is the root, rows refer to earlier ones."""
    made: list[Node] = []
    for name, arguments, children, modifiers, place in rows:
        made.append(Node(name, arguments, tuple(made[k] for k in children), modifiers, place))
    return made[-1]


@dataclass(frozen=True)
class CsgTree:
    """The content of a script: its top-level nodes, which are united.

    Parameters
    ----------
    nodes : tuple of Node
        The top-level nodes.
    name : str
        The script's name in errors.
    folder : Path
        The folder of the files that the script imports.
    intermediate : Intermediate, optional
        The `.csg` text to which lines and columns of nodes refer, if it is not the script itself.
    """

    nodes: tuple[Node, ...]
    name: str = field(default="<csg>", compare=False)
    folder: Path = field(default_factory=Path, compare=False)
    intermediate: Intermediate | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "nodes", _parts(Node, self.nodes, "The nodes of a tree"))

    def explained(self, error: BspcsgError) -> BspcsgError:
        """Return an error with the lines of the script added that its message refers to."""
        return error if self.intermediate is None else self.intermediate.explained(error)

    def roots(self) -> tuple[Node, ...]:
        """Return the nodes that are evaluated: the first one marked ``!``, or all top-level nodes.

        Nodes inside a node marked ``*`` are not searched. A node marked ``!`` is put into a group
        with the special variables that apply to it, if there are any.
        """
        waiting: list[tuple[Node, dict[str, Argument]]] = [(node, {}) for node in self.nodes[::-1]]
        while waiting:
            node, scope = waiting.pop()
            if "*" in node.modifiers:
                continue
            if "!" in node.modifiers:
                return (Node("group", tuple(scope.values()), (node,)),) if scope else (node,)
            inner = scope | {a.name: a for a in node.arguments if a.name in SPECIAL}
            waiting.extend((child, inner) for child in reversed(node.children))
        return self.nodes
