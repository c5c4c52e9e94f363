"""Binary PLY elements with lists, read at once if all lists have one length, else one by one."""

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
    """An element that was read.

    Parameters
    ----------
    end : int
        The offset at which its data end.
    polygons : IndexPolygons or None
        The lists of the wanted column, if one was wanted.
    error_at : callable
        Makes the error for record k.
    columns : dict of str to array
        The other properties, (k,) or (k, n), if every list is as long as in the first record.
    """

    end: int
    polygons: IndexPolygons | None
    error_at: Callable[[int, str, str], FormatError]
    columns: dict[str, Values] = field(default_factory=dict)


def read_uniform(
    source: Source, order: Order, element: Element, start: int, column: int | None
) -> ListBlock | None:
    """Read the element if every list is as long as in its first record; else return None."""
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
    """Return the length of each property of the first record, or None if it is cut off."""
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
    """Read the element record by record.

    Raises
    ------
    FormatError
        If the data end too early, or a list has a negative length.
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
    """The reading of one property of a record."""

    def __init__(self, prop: Property, order: Order) -> None:
        self.size = prop.item.itemsize
        self._order = order
        self._item = prop.item.char
        self._count = None if prop.count is None else struct.Struct(order + prop.count.char)

    def extent(self, data: bytes, at: int) -> tuple[int, int]:
        """Return offset and number of the values; past the end of the data, one too many."""
        if self._count is None:
            return at, 1
        if at + self._count.size > len(data):
            return len(data), 1
        return at + self._count.size, int(self._count.unpack_from(data, at)[0])

    def values(self, data: bytes, first: int, length: int) -> list[int]:
        """Return the values, which must be whole numbers."""
        return list(struct.unpack_from(f"{self._order}{length}{self._item}", data, first))
