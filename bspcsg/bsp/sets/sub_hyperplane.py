"""`SubHyperplane`: a part of a line or of a plane, as an immutable value.

It is a hyperplane, and in it a set of one dimension less: intervals of a line, a region of a plane.
"""

from collections.abc import Callable, Iterable, Iterator
from typing import Any, Self, TypeAlias

import numpy as np

from ..._types import FloatArray, Scalar
from ...errors import LimitError, UnboundedError, deprecated, invalid_parameter
from ...geometry.arrays import doubles
from ...parameters import shown
from .interval import Intervals
from .objects import ObjectTree
from .operators import SetOperators
from .region import Region
from .rows import hyperplane, hyperplane_row, point_rows
from .slicing import plane_frame
from .tree_set import TreeSet, set_of

#: A set in the coordinates of a hyperplane.
InnerSet: TypeAlias = Intervals | Region

#: Two hyperplanes count as equal if their normals and, relatively, their offsets differ by at most
#: this.
_TOLERANCE = 1e-12

#: A corner more than this many lattice steps from the origin, rounding included, is at the border
#: of the lattice and stands for infinity.
_BORDER_STEPS = 2**53 - 4


class SubHyperplane(SetOperators):
    """A part of a line in the plane, or of a plane in space; an immutable value.

    The normal and offset are doubles; the set in the hyperplane is exact. ``| & - ^ ~`` combine
    parts of one hyperplane.

    Parameters
    ----------
    normal : (2,) or (3,) array_like of float
        The normal, which points to the plus side and may have any length.
    offset : float
        Points x of the hyperplane have ``normal . x == offset``.
    part : Intervals or Region, optional
        The set in the hyperplane's coordinates; by default the whole hyperplane. The origin of
        these coordinates is the point nearest to the origin of space. On a line the coordinate
        grows with the minus side on the left; for planes see `plane_frame`.

    Raises
    ------
    InvalidMeshError
        If the normal is zero or has another shape.
    InvalidParameterError
        If the part has another dimension.

    Examples
    --------
    >>> from bspcsg import bsp
    >>> cross = bsp.SubHyperplane.inside(bsp.Region.rectangle(4, 3), (1, 1), 5)
    >>> round(cross.size**2, 6), cross.centroid.round(6).tolist()
    (8.0, [3.0, 2.0])
    """

    __slots__ = ("_normal", "_offset", "_part")

    def __init__(self, normal: Any, offset: Scalar = 0.0, part: InnerSet | None = None) -> None:
        wanted = hyperplane(normal, offset)
        if len(wanted.normal) == 1:
            raise invalid_parameter(
                "A sub-hyperplane must lie in a space of 2 or 3 dimensions, not 1."
            )
        self._normal = np.array([float(x) for x in wanted.normal])
        length = float(np.linalg.norm(self._normal))
        self._normal /= length
        self._normal.flags.writeable = False
        try:
            self._offset = float(wanted.offset) / length
        except OverflowError as error:
            raise LimitError(
                "The offset of the hyperplane is too large for doubles; choose a hyperplane"
                " nearer to the origin.",
                "too_large",
            ) from error
        inner = self.dimension - 1
        whole: InnerSet = Intervals.full() if inner == 1 else Region.full()
        self._part = whole if part is None else _inner(part)
        if self._part.dimension != inner:
            raise invalid_parameter(
                f"part must have dimension {inner}, the dimension of this hyperplane, not"
                f" {self._part.dimension}."
            )

    # Parts of sets

    @classmethod
    def of_boundary(cls, points: TreeSet) -> tuple["SubHyperplane", ...]:
        """Return a set's boundary, with one sub-hyperplane for each hyperplane and orientation.

        Parameters
        ----------
        points : Region or ObjectTree
            The set, which lies on the minus side of each sub-hyperplane.

        Raises
        ------
        UnboundedError
            If a part of a plane reaches to infinity.
        """
        tree = _tree(points)
        rows: dict[tuple[int, ...], list[FloatArray]] = {}
        for row, piece in _pieces(tree):
            rows.setdefault(row, []).append(piece)
        return tuple(_lattice_part(tree, row, pieces) for row, pieces in rows.items())

    @classmethod
    def inside(cls, points: TreeSet, normal: Any, offset: Scalar = 0.0) -> "SubHyperplane":
        """Return the part of a hyperplane that lies in the interior of a set.

        The part that lies in the set's boundary is left out.

        Parameters
        ----------
        points : Region or ObjectTree
        normal, offset
            Moved to the nearest hyperplane of the set's lattice (see `ObjectTree.half_space`).

        Raises
        ------
        UnboundedError
            If a part of a plane reaches to infinity.
        """
        tree = _tree(points)
        row = tuple(hyperplane_row(normal, offset, tree.dimension, tree.pitch))
        minus, plus = tree.split(normal, offset)
        if tree.is_full:
            return _lattice_part(tree, row, None)
        below, above = (
            _lattice_part(tree, row, [piece for other, piece in _pieces(half) if other == seen])
            for half, seen in ((minus, _reduced_row(row)), (plus, _reduced_row([-x for x in row])))
        )
        return below & above

    # Properties

    @property
    def dimension(self) -> int:
        """The dimension of the enclosing space: 2 or 3."""
        return len(self._normal)

    @property
    def normal(self) -> FloatArray:
        """The unit normal of the hyperplane, (d,) float64; it points to the plus side."""
        return self._normal

    @property
    def offset(self) -> float:
        """The offset c of the hyperplane n·x = c with unit normal n, in model units."""
        return self._offset

    @property
    def part(self) -> InnerSet:
        """The set in the hyperplane, in the hyperplane's coordinates."""
        return self._part

    @property
    def is_empty(self) -> bool:
        """True if the set in the hyperplane is empty."""
        return self._part.is_empty

    @property
    def is_bounded(self) -> bool:
        """True if the set in the hyperplane is bounded."""
        return self._part.is_bounded

    @property
    def size(self) -> float:
        """The length of the part of a line, or the area of the part of a plane, in model units.

        Raises
        ------
        UnboundedError
            If the part reaches to infinity.
        """
        return float(self._part.measure)

    @property
    def centroid(self) -> FloatArray:
        """The centre of mass of the part, (d,) float64; NaN for an empty part.

        Raises
        ------
        UnboundedError
            If the part reaches to infinity.
        """
        flat = np.reshape(self._part.centroid, (1, -1))
        return np.asarray(self._lifted(flat)[0])

    def pieces(self) -> list[FloatArray]:
        """Return the part as a list of convex pieces, each the corners of one, (m, d) float64.

        Segments run with the minus side on their left; polygons are counterclockwise seen from the
        plus side.

        Raises
        ------
        UnboundedError
            If the part reaches to infinity.
        """
        if not self.is_bounded:
            raise UnboundedError(
                "This part of a hyperplane reaches to infinity, so it cannot be divided into"
                " pieces; intersect it with a bounded set first.",
                "unbounded",
            )
        if isinstance(self._part, Region):
            return [self._lifted(corners) for corners in self._part.convex_parts()]
        return [self._lifted(pair[:, None]) for pair in self._part.pairs]

    def nearest(self, points: Any) -> tuple[FloatArray, FloatArray]:
        """Return the nearest point of the part to each given point, and its distance.

        Parameters
        ----------
        points : (k, d) array_like of float

        Returns
        -------
        nearest : (k, d) float64
        distance : (k,) float64

        Raises
        ------
        InvalidParameterError
            If the part is empty.
        """
        array = point_rows(points, self.dimension)
        if self.is_empty:
            raise invalid_parameter(
                "This part of the hyperplane is empty, so it has no nearest point."
            )
        flat = self._flattened(array)
        outside = self._part.classify(flat) < 0
        if outside.any():
            flat[outside] = self._part.nearest(flat[outside])[0]
        nearest = self._lifted(flat)
        return nearest, np.sqrt(((nearest - array) ** 2).sum(axis=1))

    def project(self, points: Any) -> tuple[FloatArray, FloatArray]:
        """Return what `nearest` returns; deprecated name, since a projection is a shadow."""
        deprecated("SubHyperplane.project", "nearest")
        return self.nearest(points)

    # Set operations

    def _combined(self, other: object, operation: Callable[[Any, Any], Any]) -> Self:
        made: Self = NotImplemented
        if isinstance(other, SubHyperplane):
            made = self._with(operation(self._part, self._beside(other)))
        return made

    def __invert__(self) -> Self:
        """Return the complement within the hyperplane."""
        return self._with(~self._part)

    def _with(self, part: Any) -> Self:
        return self._facing(1.0, part)

    def _facing(self, sign: float, part: Any) -> Self:
        """Return a part of this hyperplane (sign 1), or of the reversed hyperplane (sign -1)."""
        # The constructor would normalise the unit normal again, which may change it.
        made = object.__new__(type(self))
        made._normal = sign * self._normal + 0.0
        made._offset = sign * self._offset + 0.0
        made._part = part
        made._normal.flags.writeable = False
        return made

    def _beside(self, other: "SubHyperplane") -> Any:
        """Return the part of `other`, of the same hyperplane, in this hyperplane's coordinates."""
        if self.dimension != other.dimension:
            raise invalid_parameter(
                f"The sub-hyperplanes have different dimensions, {self.dimension} and"
                f" {other.dimension}; they must have the same."
            )
        same = float(self._normal @ other._normal)
        gap = self._offset - np.sign(same) * other._offset
        if abs(abs(same) - 1) > _TOLERANCE or abs(gap) > _TOLERANCE * max(1.0, abs(self._offset)):
            raise invalid_parameter(
                "The sub-hyperplanes lie in different hyperplanes; they must lie in the same."
            )
        return other._part if same > 0 else other.reversed()._part

    # Division and motion

    def split(self, normal: Any, offset: Scalar = 0.0) -> tuple[Self, Self]:
        """Return the parts on the minus and on the plus side of another hyperplane.

        If both hyperplanes coincide, both parts are empty.
        """
        other = SubHyperplane(normal, offset)
        inner = _frame(self._normal) @ other._normal
        height = other._offset - float(other._normal @ self._normal) * self._offset
        nothing = self._with(type(self._part).empty())
        if np.abs(inner).max() <= _TOLERANCE:
            gap = _TOLERANCE * max(1.0, abs(self._offset))
            sides = (height > gap, height < -gap)
            return (self if sides[0] else nothing, self if sides[1] else nothing)
        minus, plus = self._part.split(inner if self.dimension == 3 else inner[0], height)
        return self._with(minus), self._with(plus)

    def transform(self, matrix: Any) -> "SubHyperplane":
        """Return the image under an affine map, with the images of both sides as sides.

        Parameters
        ----------
        matrix : (d + 1, d + 1) or (d, d + 1) array_like of float
            The affine map as a matrix for column vectors.

        Raises
        ------
        InvalidParameterError
            If the map has another shape or is not invertible.
        """
        linear, shift = _affine(matrix, self.dimension)
        normal = np.linalg.solve(linear.T, self._normal)
        corner = linear @ (self._normal * self._offset) + shift
        moved = SubHyperplane(normal, float(normal @ corner))
        within = _frame(moved._normal)
        columns = within @ linear @ _frame(self._normal).T
        return moved._with(_moved(self._part, columns, within @ corner))

    def reversed(self) -> "SubHyperplane":
        """Return the same points with minus and plus side exchanged."""
        across = self._facing(-1.0, self._part)
        columns = _frame(across._normal) @ _frame(self._normal).T
        return across._with(_moved(self._part, columns, np.zeros(self.dimension - 1)))

    # As a value

    def __eq__(self, other: object) -> bool:
        """Return true if both sub-hyperplanes have the same normal, offset and part."""
        if not isinstance(other, SubHyperplane):
            return NotImplemented
        mine, others = ([*s._normal.tolist(), s._offset] for s in (self, other))
        return mine == others and self._part == other._part

    def __hash__(self) -> int:
        """Return a hash value of the normal and the offset."""
        return hash((*self._normal.tolist(), self._offset))

    def __bool__(self) -> bool:
        """Return true if the part is not empty."""
        return not self.is_empty

    def __repr__(self) -> str:
        """Return a text with the normal, the offset and the part."""
        normal = ", ".join(f"{x:.6g}" for x in self._normal)
        return f"SubHyperplane(({normal}), {self._offset:.6g}, {self._part!r})"

    # Coordinates

    def _lifted(self, flat: FloatArray) -> FloatArray:
        return np.asarray(flat @ _frame(self._normal) + self._normal * self._offset)

    def _flattened(self, points: FloatArray) -> FloatArray:
        return np.asarray(points @ _frame(self._normal).T)


