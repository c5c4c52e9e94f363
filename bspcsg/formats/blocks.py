"""Iteration over arrays in blocks of rows, which needs little memory and can be interrupted.

Python handles signals only between two calls; one call for a million rows would take a second.
"""

import itertools
from collections.abc import Iterator
from typing import Any

import numpy.typing as npt

#: The number of rows in a block of an array: they fit into the processor's cache.
ROWS_PER_BLOCK = 1 << 14

#: The number of rows that are written to a file, and read back, at a time. Smaller blocks take more
#: time, and a larger one leaves the processor's cache before it is read back.
ROWS_PER_FILE_BLOCK = 2 * ROWS_PER_BLOCK


def blocks(count: int, together: int = ROWS_PER_BLOCK) -> Iterator[slice]:
    """Yield slices that divide `count` rows into blocks of `together` rows each."""
    return (slice(start, start + together) for start in range(0, count, together))


def listed(values: npt.NDArray[Any]) -> Iterator[Any]:
    """Yield the rows of an array: Python numbers if it has one dimension, lists if it has two."""
    for block in blocks(len(values)):
        yield from values[block].tolist()


#: The number of lines of text that are joined to one chunk of about a hundred thousand bytes.
_LINES_PER_CHUNK = 1 << 12


def encoded_lines(lines: Iterator[str]) -> Iterator[bytes]:
    """Yield lines of text as UTF-8 bytes, thousands of lines in each chunk."""
    while together := "".join(itertools.islice(lines, _LINES_PER_CHUNK)):
        yield together.encode()
