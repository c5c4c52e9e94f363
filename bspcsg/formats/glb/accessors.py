"""Decoding of glTF accessors into arrays of numbers, with one row for each element.

# Source
glTF 2.0, sections 3.6.2 (accessors, sparse ones, fractions in whole numbers) and 3.11.
"""

import numpy as np

from ...attributes.attributes import Values
from .container import COMPONENTS, ELEMENTS, Container


def stored(container: Container, number: int) -> Values:
    """Return the elements of an accessor, (count, k) in the stored type, if possible as a view.

    In a sparse accessor without a buffer view, elements that are not replaced are zeros.

    Raises
    ------
    IndexError
        If a sparse accessor replaces an element that does not exist.
    """
    accessor = container.tree["accessors"][number]
    count, item = accessor["count"], np.dtype(COMPONENTS[accessor["componentType"]])
    width = ELEMENTS[accessor["type"]]
    if "bufferView" in accessor:
        values = _rows(container, accessor, count, width, item)
    else:
        values = np.zeros((count, width), item)
    if "sparse" not in accessor:
        return values
    sparse = accessor["sparse"]
    kind = np.dtype(COMPONENTS[sparse["indices"]["componentType"]])
    places = _rows(container, sparse["indices"], sparse["count"], 1, kind).ravel()
    if len(places) and not 0 <= places.min() <= places.max() < count:
        raise IndexError(f"accessor {number} has a sparse index outside its {count} elements")
    replaced = values.copy()
    replaced[places] = _rows(container, sparse["values"], sparse["count"], width, item)
    return replaced


def numbers(values: Values, is_fraction: bool) -> Values:
    """Return numbers in native byte order; if `is_fraction`, integers become fractions."""
    if is_fraction:
        return fractions(values)
    native: Values = values.astype(values.dtype.newbyteorder("="))
    return native


def fractions(values: Values) -> Values:
    """Return normalized integers as fractions from -1 to 1 in float32; floats stay unchanged."""
    if values.dtype.kind == "f":
        return values
    parts: Values = np.maximum(values / np.iinfo(values.dtype).max, -1).astype(np.float32)
    return parts


def _rows(
    container: Container,
    location: "dict[str, int]",
    count: int,
    width: int,
    item: "np.dtype[np.generic]",
) -> Values:
    """Return (count, width) numbers of a buffer view, without a copy."""
    view = container.tree["bufferViews"][location["bufferView"]]
    stride = view.get("byteStride") or item.itemsize * width
    start = view.get("byteOffset", 0) + location.get("byteOffset", 0)
    return np.ndarray((count, width), item, container.data, start, (stride, item.itemsize))
