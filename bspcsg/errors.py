"""The exceptions of this package, and the conversion of the core's errors to them.

Every failure is a `BspcsgError` with a stable `code`, the places it concerns in `where`, and a
sentence that describes the problem and the remedy.
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


#: Characters that a terminal takes for commands; lines and columns may be broken.
_CONTROLS = {*range(0x20), *range(0x7F, 0xA0)} - {ord("\t"), ord("\n")}

_HARMLESS = dict.fromkeys(_CONTROLS, "\N{REPLACEMENT CHARACTER}")


def harmless(text: str) -> str:
    """Return a text in which names and words from files cannot control a terminal."""
    return text.translate(_HARMLESS)


class BspcsgError(Exception):
    """Anything this package refuses or fails to do.

    Parameters
    ----------
    message : str
        A sentence for people; control characters in what it quotes are replaced.
    code : str
        A stable name for programs, such as ``"not_closed"``.
    where : sequence of int
        Indices of the faces or vertices concerned; the message says which of the two.
    """

    def __init__(self, message: str, code: str = "internal", where: Sequence[int] = ()) -> None:
        # All arguments go to the base class, so that pickling keeps them.
        super().__init__(harmless(message), code, tuple(where))

    @property
    def message(self) -> str:
        """The sentence for people."""
        return str(self.args[0])

    @property
    def code(self) -> str:
        """The stable name of the failure."""
        return str(self.args[1])

    @property
    def where(self) -> tuple[int, ...]:
        """Indices of the faces or vertices concerned."""
        return tuple(self.args[2])

    def __str__(self) -> str:
        """Return the sentence alone."""
        return self.message


class InvalidMeshError(BspcsgError, ValueError):
    """The input is not a closed mesh."""


class InvalidParameterError(InvalidMeshError):
    """A parameter is out of its range; until the next version an `InvalidMeshError`, too."""


class LimitError(BspcsgError, OverflowError):
    """Coordinates or sizes exceed what the lattice can hold."""


class FormatError(BspcsgError, ValueError):
    """A file cannot be read in the format that it claims, or cannot be written."""


class MissingFileError(FormatError, FileNotFoundError):
    """A file is missing; as an `OSError` this has `errno` and `filename`, too."""

    def __init__(self, message: str, code: str = "unreadable", where: Sequence[int] = ()) -> None:
        super().__init__(message, code, where)
        # OSError gives a meaning of its own to three arguments.
        self.args = harmless(message), code, tuple(where)
        self.errno, self.strerror = errno.ENOENT, os.strerror(errno.ENOENT)

    @classmethod
    def of(cls, name: str, reason: str) -> "MissingFileError":
        """Return the error for a file of this name."""
        error = cls(f"{name}: cannot read this file: {reason}.")
        error.filename = name
        return error

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the sentence, the code and the place, with the name of the file."""
        return type(self), self.args, {"filename": self.filename}


class MissingPartError(BspcsgError, RuntimeError):
    """An optional part of this package, or a program it asks, is not installed."""


class UnboundedError(BspcsgError, ValueError):
    """A solid that reaches to infinity was asked for a finite answer."""


class InternalError(BspcsgError, RuntimeError):
    """An invariant of this package failed; please report it with the file the message names."""


_Value = TypeVar("_Value")

#: The largest number of characters that a message quotes of another library's error.
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
    "too_large": "Choose a coarser pitch (for example pitch=-6), or move or scale the solids.",
    "too_small": "Choose a finer pitch (for example pitch=-12), or scale the solid up.",
}


def from_core(error: _CoreError) -> BaseException:
    """Return the exception of this package for an error of the core."""
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
    """Return the error for a defect, and write a report of it."""
    path = defect.report(message, call, inputs)
    sent = "the input" if path is None else f"the file {path}, which holds the input"
    advice = f"This is a defect of bspcsg; please report it with {sent}."
    return InternalError(_sentence(message, advice), code, where)


def _sentence(message: str, advice: str) -> str:
    return f"{message.rstrip().rstrip('.')}. {advice}".rstrip()


