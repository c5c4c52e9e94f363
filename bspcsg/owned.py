"""Copies of inherited methods that have the name of the inheriting class in error messages."""

from types import CellType, FunctionType
from typing import Any, TypeVar

_Kind = TypeVar("_Kind", bound=type)


def owning(kind: _Kind) -> _Kind:
    """Decorate a class: give it copies of the public methods that it inherits from this package.

    Python's error messages about calls, such as for a missing argument, then name this class.
    """
    for base in kind.__mro__[1:]:
        if base.__module__.partition(".")[0] != __package__:
            continue
        for name, held in vars(base).items():
            own = None if name.startswith("_") or name in vars(kind) else _owned(held, kind)
            if own is not None:
                setattr(kind, name, own)
    return kind


def _owned(held: object, kind: type) -> Any:
    """Return a copy of a method for a class; None if the object is not a method."""
    if isinstance(held, FunctionType):
        return _copied(held, kind)
    if isinstance(held, (classmethod, staticmethod)) and isinstance(held.__func__, FunctionType):
        return type(held)(_copied(held.__func__, kind))
    return None


def _copied(function: FunctionType, kind: type) -> FunctionType:
    """Return a copy of a function for another class; a wrapped function is copied, too."""
    cells, state = function.__closure__, dict(function.__dict__)
    wrapped = state.get("__wrapped__")
    if isinstance(wrapped, FunctionType) and cells:
        state["__wrapped__"] = inner = _copied(wrapped, kind)
        cells = tuple(CellType(inner) if c.cell_contents is wrapped else c for c in cells)
    copy = FunctionType(
        function.__code__, function.__globals__, function.__name__, function.__defaults__, cells
    )
    copy.__dict__.update(state)
    copy.__kwdefaults__, copy.__doc__ = function.__kwdefaults__, function.__doc__
    copy.__annotations__ = function.__annotations__
    copy.__qualname__, copy.__module__ = f"{kind.__qualname__}.{function.__name__}", kind.__module__
    return copy
