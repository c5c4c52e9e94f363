"""Reading of binary PLY elements with lists, whether or not all lists have one length."""

import struct
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ...attributes.attributes import Values
from ...errors import FormatError
from ..raw import IndexPolygons
from ..source import Source
from .header import Element, Order, Property


@dataclass(frozen=True)
class ListBlock:
    """The data of a binary PLY element with lists.

    Parameters
    ----------
    end : int
        The byte offset at which the data end.
    polygons : IndexPolygons or None
        The lists of the column that was asked for; None if none was.
    error_at : callable
        Makes the error for record k, from k, a message and a code.
    columns : dict of str to array
        All other properties, (k,) or (k, n); empty unless all lists of a property have one length.
    """

    end: int
    polygons: IndexPolygons | None
    error_at: Callable[[int, str, str], FormatError]
    columns: dict[str, Values] = field(default_factory=dict)


def read_uniform(
    source: Source, order: Order, element: Element, start: int, column: int | None
) -> ListBlock | None:
    """Read an element; return None if a list has another length than in the first record.

    `column` is the number of the property whose lists are polygons, or None.
    """
    if element.number == 0:
        return None
    lengths = _first_lengths(source, order, element, start)
    if lengths is None:
        return None
    record = _record(order, element, lengths)
    end = start + record.itemsize * element.number
    if end > len(source.data):
        return None
    records = np.frombuffer(source.data, record, element.number, start)
    for position, prop in enumerate(element.properties):
        if prop.count is not None and (records[f"n{position}"] != lengths[position]).any():
            return None

    def error_at(k: int, message: str, code: str) -> FormatError:
        return source.error(message, code, offset=start + k * record.itemsize)

    polygons = None
    if column is not None:
        polygons = IndexPolygons.from_rows(records[f"p{column}"])
    columns = {
        prop.name: records[f"p{position}"].astype(prop.item)
        for position, prop in enumerate(element.properties)
        if position != column
    }
    return ListBlock(end, polygons, error_at, columns)


def _first_lengths(source: Source, order: Order, element: Element, start: int) -> list[int] | None:
    """Return the number of values of each property in the first record; None if it is cut off."""
    lengths = []
    at = start
    for prop in element.properties:
        length = 1
        if prop.count is not None:
            if at + prop.count.itemsize > len(source.data):
                return None
            length = int(np.frombuffer(source.data, prop.count.newbyteorder(order), 1, at)[0])
            at += prop.count.itemsize
        at += length * prop.item.itemsize
        if length < 0 or at > len(source.data):
            return None
        lengths.append(length)
    return lengths


def _record(order: Order, element: Element, lengths: list[int]) -> np.dtype[np.void]:
    fields: list[tuple[str, np.dtype[np.generic], tuple[int, ...]]] = []
    for position, (prop, length) in enumerate(zip(element.properties, lengths, strict=True)):
        if prop.count is not None:
            fields.append((f"n{position}", prop.count.newbyteorder(order), ()))
            fields.append((f"p{position}", prop.item.newbyteorder(order), (length,)))
        else:
            fields.append((f"p{position}", prop.item.newbyteorder(order), ()))
    return np.dtype(fields)


def read_mixed(
    source: Source, order: Order, element: Element, start: int, column: int | None
) -> ListBlock:
    """Read an element record by record; `column` numbers the property with polygons, or is None.

    Raises
    ------
    FormatError
        If the data are cut off, or a list has a negative length.
    """
    data = source.data
    lists: list[list[int]] = []
    starts: list[int] = []
    steps = [_Step(prop, order) for prop in element.properties]
    at = start
    for number in range(element.number):
        starts.append(at)
        for position, step in enumerate(steps):
            first, length = step.extent(data, at)
            at = first + length * step.size
            if length < 0 or at > len(data):
                raise _cut_off(source, element, number, length)
            if position == column:
                lists.append(step.values(data, first, length))
    polygons = None if column is None else IndexPolygons.from_lists(lists)
    return ListBlock(at, polygons, lambda k, text, code: source.error(text, code, offset=starts[k]))


def _cut_off(source: Source, element: Element, number: int, length: int) -> FormatError:
    if length < 0:
        message = f"item {number} of the element “{element.name}” has a list of negative length."
        return source.error(message, offset=len(source.data))
    message = (
        f"the file is incomplete: it ends in item {number} of {element.number} of the element"
        f" “{element.name}”."
    )
    return source.error(message, "truncated", offset=len(source.data))


class _Step:
    """A reader of one property in binary records."""

    def __init__(self, prop: Property, order: Order) -> None:
        self.size = prop.item.itemsize
        self._order = order
        self._item = prop.item.char
        self._count = None if prop.count is None else struct.Struct(order + prop.count.char)

    def extent(self, data: bytes, at: int) -> tuple[int, int]:
        """Return the offset and the number of a property's values in the record at offset `at`.

        If the data end before them, the values reach past that end.
        """
        if self._count is None:
            return at, 1
        if at + self._count.size > len(data):
            return len(data), 1
        return at + self._count.size, int(self._count.unpack_from(data, at)[0])

    def values(self, data: bytes, first: int, length: int) -> list[int]:
        """Return `length` values from offset `first`; their type must be an integer type."""
        return list(struct.unpack_from(f"{self._order}{length}{self._item}", data, first))
