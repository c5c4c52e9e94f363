"""Build partition trees whose cuts are chosen by a callable or given by the caller."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from ..._core import FragmentTree
from ..._types import IndexArray
from ...errors import invalid_parameter
from ...geometry.hyperplane import Hyperplane
from ...parameters import shown
from .facets import Corners


@dataclass(frozen=True, eq=False)
class Choice:
    """The data from which a callable policy chooses the hyperplane that divides a region.

    Parameters
    ----------
    depth : int
        The number of hyperplanes on the path from the root to the region.
    count : int
        The number of convex pieces of facets in the region.
    pieces : (k,) int64
        The candidates: convex pieces whose hyperplanes can be chosen, at most `sample` of them.
    minus, plus, splits : (k,) int64
        For each candidate's hyperplane: the number of pieces in the region with a part on its minus
        side, on its plus side, and on both sides.
    """

    depth: int
    count: int
    pieces: IndexArray
    minus: IndexArray
    plus: IndexArray
    splits: IndexArray

    def __len__(self) -> int:
        """Return the number of candidates."""
        return len(self.pieces)


#: A policy of the caller's own: it returns the index of a candidate in the `Choice`, or a
#: hyperplane (normal, offset) with fewer pieces or parts of pieces on each side than there are in
#: the region.
Chooser: TypeAlias = Callable[[Choice], Any]


def lattice_rows(cuts: Sequence[tuple[Any, Any]], dimension: int, pitch: int) -> list[list[int]]:
    """Return hyperplanes (normal, offset) as integer rows (*normal, offset) in lattice steps."""
    return [_row(normal, offset, dimension, pitch) for normal, offset in pairs_of(cuts)]


def pairs_of(cuts: Any) -> list[tuple[Any, Any]]:
    """Return the hyperplanes as a list of pairs (normal, offset), or raise an error."""
    try:
        return [(normal, offset) for normal, offset in cuts]
    except (TypeError, ValueError) as error:
        message = f"Hyperplanes must be a list of pairs (normal, offset), not {shown(cuts)}."
        raise invalid_parameter(message) from error


def _row(normal: Any, offset: Any, dimension: int, pitch: int) -> list[int]:
    entries = np.atleast_1d(np.asarray(normal, dtype=object)).tolist()
    if len(entries) != dimension:
        message = f"The hyperplane's normal must have {dimension} numbers, not {len(entries)}."
        raise invalid_parameter(message)
    return Hyperplane.from_numbers(entries, offset).on_lattice(pitch).row


def tree_with_chosen_cuts(
    facets: Corners,
    policy: Chooser,
    sample: int,
    pitch: int,
    lenience: tuple[bool, bool],
    own: list[list[int]],
) -> FragmentTree:
    """Return the core's tree over facets, with each cut chosen by the callable `policy`.

    `own` are hyperplanes of the caller as integer rows, which are tried before the policy.
    """
    corners, offsets = facets
    dimension = corners.shape[1]

    def answer(
        depth: int, count: int, rows: list[tuple[int, int, int, int, float]]
    ) -> tuple[int, list[int] | None]:
        columns = np.array([row[:4] for row in rows], dtype=np.int64).T
        chosen = policy(Choice(depth, count, *columns))
        if isinstance(chosen, tuple):
            return 0, _row(*_pair(chosen), dimension, pitch)
        try:
            place = range(len(rows))[chosen]
        except (TypeError, IndexError) as error:
            message = (
                f"The policy must return the index of one of its {len(rows)} candidates or a"
                f" hyperplane (normal, offset), not {chosen!r}."
            )
            raise invalid_parameter(message) from error
        return place, None

    return FragmentTree.asked(corners, offsets, answer, sample, pitch, lenience, own)


def _pair(chosen: tuple[Any, ...]) -> tuple[Any, Any]:
    if len(chosen) != 2:
        raise invalid_parameter(f"A hyperplane must be a pair (normal, offset), not {chosen!r}.")
    return chosen
