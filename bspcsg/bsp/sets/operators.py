"""`SetOperators`: operators of set operations, for sets that wrap another set."""

import operator
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Self


class SetOperators(ABC):
    """A set with the operations of the set that it wraps."""

    __slots__ = ()

    @abstractmethod
    def _combined(self, other: object, operation: Callable[[Any, Any], Any]) -> Self:
        """Return an operation on this set and another one, or NotImplemented."""

    def __or__(self, other: object) -> Self:
        """Union."""
        return self._combined(other, operator.or_)

    def __and__(self, other: object) -> Self:
        """Intersection."""
        return self._combined(other, operator.and_)

    def __sub__(self, other: object) -> Self:
        """Difference."""
        return self._combined(other, operator.sub)

    def __xor__(self, other: object) -> Self:
        """Symmetric difference."""
        return self._combined(other, operator.xor)
