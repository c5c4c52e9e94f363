"""Compare pivot policies by the size, cost and build time of the trees that they give."""

import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any

from ...errors import invalid_parameter
from ...parameters import shown
from .cost import cost, stats
from .policy import POLICIES, Policy, checked_policy
from .tree import PartitionTree


@dataclass(frozen=True)
class PolicyRow:
    """The size, cost and build time of the tree that one policy gives.

    Parameters
    ----------
    policy : str
    nodes, depth, fragments, splits : int
        As in `Stats`.
    balance : float
    point_cost, ray_cost : float
        As `cost` has them.
    seconds : float
        Wall-clock time of the construction.
    """

    policy: str
    nodes: int
    depth: int
    fragments: int
    splits: int
    balance: float
    point_cost: float
    ray_cost: float
    seconds: float


class Comparison(list[PolicyRow]):
    """A list of `PolicyRow` that prints as a table."""

    def __str__(self) -> str:
        """Return the table as text: a heading and one line for each policy."""
        names = [field.name for field in fields(PolicyRow)]
        cells = [names] + [[_cell(value) for value in asdict(row).values()] for row in self]
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        lines = (zip(row, widths, strict=True) for row in cells)
        return "\n".join("  ".join(cell.rjust(width) for cell, width in line) for line in lines)


def compare_policies(
    facets: Any, policies: Sequence[Policy] = POLICIES, **options: Any
) -> Comparison:
    """Build one tree over the facets for each policy, and return the figures of each tree.

    Parameters
    ----------
    facets, **options
        As for `PartitionTree`.
    policies : sequence of str

    Returns
    -------
    list of PolicyRow
        In the order of `policies`; as a string it is a table.
    """
    try:
        names = list(policies)
    except TypeError as error:
        message = f"policies must be a list of policies, not {shown(policies)}."
        raise invalid_parameter(message) from error
    return Comparison(_row(facets, checked_policy(name), options) for name in names)


def _row(facets: Any, policy: Policy, options: dict[str, Any]) -> PolicyRow:
    start = time.perf_counter()
    tree = PartitionTree(facets, policy, **options)
    seconds = time.perf_counter() - start
    figures = stats(tree)
    return PolicyRow(
        policy=policy,
        nodes=figures.nodes,
        depth=figures.depth,
        fragments=figures.fragments,
        splits=figures.splits,
        balance=figures.balance,
        point_cost=cost(tree, "point"),
        ray_cost=cost(tree, "ray"),
        seconds=seconds,
    )


def _cell(value: Any) -> str:
    return f"{value:.3f}" if isinstance(value, float) else str(value)
