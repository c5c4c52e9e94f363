"""Reading of a PLY file's header: the elements, their counts and their properties."""

from dataclasses import dataclass
from difflib import get_close_matches
from typing import Literal, TypeAlias

import numpy as np

from ..source import Source, quoted

_TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}

#: Byte order of binary data: little-endian or big-endian.
Order: TypeAlias = Literal["<", ">"]

#: The byte order of each form that a PLY header can name; None for text.
_FORMS: dict[str, Order | None] = {
    "ascii": None,
    "binary_little_endian": "<",
    "binary_big_endian": ">",
}


#: The words that begin a line of a header. A misspelt one is an error, not a comment.
_KEYS = ("ply", "format", "element", "property", "end_header", "comment", "obj_info")
_MIN_SIMILARITY = 0.7


@dataclass(frozen=True)
class Property:
    """One property of a PLY element: a number of type `item`, or a list of such numbers.

    It is a list if `count` is not None; then `count` is the type of the list's length.
    """

    name: str
    item: np.dtype[np.generic]
    count: np.dtype[np.generic] | None = None


@dataclass(frozen=True)
class Element:
    """One element of a PLY header: a kind of record, such as a vertex, and their number."""

    name: str
    number: int
    properties: list[Property]

    @property
    def has_lists(self) -> bool:
        """True if a property is a list, so that records may differ in length."""
        return any(prop.count is not None for prop in self.properties)

    def index(self, *names: str) -> int | None:
        """Return the number, from 0, of the first property with one of these names, or None."""
        found = (k for k, prop in enumerate(self.properties) if prop.name in names)
        return next(found, None)


@dataclass(frozen=True)
class Header:
    """The content of a PLY file's header, and the start of the data.

    Parameters
    ----------
    order : {"<", ">"} or None
        Byte order; None for text.
    elements : list of Element
        In the order of their data.
    end : int
        Bytes before the data.
    lines : int
        Lines before the data.
    pictures : tuple of str
        The picture files that programs name in comments.
    unknown : tuple of int
        Numbers, from 1, of lines that are no valid statements and are ignored.
    """

    order: Order | None
    elements: list[Element]
    end: int
    lines: int
    pictures: tuple[str, ...] = ()
    unknown: tuple[int, ...] = ()


def read_header(source: Source) -> Header:
    """Read the header of a PLY file.

    Raises
    ------
    FormatError
        If the file is no PLY, or its header is not valid or not complete.
    """
    form: str | None = None
    elements: list[Element] = []
    pictures: list[str] = []
    unknown: list[int] = []
    end = number = 0
    while True:
        line, end = _line(source, end, number)
        number += 1
        words = line.decode("latin-1").split()
        key = words[0] if words else "comment"
        if number == 1:
            if key.lower() != "ply":
                raise source.error(
                    f"the file is not a PLY mesh: it begins with {quoted(line)}.", line=1
                )
        elif key == "end_header":
            break
        elif key == "format":
            form = words[1] if len(words) > 1 else ""
        elif key == "element":
            elements.append(_element(source, number, words, elements))
        elif key == "property" and elements:
            elements[-1].properties.append(_property(source, number, words))
        elif words[1:2] == ["TextureFile"]:
            pictures.append(" ".join(words[2:]))
        elif key in ("comment", "obj_info"):
            continue
        elif get_close_matches(key.lower(), _KEYS, cutoff=_MIN_SIMILARITY):
            raise source.error(
                "expected a header line (format, element, property or end_header), found"
                f" {quoted(line)}.",
                line=number,
            )
        else:
            unknown.append(number)
    if form is None or form not in _FORMS:
        named = quoted((form or "").encode("latin-1"))
        raise source.error(
            f"the header has the format {named}, but must have ascii, binary_little_endian or"
            " binary_big_endian.",
            line=number,
        )
    return Header(_FORMS[form], elements, end, number, tuple(pictures), tuple(unknown))


def _line(source: Source, start: int, number: int) -> tuple[bytes, int]:
    """Return a header's line that begins at byte `start`, and the offset of the next line."""
    data = source.data
    stop = data.find(b"\n", start)
    carriage = data.find(b"\r", start, None if stop < 0 else stop)
    if carriage >= 0 and carriage + 1 != stop:
        return data[start:carriage], carriage + 1
    if stop < 0:
        if number == 0:
            raise source.error(
                f"the file is not a PLY mesh: it begins with {quoted(data[:16])}.", line=1
            )
        raise source.error(
            "the file is incomplete: its header has no “end_header”.", "truncated", line=number
        )
    return data[start:stop], stop + 1


def _element(source: Source, line: int, words: list[str], others: list[Element]) -> Element:
    if len(words) != 3 or not words[2].isdecimal() or len(words[2]) > 18:
        raise source.error(
            f"expected “element NAME COUNT”, found {quoted(' '.join(words).encode())}.", line=line
        )
    if any(other.name == words[1] for other in others):
        message = f"the header declares the element {quoted(words[1].encode())} twice."
        raise source.error(message, line=line)
    return Element(words[1], int(words[2]), [])


def _property(source: Source, line: int, words: list[str]) -> Property:
    try:
        if words[1] == "list":
            count = np.dtype(_TYPES[words[2]])
            if count.kind == "f":
                raise source.error(
                    "the length of a list property must have an integer type, not float or double.",
                    line=line,
                )
            return Property(words[4], np.dtype(_TYPES[words[3]]), count)
        return Property(words[2], np.dtype(_TYPES[words[1]]))
    except (KeyError, IndexError):
        found = quoted(" ".join(words).encode())
        raise source.error(
            f"expected “property TYPE NAME” or “property list TYPE TYPE NAME”, found {found}.",
            line=line,
        ) from None
