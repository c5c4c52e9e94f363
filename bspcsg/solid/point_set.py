"""`PointSet`: how sets of points compare, whatever they are made of.

The operators are those of Python's own sets, for the sets of points that the objects stand for:
``==`` and ``!=``, ``<=``, ``<``, ``>=``, ``>``, and ``in`` for a point. Nothing is compared that
does not belong to the set, such as its tree, its lattice or how it was made. All of it is exact.
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
    """A regularised set of points: the closure of its inside."""

    __slots__ = ()

    @abstractmethod
    def classify(self, points: Any) -> SideArray:
        """Say of each point whether it is inside (+1), on the boundary (0), or outside (-1)."""

    @property
    @abstractmethod
    def is_empty(self) -> bool:
        """True if nothing is inside."""

    @abstractmethod
    def equals(self, other: Any) -> bool:
        """Say whether both are the same set of points, exactly."""

    @abstractmethod
    def _is_alike(self, other: object) -> bool:
        """Say whether the other is a set of the same space."""

    @abstractmethod
    def _size_key(self) -> object:
        """Return what equal sets have in common, such as their exact size."""

    @abstractmethod
    def __sub__(self, other: Any) -> Self:
        """Difference."""

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """Say which name is meant; checkers of types know all names as it is."""
            raise no_attribute(self, name, f"{type(self).__name__!r} object")

    def union(self, *others: Self | Iterable[Self]) -> Self:
        """Return what is inside this set or one of the others; ``|`` does it with one."""
        from ..operations.setops import union

        return union(self, *others)

    def intersection(self, *others: Self | Iterable[Self]) -> Self:
        """Return what is inside this set and all others; ``&`` does it with one."""
        from ..operations.setops import intersection

        return intersection(self, *others)

    def difference(self, *others: Self | Iterable[Self]) -> Self:
        """Return what is inside this set and none of the others; ``-`` does it with one."""
        from ..operations.setops import difference

        return difference(self, *others)

    def symmetric_difference(self, *others: Self | Iterable[Self]) -> Self:
        """Return what is inside an odd number of the sets; ``^`` does it with one."""
        from ..operations.setops import xor

        return xor(self, *others)

    def __eq__(self, other: object) -> bool:
        """Say whether both are the same set of points, exactly."""
        if self is other:
            return True
        return self.equals(other) if self._is_alike(other) else NotImplemented

    def __hash__(self) -> int:
        """Return a number that equal sets share, from their exact size; this evaluates them.

        Solids that were turned together are equal if they were so before; the size is that after
        rounding, and may differ if their boundaries were divided otherwise.
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

        For many points `classify` is faster, and tells the boundary apart.
        """
        if isinstance(point, PointSet):
            raise invalid_parameter("Only points are in a set; for parts of it use <=.")
        sides = self.classify([point])
        if len(sides) != 1:
            raise invalid_parameter(f"A point has coordinates, unlike {shown(point)}.")
        return bool(sides[0] >= 0)

    @uncounted
    def __bool__(self) -> bool:
        """Say whether the set is not empty; this evaluates it."""
        return not self.is_empty
