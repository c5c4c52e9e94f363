"""A case of the bench: one row of its table."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

from .targets import Goal
from .work import Work

#: Makes the work of an item from the folder of shared data.
WorkMaker: TypeAlias = Callable[[Path], Work]


@dataclass(frozen=True)
class BenchCase:
    """One row of the table.

    Parameters
    ----------
    title : str
    targets : tuple of Goal
    items : dict
        The items to time, by label; `small` has the small forms of the same.
    small : dict
        Items that take a second or so together.
    engines : tuple of str
        The engines that finish in reasonable time; none means all.
    cores : int
        The number of cores that the process may use; 0 for no limit.
    alone : bool
        Each engine runs in a process of its own, and its peak memory is measured.
    needs : str
        Path of data that may be missing, below the folder of shared data.
    limit : float
        Seconds after which a call is stopped, unless another limit is asked for.
    checked_at_once : bool
        If no other engine finishes the chain, manifold3d computes the same set as one expression.
    needs_gb : dict of str to float
        The memory that a machine must have for some items, in 10^9 bytes.
    other_sets : bool
        Other engines take the operands for other sets, so that answers are not compared.
    """

    title: str
    targets: tuple[Goal, ...]
    items: Mapping[str, WorkMaker]
    small: Mapping[str, WorkMaker]
    engines: tuple[str, ...] = ()
    cores: int = 0
    alone: bool = False
    needs: str = ""
    limit: float = 300.0
    checked_at_once: bool = False
    needs_gb: Mapping[str, float] = field(default_factory=dict)
    other_sets: bool = False
