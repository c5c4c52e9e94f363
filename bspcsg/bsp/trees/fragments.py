"""`Fragments`: the convex pieces of facets that a tree stores, as flat arrays."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray


@dataclass(frozen=True, eq=False)
class Fragments:
    """The convex pieces of facets of a tree: points in 1D, segments in 2D, polygons in 3D.

    Parameters
    ----------
    vertices : (n, d) float64
        The corners of all fragments one after another, in model units, each within a few units in
        the last place of its exact position. Counterclockwise seen from the plus side of the
        fragment.
    offsets : (k + 1,) int64
        Fragment i owns ``vertices[offsets[i]:offsets[i + 1]]``.
    source : (k,) int64
        The index of the input facet that each fragment is a part of.
    node : (k,) int64
        The index of the tree node in whose coplanar set each fragment lies.
    original : (n,) bool
        In 3D: true if the edge from this corner to the next lies on an edge of the input facet. In
        2D: true if this corner is an end of the input segment.
    flipped : (k,) bool
        True if the fragment's normal is opposite to its node's normal.
    """

    vertices: FloatArray
    offsets: IndexArray
    source: IndexArray
    node: IndexArray
    original: BoolArray
    flipped: BoolArray

    def __len__(self) -> int:
        """Return the number of fragments."""
        return len(self.source)

    def __getitem__(self, index: int) -> FloatArray:
        """Return the (m, d) corners of one fragment."""
        if not -len(self) <= index < len(self):
            raise IndexError(
                f"There is no fragment {index}; the tree has {len(self)} fragments, numbered from"
                " 0."
            )
        index %= len(self)
        return self.vertices[self.offsets[index] : self.offsets[index + 1]]

    def __iter__(self) -> Iterator[FloatArray]:
        """Yield the (m, d) corners of each fragment."""
        return (self[index] for index in range(len(self)))

    def take(self, indices: IndexArray) -> "Fragments":
        """Return the fragments with these indices, in this order."""
        starts, ends = self.offsets[:-1][indices], self.offsets[1:][indices]
        corners = concatenated_ranges(starts, ends)
        return Fragments(
            self.vertices[corners],
            np.concatenate([[0], np.cumsum(ends - starts)]),
            self.source[indices],
            self.node[indices],
            self.original[corners],
            self.flipped[indices],
        )


def concatenated_ranges(starts: IndexArray, ends: IndexArray) -> IndexArray:
    """Return ``starts[0], starts[0] + 1, …, ends[0] - 1, starts[1], …`` as one int64 array."""
    counts = ends - starts
    firsts = np.cumsum(counts) - counts
    indices: IndexArray = np.arange(counts.sum()) + np.repeat(starts - firsts, counts)
    return indices
