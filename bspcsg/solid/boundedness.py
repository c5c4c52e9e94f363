"""Whether solids and the results of set operations are bounded, found without the core."""

from collections.abc import Sequence
from typing import TypeAlias

from .program import Algebra

#: True if a solid is bounded, False if its complement is, None if neither or unknown.
Extent: TypeAlias = bool | None


def _either(operands: Sequence[Extent]) -> Extent:
    # A union has a bounded complement if one operand has; it is bounded if all operands are.
    return False if False in operands else all(operands) or None


def _both(operands: Sequence[Extent]) -> Extent:
    return True if True in operands else None if None in operands else False


def _odd(operands: Sequence[Extent]) -> Extent:
    return None if None in operands else operands.count(False) % 2 == 0


def _other(operand: Extent) -> Extent:
    return None if operand is None else not operand


#: The extent of the result of each set operation, given the extents of its operands.
EXTENTS: Algebra[Extent] = Algebra(_either, _both, _odd, _other)
