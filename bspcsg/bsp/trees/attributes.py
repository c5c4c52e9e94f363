"""`AttributeTree`: a partition of space by hyperplanes, with a label for each region.

A facet or hyperplane that is inserted divides regions in two. A cut rule labels both halves: they
inherit the region's label, or each side gets its own.


Everything is exact, in whole numbers and fractions; meant for trees of hundreds of regions.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Generic, Literal, Self, TypeAlias, TypeVar

import numpy as np

from ..._types import Scalar
from ...errors import InvalidMeshError, invalid_parameter
from ...geometry.arrays import doubles
from ...geometry.hyperplane import exact_number, exact_point
from ...geometry.polytope import Corner, Polytope, cut_polygon, height
from ...parameters import dimension_number, function_of, pitch_exponent, shown
from .chosen_cuts import lattice_rows
from .facets import box_corners, corners_of
from .node import RegionShape

#: The type of the labels of regions.
Label = TypeVar("Label")

#: The labels of the two halves of a divided region: "inherit" its label, or (minus, plus) labels.
CutRule: TypeAlias = Literal["inherit"] | tuple[Label, Label]

#: A part of a facet, the link of the subtree that it enters, the parent node, and the child's
#: index.
_Part: TypeAlias = tuple[Sequence[Corner], int, int | None, int]

#: Lattice coordinates are below this many steps.
_REACH = 2**53


@dataclass(frozen=True)
class LabelledRegion(Generic[Label]):
    """A convex region of an `AttributeTree`, with its label.

    Parameters
    ----------
    label : object
    sides : tuple of (hyperplane, side)
        The hyperplanes on the path from the root, each as the integers (*n, c) of n·x = c in
        lattice steps, with the side on which the region lies: -1 minus, 1 plus.
    pitch : int
        The lattice step is ``10**pitch`` units.
    """

    label: Label
    sides: tuple[tuple[tuple[int, ...], int], ...]
    pitch: int

    def within(self, low: Sequence[Scalar], high: Sequence[Scalar]) -> RegionShape | None:
        """Return the part of the region inside a box, shaped as by `PartitionTree.region`, or None.

        None means that the region and the box have no volume in common.

        Raises
        ------
        InvalidParameterError
            If a corner has another dimension or is not finite, or `low` is above `high`.
        """
        part = self._clipped(low, high)
        return None if part is None else part.shape(10.0**self.pitch)

    def measure_within(self, low: Sequence[Scalar], high: Sequence[Scalar]) -> float:
        """Return the length, area or volume of the region's part inside the box `low` to `high`."""
        part = self._clipped(low, high)
        if part is None:
            return 0.0
        return float(part.measure) * 10.0 ** (self.pitch * part.dimension)

    def _clipped(self, low: Any, high: Any) -> Polytope | None:
        # A region without hyperplanes is the whole space; the box then tells the dimension.
        dimension = len(self.sides[0][0]) - 1 if self.sides else max(np.size(low), 1)
        least, most = box_corners(low, high, dimension)
        part: Polytope | None = Polytope.box(_steps(least, self.pitch), _steps(most, self.pitch))
        for row, side in self.sides:
            part = part and part.clipped(row, side)
        return part


