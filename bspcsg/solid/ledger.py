"""Ledgers: the solids that an open block, a ``with`` statement, combines at its end.

A solid counts if the block combines it. A function that makes a solid for its caller is `counted`:
its result counts instead of its operands, and solids made inside the function do not count. A query
is `uncounted`: no solid made inside it counts. Outside blocks, both decorators cost one lookup of a
context variable.
"""

import itertools
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import wraps
from threading import Lock
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar, cast

if TYPE_CHECKING:
    from .solid import Solid

_Parameters = ParamSpec("_Parameters")
_Result = TypeVar("_Result")


class Ledger:
    """The solids that one block, a ``with`` statement, combines at its end, in order.

    Parameters
    ----------
    outer : Ledger or None
        The ledger of the enclosing block, if there is one.
    """

    def __init__(self, outer: "Ledger | None") -> None:
        self.outer = outer
        self.is_open = True
        # Keyed by identity, since ``==`` compares solids as sets of points.
        self._kept: dict[int, tuple[int, Solid]] = {}
        self._ranks = itertools.count()
        # Tasks and threads started in a block may share its ledger.
        self._lock = Lock()

    @property
    def solids(self) -> tuple["Solid", ...]:
        """The solids in order; a result stands where the first of its operands stood."""
        with self._lock:
            ranked = sorted(self._kept.values(), key=lambda entry: entry[0])
        return tuple(solid for _, solid in ranked)

    def discard(self, solids: Iterable["Solid"]) -> int | None:
        """Remove solids; return the first of their positions, or None if none is in the ledger."""
        with self._lock:
            gone = [self._kept.pop(id(solid), None) for solid in solids]
        return min((entry[0] for entry in gone if entry is not None), default=None)

    def put(self, solid: "Solid", rank: int | None = None) -> None:
        """Add a solid at a position or at the end, unless the ledger contains it already."""
        with self._lock:
            place = next(self._ranks) if rank is None else rank
            self._kept.setdefault(id(solid), (place, solid))


_current: ContextVar[Ledger | None] = ContextVar("bspcsg_block", default=None)


def current_ledger() -> Ledger | None:
    """Return the ledger of the innermost open block of this thread or task, None without one."""
    ledger = _current.get()
    # A task may outlive the block in which it was started.
    while ledger is not None and not ledger.is_open:
        ledger = ledger.outer
    return ledger


def open_ledger() -> Ledger:
    """Open a ledger for a block inside the current block, make it current and return it."""
    ledger = Ledger(current_ledger())
    _current.set(ledger)
    return ledger


def close_ledger(ledger: Ledger) -> None:
    """Close the ledger of a block, and make that of the enclosing block current again."""
    ledger.is_open = False
    _current.set(ledger.outer)


@contextmanager
def _apart() -> Iterator[None]:
    token = _current.set(None)
    try:
        yield
    finally:
        _current.reset(token)


def count(made: "Solid", operands: Iterable["Solid"] = ()) -> None:
    """Add a solid to the current block, and remove its operands from all open blocks."""
    ledger = current_ledger()
    if ledger is None:
        return
    given = list(operands)
    rank = ledger.discard(given)
    around = ledger.outer
    while around is not None:
        around.discard(given)
        around = around.outer
    ledger.put(made, rank)


def counted(function: Callable[_Parameters, _Result]) -> Callable[_Parameters, _Result]:
    """Decorate a function so that the solid it returns replaces its arguments in a block."""

    @wraps(function)
    def counting(*args: _Parameters.args, **kwargs: _Parameters.kwargs) -> _Result:
        if _current.get() is None:
            return function(*args, **kwargs)
        with _apart():
            result = function(*args, **kwargs)
        if not isinstance(result, _solid_type()):
            return result
        given = _solids_in((*args, *kwargs.values()))
        # If the function returns an argument, count a copy: a later use of the argument removes
        # only the argument itself.
        made = result._alias() if any(result is solid for solid in given) else result
        count(made, given)
        return cast("_Result", made)

    return counting


def uncounted(function: Callable[_Parameters, _Result]) -> Callable[_Parameters, _Result]:
    """Decorate a function so that solids made inside it do not enter a block."""

    @wraps(function)
    def silent(*args: _Parameters.args, **kwargs: _Parameters.kwargs) -> _Result:
        if _current.get() is None:
            return function(*args, **kwargs)
        with _apart():
            return function(*args, **kwargs)

    return silent


def _solids_in(arguments: Iterable[Any]) -> list["Solid"]:
    """Return the solids among arguments, including those in lists and tuples."""
    solid_type = _solid_type()
    found: list[Solid] = []
    for argument in arguments:
        entries = argument if isinstance(argument, (list, tuple)) else (argument,)
        found.extend(entry for entry in entries if isinstance(entry, solid_type))
    return found


def _solid_type() -> type["Solid"]:
    """Return the class `Solid`, imported late because its module imports this module."""
    from .solid import Solid

    return Solid
