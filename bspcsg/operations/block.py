"""Blocks: operations on all solids that are made inside a ``with`` statement.

``with difference() as d:`` subtracts all later solids from the first one, as in OpenSCAD::

    with csg.difference() as d:
        csg.cube([20, 20, 10])
        csg.cylinder(h=10, r=3).translate(10, 10, 0)
    d.solid.save("plate.3mf")

A solid counts if it was made in the block and not used up there:

* Every call that makes a solid counts it: primitives, `Solid`, `from_mesh`, `load`, operators,
  transforms and the named operations.
* A solid passed to an operator, a transform or a named operation no longer counts. The result takes
  its place, so ``cylinder(...).translate(...)`` counts once, in the first position. Another
  transform of the same solid counts as well, at the end: four translations of one pin are four
  pins, and the pin itself does not count.
* Queries such as ``volume``, ``<=`` or `check` use up nothing.
* Solids from outside do not count until something is made from them, or `Block.add` counts them;
  `Block.discard` removes a solid that was only an aid.
* A nested block counts as one solid when it ends. Solids that it uses up no longer count in the
  blocks around it either.

Threads and asyncio tasks have blocks of their own. A thread or task that starts inside a block
counts there until the block ends.
"""

from collections.abc import Callable, Sequence
from types import TracebackType

from ..errors import InvalidMeshError, invalid_parameter
from ..geometry.chain import UNMOVED
from ..solid import counting
from ..solid.expression import ExpressionNode
from ..solid.leaf import ConstantLeaf
from ..solid.solid import Solid


class Block:
    """The solids that count in a ``with`` statement, and the solid made from them.

    Parameters
    ----------
    combined : callable
        Takes the list of solids and returns the block's.
    """

    def __init__(self, combined: Callable[[Sequence[Solid]], Solid]) -> None:
        self._combined = combined
        self._ledger = counting.opened()
        self._solid: Solid | None = None

    @property
    def solids(self) -> tuple[Solid, ...]:
        """The solids that count so far, in order."""
        return tuple(solid for solid in self._ledger.solids if isinstance(solid, Solid))

    @property
    def solid(self) -> Solid:
        """The result of the operation on the solids that count.

        Raises
        ------
        InvalidMeshError
            While the block is open, or if it ended in an error; code ``"open_block"``.
        """
        if self._solid is None:
            message = (
                "The solid of a block is available only after its with statement has ended"
                " without an error."
            )
            raise InvalidMeshError(message, "open_block")
        return self._solid

    def add(self, *solids: Solid) -> None:
        """Count solids that were made elsewhere, after all others."""
        self._refuse_ended(solids)
        for solid in solids:
            self._ledger.put(solid)

    def discard(self, *solids: Solid) -> None:
        """Remove solids from those that count."""
        self._refuse_ended(solids)
        self._ledger.discard(solids)

    def _refuse_ended(self, solids: Sequence[Solid]) -> None:
        if not self._ledger.is_open:
            raise invalid_parameter(
                "The with statement of this block has ended, so no solid can be added or removed"
                " any more."
            )
        for solid in solids:
            if not isinstance(solid, Solid):
                raise invalid_parameter(
                    f"The arguments must be Solid objects, not {type(solid).__name__}."
                )

    def end(self, failed: bool) -> None:
        """Close the block; its solid counts in the block around it."""
        counting.close(self._ledger)
        if not failed:
            self._solid = self._combined(self.solids)


class Unfilled(Solid):
    """An operation without operands: a block in a ``with`` statement, otherwise the set it equals.

    Parameters
    ----------
    combined : callable
        Carries out the operation on a list of solids.
    full : bool
        True if the set is all of space, instead of empty.
    """

    __slots__ = ("_combined", "_open")

    def __init__(self, combined: Callable[[Sequence[Solid]], Solid], full: bool = False) -> None:
        self._set(ExpressionNode(ConstantLeaf(full)), UNMOVED)
        self._combined = combined
        self._open: list[Block] = []

    def __enter__(self) -> Block:
        """Open a block."""
        self._open.append(Block(self._combined))
        return self._open[-1]

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End the block."""
        self._open.pop().end(failed=kind is not None)
