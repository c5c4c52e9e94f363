"""Methods of solids that are implemented in `bspcsg.modelling`."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, cast, overload

from .._types import FloatArray, Scalar, Vector, WindingRule
from ..parameters import SEGMENTS
from .components import Components

if TYPE_CHECKING:
    from ..bsp import HitLists, Hits
    from ..modelling.bodies.placing import Anchor
    from .solid import Solid


class Modelled:
    """A solid with modelling methods."""

    __slots__ = ()

    def split(self, normal: "str | Vector | Solid", offset: Scalar = 0.0) -> "tuple[Solid, Solid]":
        """Split the solid by a plane or by another solid.

        Both parts have the cut as a face; their union is exactly the solid.

        Parameters
        ----------
        normal : "x", "y", "z", (3,) float, or Solid
            The normal of the plane, of any length; or the solid to cut with.
        offset : float
            The plane holds the points x with ``normal . x == offset``.

        Returns
        -------
        Solid, Solid
            The part with ``normal . x <= offset`` and the rest; for a cut by a solid, the part
            inside that solid and the rest. Either may be empty.

        Raises
        ------
        InvalidMeshError
            If the normal is zero or a number is not finite ("bad_normal").

        Notes
        -----
        The plane is that of `bspcsg.half_space`: the given one if it contains lattice points, else
        the nearest parallel one that does. In a block (see `bspcsg.block`) neither part counts.

        Examples
        --------
        >>> import bspcsg as csg
        >>> below, above = csg.cube(2).split((0, 0, 1), 0.5)
        >>> below.volume, above.volume
        (2.0, 6.0)
        >>> inside, outside = csg.cube(2).split(csg.cube(1))
        >>> inside.volume, outside.volume
        (1.0, 7.0)
        """
        from ..modelling.bodies.parts import split

        return split(cast("Solid", self), normal, offset)

    def trim(self, normal: str | Vector, offset: Scalar = 0.0) -> "Solid":
        """Return the part on the side to which a plane's normal points: the second part of `split`.

        Parameters
        ----------
        normal : "x", "y", "z" or (3,) float
            Need not have unit length.
        offset : float
            The part with ``normal . x >= offset`` stays.

        Raises
        ------
        InvalidMeshError
            If the normal is zero or a number is not finite ("bad_normal").

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.cube(2).trim((0, 0, 1), 0.5).bounds[0].tolist()
        [0.0, 0.0, 0.5]
        """
        from ..modelling.bodies.parts import trim

        return trim(cast("Solid", self), normal, offset)

    def decompose(self) -> "list[Solid]":
        """Return the connected parts, the largest volume first; none for the empty set.

        The wall of a cavity belongs to the part around it. Parts that touch only in a point or an
        edge are separate.

        Raises
        ------
        UnboundedError
            If the solid reaches to infinity.

        Notes
        -----
        If there are several parts, each is the solid of its mesh: corners off the lattice are
        rounded to it, or to a finer lattice if nothing would be left. A part that is too thin for
        doubles is left out. In a block (see `bspcsg.block`) no part counts.

        Examples
        --------
        >>> import bspcsg as csg
        >>> pair = csg.cube(1) | csg.cube(2).translate(5, 0, 0)
        >>> [part.volume for part in pair.decompose()]
        [8.0, 1.0]
        """
        from ..modelling.bodies.parts import decompose

        return decompose(cast("Solid", self))

    @property
    def components(self) -> "tuple[Solid, ...]":
        """The connected parts, each with its cavities, the largest volume first (see `decompose`).

        Formerly this was the number of connected surfaces, now `surface_count`. The number of parts
        is ``len(solid.components)``. A comparison with a number still uses the number of surfaces,
        with a `DeprecationWarning`.

        Examples
        --------
        >>> import bspcsg as csg
        >>> hollow = csg.cube(3) - csg.cube(1).translate(1, 1, 1)
        >>> len(hollow.components), hollow.surface_count
        (1, 2)
        """
        return Components.of(cast("Solid", self))

    def min_gap(self, other: "Solid") -> float:
        """Return the least distance between points of the two solids, in model units.

        It is 0 if they touch or overlap, and infinite if one is empty.

        Raises
        ------
        UnboundedError
            If one of them reaches to infinity, and they do not overlap.

        Notes
        -----
        Overlap is decided exactly. Otherwise boxes around triangles exclude distant pairs, and the
        nearest triangles are compared in fractions; the answer is rounded.

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.cube(1).min_gap(csg.cube(1).translate(4, 5, 0))
        5.0
        """
        from ..modelling.bodies.gaps import min_gap

        return min_gap(cast("Solid", self), other)

    def closest_points(self, other: "Solid") -> tuple[FloatArray, FloatArray]:
        """Return a point of this solid and one of the other that are nearest, (3,) float64 each.

        If there are several such pairs, the choice is reproducible. If the solids overlap, both
        points are one common point.

        Raises
        ------
        InvalidParameterError
            If one of them is empty.
        UnboundedError
            If one of them reaches to infinity, and they do not overlap.

        Examples
        --------
        >>> import bspcsg as csg
        >>> p, q = csg.cube(1).closest_points(csg.cube(1).translate(2, 3, 4))
        >>> p.tolist(), q.tolist()
        ([1.0, 1.0, 1.0], [2.0, 3.0, 4.0])
        """
        from ..modelling.bodies.gaps import closest_points

        return closest_points(cast("Solid", self), other)

    def intersects(self, other: "Solid") -> bool:
        """Say whether the solids have a point in common; touching surfaces suffice.

        To test for common volume, negate `isdisjoint`.

        Raises
        ------
        UnboundedError
            If one of them reaches to infinity.

        Examples
        --------
        >>> import bspcsg as csg
        >>> side = csg.cube(1).translate(1, 0, 0)
        >>> csg.cube(1).intersects(side), csg.cube(1).isdisjoint(side)
        (True, True)
        """
        from ..modelling.bodies.gaps import intersects

        return intersects(cast("Solid", self), other)

    def refine(self, n: int | None = None, *, edge_length: Scalar | None = None) -> "Solid":
        """Return the solid with smaller triangles, for `warp` and other functions of corners.

        Corners stay, and new ones lie on the edges and in the faces, rounded to the lattice. If no
        corner had to be rounded, the set is the same.

        Parameters
        ----------
        n : int
            Each edge is divided into n equal parts, each triangle into n².
        edge_length : float
            Alternatively, halve edges until none is longer, in model units.

        Raises
        ------
        InvalidParameterError
            If not exactly one of the two is given, or it is out of range.
        LimitError
            If there would be more than ten million triangles.
        UnboundedError
            If the solid reaches to infinity.

        Examples
        --------
        >>> import bspcsg as csg
        >>> fine = csg.cube(1).refine(4)
        >>> len(fine.faces), fine == csg.cube(1)
        (192, True)
        """
        from ..modelling.bodies.refining import refine

        return refine(cast("Solid", self), n, edge_length)

    def warp(
        self, f: Callable[[FloatArray], Any], *, winding: WindingRule | None = None
    ) -> "Solid":
        """Return the solid with its corners moved by a function; faces stay flat (see `refine`).

        Parameters
        ----------
        f : callable
            Takes all corners at once, (n, 3) float64 in model units, and returns their new
            positions, an array of the same shape. It may turn the solid inside out.
        winding : {"positive", "nonzero", "even-odd"}, optional
            The winding rule for a result that crosses itself. By default such a result is refused;
            but crossings of touching surfaces that come only from rounding are mended.

        Raises
        ------
        InvalidMeshError
            If faces cross or overlap afterwards ("self_crossing"; `where` lists some), nothing is
            left of any face ("empty_mesh"), or `f` returns another shape or numbers that are not
            finite.
        UnboundedError
            If the solid reaches to infinity.

        Examples
        --------
        >>> import bspcsg as csg
        >>> wedge = csg.cube(2).warp(lambda p: p * [1, 1, 0.5] + p[:, :1] * [0, 0, 0.25])
        >>> wedge.volume, len(wedge.faces)
        (4.0, 12)
        """
        from ..modelling.bodies.warping import warp

        return warp(cast("Solid", self), f, winding)

    def smooth(self, n: int, *, sharp_angle: Scalar = 60.0) -> "Solid":
        """Return the solid with faces bent smoothly through its corners, each in n² triangles.

        Parameters
        ----------
        n : int
            The number of parts of each edge.
        sharp_angle : float
            Edges that bend more than this stay sharp, in degrees from 0 to 180.

        Raises
        ------
        InvalidMeshError
            If bent faces cross ("self_crossing"; `where` lists them).
        LimitError
            If there would be more than ten million triangles.
        UnboundedError
            If the solid reaches to infinity.

        Notes
        -----
        Cubic patches over the triangles, after Vlachos, Peters, Boyd, Mitchell 2001, "Curved PN
        triangles". The border of a patch follows from the normals at both ends of an edge, on both
        sides.

        Examples
        --------
        >>> import bspcsg as csg
        >>> can = csg.cylinder(h=2, r=1, segments=8)
        >>> round(can.volume, 2), round(can.smooth(8).volume, 1)
        (5.66, 6.2)
        """
        from ..modelling.bodies.smoothing import smooth

        return smooth(cast("Solid", self), n, sharp_angle)

    def offset(self, r: Scalar, *, segments: int = SEGMENTS) -> "Solid":
        """Return the solid thickened by a ball, or made thinner if `r` is negative.

        The result is the union of balls about all points of the solid; for a negative `r`, the set
        of points whose ball lies in the solid. The ball is a polyhedron (see `bspcsg.sphere`) with
        its corners at the distance `r`, some of them on the axes. Faces perpendicular to an axis
        move by `r`, others by up to 1 - cos²(180° / `segments`) less.

        Parameters
        ----------
        r : float
            In model units.
        segments : int
            Sides of the ball's equator, at least 4, rounded up to a multiple of 4.

        Raises
        ------
        InvalidParameterError
            If a parameter is out of its range.
        LimitError
            If more than 10 million faces bound what the ball touches (see `bspcsg.minkowski`).
        UnboundedError
            If the solid and its complement both reach to infinity.

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.cube(4).offset(-1) == csg.cube(2).translate(1, 1, 1)
        True
        >>> csg.cube(2).offset(1).bounds.tolist()
        [[-1.0, -1.0, -1.0], [3.0, 3.0, 3.0]]
        """
        from ..modelling.bodies.offsetting import offset

        return offset(cast("Solid", self), r, segments)

    def rounded(self, r: Scalar, *, segments: int = SEGMENTS, inside: bool = False) -> "Solid":
        """Return the solid with its edges rounded: the points that a ball inside it can cover.

        Parameters
        ----------
        r : float
            Radius of the ball, in model units; parts thinner than the ball vanish.
        segments : int
            As for `offset`, as are the errors.
        inside : bool
            True to fill concave edges instead, where a ball outside cannot reach.

        Examples
        --------
        >>> import bspcsg as csg
        >>> die = csg.cube(10).rounded(1)
        >>> die.bounds.tolist(), die < csg.cube(10)
        ([[0.0, 0.0, 0.0], [10.0, 10.0, 10.0]], True)
        """
        from ..modelling.bodies.offsetting import rounded

        return rounded(cast("Solid", self), r, segments, inside)

    def align(
        self,
        *,
        x: "Anchor | None" = None,
        y: "Anchor | None" = None,
        z: "Anchor | None" = None,
        to: "Vector | Solid" = (0, 0, 0),
    ) -> "Solid":
        """Return the solid moved so that its box meets a point or the box of another solid.

        Parameters
        ----------
        x, y, z : {"min", "center", "max"} or a pair of these, optional
            For each axis, the place of this solid's box and the place of the other box to which it
            moves; one name stands for both. Without it the solid does not move along the axis.
        to : (3,) float or Solid

        Raises
        ------
        InvalidParameterError
            If a place has another name, or a solid is empty.
        UnboundedError
            If a solid reaches to infinity.

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.cube(2).align(x="center", y="center", z="min").bounds[0].tolist()
        [-1.0, -1.0, 0.0]
        >>> table, lamp = csg.box((8, 8, 1)), csg.cube(2)
        >>> lamp.align(x="center", z=("min", "max"), to=table).bounds[0].tolist()
        [3.0, 0.0, 1.0]
        """
        from ..modelling.bodies.placing import align

        return align(cast("Solid", self), {"x": x, "y": y, "z": z}, to)

    def normals(self, sharp_angle: Scalar = 30.0) -> FloatArray:
        """Return unit normals for shading, one for each corner of each triangle.

        Parameters
        ----------
        sharp_angle : float
            Corners of faces that meet in edges bent by no more than this share the mean of their
            normals, weighted by the angles at the corner; in degrees from 0 to 180. With 0 these
            are the normals of the faces.

        Returns
        -------
        (m, 3, 3) float64

        Raises
        ------
        UnboundedError
            If the solid reaches to infinity.

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.cube(1).normals().shape
        (12, 3, 3)
        """
        from ..modelling.bodies.shading import normals

        return normals(cast("Solid", self), sharp_angle)

    def curvature(self) -> tuple[FloatArray, FloatArray]:
        """Return the Gaussian and the mean curvature at each vertex, (n,) float64 each.

        The curvatures of the polyhedron, divided by a third of the area of the triangles around the
        vertex: the angle defect, in 1 / unit², and half of the bend of the edges, in 1 / unit. Both
        are positive where the solid is convex.

        Raises
        ------
        UnboundedError
            If the solid reaches to infinity.

        Examples
        --------
        >>> import bspcsg as csg
        >>> gaussian, mean = csg.sphere(2, segments=64).curvature()
        >>> round(float(mean.mean()), 1)
        0.5
        """
        from ..modelling.bodies.shading import curvature

        return curvature(cast("Solid", self))

    @overload
    def ray_cast(self, origin: Vector, direction: Vector) -> "Hits": ...
    @overload
    def ray_cast(self, origin: FloatArray, direction: Any) -> "Hits | HitLists": ...
    def ray_cast(self, origin: Any, direction: Any) -> "Hits | HitLists":
        """Return where rays meet the surface, nearest first, each point once.

        Parameters
        ----------
        origin, direction : (3,) or (n, 3) array_like of float
            The ray holds the points ``origin + t * direction`` with t ≥ 0.

        Returns
        -------
        Hits or HitLists
            The hits of one ray (see `bspcsg.bsp.Hits`), or for arrays a list of them.

        Raises
        ------
        InvalidMeshError
            For a direction of length zero, or numbers that are not finite.
        UnboundedError
            If the surface reaches to infinity.

        Notes
        -----
        The hits are exact. For many calls, make one `bspcsg.bsp.RayCaster` and reuse it.

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.cube(2).ray_cast((1, 0.5, -1), (0, 0, 1)).t
        array([1., 3.])
        """
        from ..modelling.bodies.casting import ray_cast

        return ray_cast(cast("Solid", self), origin, direction)
