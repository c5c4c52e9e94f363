"""Type aliases for arrays and values that modules share."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ._core import find_numpy

# Import numpy here rather than at the first array, so that Ctrl-C waits for the end of the import.
find_numpy()

#: An array of float64; its shape is documented where the alias is used.
FloatArray: TypeAlias = npt.NDArray[np.float64]

#: An array of int64 indices; the indexed elements are documented where the alias is used.
IndexArray: TypeAlias = npt.NDArray[np.int64]

#: An array of int8 positions of points: +1 inside, 0 on the boundary, -1 outside.
SideArray: TypeAlias = npt.NDArray[np.int8]

#: A number of Python or numpy.
Scalar: TypeAlias = float | np.floating[Any] | np.integer[Any]

#: A sequence or array with one number per axis.
Vector: TypeAlias = Sequence[Scalar] | npt.NDArray[np.floating] | npt.NDArray[np.integer]

#: The names of the rules for which winding numbers count as inside.
WindingRule: TypeAlias = Literal["positive", "nonzero", "even-odd"]

#: The name of a set operation on two or more operands.
SetOp: TypeAlias = Literal["union", "intersection", "difference", "xor"]

#: One line of a program that the core evaluates: an operator, and the line numbers of its operands.
ProgramLine: TypeAlias = tuple[str, list[int]]

#: An array of truth values.
BoolArray: TypeAlias = npt.NDArray[np.bool_]

#: The vertices, (n, 3), and the triangles, (m, 3), of a mesh.
MeshArrays: TypeAlias = tuple[FloatArray, IndexArray]


class _Shown:
    """The replacement of a type alias at run time, so that `help` prints the alias's name.

    Parameters
    ----------
    name : str
    """

    def __init__(self, name: str) -> None:
        self._name = name

    def __repr__(self) -> str:
        """Return the name of the alias."""
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
