"""The public parts of a partition tree: pieces, nodes, and the names of cases."""

from dataclasses import dataclass
from typing import Any, ClassVar, Literal, TypeAlias

from ..._types import FloatArray, IndexArray, Scalar

#: The division of a tree: axis-parallel cuts above the facets in random order, or the hyperplanes
#: of the facets alone, in random order, in the order given, or those first that cut the fewest.
BuildPolicy: TypeAlias = Literal["balanced", "random", "first", "fewest-splits"]

#: The position of a root and a splitting hyperplane to each other (see `split_case`).
SplitCase: TypeAlias = Literal[
    "leaf", "same", "opposite", "minus-minus", "minus-plus", "plus-minus", "plus-plus", "crossing"
]

#: A hyperplane: its normal, which points to the plus side, and its offset; points x on it have
#: ``normal . x == offset``. On the line the normal is a number of either sign.
NormalAndOffset: TypeAlias = tuple[Any, Scalar]


@dataclass(frozen=True, eq=False)
class Pieces:
    """Convex pieces in order: points (1D), segments (2D), polygons (3D).

    Parameters
    ----------
    vertices : (n, d) float64
        The corners of all pieces one after another, the set on the left (2D), or behind a polygon
        that is seen counterclockwise (3D).
    offsets : (k + 1,) int64
        Piece i owns ``vertices[offsets[i]:offsets[i + 1]]``.
    owner : (k,) int64
        The node (`ObjectTree.boundary`) or the cell (`ObjectTree.cells`) that the piece belongs to.
    """

    vertices: FloatArray
    offsets: IndexArray
    owner: IndexArray

    def __len__(self) -> int:
        """Count the pieces."""
        return len(self.owner)

    def __getitem__(self, index: int) -> FloatArray:
        """Return the (m, d) corners of one piece."""
        number = range(len(self))[index]
        return self.vertices[self.offsets[number] : self.offsets[number + 1]]


@dataclass(frozen=True, eq=False)
class NodeTable:
    """The inner nodes in preorder: each before its subtrees, the minus subtree first.

    Parameters
    ----------
    hyperplanes : (n, d + 1) float64
        A normal of length 1 and the offset, in model units, rounded.
    minus, plus : (n,) int64
        The children's rows; -1 for a leaf outside, -2 for a leaf inside.
    coefficients : tuple of tuple of int
        The same hyperplanes exactly: whole numbers n, c with n·x = c, x in lattice steps.
    """

    hyperplanes: FloatArray
    minus: IndexArray
    plus: IndexArray
    coefficients: tuple[tuple[int, ...], ...] = ()

    #: The entries of `minus` and `plus` for leaves.
    OUT: ClassVar[int] = -1
    IN: ClassVar[int] = -2

    def __len__(self) -> int:
        """Count the inner nodes."""
        return len(self.minus)
