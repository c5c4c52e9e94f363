"""The queries of a region of the plane: outlines, measures, lines, nearest points."""

import math
from collections.abc import Sequence
from contextlib import suppress
from fractions import Fraction
from typing import Any, Self

import numpy as np

from ..._core import ObjectTree as CoreTree
from ..._types import FloatArray, SetOp, Vector
from ...errors import LimitError, core_errors, invalid_parameter
from ...geometry.polygon import convex_corners
from ...parameters import number, shown
from .flat_set import FlatSet
from .loops import Outline, loop_segments
from .objects import ObjectTree
from .tree_set import TreeSet


class PlaneQueries(FlatSet):
    """A set of the plane with queries."""

    __slots__ = ("_outlines",)

    def _set(self, tree: CoreTree) -> None:
        super()._set(tree)
        self._outlines: tuple[Outline, ...] | None = None

    # Set operations

    def _merged(self, other: TreeSet, op: SetOp) -> Self:
        """Return a result by the faster method: a sweep over the boundaries, or merged trees."""
        try:
            a, b = self.tree._aligned(other)
        except LimitError:
            a, b = on_one_lattice([self.tree, other.tree])
        with core_errors():
            return self._of(a.combined(b, op))

    # Outlines

    @property
    def outlines(self) -> tuple[Outline, ...]:
        """The boundary as nested simple loops: outer ones counterclockwise, holes clockwise.

        Collinear edges are joined. Loops touch each other only in corners, and if a corner of one
        lies on another, the other has a corner there, too. The loops depend only on the set.

        Raises
        ------
        UnboundedError
            If the region reaches to infinity.
        """
        if self._outlines is None:
            with core_errors():
                points, offsets, parents = self._tree.outlines()
            points.flags.writeable = False
            loops = np.split(points, offsets[1:-1]) if len(parents) else []
            nested = zip(loops, parents.tolist(), strict=True)
            self._outlines = tuple(Outline(loop, parent) for loop, parent in nested)
        return self._outlines

    @property
    def exact_outlines(self) -> list[list[tuple[Fraction, Fraction]]]:
        """The corners of the outlines in model units, not rounded."""
        with core_errors():
            loops = self._tree.exact_outlines()
        return [[(Fraction(*x), Fraction(*y)) for x, y in loop] for loop in loops]

    def to_polygons(self) -> list[FloatArray]:
        """Return the outlines as (n, 2) arrays; ``bspcsg.extrude`` and others take them."""
        return [outline.points for outline in self.outlines]

    # Measures

    @property
    def area_exact(self) -> Fraction:
        """Area in square model units, exactly.

        Raises
        ------
        UnboundedError
            If the region reaches to infinity; so for all measures.
        """
        return self.measure

    @property
    def area(self) -> float:
        """Area in square model units, rounded once."""
        with core_errors():
            low, high = (n / d for n, d in self._tree.area_bounds())
        return low if low == high else float(self.measure)

    @property
    def perimeter(self) -> float:
        """Length of the boundary in model units, the same as that of the complement.

        Raises
        ------
        UnboundedError
            If the region and its complement both reach to infinity.
        """
        inner = self if self.is_bounded else ~self
        return math.fsum(outline.length for outline in inner.outlines)

    @property
    def centroid_exact(self) -> tuple[Fraction, Fraction] | None:
        """Centre of area (barycentre), exactly; None for the empty set."""
        with core_errors():
            area, x, y = (Fraction(*ratio) for ratio in self._tree.moments())
        return None if area == 0 else (x / area, y / area)

    @property
    def centroid(self) -> FloatArray:
        """Centre of area, (2,) float64, each coordinate rounded once; NaN for the empty set."""
        exact = self.centroid_exact
        return np.full(2, np.nan) if exact is None else np.array([float(c) for c in exact])

    @property
    def bounds(self) -> FloatArray | None:
        """Lowest and highest coordinates, (2, 2) float64, or None for the empty set."""
        if self.is_empty:
            return None
        points = np.concatenate(self.to_polygons())
        return np.array([points.min(axis=0), points.max(axis=0)])

    # Questions

    def cast(self, origin: Vector, direction: Vector) -> FloatArray:
        """Return the stretches of a line inside the region.

        Parameters
        ----------
        origin, direction : (2,) float
            The origin is snapped to the lattice, the direction rounded to 53 bits.

        Returns
        -------
        (k, 2) float64
            Entry and exit of each stretch in the order of the line, as multiples t of `direction`
            from `origin`; infinite if the stretch is. Stretches along the boundary do not count,
            and a single boundary point separates two stretches. The order is exact, each t is
            rounded.

        Raises
        ------
        InvalidParameterError
            If the direction is zero or a number is not finite.
        """
        start, along = vector2(origin, "origin"), vector2(direction, "direction")
        if not np.any(along):
            raise invalid_parameter("direction must not be the zero vector.")
        with core_errors():
            points, _, _ = self._tree.cast(list(start), list(along))
        axis = int(np.abs(along).argmax())
        t = (points[:, axis] - start[axis]) / along[axis]
        t[np.abs(points).max(axis=1) > self._border] *= np.inf
        return np.asarray(t.reshape(-1, 2))

    @property
    def _border(self) -> float:
        """A bound that no finite coordinate exceeds."""
        return (2**53 - 2) * 10.0**self.pitch

    def convex_parts(self) -> list[FloatArray]:
        """Return the region divided into convex polygons: the inside leaves of its tree.

        Returns
        -------
        list of (n, 2) float64
            Counterclockwise, in the order of the leaves, rounded.
        """
        cells = self.tree.cells()
        parts: list[list[FloatArray]] = []
        for face, owner in enumerate(cells.owner.tolist()):
            if owner == len(parts):
                parts.append([])
            parts[owner].append(cells[face])
        return [convex_corners(faces) for faces in parts]


