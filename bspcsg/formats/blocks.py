"""Arrays a block at a time: what goes through them can be stopped soon, and needs little room.

Signals are heard between two steps of Python: one step over a million rows would take a second.
"""

import itertools
from collections.abc import Iterator
from typing import Any

import numpy.typing as npt

#: Rows looked at together: their arrays fit into a processor's cache.
TOGETHER = 1 << 14

#: Rows of a file written together, and read back together: fewer take longer each, and of more
#: what was written leaves the cache before it is read back.
OF_FILE = 2 * TOGETHER


def blocks(count: int, together: int = TOGETHER) -> Iterator[slice]:
    """Yield the parts into which so many rows are divided."""
    return (slice(start, start + together) for start in range(0, count, together))


def listed(values: npt.NDArray[Any]) -> Iterator[Any]:
    """Yield the rows of an array as numbers, or lists of numbers, of Python."""
    for block in blocks(len(values)):
        yield from values[block].tolist()


#: The number of lines of text that are handed on together: some hundred thousand bytes.
_LINES_PER_CHUNK = 1 << 12


def encoded_lines(lines: Iterator[str]) -> Iterator[bytes]:
    """Yield lines of text, many at a time."""
    while together := "".join(itertools.islice(lines, _LINES_PER_CHUNK)):
        yield together.encode()
