"""The checks of parameters, which the whole package uses.

Each check returns the value in the type that the package uses, or raises an
`InvalidParameterError` that names the parameter. Truth values and texts are not numbers.
"""

import math
import numbers
import operator
import os
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, TypeVar

from ._core import set_threads as _set_threads
from .errors import LimitError, invalid_parameter
from .suggestions import suggestion_text

if TYPE_CHECKING:
    from ._types import SetOp, WindingRule

#: The largest absolute value of a lattice step's exponent: 10**22 is the largest power of ten that
#: doubles represent exactly.
MAX_PITCH = 22

#: The largest number of threads. Each has a stack of 64 MB, so this many take 64 GB of addresses.
MAX_THREADS = 1024

#: The largest number of sides of a circle. Such a polygon differs from the circle by 1.2e-9 of the
#: radius, π²/2 / 2**32. For radius 1 that is less than two lattice steps, so more sides would not
#: make it rounder.
MAX_SEGMENTS = 1 << 16

#: The default number of sides of a full circle.
SEGMENTS = 32

#: The largest number of corners of one solid. Each takes about 600 bytes while the solid is made:
#: at most 2.4 GB in all.
MAX_CORNERS = 4_000_000

#: The largest time limit that a caller may choose, in seconds: about twelve days. System calls
#: accept at most 2**31 milliseconds.
MAX_SECONDS = 10**6

#: The largest dimension of a partition tree.
_MAX_DIMENSION = 3

#: Counts below this are written with all digits in messages.
_MAX_COUNT_SHOWN = 10**15

#: The largest number of characters of a value that a message quotes.
_MAX_VALUE_CHARACTERS = 80

#: Seeds are reduced modulo this.
_SEED_MODULUS = 2**64

_Kind = TypeVar("_Kind")

#: The set operations on any number of operands, in the order in which campaigns try them.
SET_OPS: "tuple[SetOp, ...]" = ("union", "difference", "intersection", "xor")

_WINDING_RULES: "tuple[WindingRule, ...]" = ("positive", "nonzero", "even-odd")


def number(value: Any, name: str) -> float:
    """Check that a parameter is a finite number, and return it as a float."""
    is_text = isinstance(value, (str, bytes, bytearray))
    if is_text or _is_truth_value(value) or is_complex(value):
        raise invalid_parameter(f"{name} must be a number, not {shown(value)}.")
    try:
        result = float(value)
    except (TypeError, ValueError, OverflowError) as error:
        raise invalid_parameter(f"{name} must be a number, not {shown(value)}.") from error
    if not math.isfinite(result):
        raise invalid_parameter(f"{name} must be a finite number, not {result}.")
    return result


def is_complex(value: Any) -> bool:
    """Return True if a value is a complex number, also with imaginary part 0."""
    return isinstance(value, numbers.Complex) and not isinstance(value, numbers.Real)


def positive(value: Any, name: str) -> float:
    """Check that a parameter is a finite number above 0, and return it as a float."""
    result = number(value, name)
    if result <= 0:
        raise invalid_parameter(f"{name} must be above 0, not {result:g}.")
    return result


def not_negative(value: Any, name: str) -> float:
    """Check that a parameter is a finite number of at least 0, and return it as a float."""
    result = number(value, name)
    if result < 0:
        raise invalid_parameter(f"{name} must be at least 0, not {result:g}.")
    return result


def seconds(value: Any, name: str) -> float | None:
    """Check a time limit, above 0 and up to `MAX_SECONDS`, and return it in seconds.

    None and infinity, which mean no limit, are returned as None.
    """
    if value is None or (isinstance(value, float) and value == math.inf):
        return None
    time = positive(value, name)
    if time > MAX_SECONDS:
        message = f"{name} must be None or at most {MAX_SECONDS} seconds, not {time:g}."
        raise invalid_parameter(message)
    return time


def at_least(least: int, value: Any, name: str) -> int:
    """Check that a parameter is a whole number of at least `least`, and return it as an int."""
    result = _whole(value, name)
    if result is None or result < least:
        raise invalid_parameter(
            f"{name} must be an integer of at least {least}, not {shown(value)}."
        )
    return result


