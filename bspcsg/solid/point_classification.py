"""Classification of points that may lie outside the range of the lattice."""

from typing import Protocol

import numpy as np

from .._types import FloatArray, SideArray
from ..errors import core_errors
from ..geometry.transform import LATTICE_REACH


class PointClassifier(Protocol):
    """The interface of a tree of the core that classifies points."""

    @property
    def pitch(self) -> int:
        """Exponent of the lattice step."""

    @property
    def is_bounded(self) -> bool:
        """True if the set is bounded."""

    def classify(self, points: FloatArray, /) -> SideArray:
        """Return +1 (inside), 0 (boundary) or -1 (outside) for points in the lattice's range."""


def sides_of(points: FloatArray, tree: PointClassifier) -> SideArray:
    """Return +1 for each point inside the tree's set, 0 on the boundary, -1 outside.

    Points outside the range of the lattice are outside a bounded set.
    """
    largest = np.abs(points).max(axis=1, initial=0.0)
    is_far = np.isfinite(largest) & (largest >= LATTICE_REACH * 10.0**tree.pitch)
    with core_errors():
        if not is_far.any() or not tree.is_bounded:
            return tree.classify(points)
        sides = np.full(len(points), -1, dtype=np.int8)
        sides[~is_far] = tree.classify(points[~is_far])
    return sides
