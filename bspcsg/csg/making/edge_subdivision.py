"""Division of the edges of outlines, so that twisted walls approximate their curved shape."""

import heapq
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..._types import FloatArray, IndexArray
from ...geometry.transform import cos_sin

#: Edges are divided together if the lengths of their parts have at least this ratio.
_MIN_LENGTH_RATIO = 0.999


class TwistAndScale(NamedTuple):
    """The twist and scale of a linear extrusion.

    Parameters
    ----------
    twist : float
        The rotation of the upper end in degrees, clockwise.
    scale : (float, float)
        The scale factors of the upper end along x and y.
    slices : int
        The number of levels above the lower end.
    """

    twist: float
    scale: tuple[float, float]
    slices: int

    @property
    def is_even(self) -> bool:
        """True if walls are plane: there is no twist, and x and y are scaled equally."""
        return self.twist == 0 and self.scale[0] == self.scale[1]

    def lengths(self, vectors: FloatArray) -> FloatArray:
        """Return the largest length that each vector of the lower end gets at any level, (n,)."""
        x, y = self.scale
        if x == y:
            return np.asarray(np.linalg.norm(vectors, axis=1) * max(x, 1.0))
        longest = np.zeros(len(vectors))
        for level in range(self.slices + 1):
            part = level / self.slices
            cosine, sine = cos_sin(-self.twist * part)
            turned = vectors @ np.array([[cosine, sine], [-sine, cosine]])
            wide = turned * (1 - (1 - np.array([x, y])) * part)
            longest = np.maximum(longest, np.linalg.norm(wide, axis=1))
        return longest


def divided_outline(outline: FloatArray, segments: int, stretch: TwistAndScale) -> FloatArray:
    """Divide the edges of an outline evenly into up to `segments` parts in total, as in OpenSCAD.

    In each step, the edge with the longest parts gets one more part. Edges of about the same length
    are divided together or not at all, which preserves symmetry.

    Parameters
    ----------
    outline : (n, 2) float64
    segments : int
    stretch : TwistAndScale
        The twist and scale of the extrusion, on which the lengths of edges depend.
    """
    vectors = np.roll(outline, -1, axis=0) - outline
    counts = _counts(stretch.lengths(vectors).tolist(), segments)
    starts, steps = np.repeat(outline, counts, axis=0), np.repeat(vectors, counts, axis=0)
    rank = np.arange(len(starts)) - np.repeat(np.cumsum(counts) - counts, counts)
    return np.asarray(starts + steps * (rank / np.repeat(counts, counts))[:, None])


def _counts(lengths: Sequence[float], segments: int) -> IndexArray:
    """Return the number of parts of each edge, (n,), given the lengths of the edges."""
    counts = np.ones(len(lengths), dtype=np.int64)
    longest = [(-length / 1.5, edge) for edge, length in enumerate(lengths)]
    heapq.heapify(longest)
    total = len(lengths)
    while longest:
        first = longest[0][0]
        alike = []
        while longest and longest[0][0] <= first * _MIN_LENGTH_RATIO:
            alike.append(heapq.heappop(longest)[1])
        total += len(alike)
        if total > segments:
            break
        for edge in alike:
            counts[edge] += 1
            # The key is between the length of its parts now and after one more division.
            heapq.heappush(longest, (-lengths[edge] / (counts[edge] + 0.5), edge))
    return counts
