"""The exceptions of this package, and the conversion of the core's errors to them.

Every failure is a `BspcsgError` with a stable `code`, the numbers of the affected elements in
`where`, and a sentence that describes the problem and the remedy.
"""

import errno
import os
import sys
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar

from . import defect
from ._core import CoreError as _CoreError
from ._core import PanicException as _PanicException

if TYPE_CHECKING:
    from ._core import Finding as CoreFinding


#: The control characters that a terminal may execute; tabs and line breaks are harmless.
_CONTROLS = {*range(0x20), *range(0x7F, 0xA0)} - {ord("\t"), ord("\n")}

_REPLACEMENTS = dict.fromkeys(_CONTROLS, "\N{REPLACEMENT CHARACTER}")


def without_control_characters(text: str) -> str:
    """Return a text with control characters replaced, so that it cannot control a terminal."""
    return text.translate(_REPLACEMENTS)


class BspcsgError(Exception):
    """The base class of all errors of this package.

    Parameters
    ----------
    message : str
        A description for the user; control characters in it are replaced.
    code : str
        A stable name for programs, such as ``"not_closed"``.
    where : sequence of int
        Numbers of the affected faces, vertices or other elements; the message says which.
    """

    def __init__(self, message: str, code: str = "internal", where: Sequence[int] = ()) -> None:
        # Pass all arguments to the base class, which pickles them.
        super().__init__(without_control_characters(message), code, tuple(where))

    @property
    def message(self) -> str:
        """The description of the failure for the user."""
        return str(self.args[0])

    @property
    def code(self) -> str:
        """The stable name of the failure, such as ``"not_closed"``."""
        return str(self.args[1])

    @property
    def where(self) -> tuple[int, ...]:
        """The numbers of the affected faces, vertices or other elements; the message says which."""
        return tuple(self.args[2])

    def __str__(self) -> str:
        """Return the message without code and numbers."""
        return self.message


class InvalidMeshError(BspcsgError, ValueError):
    """An error for an input that is not a closed mesh."""


class InvalidParameterError(InvalidMeshError):
    """An error for a parameter with a wrong type or value.

    Until the next version it is also an `InvalidMeshError`.
    """


class LimitError(BspcsgError, OverflowError):
    """An error for coordinates or numbers of elements that exceed a limit of this package."""


class FormatError(BspcsgError, ValueError):
    """An error for a file that cannot be read in the format of its suffix, or cannot be written."""


class MissingFileError(FormatError, FileNotFoundError):
    """An error for a missing file; it is also an `OSError` with `errno` and `filename`."""

    def __init__(self, message: str, code: str = "unreadable", where: Sequence[int] = ()) -> None:
        super().__init__(message, code, where)
        # OSError interprets three arguments differently, so set them again.
        self.args = without_control_characters(message), code, tuple(where)
        self.errno, self.strerror = errno.ENOENT, os.strerror(errno.ENOENT)

    @classmethod
    def of(cls, name: str, reason: str) -> "MissingFileError":
        """Return the error for a file name, with the reason why the file cannot be read."""
        error = cls(f"{name}: cannot read this file: {reason}.")
        error.filename = name
        return error

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what pickle needs: message, code, numbers and the name of the file."""
        return type(self), self.args, {"filename": self.filename}


class MissingPartError(BspcsgError, RuntimeError):
    """An error for an optional dependency or an external program that is not installed."""


class UnboundedError(BspcsgError, ValueError):
    """An error for an operation that needs a bounded solid, on a solid that reaches to infinity."""


class InternalError(BspcsgError, RuntimeError):
    """An error for a failed invariant of this package; please report the file that it names."""


_Value = TypeVar("_Value")

#: The largest number of characters of another library's error that a message quotes.
_MAX_QUOTED_CHARACTERS = 200

_CLASSES: dict[str, type[BspcsgError]] = {
    "forked": BspcsgError,
    "not_closed": InvalidMeshError,
    "non_finite": InvalidMeshError,
    "index_out_of_range": InvalidMeshError,
    "shape": InvalidMeshError,
    "empty_mesh": InvalidMeshError,
    "bad_normal": InvalidMeshError,
    "degenerate": InvalidMeshError,
    "non_planar": InvalidMeshError,
    "not_simple": InvalidMeshError,
    "not_reduced": InvalidMeshError,
    "bad_snapshot": FormatError,
    "too_large": LimitError,
    "too_many": LimitError,
    "too_small": LimitError,
    "unbounded": UnboundedError,
}

_ADVICE = {
    "not_closed": "Before making a solid, close the holes and orient the faces consistently.",
    "empty_mesh": "A mesh without faces is no solid; use Solid.empty() for the empty set.",
    "degenerate": "Leave it out, or choose a finer pitch if it is only very small.",
    "non_planar": "Pass triangles, or non_planar='triangulate' to divide it into triangles.",
    "not_simple": "Give an outline that does not cross or touch itself.",
    "not_reduced": "Make the solid without trusted=True, so that its overlaps are resolved.",
}


def from_core(error: _CoreError) -> BaseException:
    """Return the Python exception for an error of the Rust core.

    It is `KeyboardInterrupt` for a cancelled operation, and `InternalError` for an unknown code.
    """
    if error.code == "cancelled":
        return KeyboardInterrupt()
    kind = _CLASSES.get(error.code, InternalError)
    if kind is InternalError:
        call, inputs = getattr(error, "call", ""), getattr(error, "inputs", {})
        return internal(error.message, error.code, error.where, call, inputs)
    return kind(_sentence(error.message, _ADVICE.get(error.code, "")), error.code, error.where)


def internal(
    message: str,
    code: str = "internal",
    where: Sequence[int] = (),
    call: str = "",
    inputs: Mapping[str, Any] = MappingProxyType({}),
) -> InternalError:
    """Return the error for a defect of this package, and write a report file about it."""
    path = defect.report(message, call, inputs)
    sent = "the input" if path is None else f"the file {path}, which holds the input"
    advice = f"This is a defect of bspcsg; please report it with {sent}."
    return InternalError(_sentence(message, advice), code, where)


def _sentence(message: str, advice: str) -> str:
    return f"{message.rstrip().rstrip('.')}. {advice}".rstrip()


@contextmanager
def format_errors(name: str, what: str) -> Iterator[None]:
    """Turn any error that a parser raises inside the block into a `FormatError`, with its cause.

    Parsers of other libraries may raise any type of error on damaged files, even `MemoryError` or
    `RecursionError`.

    Parameters
    ----------
    name : str
        The name of the file.
    what : str
        The name of the format, such as ``"3MF"``.
    """
    try:
        yield
    except BspcsgError:
        raise
    except Exception as error:
        reason = f"{type(error).__name__}: {message_of(error)}"
        message = f"{name}: the file cannot be read as {what} ({reason})."
        raise FormatError(message, "malformed") from error


class _CoreErrors:
    """The context manager of `core_errors`, which has no state and so needs only one instance."""

    __slots__ = ()

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if isinstance(error, _CoreError):
            raise from_core(error) from error
        if isinstance(error, _PanicException):
            raise internal(f"the compiled core failed: {error}") from error


_CORE_ERRORS = _CoreErrors()


def core_errors() -> AbstractContextManager[None]:
    """Return a context manager that turns errors of the core into exceptions of this package."""
    return _CORE_ERRORS


def not_none(value: _Value | None, name: str) -> _Value:
    """Return a value that cannot be None; raise `InternalError` if it is None."""
    if value is None:
        raise internal(f"the internal value “{name}” is missing")
    return value


def message_of(error: BaseException) -> str:
    """Return another library's error message as one printable line of limited length."""
    text = " ".join(str(error).split())
    printable = "".join(letter for letter in text if letter.isprintable())[:_MAX_QUOTED_CHARACTERS]
    return printable.rstrip(". ") or type(error).__name__


