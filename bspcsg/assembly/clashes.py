"""Clashes: pairs of parts of an assembly that share volume or are too close to each other."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .._types import FloatArray
from ..modelling.bodies.gaps import closest_points, min_gap
from ..solid.ledger import uncounted
from ..solid.solid import Solid

if TYPE_CHECKING:
    from .tree import Part


@dataclass(frozen=True, eq=False)
class Clash:
    """Two parts that overlap, or are too close to each other.

    Parameters
    ----------
    first, second : str
        The paths of the two parts in the assembly.
    volume : float
        The volume that both parts share, in cubic model units; 0 if they are only too close.
    gap : float
        The distance between the parts, in model units; 0 if they share volume.
    place : (3,) float64
        The centre of the common volume, or the middle between the nearest points.
    """

    first: str
    second: str
    volume: float
    gap: float
    place: FloatArray

    def __repr__(self) -> str:
        """Return a text with the two parts, their common volume or gap, and the position."""
        x, y, z = (f"{value:.6g}" for value in self.place.tolist())
        much = f"volume {self.volume:.6g}" if self.volume else f"gap {self.gap:.6g}"
        return f"Clash({self.first!r}, {self.second!r}, {much}, at ({x}, {y}, {z}))"


@uncounted
def clashes_of(parts: Sequence["Part"], clearance: float) -> list[Clash]:
    """Return the clashes of all pairs of parts that overlap or are closer than the clearance."""
    found = (
        _clash(parts[first], parts[second], clearance)
        for first, second in _near_pairs([part.solid for part in parts], clearance)
    )
    return [clash for clash in found if clash is not None]


def are_apart(solid: Solid, other: Solid) -> bool:
    """Return True if two solids are bounded and their bounding boxes have no point in common."""
    if not (solid.is_bounded and other.is_bounded):
        return False
    own, others = solid.bounds, other.bounds
    if own is None or others is None:
        return True
    return bool((own[0] > others[1]).any() or (others[0] > own[1]).any())


def _near_pairs(solids: Sequence[Solid], clearance: float) -> Iterator[tuple[int, int]]:
    """Yield pairs of solids, as numbers, whose bounding boxes are within the clearance."""
    nothing = np.array([np.full(3, np.inf), np.full(3, -np.inf)])
    held = [solid.bounds for solid in solids]
    boxes = np.array([nothing if box is None else box for box in held]).reshape(-1, 2, 3)
    for first in range(len(solids)):
        low, high = boxes[first]
        others = boxes[first + 1 :]
        near = (others[:, 0] <= high + clearance).all(axis=1)
        near &= (others[:, 1] >= low - clearance).all(axis=1)
        for second in (np.flatnonzero(near) + first + 1).tolist():
            yield first, second


def _clash(first: "Part", second: "Part", clearance: float) -> Clash | None:
    common = first.solid & second.solid
    if not common.is_empty:
        return Clash(first.path, second.path, common.volume, 0.0, common.centroid)
    if clearance == 0:
        return None
    gap = min_gap(first.solid, second.solid)
    if gap >= clearance:
        return None
    ends = closest_points(first.solid, second.solid)
    return Clash(first.path, second.path, 0.0, gap, (ends[0] + ends[1]) / 2)