def _frame(normal: FloatArray) -> FloatArray:
    """Return the unit vectors of a hyperplane's coordinates as rows, (d - 1, d)."""
    if len(normal) == 2:
        return np.array([[-normal[1], normal[0]]]) + 0.0
    return np.array(plane_frame(normal))


def _inner(part: Any) -> InnerSet:
    if isinstance(part, (Intervals, Region)):
        return part
    raise invalid_parameter(f"part must be Intervals or a Region, not {shown(part)}.")


def _tree(points: TreeSet) -> ObjectTree:
    if set_of(points, "points").dimension == 1:
        raise invalid_parameter("A sub-hyperplane must lie in a space of 2 or 3 dimensions, not 1.")
    return points.tree


def _reduced_row(row: Iterable[int]) -> tuple[int, ...]:
    """Return the integers of a hyperplane divided by their greatest common divisor."""
    numbers = list(row)
    factor = int(np.gcd.reduce(np.array(numbers, dtype=object)))
    return tuple(number // factor for number in numbers)


def _pieces(tree: ObjectTree) -> Iterator[tuple[tuple[int, ...], FloatArray]]:
    """Yield each piece of a tree's boundary with its hyperplane, whose minus side has the set."""
    pieces, rows = tree.boundary(), tree.nodes.coefficients
    for number, owner in enumerate(pieces.owner.tolist()):
        corners, row = pieces[number], _reduced_row(rows[owner])
        outward = _outward(corners)
        if outward.any():
            facing = float(outward @ np.array([float(x) for x in row[:-1]]))
            yield (row if facing > 0 else _reduced_row([-x for x in row])), corners


def _outward(corners: FloatArray) -> FloatArray:
    """Return a normal of a piece that points out of the set; zero for a degenerate piece."""
    if corners.shape[1] == 2:
        (x, y), (u, v) = corners
        return np.array([v - y, x - u])
    arms = corners[1:] - corners[0]
    return np.asarray(np.cross(arms[:-1], arms[1:]).sum(axis=0))


def _lattice_part(
    tree: ObjectTree, row: tuple[int, ...], pieces: list[FloatArray] | None
) -> SubHyperplane:
    """Return the sub-hyperplane that convex pieces cover, or the whole hyperplane for None.

    `row` is the hyperplane (*n, c) in lattice steps.
    """
    step = 10.0**tree.pitch
    longest = max(map(abs, row[:-1]))
    normal = [number / longest for number in row[:-1]]
    try:
        whole = SubHyperplane(normal, row[-1] / longest * step)
    except OverflowError as error:
        raise LimitError(
            "The offset of the hyperplane is too large for doubles; choose a hyperplane"
            " nearer to the origin.",
            "too_large",
        ) from error
    if pieces is None:
        return whole
    border = _BORDER_STEPS * step
    flat = [whole._flattened(piece) for piece in pieces]
    if tree.dimension == 2:
        beyond = [np.abs(piece).max(axis=1) > border for piece in pieces]
        pairs = [
            np.sort(np.where(far, np.copysign(np.inf, ends[:, 0]), ends[:, 0]))
            for ends, far in zip(flat, beyond, strict=True)
        ]
        return whole._with(Intervals([pair for pair in pairs if pair[0] < pair[1]]))
    if any(np.abs(piece).max() > border for piece in pieces):
        raise UnboundedError(
            "The part of the plane inside this set reaches to infinity; intersect the set with a"
            " bounded one first.",
            "unbounded",
        )
    return whole._with(Region(flat, winding="nonzero"))


def _affine(matrix: Any, dimension: int) -> tuple[FloatArray, FloatArray]:
    refusal = invalid_parameter(
        f"The matrix must be an invertible affine matrix of {dimension} or {dimension + 1}"
        f" rows and {dimension + 1} columns."
    )
    rows = doubles(matrix, refusal)
    square = (dimension + 1, dimension + 1)
    last = np.eye(dimension + 1)[-1]
    if rows.shape not in (square, (dimension, dimension + 1)) or not np.isfinite(rows).all():
        raise refusal
    if rows.shape == square and (rows[-1] != last).any():
        raise refusal
    linear = rows[:dimension, :dimension]
    if np.linalg.matrix_rank(linear) < dimension:
        raise refusal
    return linear, rows[:dimension, dimension]


def _moved(part: InnerSet, columns: FloatArray, shift: FloatArray) -> InnerSet:
    """Return the image of a part under an affine map of the hyperplane's coordinates."""
    if isinstance(part, Region):
        return part.transform(np.column_stack([columns, shift]))
    return part.scale(float(columns[0, 0])).translate(float(shift[0]))
