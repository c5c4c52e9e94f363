"""`FlatSet`: the base class of sets on the line and in the plane that have a partition tree."""

from typing import Any, Self

from ..._core import ObjectTree as CoreTree
from ..._types import FloatArray, Scalar, SetOp
from ...errors import core_errors
from .objects import ObjectTree, merge
from .tree_set import TreeSet, set_of

#: The tree of a result is rebuilt if it has more nodes than _FREE_NODES plus _MAX_GROWTH times the
#: nodes of the larger operand's tree.
_MAX_GROWTH = 4
_FREE_NODES = 64


class FlatSet(TreeSet):
    """A set of points of the line or of the plane with a partition tree; an immutable value."""

    __slots__ = ("_built_size",)

    _built_size: int

    def _set(self, tree: CoreTree) -> None:
        self._tree = tree
        self._built_size = 0

    @classmethod
    def _of(cls, tree: CoreTree) -> Self:
        made = cls.__new__(cls)
        made._set(tree)
        return made

    @property
    def tree(self) -> ObjectTree:
        """The set as an `ObjectTree`, which gives access to nodes, cells and boundary pieces."""
        return ObjectTree._of(self._tree)

    # Set operations

    def __invert__(self) -> Self:
        """Return the complement; its tree shares all nodes with the tree of this set."""
        return self._of((~self.tree)._tree)

    def _merged(self, other: TreeSet, op: SetOp) -> Self:
        """Return the result of a set operation, with a rebuilt tree if merging made it too large.

        The cost of rebuilding is amortised, so the time of a chain of operations stays near-linear
        in the size of its results.
        """
        merged = merge(self.tree, other.tree, op)
        base = max(_built_nodes(self), _built_nodes(other))
        if merged.stats()["nodes"] > _MAX_GROWTH * base + _FREE_NODES:
            return self._of(merged.condensed()._tree)
        made = self._of(merged._tree)
        made._built_size = base
        return made

    def equals(self, other: "TreeSet") -> bool:
        """Return true if both sets contain exactly the same points, as ``==`` does.

        Raises
        ------
        InvalidMeshError
            If the other set has another dimension; ``==`` then returns False.
        """
        return self.tree.equals(set_of(other).tree)

    def _size_key(self) -> object:
        return self.tree._size_key()

    def split(self, normal: Any, offset: Scalar = 0.0) -> tuple[Self, Self]:
        """Return the parts of the set on the minus and on the plus side of a hyperplane."""
        minus, plus = self.tree.split(normal, offset)
        return self._of(minus._tree), self._of(plus._tree)

    # Questions

    def nearest(self, points: Any) -> tuple[FloatArray, FloatArray]:
        """Return the nearest boundary point of each point, (k, d), and its distance, (k,).

        See `ObjectTree.nearest`.
        """
        return self.tree.nearest(points)

    # As a value

    def _moved(self, axes: list[int], shift: list[int]) -> Self:
        """Return the set moved by a lattice motion: signed axes, then a shift in lattice steps."""
        with core_errors():
            return self._of(self._tree.moved(axes, shift))

    def __reduce__(self) -> tuple[Any, tuple[type["FlatSet"], bytes]]:
        """Pickle the nodes of the tree, exactly."""
        return _restored, (type(self), self._tree.dump())


def _built_nodes(operand: TreeSet) -> int:
    """Return the number of nodes that a set's tree had when it was last built from a boundary."""
    known = operand._built_size if isinstance(operand, FlatSet) else 0
    return known or operand.tree.stats()["nodes"]


def _restored(kind: type[FlatSet], data: bytes) -> FlatSet:
    with core_errors():
        return kind._of(CoreTree.load(data))
