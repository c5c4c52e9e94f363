"""A node's arguments, checked when they are read; errors name line and column."""

import math
from typing import Any, TypeGuard

from ...errors import FormatError
from ...parameters import MAX_CORNERS, MAX_SEGMENTS
from .source import error_at
from .tree import Node, Value
from .writer import value_text

#: The largest number that may be a length or an angle: the product of three still fits a double.
MAX_NUMBER = 1e100

#: The type of numbers in trees and of defaults; true and false have another type.
_FLOAT = frozenset({float})

#: The largest number of characters of a value that an error quotes.
_MAX_QUOTED_CHARACTERS = 40


class Arguments:
    """The arguments of one node.

    Positional arguments take the names of `order`, one after another. Missing arguments and undef
    stand for the default.

    Parameters
    ----------
    node : Node
    script : str
        The script's name, for errors.
    order : tuple of str
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
        """Say whether the argument is there and not undef."""
        return self._values.get(name) is not None

    def value(self, name: str) -> Value:
        """Return the argument as it is, None if it is missing."""
        return self._values.get(name)

    def number(self, name: str, default: float | None = None) -> float:
        """Return a number, finite and not absurdly large."""
        value = self._given(name, default)
        if not is_number(value) or not _is_usable(value):
            raise self._wrong(name, "a number from -1e100 to 1e100", value)
        return float(value)

    def flag(self, name: str, default: bool = False) -> bool:
        """Return true or false; a number is true if it is not zero."""
        value = self._given(name, default)
        if not isinstance(value, (bool, float, int)):
            raise self._wrong(name, "true or false", value)
        return bool(value)

    def text(self, name: str, default: str | None = None) -> str:
        """Return a text."""
        value = self._given(name, default)
        if not isinstance(value, str):
            raise self._wrong(name, "a string", value)
        return value

    def vector(
        self, name: str, size: int, default: tuple[float, ...] | None = None
    ) -> tuple[float, ...]:
        """Return `size` numbers; one number alone stands for all of them."""
        value = self._given(name, default)
        if is_number(value):
            value = (value,) * size
        if not isinstance(value, tuple) or len(value) < size or not _all_usable(value[:size]):
            raise self._wrong(name, f"{size} numbers from -1e100 to 1e100", value)
        return tuple(float(entry) for entry in value[:size])

    def padded(self, name: str, size: int) -> tuple[float, ...]:
        """Return `size` numbers, 0 for those that are not given."""
        value = self._given(name, ())
        if isinstance(value, tuple) and len(value) < size and _all_usable(value):
            return (*map(float, value), *(0.0,) * (size - len(value)))
        return self.vector(name, size)

    def points(self, name: str, size: int) -> list[tuple[float, ...]]:
        """Return points of `size` numbers each."""
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
        """Return lists of indices below `count`; if `single`, one list need not be in a list."""
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
        """Return a number of corners, or raise an error if it would not fit into memory."""
        if not count <= MAX_CORNERS:
            message = (
                f"{what} would have more than {MAX_CORNERS:,} corners, the largest number that is"
                " allowed."
            )
            raise self.error(message, "too_large")
        return int(count)

    def sides(self, count: float, what: str) -> int:
        """Return a number of sides around, or raise an error if it is absurd."""
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
    """Say whether a value is a number; true and false are not."""
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _is_finite(value: Any) -> bool:
    """Say whether all numbers in a value are finite, at any depth."""
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
    # Only functions written in C look at long lists.
    return _FLOAT.issuperset(map(type, values)) and all(map(MAX_NUMBER.__ge__, map(abs, values)))
