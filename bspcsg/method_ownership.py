"""Copies of inherited methods that have the name of the inheriting class in error messages."""

from types import FunctionType
from typing import TypeVar

_Kind = TypeVar("_Kind", bound=type)


def with_own_methods(kind: _Kind) -> _Kind:
    """Decorate a class: give it copies of the public methods that it inherits from this package.

    Python's error messages about calls, such as for a missing argument, then name this class. A
    wrapped method would still name its own class, so inherited methods must not be wrapped.
    """
    for base in kind.__mro__[1:]:
        if base.__module__.partition(".")[0] != __package__:
            continue
        for name, method in vars(base).items():
            is_public = isinstance(method, FunctionType) and not name.startswith("_")
            if is_public and name not in vars(kind):
                setattr(kind, name, _copied(method, kind))
    return kind


def _copied(function: FunctionType, kind: type) -> FunctionType:
    """Return a copy of a method for another class."""
    copy = FunctionType(
        function.__code__,
        function.__globals__,
        function.__name__,
        function.__defaults__,
        function.__closure__,
    )
    copy.__dict__.update(function.__dict__)
    copy.__kwdefaults__, copy.__doc__ = function.__kwdefaults__, function.__doc__
    copy.__annotations__ = function.__annotations__
    copy.__qualname__, copy.__module__ = f"{kind.__qualname__}.{function.__name__}", kind.__module__
    return copy
