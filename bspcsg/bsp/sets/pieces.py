"""Types of `ObjectTree`: convex pieces, the table of nodes, build policies and split cases."""

from dataclasses import dataclass
from typing import Any, ClassVar, Literal, TypeAlias

from ..._types import FloatArray, IndexArray, Scalar

#: How a tree over facets is built. "balanced": axis-parallel cuts first, then the hyperplanes of
#: facets in random order. The others use hyperplanes of facets only: in random order, in the given
#: order, or those first that cut the fewest facets.
BuildPolicy: TypeAlias = Literal["balanced", "random", "first", "fewest-splits"]

#: How a root's cut and a splitting hyperplane lie to each other (see `ObjectTree.split_case`).
SplitCase: TypeAlias = Literal[
    "leaf", "same", "opposite", "minus-minus", "minus-plus", "plus-minus", "plus-plus", "crossing"
]

#: A hyperplane: its normal, which points to the plus side, and its offset; points x on it have
#: ``normal . x == offset``. On the line the normal is a number of either sign.
NormalAndOffset: TypeAlias = tuple[Any, Scalar]


@dataclass(frozen=True, eq=False)
class Pieces:
    """A list of convex pieces in flat arrays: points (1D), segments (2D), polygons (3D).

    Parameters
    ----------
    vertices : (n, d) float64
        The corners of all pieces one after another. In 2D a set lies on the left of its boundary;
        in 3D boundary polygons run counterclockwise seen from outside.
    offsets : (k + 1,) int64
        Piece i owns ``vertices[offsets[i]:offsets[i + 1]]``.
    owner : (k,) int64
        The node (`ObjectTree.boundary`) or the cell (`ObjectTree.cells`) that the piece belongs to.
    """

    vertices: FloatArray
    offsets: IndexArray
    owner: IndexArray

    def __len__(self) -> int:
        """Return the number of pieces."""
        return len(self.owner)

    def __getitem__(self, index: int) -> FloatArray:
        """Return the (m, d) corners of one piece."""
        number = range(len(self))[index]
        return self.vertices[self.offsets[number] : self.offsets[number + 1]]


@dataclass(frozen=True, eq=False)
class NodeTable:
    """The inner nodes of an `ObjectTree` in preorder: a node, its minus subtree, its plus subtree.

    Parameters
    ----------
    hyperplanes : (n, d + 1) float64
        The unit normal and the offset of each node's hyperplane, in model units, rounded.
    minus, plus : (n,) int64
        The children's rows; -1 for a leaf outside, -2 for a leaf inside.
    coefficients : tuple of tuple of int
        The hyperplanes exactly, as integers (*n, c) with n·x = c, x in lattice steps.
    """

    hyperplanes: FloatArray
    minus: IndexArray
    plus: IndexArray
    coefficients: tuple[tuple[int, ...], ...] = ()

    #: The entries of `minus` and `plus` for leaves.
    OUT: ClassVar[int] = -1
    IN: ClassVar[int] = -2

    def __len__(self) -> int:
        """Return the number of inner nodes."""
        return len(self.minus)
