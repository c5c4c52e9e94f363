"""`Region`: a set of points in the plane with polygonal boundary, as an immutable value."""

import math
import os
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from fractions import Fraction
from typing import Any, Literal, Self, TypeAlias

import numpy as np

from ..._core import ObjectTree as CoreTree
from ..._types import FloatArray, Scalar, SetOp, Vector, WindingRule
from ...errors import FormatError, LimitError, UnboundedError, core_errors, invalid_parameter
from ...geometry import transform
from ...geometry.arrays import doubles
from ...geometry.per_axis import per_axis
from ...geometry.transform import Factor
from ...mesh import interop
from ...method_ownership import with_own_methods
from ...parameters import (
    SEGMENTS,
    file_path,
    function_of,
    instance_of,
    number,
    one_of,
    positive,
    radius_or_half_diameter,
    shown,
    sides_around,
    truth_value,
    two_values,
    winding_rule,
)
from ...shapes.primitives import extrude, revolve
from ...shapes.sweep import unit_circle
from ...solid.solid import Solid
from ..trees.facets import chosen_pitch
from .boundary import segment_rows
from .flat_set import FlatSet
from .loops import Outline, closed_loops, loop_segments, moved_points
from .objects import ObjectTree
from .plane_queries import (
    cast_line,
    convex_parts,
    exact_centroid,
    exact_outlines,
    on_one_lattice,
    outlines_of,
    rounded_area,
    vector2,
)
from .tree_set import TreeSet

#: The rule that says which winding numbers are inside a region of the plane.
FillRule: TypeAlias = WindingRule | Literal["negative"]

_AXES = {"x": (1.0, 0.0), "y": (0.0, 1.0)}


