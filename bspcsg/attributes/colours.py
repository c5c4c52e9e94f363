"""Colours, however people, programs and files write them: the one place that takes them apart.

A colour is red, green, blue and, where it is told, opacity. It may be written as

- a name of CSS: ``"orange"``, ``"rebeccapurple"``, ``"transparent"``; case makes no difference;
- ``"#rgb"``, ``"#rgba"``, ``"#rrggbb"`` or ``"#rrggbbaa"``; six or eight digits need no ``#``;
- floats from 0 to 1;
- whole numbers from 0 to 255.

Whole numbers of which none is above 1, such as (1, 0, 0), count from 0 to 1, as in OpenSCAD: red,
and not a black that nobody can tell from (0, 0, 0). Of an array the largest number of all decides.
numpy's unsigned types leave no doubt and are parts of the largest number of their type: of uint8,
1 is 1/255.
"""

import re
from collections.abc import Iterable, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from .._types import FloatArray
from ..errors import InvalidParameterError, invalid_parameter
from ..geometry.arrays import doubles
from ..parameters import shown

#: Colours in bytes, as most files have them.
Bytes = npt.NDArray[np.uint8]

#: Whatever says one colour, as above.
AnyColor: TypeAlias = str | Iterable[float] | npt.NDArray[Any]

#: The name of the attribute that is a colour.
COLOR = "color"

_BYTE = 255

#: Digits without a mark are taken where there are enough of them to be no word by chance.
_DIGITS = re.compile("#([0-9a-f]{3,4})|#?([0-9a-f]{6}|[0-9a-f]{8})")


def color_of(given: Any, name: str = COLOR) -> tuple[float, ...]:
    """Return red, green, blue and opacity of one colour, from 0 to 1; by default it is opaque.

    Raises
    ------
    InvalidParameterError
        If it is none.
    """
    numbers: list[float] = as_floats(one_color(given, name)).tolist()
    return (*numbers, 1.0) if len(numbers) == 3 else tuple(numbers)


def one_color(given: Any, name: str = COLOR) -> npt.NDArray[Any]:
    """Return one colour as attributes have it, (3,) or (4,): bytes, or floats from 0 to 1."""
    found = colors_of(given, name)
    if found.ndim != 1:
        raise _refused(given, name)
    return found


def colors_of(given: Any, name: str = COLOR) -> npt.NDArray[Any]:
    """Return colours as attributes have them, (…, 3) or (…, 4): bytes, or floats from 0 to 1.

    Parameters
    ----------
    given : text, numbers, or arrays or sequences of them
        Texts have no axis of their own: one is (3,) or (4,), a row of n is (n, 3) or (n, 4).
    name : str
        For errors.

    Raises
    ------
    InvalidParameterError
        If something in it is no colour.
    """
    if isinstance(given, str):
        return _of_text(given, name)
    if isinstance(given, np.ndarray) and given.dtype.kind == "U":
        return _of_texts(given, name)
    if isinstance(given, (list, tuple)) and any(isinstance(one, str) for one in given):
        return np.stack(_alike([one_color(one, name) for one in given]))
    return _of_numbers(given, name)


def _of_text(text: str, name: str) -> Bytes:
    word = text.strip().lower()
    match = _DIGITS.fullmatch(word)
    digits = match and (match[2] or "".join(2 * digit for digit in match[1]))
    found = bytes.fromhex(digits) if digits else _named(word)
    if found is None:
        raise _refused(text, name)
    return np.frombuffer(found, dtype=np.uint8).copy()


def _named(word: str) -> bytes | None:
    """Return the bytes of a colour that CSS names."""
    from PIL import ImageColor

    if word == "transparent":
        return bytes(4)
    return bytes(ImageColor.getrgb(word)) if word in ImageColor.colormap else None


