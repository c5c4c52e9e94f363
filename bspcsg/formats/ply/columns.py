"""Conversion between attributes and columns of PLY.

The usual columns are red, green, blue and alpha for colours, nx, ny and nz for normals, s and t for
texture coordinates of vertices, and the list texcoord of faces for those of corners. Any other
array has one column, or one for each component with its number after the name; values of corners
are lists of faces.
"""

import re
from collections.abc import Iterator, Mapping

import numpy as np

from ...attributes.attributes import Attributes, Kind, Values
from ..storable_attributes import selected_attributes

#: The usual names of PLY columns, by the attribute that they form.
_KNOWN = {
    "color": ("red", "green", "blue", "alpha"),
    "normal": ("nx", "ny", "nz"),
    "uv": ("s", "t"),
}

#: Other names that programs write for PLY columns, and the usual names.
_ALIASES = {"u": "s", "v": "t", "texture_u": "s", "texture_v": "t"}

#: The name of the list that has the texture coordinates of a face's corners.
_TEXCOORD = "texcoord"

_RESERVED = frozenset(
    {"x", "y", "z", "vertex_index", "vertex_indices", _TEXCOORD}.union(*_KNOWN.values(), _ALIASES)
)

#: The names of types in PLY, by numpy's letter and number of bytes.
TYPES = {
    "i1": "char",
    "u1": "uchar",
    "i2": "short",
    "u2": "ushort",
    "i4": "int",
    "u4": "uint",
    "f4": "float",
    "f8": "double",
}

#: A word that a PLY header can contain, and a word that ends in the number of a component.
_NAME = re.compile(r"[!-~]+")
_NUMBERED = re.compile(r"(.+)_(\d+)")

#: The largest number of values in a list, whose length is stored in one byte.
_MAX_LIST_LENGTH = 255


def storable(attributes: Attributes) -> Attributes:
    """Return the attributes that PLY can store: numbers with one-word names."""
    return selected_attributes(attributes, _storable_values)


def _storable_values(kind: Kind, name: str, values: Values) -> Values | None:
    depth = 2 if kind == "corner" else 1
    shape = values.shape[depth:]
    if len(shape) > 1 or shape == (0,) or not _NAME.fullmatch(name):
        return None
    if name in _RESERVED or _NUMBERED.fullmatch(name):
        return None
    known = _KNOWN.get(name)
    if known and shape not in ((len(known),), (3,) if name == "color" else (len(known),)):
        return None
    if kind == "corner" and (shape == (1,) or 3 * (shape or (1,))[0] > _MAX_LIST_LENGTH):
        return None
    return _of_known_type(values)


def _of_known_type(values: Values) -> Values | None:
    """Convert an array to a type that PLY has; return None if no type fits its values."""
    if values.dtype.kind == "b":
        return values.astype(np.uint8)
    if values.dtype.kind == "f":
        size = min(max(values.dtype.itemsize, 4), 8)
        return values.astype(f"f{size}", copy=False)
    if values.dtype.kind not in "iu":
        return None
    if values.dtype.itemsize < 8:
        return values
    narrow = np.dtype(np.int32 if values.dtype.kind == "i" else np.uint32)
    limits = np.iinfo(narrow)
    fits = not values.size or limits.min <= values.min() <= values.max() <= limits.max
    return values.astype(narrow) if fits else None


def columns_of(attributes: Mapping[str, Values]) -> Iterator[tuple[str, Values]]:
    """Yield name and values of each PLY column for attributes of vertices or of faces."""
    for name, values in attributes.items():
        if values.ndim == 1:
            yield name, values
            continue
        width = values.shape[1]
        names = _KNOWN.get(name) or [f"{name}_{k}" for k in range(width)]
        for k in range(width):
            yield names[k], values[:, k]


def lists_of(attributes: Mapping[str, Values]) -> Iterator[tuple[str, Values]]:
    """Yield name and values (m, 3 k) of each PLY list of faces, for attributes of corners."""
    for name, values in attributes.items():
        yield _TEXCOORD if name == "uv" else name, values.reshape(len(values), -1)


def attributes_of(columns: Mapping[str, Values]) -> dict[str, Values]:
    """Return the attributes that PLY columns of vertices or of faces form, by name."""
    left: dict[str, Values] = {}
    for name, values in columns.items():
        usual = _ALIASES.get(name, name)
        left[name if usual in left or usual in columns else usual] = values
    found: dict[str, Values] = {}
    for name, known in _KNOWN.items():
        wanted = [one for one in known if one in left or one != "alpha"]
        if all(one in left for one in wanted):
            found[name] = np.stack([left.pop(one) for one in wanted], axis=1)
    for base, names in _numbered(left).items():
        found[base] = np.stack([left.pop(name) for name in names], axis=1)
    return found | left


def _numbered(columns: Mapping[str, Values]) -> dict[str, list[str]]:
    """Return the names of the columns of each array of several columns: `name_0`, `name_1`, …."""
    counts: dict[str, int] = {}
    for name in columns:
        match = _NUMBERED.fullmatch(name)
        if match and counts.get(match[1], 0) == int(match[2]):
            counts[match[1]] = int(match[2]) + 1
    return {
        base: [f"{base}_{k}" for k in range(count)]
        for base, count in counts.items()
        if base not in columns
    }


def corners_of(lists: Mapping[str, Values], count: int) -> dict[str, Values]:
    """Return attributes of polygon corners, (p * count, …), from PLY lists of faces.

    Parameters
    ----------
    lists : dict of str to (p, n) array
    count : int
        The number of corners of every polygon.
    """
    found = {}
    for name, values in lists.items():
        width, rest = divmod(values.shape[1], count)
        if width and not rest:
            shape = (-1,) if width == 1 else (-1, width)
            found["uv" if name == _TEXCOORD else name] = values.reshape(shape)
    return found


def names_in(attributes: Attributes | None) -> dict[str, set[str]]:
    """Return the names of the PLY columns and lists that form the attributes, by element."""
    if attributes is None:
        return {}
    vertex = {name for name, _ in columns_of(attributes.vertex)}
    face = {name for name, _ in (*columns_of(attributes.face), *lists_of(attributes.corner))}
    return {
        element: names | {other for other, usual in _ALIASES.items() if usual in names}
        for element, names in (("vertex", vertex), ("face", face))
    }