class AttributeTree(Generic[Label]):
    """A partition of space by hyperplanes, with a label for each region; an immutable value.

    Parameters
    ----------
    dimension : int
        1, 2 or 3.
    label : object
        The label of the whole space.
    pitch : int
        The lattice step is ``10**pitch`` units.

    Notes
    -----
    After the attribute trees of Apache Commons Geometry. Thibault, Naylor 1987 have two labels.

    Examples
    --------
    >>> from bspcsg import bsp
    >>> tree = bsp.AttributeTree(2, "meadow").insert([[0, 0], [9, 0]], ("wood", "lake"))
    >>> tree.label_at([1, 1]), tree.label_at([1, -1]), len(tree)
    ('wood', 'lake', 2)
    """

    def __init__(self, dimension: int, label: Label, *, pitch: int = -9) -> None:
        self.dimension = dimension_number(dimension)
        self.pitch = pitch_exponent(pitch)
        self._rows: list[tuple[int, ...]] = []
        #: The minus and plus child of each inner node: the index of an inner node, or -1 - k for
        #: label k.
        self._links: list[list[int]] = []
        self._labels: list[Label] = [label]

    def __len__(self) -> int:
        """Return the number of regions."""
        return len(self._labels)

    def __repr__(self) -> str:
        """Return a text with the dimension and the number of regions."""
        return f"AttributeTree({self.dimension}D, {len(self)} regions)"

    def __eq__(self, other: object) -> bool:
        """Return true if both trees have the same dimension, pitch, cuts and labels."""
        if not isinstance(other, AttributeTree):
            return NotImplemented
        return vars(self) == vars(other)

    __hash__ = None  # type: ignore[assignment]

    def _copy(self) -> Self:
        made = type(self).__new__(type(self))
        made.dimension, made.pitch = self.dimension, self.pitch
        made._rows, made._labels = list(self._rows), list(self._labels)
        made._links = [list(pair) for pair in self._links]
        return made

    # Growing

    def insert(self, facet: Any, rule: "CutRule[Label]" = "inherit") -> Self:
        """Return the tree in which a facet divides each region that it enters.

        Parameters
        ----------
        facet : array_like
            A number on the line, (2, 2) ends of a segment with its minus side on the left, (k, 3)
            corners of a convex polygon, counterclockwise seen from its plus side.
        rule : "inherit" or (minus, plus)
            The labels of the two halves of each divided region.

        Raises
        ------
        InvalidMeshError
            If the facet has no extent on the lattice, or its corners are not in one plane.
        """
        checked = _checked_rule(rule)
        corners = self._corners(facet)
        row = _supporting(corners)
        if any(height(corner, row) for corner in corners):
            raise InvalidMeshError(
                "The corners of the facet do not lie in one plane; divide it into triangles.",
                "non_planar",
            )
        grown = self._copy()
        pending: list[_Part] = [(corners, self._root, None, 0)]
        while pending:
            part, link, parent, side = pending.pop()
            if link < 0:
                grown._divide(link, parent, side, row, checked)
                continue
            for half in (0, 1):
                piece = cut_polygon(part, self._rows[link], 2 * half - 1)
                if piece:
                    pending.append((piece, self._links[link][half], link, half))
        return grown

    def insert_hyperplane(
        self, normal: Any, offset: Scalar, rule: "CutRule[Label]" = "inherit"
    ) -> Self:
        """Return the tree in which ``normal · x = offset`` divides each region that it crosses.

        Parameters
        ----------
        normal, offset
            As for `ObjectTree.half_space`: the minus side has smaller products.
        rule : "inherit" or (minus, plus)
        """
        checked = _checked_rule(rule)
        row = tuple(lattice_rows([(normal, offset)], self.dimension, self.pitch)[0])
        grown = self._copy()
        box = Polytope.box([-_REACH] * self.dimension, [_REACH] * self.dimension)
        pending: list[tuple[Polytope, int, int | None, int]] = [(box, self._root, None, 0)]
        while pending:
            region, link, parent, side = pending.pop()
            if not (region.clipped(row, -1) and region.clipped(row, 1)):
                continue
            if link < 0:
                grown._divide(link, parent, side, row, checked)
                continue
            for half in (0, 1):
                part = region.clipped(self._rows[link], 2 * half - 1)
                if part is not None:
                    pending.append((part, self._links[link][half], link, half))
        return grown

    @property
    def _root(self) -> int:
        return 0 if self._rows else -1

    def _divide(
        self,
        leaf: int,
        parent: int | None,
        side: int,
        row: tuple[int, ...],
        rule: tuple[Label, Label] | None,
    ) -> None:
        old = self._labels[-1 - leaf]
        minus, plus = (old, old) if rule is None else rule
        self._labels[-1 - leaf] = minus
        self._labels.append(plus)
        self._rows.append(row)
        self._links.append([leaf, -len(self._labels)])
        if parent is not None:
            self._links[parent][side] = len(self._rows) - 1

    def _corners(self, facet: Any) -> list[Corner]:
        refusal = InvalidMeshError("A facet must be an array of numbers.", "shape")
        array = doubles(facet, refusal)
        rows, _ = corners_of(array.reshape(1) if self.dimension == 1 else array[None])
        if rows.shape[1] != self.dimension:
            message = (
                f"The corners of the facet have {rows.shape[1]} coordinates, but the tree has"
                f" dimension {self.dimension}."
            )
            raise InvalidMeshError(message, "shape")
        return [tuple(map(exact_number, _steps(row, self.pitch))) for row in rows]

    # Questions

    def labels_at(self, point: Any) -> tuple[Label, ...]:
        """Return the labels of all regions that contain a point or border on it, minus sides first.

        Parameters
        ----------
        point : (d,) array_like of float
            In model units; the numbers count as the decimals they are written as.
        """
        scale = exact_number(10) ** -self.pitch
        place = tuple(x * scale for x in exact_point(point, self.dimension, "point"))
        found, pending = [], [self._root]
        while pending:
            link = pending.pop()
            if link < 0:
                found.append(self._labels[-1 - link])
                continue
            side = height(place, self._rows[link])
            minus, plus = self._links[link]
            pending += [plus] * (side >= 0) + [minus] * (side <= 0)
        return tuple(found)

    def label_at(self, point: Any) -> Label:
        """Return the label of the region at a point; on a cut the label of the minus side."""
        return self.labels_at(point)[0]

    def __iter__(self) -> Iterator[LabelledRegion[Label]]:
        """Yield the regions in the order of the tree, minus sides first."""
        way: tuple[tuple[tuple[int, ...], int], ...] = ()
        pending = [(self._root, way)]
        while pending:
            link, way = pending.pop()
            if link < 0:
                yield LabelledRegion(self._labels[-1 - link], way, self.pitch)
                continue
            row = self._rows[link]
            minus, plus = self._links[link]
            pending += [(plus, (*way, (row, 1))), (minus, (*way, (row, -1)))]

    def mapped(self, function: Callable[[Label], Any]) -> "AttributeTree[Any]":
        """Return the tree with each label replaced by ``function(label)``."""
        made: AttributeTree[Any] = self._copy()
        made._labels = list(map(function_of(function, "function"), self._labels))
        return made


