"""Arrays in blocks, so that long loops need little memory and can be interrupted.

Python handles signals only between two steps; one step over a million rows would take a second.
"""

import itertools
from collections.abc import Iterator
from typing import Any

import numpy.typing as npt

#: The number of rows in a block of arrays: they fit into the processor's cache.
ROWS_PER_BLOCK = 1 << 14

#: The number of rows of a file that are written, and read back, together. Smaller blocks take more
#: time, and a larger one leaves the cache before it is read back.
ROWS_PER_FILE_BLOCK = 2 * ROWS_PER_BLOCK


def blocks(count: int, together: int = ROWS_PER_BLOCK) -> Iterator[slice]:
    """Yield the parts into which so many rows are divided."""
    return (slice(start, start + together) for start in range(0, count, together))


def listed(values: npt.NDArray[Any]) -> Iterator[Any]:
    """Yield the rows of an array as Python numbers or lists of numbers."""
    for block in blocks(len(values)):
        yield from values[block].tolist()


#: The number of lines of text that are handed on together: some hundred thousand bytes.
_LINES_PER_CHUNK = 1 << 12


def encoded_lines(lines: Iterator[str]) -> Iterator[bytes]:
    """Yield lines of text, many at a time."""
    while together := "".join(itertools.islice(lines, _LINES_PER_CHUNK)):
        yield together.encode()
