"""Names for the arrays and values that cross module borders."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ._core import find_numpy

# Imported here, so that an interrupt waits until the import ends, and not at the first array.
find_numpy()

#: Coordinates or other measures: float64; the shape is given where the name is used.
FloatArray: TypeAlias = npt.NDArray[np.float64]

#: Indices: int64; the docstring that uses the name says what they index.
IndexArray: TypeAlias = npt.NDArray[np.int64]

#: In/on/out answers: int8, +1 inside, 0 on the boundary, -1 outside.
SideArray: TypeAlias = npt.NDArray[np.int8]

#: A number, Python's or numpy's.
Scalar: TypeAlias = float | np.floating[Any] | np.integer[Any]

#: One number per axis, in any form numpy understands.
Vector: TypeAlias = Sequence[Scalar] | npt.NDArray[np.floating] | npt.NDArray[np.integer]

#: The rules that say which winding numbers count as inside.
WindingRule: TypeAlias = Literal["positive", "nonzero", "even-odd"]

#: A boolean of two or more operands, by name.
SetOp: TypeAlias = Literal["union", "intersection", "difference", "xor"]

#: One line of the program that the core evaluates: an operation, and the lines it uses.
ProgramLine: TypeAlias = tuple[str, list[int]]

#: Answers for each element: bool.
BoolArray: TypeAlias = npt.NDArray[np.bool_]

#: Vertices (n, 3) and triangles (m, 3) of a mesh.
MeshArrays: TypeAlias = tuple[FloatArray, IndexArray]


class _Shown:
    """A stand-in for an alias while programs run, so that `help` prints its name.

    Parameters
    ----------
    name : str
    """

    def __init__(self, name: str) -> None:
        self._name = name

    def __repr__(self) -> str:
        """Return the name."""
        return self._name

    def __or__(self, other: object) -> "_Shown":
        """Return the union with another type."""
        return _Shown(f"{self._name} | {_name_of(other)}")

    def __ror__(self, other: object) -> "_Shown":
        """Return the union with another type."""
        return _Shown(f"{_name_of(other)} | {self._name}")


def _name_of(kind: object) -> str:
    return "None" if kind is None else getattr(kind, "__name__", None) or repr(kind)


if not TYPE_CHECKING:
    _ARRAYS = ("FloatArray", "IndexArray", "SideArray", "BoolArray", "MeshArrays")
    globals().update((name, _Shown(name)) for name in (*_ARRAYS, "Scalar", "Vector"))
