"""`FlatSet`: a set of points of the line or the plane that has a partition tree."""

from typing import Any, Self

from ..._core import ObjectTree as CoreTree
from ..._types import FloatArray, Scalar, SetOp
from ...errors import core_errors
from .objects import ObjectTree, merge
from .tree_set import TreeSet, set_of

#: A result is built anew if its tree has more nodes than this multiple of its operands' nodes and
#: so many more.
_MAX_GROWTH = 4
_FREE_NODES = 64


class FlatSet(TreeSet):
    """A set of points of the line or of the plane; an immutable value that has a tree."""

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
        """The partition tree, with its nodes, cells and pieces of boundary."""
        return ObjectTree._of(self._tree)

    # Set operations

    def __invert__(self) -> Self:
        """Complement, which shares all nodes."""
        return self._of((~self.tree)._tree)

    def _merged(self, other: TreeSet, op: SetOp) -> Self:
        """Return the result of an operation; rebuild its tree if merging made it too large.

        The cost of rebuilding is amortised, so a chain of n operations stays near-linear in its
        output.
        """
        merged = merge(self.tree, other.tree, op)
        base = max(_built_nodes(self), _built_nodes(other))
        if merged.stats()["nodes"] > _MAX_GROWTH * base + _FREE_NODES:
            return self._of(merged.condensed()._tree)
        made = self._of(merged._tree)
        made._built_size = base
        return made

    def equals(self, other: "TreeSet") -> bool:
        """Say whether both are the same set of points, exactly; same as ``==``.

        Raises
        ------
        InvalidMeshError
            If the other set has another dimension; ``==`` then returns False.
        """
        return self.tree.equals(set_of(other).tree)

    def _size_key(self) -> object:
        return self.tree._size_key()

    def split(self, normal: Any, offset: Scalar = 0.0) -> tuple[Self, Self]:
        """Return the parts on the minus and on the plus side of a hyperplane, as sets."""
        minus, plus = self.tree.split(normal, offset)
        return self._of(minus._tree), self._of(plus._tree)

    # Questions

    def nearest(self, points: Any) -> tuple[FloatArray, FloatArray]:
        """Return the nearest boundary point of each point, and its distance.

        See `ObjectTree.nearest`.
        """
        return self.tree.nearest(points)

    # As a value

    def _moved(self, axes: list[int], shift: list[int]) -> Self:
        """Return the set moved by whole lattice steps."""
        with core_errors():
            return self._of(self._tree.moved(axes, shift))

    def __reduce__(self) -> tuple[Any, tuple[type["FlatSet"], bytes]]:
        """Pickle the nodes, exactly."""
        return _restored, (type(self), self._tree.dump())


def _built_nodes(operand: TreeSet) -> int:
    """Return the number of nodes of a tree when it was last built from a boundary."""
    known = operand._built_size if isinstance(operand, FlatSet) else 0
    return known or operand.tree.stats()["nodes"]


def _restored(kind: type[FlatSet], data: bytes) -> FlatSet:
    with core_errors():
        return kind._of(CoreTree.load(data))
