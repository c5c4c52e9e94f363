"""Tracebacks that end where the user's code calls this package.

What is wrong with a call is said by the error's sentence; the frames inside the package say nothing
more to whoever made the call. So the public functions and methods let go of them, except of an
`InternalError`, which is a defect. With BSPCSG_TRACEBACKS=full in the environment all frames stay.
"""

import os
from collections.abc import Callable
from functools import wraps
from types import FunctionType
from typing import Any, TypeVar

from .errors import BspcsgError, InternalError

_Value = TypeVar("_Value")

#: The variable of the environment that keeps all frames, and its value.
_VARIABLE, _FULL = "BSPCSG_TRACEBACKS", "full"

#: The names of operators and the like; other names that begin with a line are nobody's business.
_OPERATORS = frozenset(
    """
    __init__ __call__ __eq__ __ne__ __lt__ __le__ __gt__ __ge__ __hash__ __contains__ __bool__
    __len__ __iter__ __getitem__ __or__ __and__ __xor__ __sub__ __add__ __radd__ __invert__
    """.split()  # noqa: SIM905  words are read more easily
)


def shortened(value: _Value) -> _Value:
    """Return a public function whose errors end at its caller; of a class, change the methods."""
    if isinstance(value, FunctionType):
        found: Any = _shortened(value)
        return found  # type: ignore[no-any-return]
    if isinstance(value, type) and not issubclass(value, BaseException):
        for kind in value.__mro__:
            if kind.__module__.split(".")[0] == __package__:
                _shorten_methods(kind)
    return value


def keep_all() -> None:
    """Let all frames stay from now on."""
    os.environ[_VARIABLE] = _FULL


def _shorten_methods(kind: type) -> None:
    for name, member in list(vars(kind).items()):
        if name.startswith("_") and name not in _OPERATORS:
            continue
        if isinstance(member, FunctionType):
            setattr(kind, name, _shortened(member))
        elif isinstance(member, (classmethod, staticmethod)):
            setattr(kind, name, type(member)(_shortened(member.__func__)))
        elif isinstance(member, property) and member.fget is not None:
            setattr(kind, name, member.getter(_shortened(member.fget)))


def _shortened(function: Callable[..., Any]) -> Callable[..., Any]:
    if getattr(function, "_is_shortened", False):
        return function

    @wraps(function)
    def entered(*args: Any, **kwargs: Any) -> Any:
        try:
            return function(*args, **kwargs)
        except BspcsgError as error:
            if isinstance(error, InternalError) or os.environ.get(_VARIABLE) == _FULL:
                raise
            raise error.with_traceback(None) from _bare(error.__cause__)

    entered._is_shortened = True  # type: ignore[attr-defined]
    return entered


def _bare(cause: BaseException | None) -> BaseException | None:
    """Return what another library said, without its frames.

    What the core and the system said is in the error's sentence.
    """
    own = type(cause).__module__.split(".")[0] == __package__
    if cause is None or own or isinstance(cause, OSError):
        return None
    return cause.with_traceback(None)