def on_one_lattice(trees: Sequence[ObjectTree]) -> list[CoreTree]:
    """Return sets of the plane on the finest lattice that holds them and all their corners.

    Raises
    ------
    LimitError
        If there is no such lattice.
    """
    # The empty set and the plane fit on any lattice.
    pitches = {tree.pitch for tree in trees if not (tree.is_empty or tree.is_full)}
    finest, coarsest = min(pitches, default=trees[0].pitch), max(pitches, default=trees[0].pitch)
    for pitch in range(finest, coarsest):
        with suppress(LimitError):
            return [_on_lattice(tree, pitch) for tree in trees]
    return [_on_lattice(tree, coarsest) for tree in trees]


def _on_lattice(tree: ObjectTree, pitch: int) -> CoreTree:
    """Return a set on a finer lattice, or on a coarser one that holds all of its corners."""
    if pitch <= tree.pitch or tree.is_empty or tree.is_full:
        return tree._refined(pitch)
    if not tree.is_bounded and (~tree).is_bounded:
        return _on_lattice(~tree, pitch).complement()
    with core_errors():
        loops = tree._tree.exact_outlines() if tree.is_bounded else None
    step = Fraction(10) ** pitch
    if loops is None or any(Fraction(*x) % step for loop in loops for p in loop for x in p):
        message = (
            "One region extends beyond the 2^53 steps of the fine lattice that the corners of"
            f" another region need. Round those corners to multiples of {float(step):g}, or"
            " cut off distant parts."
        )
        raise LimitError(message, "too_large")
    corners = [np.array([[n / d for n, d in point] for point in loop]) for loop in loops]
    with core_errors():
        return CoreTree.region(loop_segments(corners).reshape(-1, 4), pitch, "positive")


def vector2(value: Any, name: str) -> tuple[float, float]:
    """Return two finite numbers."""
    try:
        x, y = value
    except (TypeError, ValueError) as error:
        raise invalid_parameter(f"{name} must be two numbers, not {shown(value)}.") from error
    return number(x, name), number(y, name)