@with_own_methods
class Region(FlatSet):
    """A set of points of the plane with polygonal boundary.

    A point is inside if the winding number of the outlines satisfies the rule; outlines may cross,
    touch or overlap themselves and each other. The lattice is as for `Solid`: coordinates are
    snapped to steps of ``10**pitch``, at most 2**53 steps from the origin, and everything else is
    exact. Sets are regularised: points and edges without adjacent area vanish. ``==``, ``<=``,
    ``<``, ``in`` and the like compare sets of points exactly, as for `Solid`. Operations use the
    finest lattice of the operands, or if its range is too small, the finest lattice with a
    sufficient range that has all corners of the operands; without such a lattice they raise a
    `LimitError`.

    Parameters
    ----------
    outlines : object
        (n, 2) points of one closed outline; a sequence of such outlines; a `Region`; a manifold3d
        cross section; or a shapely polygon, multipolygon or collection, or a list of these. With
        the rule "positive", outer outlines run counterclockwise, with the inside on their left, and
        holes clockwise. Rings of shapely shapes are oriented like this, so the region is the union
        of the polygons; points and lines in collections are ignored.
    winding : {"positive", "nonzero", "even-odd", "negative"}
        The rule that says which winding numbers are inside.
    pitch : int, optional
        Exponent of the lattice step; by default -9, or another if the coordinates require it.

    Raises
    ------
    InvalidMeshError
        If an outline has fewer than three points, another shape, or a coordinate that is not
        finite.
    LimitError
        If the coordinates do not fit on the lattice.

    Examples
    --------
    >>> from bspcsg import bsp
    >>> plate = bsp.Region.rectangle(6, 4) - bsp.Region.rectangle(2, 2).translate(1, 1)
    >>> plate.area, len(plate.outlines)
    (20.0, 2)
    """

    __slots__ = ("_outlines",)

    def __init__(
        self, outlines: Any = (), *, winding: FillRule = "positive", pitch: int | None = None
    ) -> None:
        loops = closed_loops(outlines)
        points = np.concatenate(loops) if loops else np.zeros((0, 2))
        rows = loop_segments(loops).reshape(-1, 4)
        self._set(_built(rows, chosen_pitch(pitch, points), winding))

    def _set(self, tree: CoreTree) -> None:
        super()._set(tree)
        self._outlines: tuple[Outline, ...] | None = None

    # Making

    @classmethod
    def from_segments(
        cls, segments: Any, *, winding: FillRule = "positive", pitch: int | None = None
    ) -> Self:
        """Return the region enclosed by oriented segments, (n, 2, 2), the inside on their left.

        Raises
        ------
        InvalidMeshError
            If the segments do not form closed outlines (`where` lists segments).
        """
        refusal = invalid_parameter(
            "Segments must be pairs of points with two numbers each, in an array of shape (n, 2,"
            " 2)."
        )
        given = doubles(segments, refusal)
        if given.size % 4:
            raise refusal
        array = given.reshape(-1, 2, 2)
        chosen = chosen_pitch(pitch, array.reshape(-1, 2))
        return cls._of(_built(segment_rows(array), chosen, winding))

    @classmethod
    def empty(cls) -> Self:
        """Return the empty set."""
        return cls()

    @classmethod
    def full(cls) -> Self:
        """Return the whole plane."""
        return ~cls()

    @classmethod
    def rectangle(
        cls, width: Scalar | Vector, height: Scalar | None = None, *, center: bool = False
    ) -> Self:
        """Return a rectangle with its minimum corner or its centre at the origin.

        Give its sides as two numbers or one pair; a single number makes a square.
        """
        sides = two_values(width, "size") if height is None else (width, height)
        w, h = positive(sides[0], "width"), positive(sides[1], "height")
        corners = np.array([(0, 0), (w, 0), (w, h), (0, h)], dtype=np.float64)
        return cls(corners - (w / 2, h / 2) if truth_value(center, "center") else corners)

    @classmethod
    def circle(
        cls, r: Scalar | None = None, segments: int = SEGMENTS, *, d: Scalar | None = None
    ) -> Self:
        """Return a circle about the origin as a regular polygon with its corners on that circle.

        Parameters
        ----------
        r, d : float
            The radius of the circle, or its diameter.
        segments : int
            The number of sides of the polygon, at least 3.
        """
        size = positive(radius_or_half_diameter(r, d, "A circle"), "r")
        return cls(unit_circle(sides_around(3, segments, "segments")) * size)

    @classmethod
    def regular_polygon(
        cls,
        sides: int,
        r: Scalar | None = None,
        *,
        d: Scalar | None = None,
        flats: Scalar | None = None,
    ) -> Self:
        """Return a regular polygon about the origin, given its radius or its width across flats.

        Parameters
        ----------
        sides : int
            The number of sides, at least 3.
        r, d : float
            The radius or the diameter of the circle through the corners; the first corner is on the
            x axis.
        flats : float
            Instead: the diameter of the inscribed circle, which for an even number of sides is the
            width across flats, as of a nut. The first side is then parallel to the y axis.

        Examples
        --------
        >>> from bspcsg import Region
        >>> Region.regular_polygon(6, flats=13).bounds[:, 0].tolist()
        [-6.5, 6.5]
        """
        around = sides_around(3, sides, "sides")
        if flats is None:
            return cls(
                unit_circle(around)
                * positive(radius_or_half_diameter(r, d, "A regular polygon"), "r")
            )
        if r is not None or d is not None:
            raise invalid_parameter("A regular polygon needs exactly one of r, d and flats.")
        # Every second corner of a polygon with twice as many makes axis-parallel sides exact.
        corners = unit_circle(2 * around)[1::2]
        return cls(corners * (positive(flats, "flats") / 2 / corners[0, 0]))

    @classmethod
    def slot(
        cls,
        length: Scalar,
        r: Scalar | None = None,
        *,
        d: Scalar | None = None,
        segments: int = SEGMENTS,
    ) -> Self:
        """Return a straight slot with round ends about the origin, along x.

        Parameters
        ----------
        length : float
            The length from end to end, at least twice the radius.
        r, d : float
            The radius of the round ends, or their diameter, which is the slot's width.
        segments : int
            The number of sides of a full circle, at least 4; an odd number is increased by one.

        Examples
        --------
        >>> from bspcsg import Region
        >>> Region.slot(10, d=4).bounds.tolist()
        [[-5.0, -2.0], [5.0, 2.0]]
        """
        size, whole = (
            positive(radius_or_half_diameter(r, d, "A slot"), "r"),
            positive(length, "length"),
        )
        if whole < 2 * size:
            raise invalid_parameter(
                f"The length of a slot must be at least its width {2 * size:g}, not {whole:g}."
            )
        steps = -(-sides_around(4, segments, "segments") // 2)
        turned = unit_circle(2 * steps)[: steps + 1]
        # The right end's arc, in the order of increasing y.
        end = np.column_stack([turned[:, 1], -turned[:, 0]]) * size + (whole / 2 - size, 0)
        return cls(np.concatenate([end, -end]))

    @classmethod
    def polygon(cls, points: Any, *, pitch: int | None = None) -> Self:
        """Return the region that one outline of either orientation encloses (rule "nonzero")."""
        return cls([points], winding="nonzero", pitch=pitch)

    @classmethod
    def half_plane(cls, normal: Vector, offset: Scalar = 0.0, *, pitch: int | None = None) -> Self:
        """Return the half-plane of all points x with ``normal . x <= offset``."""
        half = ObjectTree.half_space(vector2(normal, "normal"), offset, pitch=pitch)
        return cls._of(half._tree)

    @classmethod
    def from_svg(cls, path: str | os.PathLike[str], **options: Any) -> "Region":
        """Read the filled shapes of an SVG file (see `bspcsg.bsp.load_svg`)."""
        from ..drawings.svg import load_svg

        return load_svg(path, **options)

    @classmethod
    def from_dxf(cls, path: str | os.PathLike[str], **options: Any) -> "Region":
        """Read the closed outlines of a DXF file (see `bspcsg.bsp.load_dxf`)."""
        from ..drawings.dxf import load_dxf

        return load_dxf(path, **options)

    @classmethod
    def compose(cls, regions: Iterable["Region"]) -> "Region":
        """Return the union of any number of regions in one operation.

        Examples
        --------
        >>> from bspcsg import Region
        >>> Region.compose(Region.rectangle(2, 1).translate(k, 0) for k in range(9)).area
        10.0
        """
        if not isinstance(regions, Iterable):
            raise invalid_parameter(
                f"regions must be a list of Region objects, not {shown(regions)}."
            )
        parts = [instance_of(Region, part, "Each part") for part in regions]
        if not parts:
            return cls()
        trees = on_one_lattice([part.tree for part in parts])
        with core_errors():
            return cls._of(trees[0].composed(trees[1:]))

    # Set operations

    def _merged(self, other: TreeSet, op: SetOp) -> Self:
        """Return the result of a set operation, by sweeping over boundaries or merging trees."""
        try:
            a, b = self.tree._aligned(other)
        except LimitError:
            a, b = on_one_lattice([self.tree, other.tree])
        with core_errors():
            return self._of(a.combined(b, op))

    # Outlines and parts

    @property
    def outlines(self) -> tuple[Outline, ...]:
        """The boundary as nested simple loops: outer ones counterclockwise, holes clockwise.

        Collinear edges are joined. Loops touch each other only in corners: where two loops touch,
        both have a corner. The loops depend only on the set of points.

        Raises
        ------
        UnboundedError
            If the region reaches to infinity.
        """
        if self._outlines is None:
            self._outlines = outlines_of(self._tree)
        return self._outlines

    @property
    def exact_outlines(self) -> list[list[tuple[Fraction, Fraction]]]:
        """The corners (x, y) of each outline as exact fractions, in model units."""
        return exact_outlines(self._tree)

    def to_polygons(self) -> list[FloatArray]:
        """Return the outlines as a list of (n, 2) float64, as ``bspcsg.extrude`` takes them."""
        return [outline.points for outline in self.outlines]

    def decompose(self) -> list["Region"]:
        """Return the connected parts of the region, each with its holes, as a list.

        Examples
        --------
        >>> from bspcsg import Region
        >>> [part.area for part in (Region.rectangle(9, 1) - Region.rectangle(3, 1)).decompose()]
        [6.0]
        """
        return list(self.components)

    @property
    def components(self) -> tuple["Region", ...]:
        """The connected parts, each with its holes, in the order of their outlines.

        Parts that touch only in corners are separate. Corners that are not on the lattice are
        rounded to it, so that a part thinner than a step may become empty.
        """
        return tuple(Region(loops, pitch=self.pitch) for loops in self._parts())

    def _parts(self) -> list[list[FloatArray]]:
        """Return the outlines of each connected part, the outer outline before its holes."""
        parts: dict[int, list[FloatArray]] = {}
        outlines = list(enumerate(self.outlines))
        for k, outline in outlines:
            if not outline.is_hole:
                parts[k] = [outline.points]
        for _, outline in outlines:
            if outline.is_hole:
                parts[outline.parent].append(outline.points)
        return list(parts.values())

    def convex_parts(self) -> list[FloatArray]:
        """Return the region divided into convex polygons, the inside leaves of its partition tree.

        Returns
        -------
        list of (n, 2) float64
            The corners of each polygon, counterclockwise, rounded to doubles; in the order of the
            leaves.
        """
        return convex_parts(self.tree.cells())

    # Measures

    @property
    def area_exact(self) -> Fraction:
        """Area in square model units, exactly.

        Raises
        ------
        UnboundedError
            If the region reaches to infinity.
        """
        return self.measure

    @property
    def area(self) -> float:
        """Area in square model units, rounded once."""
        return rounded_area(self._tree)

    @property
    def perimeter(self) -> float:
        """Length of the boundary in model units; the complement has the same perimeter.

        Raises
        ------
        UnboundedError
            If the region and its complement both reach to infinity.
        """
        inner = self if self.is_bounded else ~self
        return math.fsum(outline.length for outline in inner.outlines)

    @property
    def centroid_exact(self) -> tuple[Fraction, Fraction] | None:
        """Centre of area (x, y) in model units, as exact fractions; None for the empty set."""
        return exact_centroid(self._tree)

    @property
    def centroid(self) -> FloatArray:
        """Centre of area, (2,) float64, each coordinate rounded once; NaN for the empty set."""
        exact = self.centroid_exact
        return np.full(2, np.nan) if exact is None else np.array([float(c) for c in exact])

    @property
    def bounds(self) -> FloatArray | None:
        """The bounding box: lowest, then highest x and y, (2, 2) float64; None if empty."""
        if self.is_empty:
            return None
        points = np.concatenate(self.to_polygons())
        return np.array([points.min(axis=0), points.max(axis=0)])

    # Questions

    def cast(self, origin: Vector, direction: Vector) -> FloatArray:
        """Return the segments of a line that lie inside the region.

        Parameters
        ----------
        origin, direction : (2,) float
            The origin is snapped to the lattice, the direction rounded to 53 bits.

        Returns
        -------
        (k, 2) float64
            The parameters t of the start and the end ``origin + t * direction`` of each segment,
            ascending; infinite at an end where the segment is unbounded. Segments that lie on the
            boundary do not count, and a single boundary point separates two segments. The order is
            exact, each t is rounded.

        Raises
        ------
        InvalidParameterError
            If the direction is zero or a number is not finite.
        """
        return cast_line(self._tree, origin, direction)

    # Transforms

    def translate(
        self, *offset: Scalar | Vector, x: Scalar | None = None, y: Scalar | None = None
    ) -> "Region":
        """Return the region translated by two numbers, one vector, or along named axes.

        The result is exact if the numbers are multiples of the lattice step.

        Examples
        --------
        >>> from bspcsg import Region
        >>> Region.rectangle(2, 1).translate(y=3).bounds.tolist()
        [[0.0, 3.0], [2.0, 4.0]]
        """
        step = vector2(per_axis(offset, "offset", x=x, y=y), "offset")
        return self._placed(transform.translation([*step, 0.0]))

    def rotate(self, angle: Scalar, *, about: Vector = (0, 0)) -> "Region":
        """Return the region rotated counterclockwise by an angle in degrees about a point.

        Quarter turns are exact.
        """
        return self._placed_about(about, transform.rotation(number(angle, "angle"), "z"))

    def scale(
        self,
        factor: Scalar | Vector | None = None,
        *others: Scalar,
        x: Scalar | None = None,
        y: Scalar | None = None,
        about: Vector = (0, 0),
    ) -> "Region":
        """Return the region scaled by one factor, by two factors, or along named axes.

        The point `about` does not move.
        """
        given = () if factor is None else (factor, *others)
        factors = per_axis(given, "scale factor", missing=1.0, x=x, y=y)
        along = vector2(two_values(factors, "factor"), "factor")
        return self._placed_about(about, transform.scaling([*along, 1.0]))

    def mirror(
        self,
        normal: str | Vector | Scalar | None = None,
        *others: Scalar,
        x: Scalar | None = None,
        y: Scalar | None = None,
        about: Vector = (0, 0),
    ) -> "Region":
        """Return the mirror image across the line through `about` with the given normal.

        The normal is "x" or "y", a vector, two numbers, or given by the coordinates `x` and `y`.
        """
        given = () if normal is None else (normal, *others)
        across = per_axis(given, "normal", x=x, y=y)
        if isinstance(across, str):
            across = _AXES[one_of(_AXES, across.lower(), "normal")]
        factor = transform.mirroring([*vector2(across, "normal"), 0.0])
        return self._placed_about(about, factor)

    def transform(self, matrix: Any) -> "Region":
        """Return the region's image under an affine map: a (3, 3) or (2, 3) matrix.

        The matrix multiplies column vectors.

        Raises
        ------
        InvalidMeshError
            If the matrix is not an invertible affine map.
        UnboundedError
            If the map is not a lattice motion, and the region and its complement are unbounded.
        """
        rows = doubles(matrix, invalid_parameter("matrix must be an array of numbers."))
        if rows.shape not in ((3, 3), (2, 3)) or (len(rows) == 3 and list(rows[2]) != [0, 0, 1]):
            raise invalid_parameter(
                "matrix must be an affine matrix of the plane, of shape (2, 3), or of shape (3,"
                " 3) with the last row 0, 0, 1."
            )
        wide = np.eye(4)
        wide[:2, [0, 1, 3]] = rows[:2]
        return self._placed(transform.matrix_factor(wide))

    def _placed_about(self, point: Vector, factor: Factor) -> "Region":
        """Return the region's image under a linear map about a point instead of the origin."""
        x, y = vector2(point, "about")
        placed = self
        for one in reversed(transform.about((x, y, 0.0), (factor,))):
            placed = placed._placed(one)
        return placed

    def _placed(self, factor: Factor) -> "Region":
        motion = transform.lattice_motion((factor,), self.pitch)
        if motion is not None:
            # If the image does not fit the lattice, the code below moves the corners to a coarser
            # one.
            with suppress(LimitError):
                return self._moved(list(motion.axes[:2]), list(motion.shift[:2]))
        if self.is_bounded:
            loops = [moved_points(factor, loop) for loop in self.to_polygons()]
            return Region(loops, pitch=self._pitch_for(loops))
        outside = ~self
        if not outside.is_bounded:
            raise UnboundedError(
                "This region and its complement both reach to infinity, so it can only be"
                " translated by whole lattice steps, rotated by quarter turns and mirrored at"
                " the axes. Intersect it with a bounded region first.",
                "unbounded",
            )
        return ~outside._placed(factor)

    def _pitch_for(self, loops: Sequence[FloatArray]) -> int | None:
        """Return the region's pitch if all points lie in the range of its lattice, else None."""
        largest = max((float(np.abs(loop).max()) for loop in loops), default=0.0)
        return self.pitch if largest < (2**53 - 1) * 10.0**self.pitch else None

    # Other figures

    def offset(
        self,
        delta: Scalar,
        join: Literal["round", "miter", "square", "bevel"] = "round",
        *,
        segments: int = SEGMENTS,
        miter_limit: Scalar = 1e6,
    ) -> "Region":
        """Return the region with its outline moved outwards, or inwards, by a distance.

        Parameters
        ----------
        delta : float
            The distance, in model units; inwards if it is negative.
        join : {"round", "miter", "square", "bevel"}
            The shape at corners from which the outline moves away. "round": an arc; "miter": the
            corner where the moved edges meet; "square": cut off at the distance `delta` from the
            old corner; "bevel": cut off from the end of one moved edge to the start of the next.
        segments : int
            The number of sides of a full circle, for arcs, at least 3.
        miter_limit : float
            A mitred corner is squared if it is farther from the old corner than this multiple of
            `delta`.

        Raises
        ------
        InvalidParameterError
            If a parameter is out of its range.
        LimitError
            If arcs would have too many corners.
        UnboundedError
            If the region and its complement both reach to infinity.

        Notes
        -----
        Corners are rounded to about 2**-40 of the region's extent. Arcs and mitred corners are
        those of OpenSCAD, with `segments` as its ``$fn``.

        Examples
        --------
        >>> from bspcsg import Region
        >>> Region.rectangle(4, 2).offset(1, "miter").area
        24.0
        >>> Region.rectangle(4, 2).offset(-1).is_empty
        True
        """
        from ...modelling.planar.offsetting import offset_region

        return offset_region(self, delta, join, segments=segments, miter_limit=miter_limit)

    def fillet(
        self,
        r: Scalar,
        corners: "Callable[[FloatArray], Any] | None" = None,
        *,
        segments: int = SEGMENTS,
    ) -> "Region":
        """Return the region with corners rounded by arcs.

        Parameters
        ----------
        r : float
            The radius of the arcs, in model units.
        corners : function, optional
            Takes corners, (n, 2), and returns for each whether to round it. Only corners where the
            outline bends by more than 30 degrees are rounded; by default all such corners.
        segments : int
            The number of sides of a full circle, at least 4.

        Raises
        ------
        InvalidParameterError
            If edges are too short, or new corners cross another outline; the message has the
            coordinates.
        UnboundedError
            If the region and its complement both reach to infinity.

        Examples
        --------
        >>> from bspcsg import Region
        >>> plate = Region.rectangle(6, 4)
        >>> len(plate.fillet(1, segments=8).outlines[0].points)
        12
        >>> plate.fillet(2, lambda p: p[:, 0] > 0, segments=4).area
        20.0
        """
        from ...modelling.planar.corners import fillet_region

        return fillet_region(self, r, corners, segments)

    def chamfer(
        self, size: Scalar, corners: "Callable[[FloatArray], Any] | None" = None
    ) -> "Region":
        """Return the region with its corners cut off.

        Parameters
        ----------
        size : float
            The distance from the corner to the cut along both edges, in model units.
        corners : function, optional
            Takes corners, (n, 2), and returns for each whether to cut it off, as for `fillet`.

        Raises
        ------
        InvalidParameterError
        UnboundedError
            As for `fillet`.

        Examples
        --------
        >>> from bspcsg import Region
        >>> Region.rectangle(6, 4).chamfer(1).area
        22.0
        """
        from ...modelling.planar.corners import chamfer_region

        return chamfer_region(self, size, corners)

    def hull(self) -> "Region":
        """Return the convex hull of the region, computed exactly.

        Examples
        --------
        >>> from bspcsg import Region
        >>> (Region.rectangle(4, 4) - Region.rectangle(4, 4).translate(2, 2)).hull().area
        14.0
        """
        from ...modelling.planar.hulls import hull_of_region

        return hull_of_region(self)

    def simplify(self, tolerance: Scalar) -> "Region":
        """Return the region with fewer corners, within a tolerance of the old outline.

        The remaining corners do not move. Each point of the new outline lies within `tolerance` of
        the old outline, and vice versa, except that parts thinner than `tolerance` may vanish.
        Where new outlines cross, their insides are united.

        Parameters
        ----------
        tolerance : float
            The largest distance in model units. With 0 the region itself is returned.

        Raises
        ------
        InvalidParameterError
            If `tolerance` is negative or not finite.
        UnboundedError
            If the region and its complement both reach to infinity.

        Examples
        --------
        >>> from bspcsg import Region
        >>> len(Region.circle(10, 360).simplify(0.1).outlines[0].points)
        32
        """
        from ...modelling.planar.simplifying import simplify_region

        return simplify_region(self, tolerance)

    def warp(self, function: Callable[[FloatArray], Any]) -> "Region":
        """Return the region after a function has moved each of its corners.

        Edges stay straight. A point is inside the result if its winding number in the moved
        outlines is not zero, so that mirror images are correct; a part that a fold covers once in
        each orientation has winding number zero and vanishes.

        Parameters
        ----------
        function : callable
            Takes all corners, (n, 2) float64, and returns the moved corners, (n, 2); it may change
            its argument.

        Raises
        ------
        InvalidParameterError
            If the function returns another shape or a number that is not finite.
        UnboundedError
            If the region reaches to infinity.

        Examples
        --------
        >>> from bspcsg import Region
        >>> Region.rectangle(2, 2).warp(lambda p: p * (1, 3)).area
        12.0
        """
        loops, move = self.to_polygons(), function_of(function, "function")
        if not loops:
            return self
        ends = np.cumsum([len(loop) for loop in loops])[:-1]
        points = np.concatenate(loops)
        moved = _moved_corners(points, move(points.copy()))
        warped = np.split(moved, ends)
        return Region(warped, winding="nonzero", pitch=self._pitch_for(warped))

    # To space

    def extrude(
        self,
        height: Scalar,
        *,
        center: bool = False,
        twist: Scalar = 0.0,
        scale: Scalar | Vector = 1.0,
        slices: int | None = None,
        taper: Scalar = 0.0,
    ) -> Solid:
        """Return the solid that the region sweeps along z, from 0 to the height.

        The parameters are those of `bspcsg.extrude`; an empty region gives an empty solid.

        Examples
        --------
        >>> from bspcsg import Region
        >>> Region.rectangle(2, 2, center=True).extrude(3, scale=0).volume
        4.0
        """
        positive(height, "height")
        return extrude(
            self, height, center=center, twist=twist, scale=scale, slices=slices, taper=taper
        )

    def revolve(self, *, angle: Scalar = 360.0, segments: int = SEGMENTS) -> Solid:
        """Return the solid that the region sweeps around z; x is the distance from the axis.

        The parameters are those of `bspcsg.revolve`; an empty region gives an empty solid.
        """
        return revolve(self, angle=angle, segments=segments)

    # Files and other libraries

    def to_svg(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Write the region to an SVG file (see `bspcsg.bsp.save_svg`)."""
        from ..drawings.svg import save_svg

        save_svg(self, path, **options)

    def to_dxf(self, path: str | os.PathLike[str]) -> None:
        """Write the region to a DXF file (see `bspcsg.bsp.save_dxf`)."""
        from ..drawings.dxf import save_dxf

        save_dxf(self, path)

    def save(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Write the region to an SVG or a DXF file, by the path's suffix (see `to_svg`, `to_dxf`).

        Raises
        ------
        FormatError
            If the suffix is neither; code ``"unknown_format"``.
        """
        name = file_path(path)
        suffix = os.path.splitext(name)[1].lower()
        if suffix not in (".svg", ".dxf"):
            message = (
                f"{name}: a region cannot be written in this format; choose a file name that ends"
                " in .svg or .dxf."
            )
            raise FormatError(message, "unknown_format")
        if suffix == ".svg":
            self.to_svg(path, **options)
        else:
            self.to_dxf(path, **options)

    def show(self) -> None:
        """Show the region in a notebook, or as a slab in a browser (see `bspcsg.show`)."""
        from ...script.run import show

        show(self)

    def to_shapely(self) -> Any:
        """Return the region as a ``shapely.MultiPolygon``; shapely must be installed."""
        shapely = interop.import_optional("shapely", "shapely")
        return shapely.MultiPolygon([(shell, holes) for shell, *holes in self._parts()])

    def _repr_svg_(self) -> str | None:
        """Return an SVG picture for notebooks, or None if there is no outline."""
        from ...report.viewer.notebook import region_svg

        return region_svg(self)

    def _repr_png_(self) -> bytes | None:
        """Return a PNG picture for notebooks, or None if there is no outline or no Pillow."""
        from ...report.viewer.notebook import region_png

        return region_png(self)

    # As a value

    def __repr__(self) -> str:
        """Return a text with the numbers of outlines and corners and the area."""
        if self.is_empty or self.is_full:
            return f"Region({'empty' if self.is_empty else 'full'})"
        if not self.is_bounded:
            return "Region(unbounded)"
        corners = sum(len(outline.points) for outline in self.outlines)
        count = len(self.outlines)
        return (
            f"Region({count} outline{'s' * (count > 1)}, {corners} corners, area {self.area:.6g})"
        )


def _moved_corners(points: FloatArray, given: Any) -> FloatArray:
    """Return the corners that a function returned, or raise an error if they are invalid."""
    wrong = invalid_parameter(
        "The function must return an array of numbers of the shape that it is given,"
        f" {points.shape}."
    )
    moved = doubles(given, wrong)
    if moved.shape != points.shape:
        raise wrong
    bad = np.flatnonzero(~np.isfinite(moved).all(axis=1))
    if len(bad):
        x, y = points[bad[0]].tolist()
        message = (
            f"The function must return finite coordinates, but does not for the point ({x:g},"
            f" {y:g})."
        )
        raise invalid_parameter(message, bad[:20].tolist())
    return moved


def _built(rows: FloatArray, pitch: int, winding: FillRule) -> CoreTree:
    if isinstance(winding, str) and winding == "negative":
        # Reversed segments have the opposite winding numbers.
        rows, winding = np.ascontiguousarray(rows[:, [2, 3, 0, 1]]), "positive"
    rule = winding_rule(winding)
    with core_errors():
        return CoreTree.region(np.ascontiguousarray(rows), pitch, rule)
