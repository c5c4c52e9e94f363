"""`SetOperators`: the operators ``| & - ^`` for classes that wrap a set."""

import operator
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Self


class SetOperators(ABC):
    """The base class of sets that wrap another set and use its operators."""

    __slots__ = ()

    @abstractmethod
    def _combined(self, other: object, operation: Callable[[Any, Any], Any]) -> Self:
        """Return the result of an operator on this set and another, or NotImplemented."""

    def __or__(self, other: object) -> Self:
        """Return the union of both sets."""
        return self._combined(other, operator.or_)

    def __and__(self, other: object) -> Self:
        """Return the intersection of both sets."""
        return self._combined(other, operator.and_)

    def __sub__(self, other: object) -> Self:
        """Return the difference: this set without the other one."""
        return self._combined(other, operator.sub)

    def __xor__(self, other: object) -> Self:
        """Return the symmetric difference of both sets."""
        return self._combined(other, operator.xor)
