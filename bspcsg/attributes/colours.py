"""Conversion of colours from text, floats and whole numbers.

A colour is red, green, blue and optionally opacity. It may be written as

- a name of CSS: ``"orange"``, ``"rebeccapurple"``, ``"transparent"``; case makes no difference;
- ``"#rgb"``, ``"#rgba"``, ``"#rrggbb"`` or ``"#rrggbbaa"``; six or eight digits need no ``#``;
- floats from 0 to 1;
- whole numbers from 0 to 255.

Whole numbers are from 0 to 1 if none is above 1, as in OpenSCAD: (1, 0, 0) is red, and not a
black that looks like (0, 0, 0). For an array, its largest number decides. Numpy's unsigned types
are unambiguous: their values are fractions of the type's largest number, so a uint8 of 1 is 1/255.
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

#: Colours as bytes, 0 to 255 for each component.
Bytes = npt.NDArray[np.uint8]

#: One colour as a name, hexadecimal digits or numbers.
AnyColor: TypeAlias = str | Iterable[float] | npt.NDArray[Any]

#: The name of the attribute whose values are colours.
COLOR = "color"

_BYTE = 255

#: Hexadecimal colours; without ``#``, only six or eight digits, which are hardly an English word.
_DIGITS = re.compile("#([0-9a-f]{3,4})|#?([0-9a-f]{6}|[0-9a-f]{8})")

# Source: CSS Color Module Level 4, section 6.1.
_NAMED = """
aliceblue f0f8ff antiquewhite faebd7 aqua 00ffff aquamarine 7fffd4 azure f0ffff beige f5f5dc
bisque ffe4c4 black 000000 blanchedalmond ffebcd blue 0000ff blueviolet 8a2be2 brown a52a2a
burlywood deb887 cadetblue 5f9ea0 chartreuse 7fff00 chocolate d2691e coral ff7f50 cornflowerblue
6495ed cornsilk fff8dc crimson dc143c cyan 00ffff darkblue 00008b darkcyan 008b8b darkgoldenrod
b8860b darkgray a9a9a9 darkgreen 006400 darkgrey a9a9a9 darkkhaki bdb76b darkmagenta 8b008b
darkolivegreen 556b2f darkorange ff8c00 darkorchid 9932cc darkred 8b0000 darksalmon e9967a
darkseagreen 8fbc8f darkslateblue 483d8b darkslategray 2f4f4f darkslategrey 2f4f4f darkturquoise
00ced1 darkviolet 9400d3 deeppink ff1493 deepskyblue 00bfff dimgray 696969 dimgrey 696969
dodgerblue 1e90ff firebrick b22222 floralwhite fffaf0 forestgreen 228b22 fuchsia ff00ff gainsboro
dcdcdc ghostwhite f8f8ff gold ffd700 goldenrod daa520 gray 808080 green 008000 greenyellow adff2f
grey 808080 honeydew f0fff0 hotpink ff69b4 indianred cd5c5c indigo 4b0082 ivory fffff0 khaki
f0e68c lavender e6e6fa lavenderblush fff0f5 lawngreen 7cfc00 lemonchiffon fffacd lightblue add8e6
lightcoral f08080 lightcyan e0ffff lightgoldenrodyellow fafad2 lightgray d3d3d3 lightgreen 90ee90
lightgrey d3d3d3 lightpink ffb6c1 lightsalmon ffa07a lightseagreen 20b2aa lightskyblue 87cefa
lightslategray 778899 lightslategrey 778899 lightsteelblue b0c4de lightyellow ffffe0 lime 00ff00
limegreen 32cd32 linen faf0e6 magenta ff00ff maroon 800000 mediumaquamarine 66cdaa mediumblue
0000cd mediumorchid ba55d3 mediumpurple 9370db mediumseagreen 3cb371 mediumslateblue 7b68ee
mediumspringgreen 00fa9a mediumturquoise 48d1cc mediumvioletred c71585 midnightblue 191970
mintcream f5fffa mistyrose ffe4e1 moccasin ffe4b5 navajowhite ffdead navy 000080 oldlace fdf5e6
olive 808000 olivedrab 6b8e23 orange ffa500 orangered ff4500 orchid da70d6 palegoldenrod eee8aa
palegreen 98fb98 paleturquoise afeeee palevioletred db7093 papayawhip ffefd5 peachpuff ffdab9 peru
cd853f pink ffc0cb plum dda0dd powderblue b0e0e6 purple 800080 rebeccapurple 663399 red ff0000
rosybrown bc8f8f royalblue 4169e1 saddlebrown 8b4513 salmon fa8072 sandybrown f4a460 seagreen
2e8b57 seashell fff5ee sienna a0522d silver c0c0c0 skyblue 87ceeb slateblue 6a5acd slategray
708090 slategrey 708090 snow fffafa springgreen 00ff7f steelblue 4682b4 tan d2b48c teal 008080
thistle d8bfd8 tomato ff6347 turquoise 40e0d0 violet ee82ee wheat f5deb3 white ffffff whitesmoke
f5f5f5 yellow ffff00 yellowgreen 9acd32
"""

_NAMES = dict(zip(_NAMED.split()[::2], _NAMED.split()[1::2], strict=True)) | {
    "transparent": "00000000"
}


def color_of(given: Any, name: str = COLOR) -> tuple[float, ...]:
    """Return red, green, blue and opacity of one colour, from 0 to 1; by default it is opaque.

    Raises
    ------
    InvalidParameterError
        If `given` is not a colour; the message calls it `name`.
    """
    numbers: list[float] = as_floats(one_color(given, name)).tolist()
    return (*numbers, 1.0) if len(numbers) == 3 else tuple(numbers)


def one_color(given: Any, name: str = COLOR) -> npt.NDArray[Any]:
    """Return one colour as an array, (3,) or (4,): unsigned integers, or floats from 0 to 1."""
    found = colors_of(given, name)
    if found.ndim != 1:
        raise _colour_error(given, name)
    return found


def colors_of(given: Any, name: str = COLOR) -> npt.NDArray[Any]:
    """Return colours as an array, (…, 3) or (…, 4): unsigned integers, or floats from 0 to 1.

    Parameters
    ----------
    given : text, numbers, or arrays or sequences of them
        A text has no axis of its own: one text gives (3,) or (4,), n texts give (n, 3) or (n, 4).
    name : str
        The name of the parameter in error messages.

    Raises
    ------
    InvalidParameterError
        If an entry is not a colour.
    """
    if isinstance(given, str):
        return _of_text(given, name)
    if isinstance(given, np.ndarray) and given.dtype.kind == "U":
        return _of_texts(given, name)
    if isinstance(given, (list, tuple)) and any(isinstance(one, str) for one in given):
        return np.stack(_uniform_colors([one_color(one, name) for one in given]))
    return _of_numbers(given, name)


def _of_text(text: str, name: str) -> Bytes:
    word = text.strip().lower()
    match = _DIGITS.fullmatch(word)
    digits = _NAMES.get(word) or (match and (match[2] or "".join(2 * d for d in match[1])))
    if not digits:
        raise _colour_error(text, name)
    return np.frombuffer(bytes.fromhex(digits), dtype=np.uint8).copy()


def _of_texts(texts: npt.NDArray[np.str_], name: str) -> Bytes:
    """Return the colours of an array of texts; each distinct text is parsed once."""
    kinds, numbers = np.unique(texts, return_inverse=True)
    if not len(kinds):
        return np.zeros((*texts.shape, 3), dtype=np.uint8)
    table = np.stack(_uniform_colors([_of_text(kind, name) for kind in kinds.tolist()]))
    found: Bytes = table[numbers.reshape(texts.shape)]
    return found


def _uniform_colors(rows: Sequence[npt.NDArray[Any]]) -> list[npt.NDArray[Any]]:
    """Return colours of equal width and one type: bytes if all are bytes, else floats."""
    width = max(map(len, rows))
    if any(row.dtype != np.uint8 for row in rows):
        rows = [as_floats(row) for row in rows]
    return [row if len(row) == width else opaque(row) for row in rows]


def _of_numbers(given: Any, name: str) -> npt.NDArray[Any]:
    refusal = _colour_error(given, name)
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
    """Return whole numbers as bytes, multiplied by 255 if none is above 1.

    None means that a number is not from 0 to 255.
    """
    low, high = numbers.min(initial=0), numbers.max(initial=0)
    if low < 0 or high > _BYTE:
        return None
    return (numbers * _BYTE if high <= 1 else numbers).astype(np.uint8)


def opaque(colors: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return colours with four components: full opacity is added to colours of three."""
    if colors.shape[-1] == 4:
        return colors
    full = np.iinfo(colors.dtype).max if colors.dtype.kind == "u" else 1
    return np.concatenate([colors, np.full_like(colors[..., :1], full)], axis=-1)


