"""Blocks: operations on all solids that are made inside a ``with`` statement.

``with difference() as d:`` subtracts all later solids from the first one, as in OpenSCAD::

    with csg.difference() as d:
        csg.cube([20, 20, 10])
        csg.cylinder(h=10, r=3).translate(10, 10, 0)
    d.solid.save("plate.3mf")

A solid counts as an operand of the block if it was made in the block and not used up there:

* Every call that makes a solid counts it: primitives, `Solid`, `from_mesh`, `load`, operators,
  transforms and the named operations.
* A solid passed to an operator, a transform or a named operation no longer counts. The result takes
  its position, so ``cylinder(...).translate(...)`` counts once, in the first position. Another
  transform of the same solid counts as well, at the end: four translations of one pin are four
  pins, and the pin itself does not count.
* Queries such as ``volume``, ``<=`` or `check` use up nothing.
* Solids from outside the block do not count until a solid is made from them, or `Block.add` counts
  them; `Block.discard` removes a solid that was only an aid.
* A nested block counts as one solid when it ends. Solids that it uses up no longer count in the
  blocks around it either.

Each thread and each asyncio task has its own blocks. A thread or task that starts inside a block
counts its solids in that block until the block ends.
"""

from collections.abc import Callable, Sequence
from types import TracebackType

from ..errors import InvalidMeshError, invalid_parameter
from ..geometry.chain import IDENTITY_CHAIN
from ..solid import ledger
from ..solid.expression import ExpressionNode
from ..solid.leaf import ConstantLeaf
from ..solid.solid import Solid


class Block:
    """The solids that are operands of a ``with`` statement, and the solid made from them.

    Parameters
    ----------
    combined : callable
        Takes the list of solids and returns the result of the operation on them.
    """

    def __init__(self, combined: Callable[[Sequence[Solid]], Solid]) -> None:
        self._combined = combined
        self._ledger = ledger.open_ledger()
        self._solid: Solid | None = None

    @property
    def solids(self) -> tuple[Solid, ...]:
        """The current operands of the block, in order."""
        return self._ledger.solids

    @property
    def solid(self) -> Solid:
        """The result of the block's operation on its operands.

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
        """Append solids that were made outside the block to its operands."""
        self._refuse_ended(solids)
        for solid in solids:
            self._ledger.put(solid)

    def discard(self, *solids: Solid) -> None:
        """Remove solids from the block's operands."""
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
        """Close the block, and carry out its operation unless the block failed.

        The result becomes an operand of the enclosing block, if there is one.
        """
        ledger.close_ledger(self._ledger)
        if not failed:
            self._solid = self._combined(self.solids)


class Unfilled(Solid):
    """The result of a set operation without operands, such as ``union()``.

    In a ``with`` statement it opens a block; otherwise it is the empty set or all of space.

    Parameters
    ----------
    combined : callable
        Carries out the operation on a list of solids.
    full : bool
        True if the operation without operands gives all of space, instead of the empty set.
    """

    __slots__ = ("_combined", "_open")

    def __init__(self, combined: Callable[[Sequence[Solid]], Solid], full: bool = False) -> None:
        self._set(ExpressionNode(ConstantLeaf(full)), IDENTITY_CHAIN)
        self._combined = combined
        self._open: list[Block] = []

    def __enter__(self) -> Block:
        """Open a block, whose operands are the solids made in the ``with`` statement."""
        self._open.append(Block(self._combined))
        return self._open[-1]

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End the block; its operation is carried out unless an error was raised."""
        self._open.pop().end(failed=kind is not None)
