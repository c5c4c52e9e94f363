"""`Intervals`: a set of points on the line, as an immutable value."""

from contextlib import suppress
from fractions import Fraction
from typing import Any, Self

import numpy as np

from ..._core import ObjectTree as CoreTree
from ..._types import FloatArray, Scalar
from ...errors import InvalidMeshError, LimitError, core_errors, invalid_parameter
from ...geometry.arrays import doubles
from ...geometry.hyperplane import Hyperplane
from ...geometry.transform import whole_steps
from ...method_ownership import with_own_methods
from ...parameters import number
from ..trees.facets import chosen_pitch
from .boundary import interval_rows
from .flat_set import FlatSet


@with_own_methods
class Intervals(FlatSet):
    """A union of intervals on the line.

    Sets are regularised: ends belong to the boundary, intervals that touch are joined, and single
    points vanish. Coordinates are snapped to the lattice of step ``10**pitch``. ``==``, ``<=``,
    ``<``, ``in`` and the like compare sets of points, exactly, as for `Solid`.

    Parameters
    ----------
    pairs : (n, 2) array_like of float
        The lower and upper ends of intervals. Intervals may overlap, in any order, and ends may be
        infinite. Without intervals the set is empty.
    pitch : int, optional

    Raises
    ------
    InvalidMeshError
        If an end is NaN, or an upper end is not above its lower end.
    LimitError
        If the ends do not fit on the lattice.

    Examples
    --------
    >>> from bspcsg import bsp
    >>> a = bsp.Intervals([(0, 2), (5, 7)])
    >>> a - bsp.Intervals([(1, 6)])
    Intervals((0, 1), (6, 7))
    """

    __slots__ = ()

    def __init__(self, pairs: Any = (), *, pitch: int | None = None) -> None:
        ends = _pairs(pairs)
        finite = ends[np.isfinite(ends)]
        chosen = chosen_pitch(pitch, finite[:, None])
        bounded = np.isfinite(ends).all(axis=1)
        with core_errors():
            tree = CoreTree.uniform(1, False, chosen)
            if bounded.any():
                rows = interval_rows(ends[bounded])
                tree = CoreTree.build(1, rows, chosen)
            for low, high in ends[~bounded].tolist():
                tree = tree.merge(_unbounded(low, high, chosen), "union")
        self._set(tree)

    @classmethod
    def empty(cls) -> Self:
        """Return the empty set."""
        return cls()

    @classmethod
    def full(cls) -> Self:
        """Return the whole line."""
        return cls([(-np.inf, np.inf)])

    @property
    def pairs(self) -> FloatArray:
        """The lower and upper ends of the intervals in order, (n, 2) float64; may be infinite."""
        if self.is_empty or self.is_full:
            return np.array([[-np.inf, np.inf]]) if self.is_full else np.zeros((0, 2))
        ends = np.sort(self.tree.boundary().vertices[:, 0])
        if self._holds_lowest():
            ends = np.concatenate([[-np.inf], ends])
        if len(ends) % 2:
            ends = np.append(ends, np.inf)
        return ends.reshape(-1, 2)

    def _holds_lowest(self) -> bool:
        """Return true if the set is unbounded below."""
        nodes = self.tree.nodes
        at = 0
        while at >= 0:
            below = nodes.minus if nodes.hyperplanes[at, 0] > 0 else nodes.plus
            at = int(below[at])
        return at == nodes.IN

    @property
    def length(self) -> float:
        """The total length of the intervals in model units, rounded once; `measure` is exact.

        Raises
        ------
        UnboundedError
            If the set reaches to infinity.
        """
        return float(self.measure)

    @property
    def centroid(self) -> float:
        """The centre of mass, the mean of all points of the set; NaN for the empty set."""
        if self.measure == 0:
            return float("nan")
        step = Fraction(10) ** self.pitch
        ends = [[round(Fraction(end) / step) for end in pair] for pair in self.pairs.tolist()]
        total = sum(b - a for a, b in ends)
        # Above 2^52 steps two different ends may be equal as doubles.
        middle = Fraction(sum(b * b - a * a for a, b in ends), 2 * total) if total else ends[0][0]
        return float(middle * step)

    @property
    def bounds(self) -> tuple[float, float] | None:
        """The least and the greatest coordinate of the set, or None for the empty set."""
        pairs = self.pairs
        return None if self.is_empty else (float(pairs[0, 0]), float(pairs[-1, 1]))

    @property
    def components(self) -> tuple["Intervals", ...]:
        """The intervals of the set in order, each as a set of its own."""
        return tuple(type(self)([pair], pitch=self.pitch) for pair in self.pairs)

    def translate(self, offset: Scalar) -> "Intervals":
        """Return the set moved by an offset; exact for a whole number of lattice steps."""
        shift = number(offset, "offset")
        steps = whole_steps(shift, self.pitch)
        if steps is None:
            return self._placed(self.pairs + shift)
        return self._moved([1], [steps])

    def scale(self, factor: Scalar) -> "Intervals":
        """Return the set scaled about 0; a negative factor mirrors it."""
        by = number(factor, "factor")
        if by == 0:
            raise invalid_parameter("factor must not be 0.")
        with np.errstate(over="ignore"):
            return self._placed(np.sort(self.pairs * by, axis=1))

    def _placed(self, pairs: FloatArray) -> "Intervals":
        """Return the set with moved ends, on this set's lattice or on another one that fits."""
        if np.isinf(pairs).sum() > np.isinf(self.pairs).sum():
            raise LimitError(
                "The moved or scaled intervals have an end that is too large for doubles; move or"
                " scale them less.",
                "too_large",
            )
        suited = chosen_pitch(None, pairs[np.isfinite(pairs)][:, None])
        # Far from 0, both ends of an interval may round to one double; it is left out.
        there = pairs[pairs[:, 0] < pairs[:, 1]]
        with suppress(LimitError):
            return type(self)(there, pitch=min(self.pitch, suited))
        return type(self)(there, pitch=suited)

    def __repr__(self) -> str:
        """Return a text with the intervals, at most the first six."""
        pairs = self.pairs.tolist()
        shown = [f"({low:.12g}, {high:.12g})" for low, high in pairs[:6]]
        if len(pairs) > 6:
            shown.append(f"... {len(pairs) - 6} more")
        return f"Intervals({', '.join(shown)})"


def _pairs(pairs: Any) -> FloatArray:
    array = doubles(pairs, invalid_parameter("Intervals must be pairs of numbers (low, high)."))
    if array.size == 0:
        return np.zeros((0, 2))
    if array.ndim == 1 and len(array) == 2:
        array = array[None]
    if array.ndim != 2 or array.shape[1] != 2:
        raise InvalidMeshError(f"Intervals must have shape (n, 2), not {array.shape}.", "shape")
    wrong = np.flatnonzero(~(array[:, 0] < array[:, 1]))
    if len(wrong):
        low, high = array[wrong[0]]
        message = (
            f"Interval {wrong[0]} must have a lower end below its upper end, but the ends are"
            f" {low:g} and {high:g}."
        )
        raise invalid_parameter(message, wrong.tolist())
    return array


def _unbounded(low: float, high: float, pitch: int) -> CoreTree:
    def below(x: float, side: float) -> CoreTree:
        row = Hyperplane.from_numbers([side], side * x).on_lattice(pitch).row
        return CoreTree.half_space(row, pitch)

    if low == -np.inf and high == np.inf:
        return CoreTree.uniform(1, True, pitch)
    return below(high, 1.0) if low == -np.inf else below(low, -1.0)