def dimension_number(value: Any) -> int:
    """Check that a dimension is 1, 2 or 3, and return it as an int."""
    result = at_least(1, value, "dimension")
    if result > _MAX_DIMENSION:
        raise invalid_parameter(f"dimension must be 1, 2 or 3, not {shown(value)}.")
    return result


def sides_around(least: int, value: Any, name: str) -> int:
    """Check a number of sides of a circle, and return it as an int.

    Raises
    ------
    InvalidParameterError
        If the number is not whole, or below `least`.
    LimitError
        If the number exceeds `MAX_SEGMENTS`.
    """
    count = at_least(least, value, name)
    if count > MAX_SEGMENTS:
        message = (
            f"{name} must be at most {MAX_SEGMENTS}, not {shown(count)}; more segments would"
            " not make the shape rounder, because corners are rounded to the lattice."
        )
        raise LimitError(message, "too_many")
    return count


def refuse_many_corners(count: float, what: str) -> None:
    """Raise `LimitError` if a solid would have more than `MAX_CORNERS` corners.

    The message begins with `what`, a name of the solid.
    """
    if count > MAX_CORNERS:
        amount = f"{count:.0f}" if count < _MAX_COUNT_SHOWN else "far too many"
        message = f"{what} would have {amount} corners, and at most {MAX_CORNERS} are allowed."
        raise LimitError(f"{message} Choose fewer sides or segments.", "too_many")


def truth_value(value: Any, name: str) -> bool:
    """Check that a parameter is a truth value, or 1 or 0, and return it as a bool."""
    if isinstance(value, bool) or (_is_truth_value(value) and value.shape == ()):
        return bool(value)
    if isinstance(value, int) and value in (0, 1):
        return bool(value)
    raise invalid_parameter(f"{name} must be True or False, not {shown(value)}.")


def radius_or_half_diameter(r: Any, d: Any, owner: str, *, default: Any = None) -> Any:
    """Return the given radius, or half of the given diameter; the radius is not checked.

    Parameters
    ----------
    r, d : float or None
        The radius and the diameter, of which one is None; both may be None if there is a default.
    owner : str
        The owner of the radius in error messages, such as ``"A sphere"``.
    default : float, optional
        The radius if neither is given.

    Raises
    ------
    InvalidParameterError
        If both are given, or if neither is given and there is no default.
    """
    if r is not None and d is not None:
        raise invalid_parameter("Both a radius and a diameter are given; give one of them.")
    found = default if r is None and d is None else r if d is None else not_negative(d, "d") / 2
    if found is None:
        raise invalid_parameter(f"{owner} needs a radius or a diameter.")
    return found


def two_values(value: Any, name: str) -> tuple[Any, Any]:
    """Return the two entries of a sequence, or a single value twice; entries are not checked."""
    try:
        entries = tuple(value)
    except TypeError:
        return value, value
    if len(entries) != 2:
        raise invalid_parameter(
            f"{name} must be one number or a pair of numbers, not {shown(value)}."
        )
    return entries


def file_path(value: Any, name: str = "path") -> str:
    """Check that a parameter is a text or path object, and return it as a text."""
    try:
        path = os.fspath(value)
    except TypeError as error:
        raise invalid_parameter(
            f"{name} must be a file name or path, not {shown(value)}."
        ) from error
    if isinstance(path, str):
        return path
    raise invalid_parameter(f"{name} must be a file name as str or path, not {shown(value)}.")


def text_value(value: Any, name: str) -> str:
    """Check that a parameter is a text, and return it as a plain `str`."""
    if isinstance(value, str):
        return str(value)
    raise invalid_parameter(f"{name} must be a str, not {shown(value)}.")


def text_list(value: Any, name: str) -> list[str]:
    """Check that a parameter is an iterable of texts, not a single text, and return a list."""
    if isinstance(value, (str, bytes)) or not isinstance(value, Iterable):
        raise invalid_parameter(f"{name} must be a list of str, not {shown(value)}.")
    return [text_value(entry, f"each entry of {name}") for entry in value]


