"""Objects as they stand in a file, and blocks of numbers in one layout."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ..._core import numbers_in
from ..._types import IndexArray


@dataclass(frozen=True, eq=False)
class Held:
    """One object as it stands in a file.

    Parameters
    ----------
    vertices : (n, 3) float32 or float64
        In the precision of the file.
    faces : (m, 3) int, optional
        Indices of `vertices`; where there are none, three vertices after another are a triangle.
    name : str
    """

    vertices: npt.NDArray[Any]
    faces: IndexArray | None = None
    name: str = ""

    @property
    def count(self) -> int:
        """Number of triangles."""
        return len(self.vertices) // 3 if self.faces is None else len(self.faces)


def after(key: bytes, line: bytes) -> str:
    """Return the name in a line that begins with a key."""
    if not line.startswith(key):
        raise ValueError(f"a line does not begin with “{key.decode()}”")
    return line[len(key) :].decode("utf-8")


def whole_numbers(found: npt.NDArray[np.float64]) -> IndexArray:
    """Return whole numbers of doubles; others become what no file may hold."""
    whole: IndexArray = found.astype(np.int64)
    return np.where(whole == found, whole, -1)


def rows_of(block: bytes, row: bytes, width: int) -> npt.NDArray[np.float64]:
    """Return the numbers of a block that is one layout of lines again and again."""
    layout, unit = block.translate(None, OF_NUMBERS), row.translate(None, OF_NUMBERS)
    count = len(layout) // len(unit)
    check_layout(layout, unit * count)
    return numbers_in(block).reshape(count, width)


#: Bytes that may belong to a number.
OF_NUMBERS = b"0123456789+-.eE"


def check_layout(found: bytes, expected: bytes) -> None:
    """Refuse a block whose bytes between the numbers are others."""
    if found != expected:
        raise ValueError("its lines are not what they should be")
