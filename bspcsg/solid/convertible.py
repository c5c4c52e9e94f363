"""Methods of solids for files, other libraries, drawings and checks."""

import os
from typing import TYPE_CHECKING, Any, cast, overload

from .._types import Scalar, Vector
from ..errors import deprecated
from ..mesh import leaving
from .counting import uncounted
from .measure import Measured

if TYPE_CHECKING:
    import manifold3d
    import trimesh

    from ..bsp import Region
    from ..verify.check import CheckReport
    from .solid import Solid


class Convertible(Measured):
    """A solid that can be converted to files, other libraries' types and drawings."""

    __slots__ = ()

    def to_trimesh(self) -> "trimesh.Trimesh":
        """Return a `trimesh.Trimesh` with the same vertices and faces, and the attributes.

        The visual has ``"color"``, or a single material with texture coordinates ``"uv"`` of
        vertices; else faces show the colours of their materials. All other arrays of vertices and
        faces keep their names, and the metadata have the materials and the values of corners.
        `Solid.from_mesh` reads all of that back.

        Warns
        -----
        LossWarning
            If a trimesh cannot show an attribute: colours of corners, pictures of several
            materials.
        """
        return leaving.trimesh_of(self.normalized().to_mesh())

    def to_manifold(self) -> "manifold3d.Manifold":
        """Return a `manifold3d.Manifold`; ask its ``status()`` whether it was accepted.

        Numeric attributes become vertex properties: ``"properties"`` first, then the others in
        order, colours as four numbers from 0 to 1. `Solid.from_mesh` restores their names, also
        after Manifold's operations, if all operands had the same attributes.

        Warns
        -----
        LossWarning
            If an attribute is text, as materials are, or not finite.
        """
        return leaving.manifold_of(self.normalized().to_mesh())

    def save(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Write the mesh to a file; the suffix names the format (see `bspcsg.save`)."""
        from ..io import save

        save(cast("Solid", self), path, **options)

    def show(self) -> None:
        """Show the solid in a notebook or in a browser (see `bspcsg.show`)."""
        from ..script.run import show

        show(cast("Solid", self))

    def to_csg(self, *, flat: bool = False) -> str:
        """Return the expression that made the solid as a `.csg` script (see `bspcsg.csg.dumps`)."""
        from ..csg.loading import dumps

        return dumps(cast("Solid", self), flat=flat)

    @classmethod
    def load(cls, path: str | os.PathLike[str], **options: Any) -> "Solid":
        """Read a mesh file; the suffix names the format (see `bspcsg.load`)."""
        from ..io import load

        return load(path, **options)

    @overload
    def slice(
        self,
        offset: Scalar = 0.0,
        normal: str | Vector = (0, 0, 1),
        *,
        origin: Vector | None = None,
    ) -> "Region": ...
    @overload
    def slice(self, offset: Vector, normal: str | Vector = (0, 0, 1)) -> "list[Region]": ...
    def slice(
        self, offset: Any = 0.0, normal: str | Vector = (0, 0, 1), *, origin: Vector | None = None
    ) -> "Region | list[Region]":
        """Return the section by a plane as a region of the plane (`bspcsg.Region`).

        The boundary is cut exactly, by the plane that `half_space` uses for these numbers: the
        given plane if it contains lattice points, else the nearest parallel one that does. Each
        corner of the section is rounded to the nearest lattice point, so corners with lattice
        coordinates are exact.

        Parameters
        ----------
        offset : float or (n,) float
            The plane consists of the points x with ``normal . x == offset``: by default a height z.
            Several offsets give a list of sections.
        normal : "x", "y", "z" or (3,) float
            Need not have unit length. The region is seen from where it points: z gives coordinates
            (x, y), x gives (y, z), y gives (z, x), negative axes exchange the two; for others see
            `bspcsg.bsp.plane_frame`, whose coordinates are rounded once more.
        origin : (3,) float, optional
            A point of the plane, instead of `offset`.

        Raises
        ------
        InvalidMeshError
            If the normal is zero or a number is not finite.
        UnboundedError
            If the solid reaches to infinity.

        Notes
        -----
        A face in the plane counts as above it: the section is the limit from the minus side. For a
        box standing on z = 0 it is empty at z = 0 and full at the top.
        """
        from ..bsp.sets.slicing import slice_solid

        return slice_solid(cast("Solid", self), offset, normal, origin=origin)

    @uncounted
    def project(self) -> "Region":
        """Return the projection along z onto the plane z = 0: all (x, y) of points of the solid.

        To project along another direction, rotate the solid first.

        Raises
        ------
        UnboundedError
            If the solid reaches to infinity.

        Notes
        -----
        The mesh is projected: corners off the lattice are first rounded to it.

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.torus(3, 1, segments=4).rotate(90, "x").project().bounds.tolist()
        [[-4.0, -1.0], [4.0, 1.0]]
        """
        from ..modelling.planar.shadows import shadow

        return shadow(cast("Solid", self))

    @uncounted
    def validate(self, **options: Any) -> "CheckReport":
        """Compare the operation that made this solid with manifold3d (see `bspcsg.validate`)."""
        from ..verify.check import check_result

        return check_result(cast("Solid", self), **options)

    def check(self, **options: Any) -> "CheckReport":
        """Call `validate`; deprecated."""
        deprecated("Solid.check", "validate")
        return self.validate(**options)

    def _repr_html_(self) -> str | None:
        """Return the HTML for a notebook: an interactive view, or the reason why there is none."""
        from ..report.viewer.notebook import solid_html

        return solid_html(cast("Solid", self))

    def _repr_svg_(self) -> str | None:
        """Return a picture as SVG, for notebooks that show neither HTML nor PNG."""
        from ..report.viewer.notebook import solid_svg

        return solid_svg(cast("Solid", self))

    def _repr_png_(self) -> bytes | None:
        """Return a picture as PNG, for notebooks that show nothing else; None without Pillow."""
        from ..report.viewer.notebook import solid_png

        return solid_png(cast("Solid", self))
