"""`BenchCase`: one benchmark case, a row of the result table."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

from .targets import Goal
from .workloads import Work

#: A function of the folder of shared data that returns the work of an item.
WorkMaker: TypeAlias = Callable[[Path], Work]

#: A function of the folder of shared data that returns labels of items.
Choice: TypeAlias = Callable[[Path], list[str]]

#: The number of items in the small form of a case whose data choose the items.
_SMALL = 2


@dataclass(frozen=True)
class BenchCase:
    """A benchmark case: what is timed, with which engines, and which targets it has.

    Parameters
    ----------
    title : str
    targets : tuple of Goal
    items : dict
        The works to time, by label.
    small : dict
        Smaller forms of the items, which take about a second together.
    engines : tuple of str
        The names of the engines to time, which finish in reasonable time; empty for all.
    cores : int
        The number of cores that the process may use; 0 for no limit.
    alone : bool
        True to run each engine in a process of its own and measure its peak memory.
    needs : str
        The path of necessary data below the folder of shared data; the case is left out without it.
    limit : float
        The default time limit of a call, in seconds.
    checked_at_once : bool
        True to compare a chain that no other engine finishes with manifold3d's result of the same
        set as one expression.
    needs_gb : dict of str to float
        The memory that a machine must have for an item, by its label, in 10^9 bytes.
    other_sets : bool
        True if other engines interpret the operands as other sets, so that results are not
        compared.
    chosen : Choice, optional
        Chooses the items that belong to the case by the shared data; None for all items.
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
    chosen: Choice | None = None

    def labels(self, shared: Path, *, small: bool) -> list[str]:
        """Return the labels of the items that are timed."""
        if self.chosen is None:
            return list(self.small if small else self.items)
        return self.chosen(shared)[: _SMALL if small else None]
