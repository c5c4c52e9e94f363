"""Methods of solids for edges, chamfers, fillets and holes."""

from typing import TYPE_CHECKING, Any, cast

from .._types import Scalar
from ..parameters import SEGMENTS
from .counting import counted, uncounted

if TYPE_CHECKING:
    from ..modelling.making.edges import EdgeSelection
    from ..modelling.making.faces import FaceSelection
    from .solid import Solid


class Edged:
    """A solid with edges and faces."""

    __slots__ = ()

    @uncounted
    def edges(self, *, all: bool = False, angle: Scalar = 30.0) -> "EdgeSelection":  # noqa: A002
        """Return the sharp edges of the solid as a selection (see `EdgeSelection`).

        Lines between the facets of a round surface do not count. The rim of a bore does; it
        consists of one edge for each facet.

        Parameters
        ----------
        all : bool
            True for all edges between plane faces, also between facets.
        angle : float
            Degrees; the normals of the faces at an edge differ by more than this.

        Raises
        ------
        InvalidParameterError
            If the angle is not in the range from 0 to below 180.
        UnboundedError
            If the solid reaches to infinity.

        Examples
        --------
        >>> import bspcsg as csg
        >>> part = csg.box(30, 20, 10) - csg.cylinder(10, d=8).translate(15, 10, 0)
        >>> len(part.edges().parallel("z")), len(part.edges(all=True).parallel("z"))
        (4, 36)
        """
        from ..modelling.making.edges import edges_of

        return edges_of(cast("Solid", self), all=all, angle=angle)

    @counted
    def chamfer(self, edges: "EdgeSelection", size: Scalar) -> "Solid":
        """Return the solid with chamfered edges.

        Material is removed along convex edges and added along concave ones. At corners the new
        surfaces meet. If a concave edge ends between two convex ones, or the other way around, it
        is chamfered first, and the two continue along the end of its new surface. If all edges of a
        face with perpendicular walls are selected, as of an extruded text, short edges may vanish.

        Parameters
        ----------
        edges : EdgeSelection
            Some of the solid's own.
        size : float
            Distance from the edge to the new surface, on both faces, in model units.

        Raises
        ------
        InvalidParameterError
            If the faces have no room, if convex and concave edges meet in another way, or if a
            corner of more than three faces is not convex; the message names the place.
        LimitError
            If more than 10 000 edges are chosen.

        Examples
        --------
        >>> import bspcsg as csg
        >>> part = csg.box(10, 10, 10)
        >>> part.chamfer(part.edges().parallel("z"), 1).volume
        980.0
        """
        from ..modelling.making.blends import chamfer

        return chamfer(cast("Solid", self), edges, size)

    @counted
    def fillet(self, edges: "EdgeSelection", radius: Scalar, segments: int = SEGMENTS) -> "Solid":
        """Return the solid with rounded edges.

        Material is removed along convex edges and added along concave ones, up to a cylinder that
        touches both faces. Where three selected edges of one kind meet, the corner is part of a
        ball. Convex and concave edges that meet are rounded one after the other, and short edges of
        a face may vanish, as in `chamfer`.

        Parameters
        ----------
        edges : EdgeSelection
            Some of the solid's own.
        radius : float
            In model units.
        segments : int
            Sides of a full circle, at least 4; all edges get as many sides as the sharpest needs.

        Raises
        ------
        InvalidParameterError
            As for `chamfer`, or if more than three rounded edges meet. If edges of both kinds meet,
            the later ones run along the facets of the earlier fillets, which have no room if they
            are narrower than the radius; the message names the place.
        LimitError
            If more than 10 000 edges are chosen, or the solid would have too many corners.

        Examples
        --------
        >>> import bspcsg as csg
        >>> part = csg.box(4, 3, 2)
        >>> part.fillet(part.edges(), 0.5) == csg.rounded_box((4, 3, 2), 0.5)
        True
        """
        from ..modelling.making.blends import fillet

        return fillet(cast("Solid", self), edges, radius, segments)

    @counted
    def hole(
        self,
        face: "FaceSelection",
        at: Any = None,
        *,
        d: Scalar | None = None,
        r: Scalar | None = None,
        depth: Scalar | None = None,
        segments: int = SEGMENTS,
    ) -> "Solid":
        """Return the solid with round holes, perpendicular to a face.

        Parameters
        ----------
        face : FaceSelection
            One flat face. It may come from the solid before other holes were made.
        at : (3,) or (n, 3) float, optional
            The centres of the holes: one or more points on the face. By default its middle.
        d, r : float
            Diameter, or radius instead.
        depth : float, optional
            Depth of the holes. By default they go through the whole solid.
        segments : int
            Sides around, at least 3.

        Raises
        ------
        InvalidParameterError
            If the selection is not one flat face, the solid has no such face at a point, or a
            number is out of range.

        Examples
        --------
        >>> import bspcsg as csg
        >>> plate = csg.box(30, 20, 5)
        >>> top = plate.faces().sort_by("z")[-1]
        >>> plate.hole(top, [(5, 5, 5), (25, 5, 5)], d=4).genus
        2
        >>> plate.hole(top, r=4, depth=2, segments=4).volume
        2936.0
        """
        from ..modelling.making.drilling import hole

        return hole(cast("Solid", self), face, at, d=d, r=r, depth=depth, segments=segments)

    @counted
    def counterbore(
        self,
        face: "FaceSelection",
        at: Any = None,
        *,
        d: Scalar | None = None,
        r: Scalar | None = None,
        head_d: Scalar | None = None,
        head_r: Scalar | None = None,
        head_depth: Scalar,
        depth: Scalar | None = None,
        segments: int = SEGMENTS,
    ) -> "Solid":
        """Return the solid with holes that are wider at a face, for cylindrical heads of screws.

        Parameters
        ----------
        face : FaceSelection
        at : (3,) or (n, 3) float, optional
        d, r : float
        depth : float, optional
        segments : int
            As for `hole`; the depth is that of the whole hole.
        head_d, head_r : float
            Diameter of the wide part, or radius instead.
        head_depth : float
            Depth of the wide part.

        Raises
        ------
        InvalidParameterError
            As for `hole`, or if the wide part is not wider or not less deep than the hole.

        Examples
        --------
        >>> import bspcsg as csg
        >>> plate = csg.box(30, 20, 8)
        >>> top = plate.faces().sort_by("z")[-1]
        >>> screwed = plate.counterbore(top, d=4.5, head_d=8, head_depth=4.4)
        >>> screwed.genus, len(screwed.faces())
        (1, 9)
        """
        from ..modelling.making.drilling import counterbore

        return counterbore(
            cast("Solid", self),
            face,
            at,
            d=d,
            r=r,
            head_d=head_d,
            head_r=head_r,
            head_depth=head_depth,
            depth=depth,
            segments=segments,
        )

    @counted
    def countersink(
        self,
        face: "FaceSelection",
        at: Any = None,
        *,
        d: Scalar | None = None,
        r: Scalar | None = None,
        head_d: Scalar | None = None,
        head_r: Scalar | None = None,
        angle: Scalar = 90.0,
        depth: Scalar | None = None,
        segments: int = SEGMENTS,
    ) -> "Solid":
        """Return the solid with holes that open as a cone at a face, for flat heads of screws.

        Parameters
        ----------
        face : FaceSelection
        at : (3,) or (n, 3) float, optional
        d, r : float
        depth : float, optional
        segments : int
            As for `hole`; the depth is that of the whole hole.
        head_d, head_r : float
            Diameter of the cone in the face, or radius instead.
        angle : float
            Degrees from side to side of the cone: 90 for metric screws, 82 for those in inches.

        Raises
        ------
        InvalidParameterError
            As for `hole`, or if the cone is not wider, or deeper than the hole.

        Examples
        --------
        >>> import bspcsg as csg
        >>> plate = csg.box(30, 20, 5)
        >>> top = plate.faces().sort_by("z")[-1]
        >>> screwed = plate.countersink(top, [(5, 10, 5), (25, 10, 5)], d=4.5, head_d=9)
        >>> screwed.genus, len(screwed.faces())
        (2, 10)
        """
        from ..modelling.making.drilling import countersink

        return countersink(
            cast("Solid", self),
            face,
            at,
            d=d,
            r=r,
            head_d=head_d,
            head_r=head_r,
            angle=angle,
            depth=depth,
            segments=segments,
        )