def unreadable(name: object, error: Exception | None = None) -> FormatError:
    """Return the error for a file that cannot be read or is missing.

    Parameters
    ----------
    name : str or path
    error : Exception, optional
        The error that reading raised; without it, the error is for a missing file.
    """
    if error is None or isinstance(error, FileNotFoundError):
        reason = getattr(error, "strerror", None) or os.strerror(errno.ENOENT)
        return MissingFileError.of(str(name), reason)
    reason = getattr(error, "strerror", None) or type(error).__name__
    return FormatError(f"{name}: cannot read this file: {reason}.", "unreadable")


def invalid_parameter(message: str, where: Sequence[int] = ()) -> InvalidParameterError:
    """Return the error for a parameter with a wrong type or value."""
    return InvalidParameterError(message, "invalid_parameter", where)


def missing_part(part: str, purpose: str, remedy: str) -> MissingPartError:
    """Return the error for a missing dependency, with its purpose and an installing command."""
    return MissingPartError(
        f"{part} is needed {purpose}, but is missing or incomplete. Try: {remedy}", "missing_part"
    )


@dataclass(frozen=True)
class Finding:
    """A noteworthy fact about an input or a result that does not stop the operation.

    Parameters
    ----------
    code : str
        A stable name, such as ``"zero_area"``.
    severity : {"note", "warning", "error"}
        How serious the fact is.
    message : str
        A description for the user.
    where : tuple of int
        Numbers of the first affected faces or vertices.
    count : int
        The total number of affected faces or vertices.
    """

    code: str
    severity: str
    message: str
    where: tuple[int, ...]
    count: int

    def __post_init__(self) -> None:
        # The message may quote text from a file.
        object.__setattr__(self, "message", without_control_characters(self.message))

    @classmethod
    def from_core(cls, finding: "CoreFinding") -> "Finding":
        """Convert a finding of the Rust core, which is a dictionary."""
        return cls(
            finding["code"],
            finding["severity"],
            finding["message"],
            tuple(finding["where"]),
            finding["count"],
        )


class LossWarning(UserWarning):
    """A warning that a file or mesh made from a solid cannot store an attribute of the solid."""


#: The codes of findings about attributes that were not stored.
_LOSS_CODES = frozenset({"attributes_left_out", "colors_left_out"})


def warn_of_losses(findings: Iterable[Finding]) -> None:
    """Issue a `LossWarning` for each finding about attributes that were not stored."""
    for finding in findings:
        if finding.code in _LOSS_CODES:
            warnings.warn(finding.message, LossWarning, stacklevel=_levels_to_caller())


def deprecated(old: str, new: str) -> None:
    """Issue a `DeprecationWarning` for a name that the next version removes.

    `new` is the name to use instead.
    """
    message = f"{old} will be removed in the next version; use {new}."
    warnings.warn(message, DeprecationWarning, stacklevel=_levels_to_caller())


def _levels_to_caller() -> int:
    """Return the stack level of the code outside this package, for `warnings.warn`.

    Levels are counted from the function that calls this one.
    """
    frame = sys._getframe(1)
    level = 1
    while frame.f_back is not None and _is_package_module(str(frame.f_globals.get("__name__", ""))):
        frame = frame.f_back
        level += 1
    return level


def _is_package_module(module: str) -> bool:
    return module.partition(".")[0] == __package__