def values_by_name(value: Any, name: str) -> dict[str, Any]:
    """Check that a parameter is a mapping with texts as keys; return a dict, empty for None."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise invalid_parameter(f"{name} must be a dict from names to values, not {shown(value)}.")
    return {text_value(key, f"each name in {name}"): entry for key, entry in value.items()}


def one_of(known: Iterable[str], value: Any, name: str) -> str:
    """Check that a parameter is one of the known texts, and return it."""
    words = tuple(known)
    if isinstance(value, str) and value in words:
        return str(value)
    message = f"{name} must be one of {', '.join(words)}, not {shown(value)}."
    raise invalid_parameter(message + suggestion_text(value, words))


def function_of(value: Any, name: str) -> Callable[..., Any]:
    """Check that a parameter is callable, and return it."""
    if callable(value):
        called: Callable[..., Any] = value
        return called
    raise invalid_parameter(f"{name} must be a function, not {shown(value)}.")


def instance_of(kind: type[_Kind], value: Any, name: str) -> _Kind:
    """Check that a parameter is an instance of a class, and return it."""
    if isinstance(value, kind):
        return value
    article = "an" if kind.__name__[0] in "AEIOU" else "a"
    raise invalid_parameter(f"{name} must be {article} {kind.__name__}, not {shown(value)}.")


def no_options(options: Mapping[str, Any], solid: object) -> None:
    """Raise an error if options for reading a mesh are given together with a solid."""
    if options:
        given = ", ".join(options)
        raise invalid_parameter(
            f"{given} can only be given when a mesh is read, but the argument already is a"
            f" solid, of type {type(solid).__name__}. Pass these options where the solid is"
            " made, or pass its mesh instead."
        )


def pitch_exponent(value: Any) -> int:
    """Check the exponent of a lattice step, and return it as an int.

    Raises
    ------
    InvalidParameterError
        If the exponent is not a whole number.
    LimitError
        If the exponent is not from -22 to 22.
    """
    result = _whole(value, "pitch")
    if result is None:
        raise invalid_parameter(
            "pitch must be an integer, the exponent of ten of the lattice step, not"
            f" {shown(value)}."
        )
    if abs(result) > MAX_PITCH:
        raise LimitError(
            f"pitch must be from -{MAX_PITCH} to {MAX_PITCH}, not {shown(result)}.", "too_large"
        )
    return result


def optional_pitch(value: Any) -> int | None:
    """Check the exponent of a lattice step, and return it as an int; return None for None."""
    return None if value is None else pitch_exponent(value)


def thread_count(value: Any) -> int:
    """Check a number of threads, and return it as an int; 0 means one per processor."""
    result = _whole(value, "threads")
    if result is None or not 0 <= result <= MAX_THREADS:
        raise invalid_parameter(
            f"threads must be an integer from 0 to {MAX_THREADS}, not {shown(value)}."
        )
    return result


def set_threads(n: int) -> None:
    """Set the number of threads that operations use by default.

    Parameters
    ----------
    n : int
        The number of threads, from 0 to 1024; 0 means one per processor.
    """
    _set_threads(thread_count(n))


def seed_number(value: Any) -> int:
    """Check that a seed is a whole number of at least 0, and return it modulo 2**64."""
    return at_least(0, value, "seed") % _SEED_MODULUS


def winding_rule(value: Any) -> "WindingRule":
    """Check that a parameter is the name of a winding rule, and return it."""
    for rule in _WINDING_RULES:
        if isinstance(value, str) and value == rule:
            return rule
    known = ", ".join(_WINDING_RULES)
    raise invalid_parameter(f"Unknown winding rule {shown(value)}; known are {known}.")


def _whole(value: Any, name: str) -> int | None:
    """Return a number as an int of any size, or None if it is not whole."""
    if not _is_truth_value(value):
        try:
            return operator.index(value)
        except TypeError:
            pass
    result = number(value, name)
    return int(result) if result.is_integer() else None


def shown(value: Any) -> str:
    """Return the `repr` of a value for error messages; only beginning and end if it is long."""
    try:
        text = repr(value)
    except ValueError:  # an integer of thousands of digits
        return "an integer with thousands of digits"
    return (
        text
        if len(text) <= _MAX_VALUE_CHARACTERS
        else f"{text[: _MAX_VALUE_CHARACTERS // 2]}...{text[-_MAX_VALUE_CHARACTERS // 2 :]}"
    )


def _is_truth_value(value: Any) -> bool:
    kind = getattr(getattr(value, "dtype", None), "kind", None)
    return isinstance(value, bool) or kind == "b"