def are_equal_in_bytes(first: npt.NDArray[Any], second: npt.NDArray[Any]) -> bool:
    """Return True if two arrays of colours are equal after conversion to bytes."""
    return np.array_equal(opaque(as_bytes(first)), opaque(as_bytes(second)))


def is_opaque(colors: npt.NDArray[Any]) -> bool:
    """Return True if all colours are fully opaque after conversion to bytes."""
    return colors.shape[-1] == 3 or bool((as_bytes(colors[..., 3]) == _BYTE).all())


def is_color(name: str, values: npt.NDArray[Any], depth: int) -> bool:
    """Return True if an attribute has the name "color" and three or four numbers per element.

    The first `depth` axes of the values index the elements.
    """
    is_number = values.dtype.kind in "uf"
    return name == COLOR and is_number and values.shape[depth:] in ((3,), (4,))


def as_bytes(colors: npt.NDArray[Any]) -> Bytes:
    """Return colours as bytes; floats are clamped to 0 to 1, and NaN becomes 255."""
    if colors.dtype == np.uint8:
        return colors
    scaled: Any = np.clip(as_floats(colors), 0, 1) * _BYTE
    rounded: Bytes = np.rint(scaled).astype(np.uint8)
    return rounded


def as_floats(colors: npt.NDArray[Any]) -> FloatArray:
    """Return colours as floats from 0 to 1; NaN becomes 1.

    Unsigned integers are divided by their type's largest number.
    """
    numbers = colors.astype(np.float64)
    if colors.dtype.kind == "u":
        return numbers * (1 / np.iinfo(colors.dtype).max)
    return np.where(np.isnan(numbers), 1.0, numbers)


def hexadecimal(color: Sequence[float]) -> str:
    """Return ``"#rrggbb"`` for three numbers from 0 to 1, or ``"#rrggbbaa"`` for four."""
    return "#" + bytes(round(value * _BYTE) for value in color).hex()


def _colour_error(given: Any, name: str) -> InvalidParameterError:
    return invalid_parameter(
        f"The {name} must be a colour name or code such as 'orange' or '#3070b0', or three or"
        f" four numbers (floats from 0 to 1 or integers from 0 to 255), not {shown(given)}."
    )
