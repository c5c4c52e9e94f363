"""The methods that make things of a solid with the floors above, apart from the value."""

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
    """A solid as modelling sees it."""

    __slots__ = ()

    def split(self, normal: "str | Vector | Solid", offset: Scalar = 0.0) -> "tuple[Solid, Solid]":
        """Return the solid in two: what lies on either side of a plane, or of another's surface.

        Both have the cut as a face; together they are the solid again, exactly.

        Parameters
        ----------
        normal : "x", "y", "z", (3,) float, or Solid
            Of the plane; need not have unit length. Or the solid to cut with.
        offset : float
            The plane holds the points x with ``normal . x == offset``.

        Returns
        -------
        Solid, Solid
            The part with ``normal . x <= offset``, and the rest. Of a cut by a solid: what is
            inside that, and the rest. Either may be empty.

        Raises
        ------
        InvalidMeshError
            If the normal is zero or a number is not finite ("bad_normal").

        Notes
        -----
        The plane is that of `bspcsg.half_space`: the one asked for if it holds lattice points, else
        the nearest of its direction that does. In a block (see `bspcsg.block`) neither counts.

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
        """Return what lies on the side of a plane where its normal points: the second of `split`.

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

        The wall of a cavity stays with the part around it. Parts that touch in a point or an edge
        only are apart.

        Raises
        ------
        UnboundedError
            If the solid reaches to infinity.

        Notes
        -----
        Of several parts each is the solid of its mesh: corners that are no lattice points are
        rounded to them, or to those of a finer lattice where nothing would be left. A part that is
        too thin for doubles is left out. In a block (see `bspcsg.block`) none of them counts.

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

        Before, this was the number of connected surfaces: that is `surface_count`, and the number
        of parts is ``len(solid.components)``. Compared with a number, the parts answer as that did,
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
        """Return the least distance of a point of one solid from one of the other.

        It is 0 where they touch or overlap, and infinite if one is empty.

        Raises
        ------
        UnboundedError
            If one of them reaches to infinity, and they do not overlap.

        Notes
        -----
        Whether they overlap is decided exactly. Else boxes around triangles rule out what is far,
        and the nearest triangles are compared in fractions; the answer is rounded.

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

        Of several such pairs it is always the same one. Where the solids overlap, both are one
        point of both.

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
        """Say whether the solids have a point in common; a common point of their surfaces will do.

        Whether they have volume in common is the opposite of `isdisjoint`.

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
        """Return the solid with smaller triangles, for `warp` and for what works corner by corner.

        Corners stay, and new ones lie on the edges and in the faces, rounded to the lattice; where
        nothing had to be rounded, it is the same set.

        Parameters
        ----------
        n : int
            Each edge falls into n equal parts, each triangle into n².
        edge_length : float
            Or: edges are halved until none is longer, in model units.

        Raises
        ------
        InvalidParameterError
            If not just one of the two is given, or it is out of range.
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
            Takes all corners at once, (n, 3) float64 in model units, and returns where they go, an
            array of the same shape. It may turn the solid inside out.
        winding : {"positive", "nonzero", "even-odd"}, optional
            The winding numbers inside a result that crosses itself. By default such a result is
            refused, but where only rounding makes surfaces cross that touched: that is mended.

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
            Into how many parts each edge falls.
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
        triangles". Their borders follow from the normals at both ends of an edge, on both sides.

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

        All points of the ball about any point of the solid are in the result; for a negative `r`
        those points are whose ball lies in the solid. The ball is a polyhedron (see
        `bspcsg.sphere`) with its corners at the distance `r`, some of them on the axes: faces
        across these move by `r`, others up to 1 - cos² of 180° by `segments` less.

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
        """Return the solid with its edges rounded: what a ball that stays inside can reach.

        Parameters
        ----------
        r : float
            Of the ball, in model units; what is thinner than it vanishes.
        segments : int
            As for `offset`, as are the errors.
        inside : bool
            True to fill the edges that go inwards instead, where a ball outside cannot reach.

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
            The place of this solid's box and that of the other's where it goes, along each axis;
            one name stands for both. Without it the solid does not move along the axis.
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

        Of the polyhedron, spread over a third of the triangles around the vertex: the angle that
        lacks to a full turn, and half of the bend of the edges there; in units of one by model
        units squared, and one by model units. Positive where the solid is convex.

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
            Of one ray its hits (see `bspcsg.bsp.Hits`); of arrays a list of these.

        Raises
        ------
        InvalidMeshError
            For a direction of length zero, or numbers that are not finite.
        UnboundedError
            If the surface reaches to infinity.

        Notes
        -----
        It is exact (see `bspcsg.bsp.RayCaster`, which for many calls is made only once).

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.cube(2).ray_cast((1, 0.5, -1), (0, 0, 1)).t
        array([1., 3.])
        """
        from ..modelling.bodies.casting import ray_cast

        return ray_cast(cast("Solid", self), origin, direction)
