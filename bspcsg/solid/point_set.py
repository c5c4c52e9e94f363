"""`PointSet`: the comparison of sets of points of any kind.

The operators are those of Python's own sets, applied to the sets of points: ``==`` and ``!=``,
``<=``, ``<``, ``>=``, ``>``, and ``in`` for a point. Only the points count, not the tree, the
lattice or the history. All comparisons are exact.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Self

from .._types import SideArray
from ..errors import invalid_parameter
from ..meant import no_attribute
from ..parameters import shown
from .counting import uncounted


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
        """Say whether both are the same set of points, exactly."""

    @abstractmethod
    def _is_alike(self, other: object) -> bool:
        """Say whether the other is a set in the same space."""

    @abstractmethod
    def _size_key(self) -> object:
        """Return a key that equal sets share, such as their exact size."""

    @abstractmethod
    def __sub__(self, other: Any) -> Self:
        """Difference."""

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """Raise an error that suggests the intended name; hidden from type checkers."""
            raise no_attribute(self, name, f"{type(self).__name__!r} object")

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
        """Return the points in an odd number of the sets; ``^`` takes one other set."""
        from ..operations.setops import xor

        return xor(self, *others)

    def __eq__(self, other: object) -> bool:
        """Say whether both are the same set of points, exactly."""
        if self is other:
            return True
        return self.equals(other) if self._is_alike(other) else NotImplemented

    def __hash__(self) -> int:
        """Return a hash of the exact size; this evaluates the set.

        Equal solids stay equal under a common rotation. The hash is of the size after rounding,
        which may differ if their boundaries are triangulated differently.
        """
        return hash(self._size_key())

    @uncounted
    def __le__(self, other: object) -> bool:
        """Say whether this set is part of the other, exactly."""
        return (self - other).is_empty if self._is_alike(other) else NotImplemented

    @uncounted
    def __lt__(self, other: object) -> bool:
        """Say whether this set is part of the other and not equal to it, exactly."""
        if not isinstance(other, PointSet) or not self._is_alike(other):
            return NotImplemented
        return (self - other).is_empty and not (other - self).is_empty

    def __ge__(self, other: object) -> bool:
        """Say whether the other set is part of this one, exactly."""
        alike = isinstance(other, PointSet) and self._is_alike(other)
        return other <= self if alike else NotImplemented

    def __gt__(self, other: object) -> bool:
        """Say whether the other set is part of this one and not equal to it, exactly."""
        alike = isinstance(other, PointSet) and self._is_alike(other)
        return other < self if alike else NotImplemented

    @uncounted
    def __contains__(self, point: object) -> bool:
        """Say whether a point is inside or on the boundary; it is snapped to the lattice.

        For many points `classify` is faster, and it distinguishes the boundary.
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
        """Say whether the set is not empty; this evaluates it."""
        return not self.is_empty