def _of_texts(texts: npt.NDArray[np.str_], name: str) -> Bytes:
    """Return the colours of many texts, of which most will be the same few."""
    kinds, numbers = np.unique(texts, return_inverse=True)
    if not len(kinds):
        return np.zeros((*texts.shape, 3), dtype=np.uint8)
    table = np.stack(_alike([_of_text(kind, name) for kind in kinds.tolist()]))
    found: Bytes = table[numbers.reshape(texts.shape)]
    return found


def _alike(rows: Sequence[npt.NDArray[Any]]) -> list[npt.NDArray[Any]]:
    """Return colours of one width and one type: bytes if all are, else floats."""
    width = max(map(len, rows))
    if any(row.dtype != np.uint8 for row in rows):
        rows = [as_floats(row) for row in rows]
    return [row if len(row) == width else opaque(row) for row in rows]


def _of_numbers(given: Any, name: str) -> npt.NDArray[Any]:
    refusal = _refused(given, name)
    numbers = doubles(given, refusal)
    if not numbers.ndim or numbers.shape[-1] not in (3, 4):
        raise refusal
    array = np.asarray(given)
    if array.dtype.kind == "u":
        return array
    if array.dtype.kind == "i":
        found = in_bytes(array)
        if found is None:
            raise refusal
        return found
    if not ((numbers >= 0) & (numbers <= 1)).all():
        raise refusal
    return array if array.dtype.kind == "f" else numbers


def in_bytes(numbers: npt.NDArray[Any]) -> Bytes | None:
    """Return whole numbers as bytes by the rule above; None if one is out of its range."""
    low, high = numbers.min(initial=0), numbers.max(initial=0)
    if low < 0 or high > _BYTE:
        return None
    return (numbers * _BYTE if high <= 1 else numbers).astype(np.uint8)


def opaque(colors: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return colours of three numbers with a fourth, their opacity; others as they are."""
    if colors.shape[-1] == 4:
        return colors
    full = np.iinfo(colors.dtype).max if colors.dtype.kind == "u" else 1
    return np.concatenate([colors, np.full_like(colors[..., :1], full)], axis=-1)


def are_same_in_bytes(some: npt.NDArray[Any], others: npt.NDArray[Any]) -> bool:
    """Say whether colours are the same on a screen, however they are written."""
    return np.array_equal(opaque(as_bytes(some)), opaque(as_bytes(others)))


def is_opaque(colors: npt.NDArray[Any]) -> bool:
    """Say whether no colour lets anything through."""
    return colors.shape[-1] == 3 or bool((as_bytes(colors[..., 3]) == _BYTE).all())


def is_color(name: str, values: npt.NDArray[Any], depth: int) -> bool:
    """Say whether an attribute is a colour: three or four numbers."""
    is_number = values.dtype.kind in "uf"
    return name == COLOR and is_number and values.shape[depth:] in ((3,), (4,))


def as_bytes(colors: npt.NDArray[Any]) -> Bytes:
    """Return colours in bytes, as `as_floats` has them; those beyond 0 and 1 are moved there."""
    if colors.dtype == np.uint8:
        return colors
    scaled: Any = np.clip(as_floats(colors), 0, 1) * _BYTE
    rounded: Bytes = np.rint(scaled).astype(np.uint8)
    return rounded


def as_floats(colors: npt.NDArray[Any]) -> FloatArray:
    """Return colours as floats: whole numbers are parts of their type's largest, NaN is white."""
    numbers = colors.astype(np.float64)
    if colors.dtype.kind == "u":
        return numbers * (1 / np.iinfo(colors.dtype).max)
    return np.where(np.isnan(numbers), 1.0, numbers)


def hexadecimal(color: Sequence[float]) -> str:
    """Return ``"#rrggbb"``, or ``"#rrggbbaa"`` of four numbers from 0 to 1."""
    return "#" + bytes(round(value * _BYTE) for value in color).hex()


def _refused(given: Any, name: str) -> InvalidParameterError:
    return invalid_parameter(
        f"The {name} must be like 'orange', '#3070b0', or three or four numbers: floats from 0 to 1"
        f" or whole numbers from 0 to 255; not {shown(given)}."
    )
