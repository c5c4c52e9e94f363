"""The queries of a set in any dimension."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ..._types import FloatArray
from ...errors import InvalidMeshError, core_errors, invalid_parameter
from .nearest import nearest_on_polygons, nearest_on_segments
from .pieces import NodeTable, PieceArrays, Pieces
from .rows import point_rows
from .tree_set import TreeSet


class TreeQueries(TreeSet):
    """A partition tree with in and out leaves, with queries."""

    __slots__ = ()

    def nearest(self, points: Any) -> tuple[FloatArray, FloatArray]:
        """Return the nearest boundary point of each point, and its distance.

        Parameters
        ----------
        points : (k, d) array_like of float
            In model units; on the line (k,) will do.

        Returns
        -------
        nearest : (k, d) float64
            Rounded; of several, the one on the first piece of the boundary.
        distance : (k,) float64

        Raises
        ------
        InvalidMeshError
            If the set has no boundary, or a point is not finite.
        """
        array = point_rows(points, self.dimension)
        if not np.isfinite(array).all():
            raise InvalidMeshError(
                "The points have coordinates that are not finite numbers; remove these points.",
                "non_finite",
            )
        if self.is_empty or self.is_full:
            raise invalid_parameter(
                "The set is empty or all of space, so it has no boundary and no nearest boundary"
                " point."
            )
        nearest = self._nearest(array)
        return nearest, np.sqrt(((nearest - array) ** 2).sum(axis=1))

    def _nearest(self, points: FloatArray) -> FloatArray:
        if self.dimension == 3:
            return nearest_on_polygons(points, self.boundary())
        if self.dimension == 1:
            ends = self.boundary().vertices
            return nearest_on_segments(points, np.stack([ends, ends], axis=1))
        with core_errors():
            return self._tree.nearest(points)

    def boundary(self) -> Pieces:
        """Return the boundary in convex pieces, with the nodes in whose cuts they lie.

        The pieces of an unbounded set end at the border of the lattice.
        """
        return self._pieces(self._tree.boundary)

    def cells(self) -> Pieces:
        """Return the faces of the leaves that are inside: a decomposition into convex cells.

        Raises
        ------
        UnboundedError
            If the set reaches to infinity.
        """
        return self._pieces(self._tree.cells)

    def _pieces(self, ask: Callable[[], PieceArrays]) -> Pieces:
        with core_errors():
            return Pieces(*ask())

    @property
    def nodes(self) -> NodeTable:
        """The inner nodes as arrays; none if the tree is a leaf."""
        with core_errors():
            return NodeTable(*self._tree.nodes, tuple(map(tuple, self._tree.hyperplanes())))

    def stats(self) -> dict[str, int]:
        """Return the numbers of inner nodes, leaves and coplanar fragments, and the depth."""
        return self._tree.stats()