def _checked_rule(rule: "CutRule[Label]") -> tuple[Label, Label] | None:
    """Return the labels (minus, plus) of a cut rule, or None if both sides inherit."""
    if isinstance(rule, str) and rule == "inherit":
        return None
    try:
        if isinstance(rule, (str, bytes)):
            raise TypeError("a string is not a pair of labels")
        minus, plus = rule
    except (TypeError, ValueError) as error:
        message = f"rule must be 'inherit' or a pair of labels (minus, plus), not {shown(rule)}."
        raise invalid_parameter(message) from error
    return minus, plus


def _steps(values: Any, pitch: int) -> list[int]:
    """Return the lattice coordinates nearest to coordinates in model units."""
    scale = exact_number(10) ** -pitch
    return [round(exact_number(value) * scale) for value in values]


def _supporting(corners: Sequence[Corner]) -> tuple[int, ...]:
    """Return the hyperplane n·x = c through a facet's integer corners as (*n, c).

    Its minus side is the facet's minus side.
    """
    whole = [[int(x) for x in corner] for corner in corners]
    first = whole[0]
    arms = [[x - y for x, y in zip(corner, first, strict=True)] for corner in whole[1:]]
    if len(first) == 1:
        normal = [1]
    elif len(first) == 2:
        (x, y) = arms[0]
        normal = [y, -x]
    else:
        normal = [0, 0, 0]
        for a, b in pairwise(arms):
            for k in range(3):
                u, v = (k + 1) % 3, (k + 2) % 3
                normal[k] += a[u] * b[v] - a[v] * b[u]
    if not any(normal):
        raise InvalidMeshError(
            "The facet has no length or area once its corners are rounded to the lattice; leave"
            " it out, or choose a finer pitch.",
            "degenerate",
        )
    return (*normal, sum(n * x for n, x in zip(normal, first, strict=True)))
