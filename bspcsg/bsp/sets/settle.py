"""Values that keep their trees small over long chains of operations."""

from typing import Self

from ..._types import SetOp
from .objects import ObjectTree

#: A result is built anew when its tree is this many times larger than its operands' were.
_GROWTH = 4
_SMALL = 64


class Settled(ObjectTree):
    """A set whose tree is built anew from its boundary once merging has let it grow too far.

    Each doubling is paid for once, so that a chain of n operations stays near-linear in what it
    makes.
    """

    __slots__ = ()

    def _merged(self, other: object, op: SetOp) -> Self:
        merged = super()._merged(other, op)
        if not isinstance(other, ObjectTree):
            return merged
        base = max(self._settled_nodes(), other._settled_nodes())
        if merged.stats()["nodes"] <= _GROWTH * base + _SMALL:
            merged._settled_size = base
            return merged
        return merged.condensed()