@contextmanager
def format_errors(name: str, what: str) -> Iterator[None]:
    """Turn any error that a parser raises inside the block into a `FormatError`, with its cause.

    Parsers of other libraries raise any kind of error on damaged files, even those for exhausted
    memory or stack.

    Parameters
    ----------
    name : str
        The name of the file.
    what : str
        The format it is read as, such as ``"3MF"``.
    """
    try:
        yield
    except BspcsgError:
        raise
    except Exception as error:
        reason = f"{type(error).__name__}: {words_of(error)}"
        message = f"{name}: the file cannot be read as {what} ({reason})."
        raise FormatError(message, "malformed") from error


class _CoreErrors:
    """The context of `core_errors`: without state, so that one serves all."""

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
    """Turn the core's errors inside the block into exceptions of this package."""
    return _CORE_ERRORS


def held(value: _Value | None, name: str) -> _Value:
    """Return a value that is never None by an invariant of this package."""
    if value is None:
        raise internal(f"the internal value “{name}” is missing")
    return value


def words_of(error: BaseException) -> str:
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
        The error that reading raised; by default the file is missing.
    """
    if error is None or isinstance(error, FileNotFoundError):
        reason = getattr(error, "strerror", None) or os.strerror(errno.ENOENT)
        return MissingFileError.of(str(name), reason)
    reason = getattr(error, "strerror", None) or type(error).__name__
    return FormatError(f"{name}: cannot read this file: {reason}.", "unreadable")


def invalid_parameter(message: str, where: Sequence[int] = ()) -> InvalidParameterError:
    """Return the error for a parameter out of its range."""
    return InvalidParameterError(message, "invalid_parameter", where)


def missing_part(part: str, purpose: str, remedy: str) -> MissingPartError:
    """Return the error for an optional part, with the command that installs it."""
    return MissingPartError(
        f"{part} is needed {purpose}, but is missing or incomplete. Try: {remedy}", "missing_part"
    )


@dataclass(frozen=True)
class Finding:
    """Something noteworthy about an input or a result that is not an error.

    Parameters
    ----------
    code : str
        A stable name, such as ``"zero_area"``.
    severity : {"note", "warning", "error"}
    message : str
        A sentence for people.
    where : tuple of int
        Indices of the first faces or vertices concerned.
    count : int
        The total number of these.
    """

    code: str
    severity: str
    message: str
    where: tuple[int, ...]
    count: int

    def __post_init__(self) -> None:
        # The message may quote text from a file.
        object.__setattr__(self, "message", harmless(self.message))

    @classmethod
    def from_core(cls, finding: "CoreFinding") -> "Finding":
        """Return the finding of the core as a value."""
        return cls(
            finding["code"],
            finding["severity"],
            finding["message"],
            tuple(finding["where"]),
            finding["count"],
        )


class LossWarning(UserWarning):
    """A file or mesh made from a solid cannot store one of its attributes."""


#: The codes of findings about attributes that were not stored.
_LOSSES = frozenset({"attributes_left_out", "colors_left_out"})


def warn_of_losses(findings: Iterable[Finding]) -> None:
    """Warn the caller of this package about attributes that were lost."""
    for finding in findings:
        if finding.code in _LOSSES:
            warnings.warn(finding.message, LossWarning, stacklevel=_levels_to_caller())


def deprecated(old: str, new: str) -> None:
    """Warn the caller of this package about a name that the next version removes."""
    message = f"{old} will be removed in the next version; use {new}."
    warnings.warn(message, DeprecationWarning, stacklevel=_levels_to_caller())


def _levels_to_caller() -> int:
    """Return the stack level of the package's caller, as seen from the function that calls this."""
    frame = sys._getframe(1)
    level = 1
    while frame.f_back is not None and _is_own(str(frame.f_globals.get("__name__", ""))):
        frame = frame.f_back
        level += 1
    return level


def _is_own(module: str) -> bool:
    return module.partition(".")[0] == __package__
