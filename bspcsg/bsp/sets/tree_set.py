"""`TreeSet`: the base class of sets of points that are represented by a partition tree."""

from abc import abstractmethod
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Self

from ..._core import ObjectTree as CoreTree
from ..._types import FloatArray, Scalar, SetOp, SideArray
from ...errors import core_errors, deprecated, invalid_parameter
from ...parameters import shown
from ...solid.point_classification import sides_of
from ...solid.point_set import PointSet
from .rows import point_rows

if TYPE_CHECKING:
    from .objects import ObjectTree


class TreeSet(PointSet):
    """A set of points that a partition tree represents; an immutable value.

    Sets of the same dimension can be compared and combined, even if their classes differ; a result
    has the class of the first operand.
    """

    __slots__ = ("_tree",)

    _tree: CoreTree

    @property
    @abstractmethod
    def tree(self) -> "ObjectTree":
        """The set as an `ObjectTree`, which gives access to nodes, cells and boundary pieces."""

    @abstractmethod
    def _merged(self, other: "TreeSet", op: SetOp) -> Self:
        """Return the result of a set operation on this set and another one of its dimension."""

    def __or__(self, other: object) -> Self:
        """Return the union of this set and the other one."""
        return self._merged(other, "union") if isinstance(other, TreeSet) else NotImplemented

    def __and__(self, other: object) -> Self:
        """Return the intersection of this set and the other one."""
        return self._merged(other, "intersection") if isinstance(other, TreeSet) else NotImplemented

    def __sub__(self, other: object) -> Self:
        """Return the difference: this set without the other one."""
        return self._merged(other, "difference") if isinstance(other, TreeSet) else NotImplemented

    def __xor__(self, other: object) -> Self:
        """Return the symmetric difference of this set and the other one."""
        return self._merged(other, "xor") if isinstance(other, TreeSet) else NotImplemented

    @abstractmethod
    def split(self, normal: Any, offset: Scalar = 0.0) -> tuple[Self, Self]:
        """Return the parts of the set on the minus and on the plus side of a hyperplane."""

    def isdisjoint(self, other: "TreeSet") -> bool:
        """Return true if both sets have no interior point in common; they may touch."""
        return (self & set_of(other)).is_empty

    def _is_alike(self, other: object) -> bool:
        return isinstance(other, TreeSet) and self.dimension == other.dimension

    def __copy__(self) -> Self:
        """Return the set itself, which never changes."""
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """Return the set itself, which never changes."""
        return self

    # Questions

    def classify(self, points: Any) -> SideArray:
        """Classify points as inside, outside or on the boundary, exactly.

        Parameters
        ----------
        points : (k, d) array_like of float
            In model units, snapped to the lattice; on the line (k,) is allowed. For a bounded set,
            points may lie anywhere.

        Returns
        -------
        (k,) int8
            +1 inside, 0 on the boundary, -1 outside.
        """
        return sides_of(point_rows(points, self.dimension), self._tree)

    @abstractmethod
    def nearest(self, points: Any) -> tuple[FloatArray, FloatArray]:
        """Return for each point the nearest boundary point, (k, d), and its distance, (k,)."""

    def project(self, points: Any) -> tuple[FloatArray, FloatArray]:
        """Return the result of `nearest`; deprecated name, since a projection is a shadow."""
        deprecated(f"{type(self).__name__}.project", "nearest")
        return self.nearest(points)

    @property
    def measure(self) -> Fraction:
        """The exact length, area or volume of the set, in (square, cubic) model units.

        Raises
        ------
        UnboundedError
            If the set reaches to infinity.
        """
        with core_errors():
            return Fraction(*self._tree.measure())

    @property
    def dimension(self) -> int:
        """The dimension of the space that contains the set: 1, 2 or 3."""
        return self._tree.dimension

    @property
    def pitch(self) -> int:
        """The exponent of the lattice step, which is ``10**pitch`` model units."""
        return self._tree.pitch

    @property
    def is_empty(self) -> bool:
        """True if the set has no points."""
        return self._tree.is_empty

    @property
    def is_full(self) -> bool:
        """True if the set is the whole space."""
        return self._tree.is_full

    @property
    def is_bounded(self) -> bool:
        """True if the set does not reach to infinity."""
        return self._tree.is_bounded


def set_of(value: object, name: str = "other") -> TreeSet:
    """Return a value if it is a `TreeSet`, else raise an error that names the parameter."""
    if isinstance(value, TreeSet):
        return value
    message = f"{name} must be a Region, Intervals or an ObjectTree, not {shown(value)}."
    raise invalid_parameter(message)
