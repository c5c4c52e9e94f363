"""The arguments of a node, checked when they are read; errors name line and column."""

import math
from typing import Any, TypeGuard

from ...errors import FormatError
from ...parameters import MAX_CORNERS, MAX_SEGMENTS
from .source import error_at
from .tree import Node, Value
from .writer import value_text

#: The largest allowed length or angle: the product of three such numbers still fits in a double.
MAX_NUMBER = 1e100

#: The only type of numbers in trees and of default values.
_FLOAT = frozenset({float})

#: The largest number of characters of a value that an error quotes.
_MAX_QUOTED_CHARACTERS = 40


class Arguments:
    """The arguments of one node.

    Positional arguments get the names in `order`, one after another. An argument that is missing or
    undef has the default value.

    Parameters
    ----------
    node : Node
    script : str
        The name of the script in errors.
    order : tuple of str
        The names of positional arguments.
    """

    def __init__(self, node: Node, script: str, order: tuple[str, ...] = ()) -> None:
        self.node = node
        self._script = script
        self._values: dict[str, Value] = {}
        unnamed = iter(order)
        for argument in node.arguments:
            name = next(unnamed, None) if argument.name is None else argument.name
            if name is not None:
                self._values[name] = argument.value

    def error(self, message: str, code: str = "bad_argument") -> FormatError:
        """Return the error for this node; the message names script, line and column."""
        message = f"{self.node.name}(): {message}"
        return error_at(self._script, self.node.place, message, code)

    def __contains__(self, name: str) -> bool:
        """Return True if the argument is given and is not undef."""
        return self._values.get(name) is not None

    def value(self, name: str) -> Value:
        """Return the unchecked value of an argument; None if it is missing or undef."""
        return self._values.get(name)

    def number(self, name: str, default: float | None = None) -> float:
        """Return an argument that must be a number from -1e100 to 1e100."""
        value = self._given(name, default)
        if not is_number(value) or not _is_usable(value):
            raise self._wrong(name, "a number from -1e100 to 1e100", value)
        return float(value)

    def flag(self, name: str, default: bool = False) -> bool:
        """Return an argument as a truth value; a number is true if it is not zero."""
        value = self._given(name, default)
        if not isinstance(value, (bool, float, int)):
            raise self._wrong(name, "true or false", value)
        return bool(value)

    def text(self, name: str, default: str | None = None) -> str:
        """Return an argument that must be a text."""
        value = self._given(name, default)
        if not isinstance(value, str):
            raise self._wrong(name, "a string", value)
        return value

    def vector(
        self, name: str, size: int, default: tuple[float, ...] | None = None
    ) -> tuple[float, ...]:
        """Return an argument of `size` numbers; a single number is repeated."""
        value = self._given(name, default)
        if is_number(value):
            value = (value,) * size
        if not isinstance(value, tuple) or len(value) < size or not _all_usable(value[:size]):
            raise self._wrong(name, f"{size} numbers from -1e100 to 1e100", value)
        return tuple(float(entry) for entry in value[:size])

    def padded(self, name: str, size: int) -> tuple[float, ...]:
        """Return an argument of `size` numbers; missing numbers at the end are 0."""
        value = self._given(name, ())
        if isinstance(value, tuple) and len(value) < size and _all_usable(value):
            return (*map(float, value), *(0.0,) * (size - len(value)))
        return self.vector(name, size)

    def points(self, name: str, size: int) -> list[tuple[float, ...]]:
        """Return an argument that must be a list of points with `size` numbers each."""
        value = self._given(name, None)
        if not isinstance(value, tuple):
            raise self._wrong(name, "a list of points", value)
        for number, point in enumerate(value):
            if not isinstance(point, tuple) or len(point) != size or not _all_usable(point):
                raise self._wrong(
                    f"{name}[{number}]", f"{size} numbers from -1e100 to 1e100", point
                )
        return list(value)

    def index_lists(self, name: str, count: int, *, single: bool = False) -> list[list[int]]:
        """Return an argument that must be a list of lists of indices below `count`.

        If `single`, it may also be one list of indices.
        """
        value = self._given(name, None)
        if single and isinstance(value, tuple) and value and is_number(value[0]):
            value = (value,)
        if not isinstance(value, tuple):
            raise self._wrong(name, "a list of lists of point indices", value)
        return [self._indices(f"{name}[{k}]", entry, count) for k, entry in enumerate(value)]

    def _indices(self, name: str, value: Any, count: int) -> list[int]:
        if not isinstance(value, tuple):
            raise self._wrong(name, "a list of point indices", value)
        is_whole = _FLOAT.issuperset(map(type, value)) and all(map(float.is_integer, value))
        if value and not (is_whole and min(value) >= 0 and max(value) < count):
            raise self._wrong(name, f"whole numbers from 0 to {count - 1}", value)
        return list(map(int, value))

    def limited(self, count: float, what: str) -> int:
        """Return a number of corners; raise an error if it exceeds `MAX_CORNERS`."""
        if not count <= MAX_CORNERS:
            message = (
                f"{what} would have more than {MAX_CORNERS:,} corners, the largest number that is"
                " allowed."
            )
            raise self.error(message, "too_large")
        return int(count)

    def sides(self, count: float, what: str) -> int:
        """Return a number of sides of a circle; raise an error if it exceeds `MAX_SEGMENTS`."""
        if not count <= MAX_SEGMENTS:
            message = (
                f"{what} would have more than {MAX_SEGMENTS:,} sides, the largest number that is"
                " allowed."
            )
            raise self.error(message, "too_large")
        return int(count)

    def _given(self, name: str, default: Any) -> Any:
        value = self._values.get(name)
        if value is None and default is None:
            raise self.error(f"the required argument {name} is missing.", "missing_argument")
        return default if value is None else value

    def _wrong(self, name: str, expected: str, value: Any) -> FormatError:
        shown = value_text(value)
        shown = (
            shown if len(shown) <= _MAX_QUOTED_CHARACTERS else shown[:_MAX_QUOTED_CHARACTERS] + "…"
        )
        code = "bad_argument" if _is_finite(value) else "not_finite"
        return self.error(f"{name} must be {expected}, not {shown}.", code)


def is_number(value: Any) -> TypeGuard[float]:
    """Return True if a value is an int or a float, but not a truth value."""
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _is_finite(value: Any) -> bool:
    """Return True if all numbers in a value, also in nested tuples, are finite."""
    waiting = [value]
    while waiting:
        one = waiting.pop()
        if isinstance(one, tuple):
            waiting.extend(one)
        elif isinstance(one, float) and not math.isfinite(one):
            return False
    return True


def _is_usable(value: float) -> bool:
    return abs(value) <= MAX_NUMBER  # false for NaN


def _all_usable(values: tuple[Any, ...]) -> bool:
    # Long lists are tested by functions written in C only, for speed.
    return _FLOAT.issuperset(map(type, values)) and all(map(MAX_NUMBER.__ge__, map(abs, values)))
