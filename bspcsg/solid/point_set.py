"""`PointSet`: the base class of sets of points, which compare as Python's sets do.

The operators are those of Python's own sets, applied to the sets of points: ``==`` and ``!=``,
``<=``, ``<``, ``>=``, ``>``, and ``in`` for a point. Only the points count, not the tree, the
lattice or the history. All comparisons are exact.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Self

from .._types import SideArray
from ..errors import invalid_parameter
from ..parameters import shown
from ..suggestions import attribute_error
from .ledger import uncounted


class PointSet(ABC):
    """A regularised set of points: the closure of its interior."""

    __slots__ = ()

    @abstractmethod
    def classify(self, points: Any) -> SideArray:
        """Classify points as inside (+1), on the boundary (0), or outside (-1)."""

    @property
    @abstractmethod
    def is_empty(self) -> bool:
        """True if the set has no interior."""

    @abstractmethod
    def equals(self, other: Any) -> bool:
        """Return true if this set and the other contain exactly the same points."""

    @abstractmethod
    def _is_alike(self, other: object) -> bool:
        """Return true if the other object is a set in the same space, so that the two compare."""

    @abstractmethod
    def _size_key(self) -> object:
        """Return a hashable key that equal sets share, such as their exact area or volume."""

    @abstractmethod
    def __sub__(self, other: Any) -> Self:
        """Return the difference: the points of this set that are not in the other one."""

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """Raise an error that suggests the intended name; hidden from type checkers."""
            raise attribute_error(self, name, f"{type(self).__name__!r} object")

    def union(self, *others: Self | Iterable[Self]) -> Self:
        """Return the union of this set and all others; ``|`` takes one other set."""
        from ..operations.setops import union

        return union(self, *others)

    def intersection(self, *others: Self | Iterable[Self]) -> Self:
        """Return the intersection of this set and all others; ``&`` takes one other set."""
        from ..operations.setops import intersection

        return intersection(self, *others)

    def difference(self, *others: Self | Iterable[Self]) -> Self:
        """Return the difference of this set and all others; ``-`` takes one other set."""
        from ..operations.setops import difference

        return difference(self, *others)

    def symmetric_difference(self, *others: Self | Iterable[Self]) -> Self:
        """Return the points that lie in an odd number of the sets; ``^`` takes one other set."""
        from ..operations.setops import xor

        return xor(self, *others)

    def __eq__(self, other: object) -> bool:
        """Return true if this set and the other contain exactly the same points."""
        if self is other:
            return True
        return self.equals(other) if self._is_alike(other) else NotImplemented

    def __hash__(self) -> int:
        """Return a hash of the exact length, area or volume; this evaluates the set.

        Equal solids stay equal under the same rotation, but their hashes may then differ if their
        boundaries are triangulated differently: the hash is of the volume after rounding.
        """
        return hash(self._size_key())

    @uncounted
    def __le__(self, other: object) -> bool:
        """Return true if this set is a subset of the other, exactly."""
        return (self - other).is_empty if self._is_alike(other) else NotImplemented

    @uncounted
    def __lt__(self, other: object) -> bool:
        """Return true if this set is a subset of the other and not equal to it, exactly."""
        if not isinstance(other, PointSet) or not self._is_alike(other):
            return NotImplemented
        return (self - other).is_empty and not (other - self).is_empty

    def __ge__(self, other: object) -> bool:
        """Return true if the other set is a subset of this one, exactly."""
        alike = isinstance(other, PointSet) and self._is_alike(other)
        return other <= self if alike else NotImplemented

    def __gt__(self, other: object) -> bool:
        """Return true if the other set is a subset of this one and not equal to it, exactly."""
        alike = isinstance(other, PointSet) and self._is_alike(other)
        return other < self if alike else NotImplemented

    @uncounted
    def __contains__(self, point: object) -> bool:
        """Return true if a point, snapped to the lattice, is inside the set or on its boundary.

        For several points `classify` is faster, and it tells the boundary from the inside.
        """
        if isinstance(point, PointSet):
            raise invalid_parameter(
                "“in” tests points only; to test whether a set is part of another, use <=."
            )
        sides = self.classify([point])
        if len(sides) != 1:
            raise invalid_parameter(
                f"A point must be one tuple of coordinates, not {shown(point)}."
            )
        return bool(sides[0] >= 0)

    @uncounted
    def __bool__(self) -> bool:
        """Return true if the set is not empty; this evaluates the set."""
        return not self.is_empty
