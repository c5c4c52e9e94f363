"""`Solid`: a set of points with a polyhedral boundary, as an immutable value.

A solid is a lazy expression under a transform. The first query evaluates the expression once; the
result is cached and the expression released. Queries rely on one of two guarantees:

* the set of points is always right: `to_mesh`, `vertices` and `faces` need no more than this;
* the mesh is the reduced boundary, every wall between inside and outside exactly once: `volume`,
  `equals`, `save` and the like use `normalized`, which checks inputs that are not `trusted`.
"""

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any, overload

from .._core import Tree
from .._types import FloatArray, ProgramLine, Scalar, SideArray, Vector, WindingRule
from ..attributes.attributes import Attributes, GivenAttributes
from ..attributes.material import Material
from ..errors import BspcsgError, Finding, core_errors, deprecated
from ..geometry.chain import IDENTITY_CHAIN, FactorChain, common_prefix
from ..geometry.transform import Factors
from ..mesh import interop, library_export, visuals
from ..mesh.mesh import Mesh
from ..method_ownership import with_own_methods
from ..parameters import (
    SEGMENTS,
    instance_of,
    no_options,
    not_negative,
    optional_pitch,
    positive,
    truth_value,
    winding_rule,
)
from .components import Components
from .describe import describe
from .expression import ExpressionNode, PlacedNode, complement, evaluate, operation
from .leaf import (
    ConstantLeaf,
    ExpressionLeaf,
    MeshLeaf,
    Record,
    TreeLeaf,
    bounded_on_one_lattice,
    mesh_tree_of,
    tagged_leaf,
    tree_of,
)
from .ledger import count, counted, uncounted
from .measure import (
    LONGEST_VOLUME,
    exact_volume,
    findings_of,
    residues_of_volume,
    rounded_volume,
    volume_near,
    volume_residues,
)
from .movable import Movable
from .point_classification import sides_of
from .point_set import PointSet
from .profile import Profile
from .program import Operator
from .source_attributes import SourceAttributes, inherited, later_attributes
from .triangles import Triangles, triangles_of

if TYPE_CHECKING:
    import manifold3d
    import trimesh

    from ..bsp import HitLists, Hits, Region
    from ..modelling.bodies.alignment import Anchor
    from ..modelling.making.edges import EdgeSelection
    from ..modelling.making.faces import FaceSelection
    from ..verify.check import CheckReport

#: The largest number of faces of a result whose mesh is made for `repr`, which takes some
#: hundredths of a second.
_MAX_FACES_FOR_REPR = 20_000


@with_own_methods
class Solid(Movable, PointSet):
    """A closed triangle mesh as a set of points.

    A point is inside if the winding number of the faces satisfies the rule; faces may cross,
    overlap, touch or repeat. Coordinates are snapped to a decimal lattice, by default of step 1e-9.

    ``==``, ``<=``, ``<``, ``in`` and the like compare solids as Python compares sets: solids are
    equal if they are the same set of points, however they were made. Comparisons are exact, and
    evaluate the solids, as `hash` does; use ``is`` to compare objects.

    Parameters
    ----------
    vertices : (n, 3) array_like of float
        In model units.
    faces : (m, 3) array_like of int, or sequence of index sequences
        Indices of `vertices`, counter-clockwise seen from outside. Polygons are triangulated.
    pitch : int, optional
        The lattice step is ``10**pitch`` units. By default -9, or another if the size requires it.
        Transforms keep a given pitch, unless the result exceeds the range of its lattice.
    trusted : bool
        True if you guarantee that faces meet only in common edges and vertices; a check is then
        omitted.
    winding : {"positive", "nonzero", "even-odd"}
        The rule that says which winding numbers are inside.
    vertex_attributes : dict of str to (n, …) array_like, optional
        Named arrays with one value for each vertex: colours, texture coordinates, weights.
    corner_attributes : dict of str to (m, 3, …) array_like, optional
        Named arrays with one value for each corner of each triangle, for values that differ between
        the faces at a vertex.
    face_attributes : dict of str to (m, …) array_like, optional
        Named arrays with one value for each triangle.
    materials : dict of str to Material, optional
        The materials that the face attribute ``"material"`` names.

    Raises
    ------
    InvalidMeshError
        If the mesh is not closed (`where` lists faces), has no faces, has coordinates that are not
        finite, indices out of range, or arrays of another shape.
    LimitError
        If the coordinates do not fit on the lattice of the given pitch.

    Notes
    -----
    Attributes follow the faces through all operations and transforms to the result's mesh
    (`Mesh.vertex_attributes`, `corner_attributes`, `face_attributes`). Values of faces are copied.
    Values of vertices and corners are copied at corners of the source, and interpolated in the
    source's triangle elsewhere: integers are rounded; truth values and text come from the nearest
    corner. ``"color"`` takes any form of colour (texts, integers from 0 to 255, floats from 0 to
    1), one for each element or one for all elements. Coplanar faces with different values are
    not joined. If an operand lacks an attribute, its values are NaN, 0, False or empty text; a
    ``"color"`` of integers is opaque white there, and a colour that is NaN is shown as white.
    Attributes called ``"normal"`` or ``"normals"``, of three floats, turn with the solid, keep
    their length, and are reversed where the solid was subtracted. `simplify` drops attributes.

    Examples
    --------
    >>> import bspcsg as csg
    >>> part = csg.cube(2) - csg.cube(1)
    >>> part
    Solid(pending: 2 operands)
    >>> part.volume
    7.0
    >>> (part | csg.cube(1)).equals(csg.cube(2))
    True
    """

    __slots__ = ("__weakref__", "_factors", "_mesh", "_node", "_placed", "_reduced")

    def __init__(
        self,
        vertices: Any,
        faces: Any,
        *,
        pitch: int | None = None,
        trusted: bool = False,
        winding: WindingRule = "positive",
        vertex_attributes: Mapping[str, Any] | None = None,
        corner_attributes: Mapping[str, Any] | None = None,
        face_attributes: Mapping[str, Any] | None = None,
        materials: Mapping[str, Material] | None = None,
    ) -> None:
        rule, chosen = winding_rule(winding), optional_pitch(pitch)
        arrays = interop.mesh_arrays(vertices, faces)
        given = GivenAttributes(vertex_attributes, corner_attributes, face_attributes, materials)
        said = given.over(len(arrays[0]), arrays[1])
        leaf = MeshLeaf(
            *arrays,
            pitch=chosen,
            trusted=truth_value(trusted, "trusted"),
            winding=rule,
            attributes=said,
        )
        # Raise errors in a mesh here, on the user's line, not in the first query.
        leaf.own_tree()
        leaf.release_arrays()
        self._set(ExpressionNode(leaf), IDENTITY_CHAIN)
        count(self)

    def _set(self, node: ExpressionNode, factors: FactorChain) -> None:
        self._node = node
        self._factors = factors
        self._placed: ExpressionLeaf | None = None
        self._mesh: Mesh | None = None
        self._reduced: Solid | None = None

    @classmethod
    def _of(cls, node: ExpressionNode, factors: FactorChain = IDENTITY_CHAIN) -> "Solid":
        solid = cls.__new__(cls)
        solid._set(node, factors)
        return solid

    @classmethod
    @counted
    def from_mesh(
        cls,
        mesh: Any,
        *,
        format: str | None = None,  # noqa: A002
        tolerance: float = interop.TESSELLATION_TOLERANCE,
        **options: Any,
    ) -> "Solid":
        """Return the solid that an object with a mesh describes.

        Parameters
        ----------
        mesh : object
            A trimesh, manifold3d, pymeshlab, open3d, pyvista, vtk or meshio mesh, a CadQuery or
            build123d shape, an `Assembly`, a pair (vertices, faces) as libigl has it, a path, the
            bytes of a file or an open one, or anything that has ``vertices`` and ``faces``. A
            `Solid` is returned as it is and takes no options, nor does an `Assembly`. A mesh
            without vertices and faces is the empty set.
        format : str, optional
            For bytes and open files: the suffix of the format, such as ``"stl"``.
        tolerance : float
            The largest deviation of triangles from the true surface of a CAD shape, in model units.
        **options
            Keyword arguments of `Solid`, such as `pitch`.

        Raises
        ------
        InvalidMeshError
            If the object has no mesh, or its mesh is invalid as described for `Solid`.
        InvalidParameterError
            If options are given with a solid.
        FormatError
            If a file cannot be read in its format.

        Notes
        -----
        Coordinates are taken as they are: those of pyvista and of files in binary STL have single
        precision, unless a pyvista mesh was made of float64 points.

        Attributes are kept: those of a `Mesh` of this package, of a trimesh (colours as
        ``"color"``, texture coordinates as ``"uv"``, materials), of manifold3d as ``"properties"``,
        or under their names if they came from `to_manifold`, and point and cell data of pyvista and
        meshio.
        """
        if isinstance(mesh, (str, os.PathLike)):
            return cls.load(mesh, **options)
        if isinstance(mesh, Solid) or hasattr(mesh, "to_solid"):
            no_options(options, mesh)
            whole: Solid = mesh if isinstance(mesh, Solid) else mesh.to_solid()
            return whole
        if isinstance(mesh, (bytes, bytearray, memoryview)) or hasattr(mesh, "readable"):
            from ..io import loads

            suffix = None if format is None else instance_of(str, format, "format")
            return loads(mesh, suffix, **options)
        arrays = interop.arrays_from(mesh, positive(tolerance, "tolerance"))
        if interop.are_empty(arrays):
            return cls.empty()
        return cls(*arrays, **{**visuals.attributes_from(mesh, *arrays), **options})

    @classmethod
    def load(cls, path: str | os.PathLike[str], **options: Any) -> "Solid":
        """Read a mesh file; the suffix names the format (see `bspcsg.load`)."""
        from ..io import load

        return load(path, **options)

    @classmethod
    @counted
    def empty(cls) -> "Solid":
        """Return the empty set."""
        return cls._of(ExpressionNode(ConstantLeaf(full=False)))

    @classmethod
    @counted
    def full(cls) -> "Solid":
        """Return all of space."""
        return cls._of(ExpressionNode(ConstantLeaf(full=True)))

    # Set operations

    @counted
    def __or__(self, other: object) -> "Solid":
        """Union of this solid and the other one."""
        return combine("or", (self, other)) if isinstance(other, Solid) else NotImplemented

    __add__ = __or__

    def __radd__(self, other: object) -> "Solid":
        """Return the solid itself for ``0 + solid``, with which ``sum(solids)`` starts."""
        return self if isinstance(other, int) and other == 0 else NotImplemented

    @counted
    def __and__(self, other: object) -> "Solid":
        """Intersection of this solid and the other one."""
        return combine("and", (self, other)) if isinstance(other, Solid) else NotImplemented

    @counted
    def __sub__(self, other: object) -> "Solid":
        """Difference: this solid without the other one."""
        return combine("and", (self, ~other)) if isinstance(other, Solid) else NotImplemented

    @counted
    def __xor__(self, other: object) -> "Solid":
        """Symmetric difference, as for Python's sets (manifold3d's ``^`` is the intersection)."""
        return combine("xor", (self, other)) if isinstance(other, Solid) else NotImplemented

    @counted
    def __invert__(self) -> "Solid":
        """Complement: all of space outside this solid."""
        return from_node(*complement(PlacedNode(self._node, self._factors)))

    # Results

    @property
    def tree(self) -> Tree:
        """The solid's partition tree, an object of the compiled core; this evaluates the solid."""
        return mesh_tree_of(self._leaf())

    def _leaf(self) -> ExpressionLeaf:
        """Evaluate the solid and return its leaf, to which the transform has been applied."""
        if self._placed is None:
            evaluate(self._node)
            self._placed = self._node.placed(self._factors)
        return self._placed

    @property
    def _source_attributes(self) -> SourceAttributes:
        """The attributes of each source (input mesh) of the tree; empty if no source has any."""
        return self._leaf().source_attributes

    def to_mesh(self) -> Mesh:
        """Return the boundary as a closed mesh, with read-only arrays; the mesh is cached.

        Faces of inputs that were not cut are unchanged. If an input overlaps itself, its walls
        inside the solid remain where no operation met them; `normalized` removes them.

        Raises
        ------
        UnboundedError
            If the solid reaches to infinity.
        """
        if self._mesh is None:
            self._mesh = self._made_mesh()
        return self._mesh

    def _made_mesh(self) -> Mesh:
        return _mesh_of(self.tree, self._source_attributes)

    def _divided_mesh(self) -> Mesh:
        """Return the reduced boundary, with faces divided where the surface touches itself."""
        reduced = self.normalized()
        with core_errors():
            divided = reduced.tree.divided()
        return (
            reduced.to_mesh() if divided is None else _mesh_of(divided, reduced._source_attributes)
        )

    def _surfaces_and_euler_number(self) -> tuple[int, int]:
        """Return the number of surfaces and the Euler number; equal solids have equal ones."""
        tree = self.normalized().tree
        with core_errors():
            return tree.surfaces_and_euler_number()

    def normalized(self) -> "Solid":
        """Return the same set with a reduced mesh: each wall between inside and outside once.

        Inputs that are not trusted are checked once, and united with themselves if their faces
        overlap. Measures, comparisons, checks and file output use the normalized solid.
        """
        tree = self.tree
        if self._reduced is None and not _is_reduced(tree):
            with core_errors():
                reduced = tree.normalized()
            # If the check found nothing to change, the tree itself is the reduced one.
            if not _is_reduced(tree):
                source_attributes = inherited(reduced, [(tree, self._source_attributes)])
                given = self._leaf().given_pitch
                self._reduced = from_leaf(
                    TreeLeaf(reduced, source_attributes=source_attributes, given_pitch=given)
                )
        return self if self._reduced is None else self._reduced

    @property
    def vertices(self) -> FloatArray:
        """Vertices of the solid's mesh, (n, 3) float64, in model units, read-only."""
        return self.to_mesh().vertices

    @property
    def faces(self) -> Triangles:
        """Triangles of the solid's mesh, (m, 3) int64, indices of `vertices`, read-only.

        Call it, as ``solid.faces()``, to select faces: flat ones, and round ones such as the wall
        of a bore (see `FaceSelection`). Neighbouring facets belong to one round face if they bend
        by at most 30 degrees, or another ``angle``, and neither is more than twice as wide as the
        other; ``all=True`` returns the facets one by one.

        Examples
        --------
        >>> import bspcsg as csg
        >>> part = csg.cylinder(10, d=8)
        >>> part.faces.shape, len(part.faces()), len(part.faces(all=True))
        ((124, 3), 3, 34)
        >>> part.faces().sort_by("z")[-1].normal.tolist()
        [[0.0, 0.0, 1.0]]
        """
        return triangles_of(self, self.to_mesh().faces)

    @property
    def sources(self) -> tuple[int, ...]:
        """Identities of the input meshes, to which `Mesh.source` refers by index in this tuple."""
        return tuple(self.tree.sources)

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The findings about the input meshes and the solid's mesh, which is made and checked.

        "self_overlap" means that the mesh is not the boundary of the solid, and names triangles
        that cross or overlap others; `normalized` returns the solid with its boundary as mesh.
        "crossing" means that an input crosses itself by less than a step of the lattice. "flat"
        names triangles with area on the lattice, but none in the doubles of the mesh. The
        certificate of the mesh has no other faults.
        """
        return findings_of(self)

    @property
    def pitch(self) -> int:
        """Exponent of the lattice step: it is ``10**pitch`` model units."""
        return self.tree.pitch

    # History

    @property
    def last_operation(self) -> "LastOperation | None":
        """The operation that made this solid; None for a mesh, a loaded or an unpickled solid.

        This is the program of the last evaluation, with its operands. If each result of a chain of
        operations is queried, it has one operation; if only the last result is queried, the chain
        is evaluated as a whole, and the program has all of its operations.
        """
        content = evaluate(self._node)
        if not isinstance(content, TreeLeaf) or content.record is None:
            return None
        record = content.record
        operands = tuple(from_leaf(leaf) for leaf in record.leaves)
        program = [(name, list(lines)) for name, lines in record.program]
        return LastOperation(program, operands, from_node(self._node))

    def profile(self) -> Profile:
        """Return the times and counts of the stages of the solid's evaluation; empty for a mesh.

        Operations on two different unchanged meshes take a fast path, which looks only at faces
        that may meet; `Profile.handed_on` has the reason why an evaluation could not take it, and
        `Profile.kernels` how often each method was asked, and why it refused.

        Examples
        --------
        >>> import bspcsg as csg
        >>> part = csg.cube(2) - csg.cube(1).translate(1.5, 1.5, 1.5)
        >>> [stage.name for stage in part.profile().stages]
        ['candidates', 'contacts', 'faces']
        """
        content = evaluate(self._node)
        return Profile.of(content.result) if isinstance(content, TreeLeaf) else Profile()

    # Queries

    @property
    def is_empty(self) -> bool:
        """True if the solid has no volume."""
        return self.normalized().tree.is_empty

    @property
    def is_bounded(self) -> bool:
        """True if the solid fits into some box: it does not reach to infinity."""
        return self.tree.is_bounded

    @uncounted
    def equals(self, other: "Solid") -> bool:
        """Return true if both solids are exactly the same set of points, as ``==`` does."""
        return (self ^ instance_of(Solid, other, "other")).is_empty

    @uncounted
    def isdisjoint(self, other: "Solid") -> bool:
        """Return true if the two solids have no volume in common; they may touch."""
        return (self & instance_of(Solid, other, "other")).is_empty

    def intersects(self, other: "Solid") -> bool:
        """Return true if the solids have a point in common; it suffices that their surfaces touch.

        To test for common volume, negate `isdisjoint`.

        Raises
        ------
        UnboundedError
            If one of the solids reaches to infinity.

        Examples
        --------
        >>> import bspcsg as csg
        >>> side = csg.cube(1).translate(1, 0, 0)
        >>> csg.cube(1).intersects(side), csg.cube(1).isdisjoint(side)
        (True, True)
        """
        from ..modelling.bodies.gaps import intersects

        return intersects(self, other)

    def _is_alike(self, other: object) -> bool:
        return isinstance(other, Solid)

    @uncounted
    def _size_key(self) -> object:
        if self.normalized().is_bounded:
            return residues_of_volume(self)
        outside = self._outside()
        # If both are unbounded, no cheap test can distinguish solids.
        bounded = outside.is_bounded
        return ("outside", residues_of_volume(outside)) if bounded else "unbounded"

    @uncounted
    def _outside(self) -> "Solid":
        """Return the complement with its reduced boundary."""
        return (~self).normalized()

    def classify(self, points: Any) -> SideArray:
        """Classify points as inside, outside or on the boundary, exactly.

        Parameters
        ----------
        points : (k, 3) array_like of float
            In model units; snapped to the lattice. For a bounded solid, points may lie anywhere.

        Returns
        -------
        (k,) int8
            +1 inside, 0 on the boundary, -1 outside.
        """
        return sides_of(interop.points_array(points), self.normalized().tree)

    def min_gap(self, other: "Solid") -> float:
        """Return the least distance between points of the two solids, in model units.

        It is 0 if the solids touch or overlap, and infinite if one of them is empty.

        Raises
        ------
        UnboundedError
            If one of the solids reaches to infinity, and they do not overlap.

        Notes
        -----
        Overlap is decided exactly. Otherwise boxes around triangles exclude distant pairs, and the
        nearest triangles are compared in fractions; the distance is rounded.

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.cube(1).min_gap(csg.cube(1).translate(4, 5, 0))
        5.0
        """
        from ..modelling.bodies.gaps import min_gap

        return min_gap(self, other)

    def closest_points(self, other: "Solid") -> tuple[FloatArray, FloatArray]:
        """Return the point of this solid and the point of the other that are nearest to each other.

        Both are (3,) float64, in model units. If several pairs are nearest, the choice is
        reproducible. If the solids overlap, both points are the same common point.

        Raises
        ------
        InvalidParameterError
            If one of the solids is empty.
        UnboundedError
            If one of the solids reaches to infinity, and they do not overlap.

        Examples
        --------
        >>> import bspcsg as csg
        >>> p, q = csg.cube(1).closest_points(csg.cube(1).translate(2, 3, 4))
        >>> p.tolist(), q.tolist()
        ([1.0, 1.0, 1.0], [2.0, 3.0, 4.0])
        """
        from ..modelling.bodies.gaps import closest_points

        return closest_points(self, other)

    @overload
    def ray_cast(self, origin: Vector, direction: Vector) -> "Hits": ...
    @overload
    def ray_cast(self, origin: FloatArray, direction: Any) -> "Hits | HitLists": ...
    def ray_cast(self, origin: Any, direction: Any) -> "Hits | HitLists":
        """Return the points where rays meet the surface, nearest first, each point once.

        Parameters
        ----------
        origin, direction : (3,) or (n, 3) array_like of float
            A ray consists of the points ``origin + t * direction`` with t ≥ 0.

        Returns
        -------
        Hits or HitLists
            The hits of one ray (see `bspcsg.bsp.Hits`), or for arrays of rays, those of each ray.

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
        from ..modelling.bodies.ray_casting import ray_cast

        return ray_cast(self, origin, direction)

    # Measures

    @property
    def volume(self) -> float:
        """Volume in cubic model units, computed exactly and then rounded once."""
        return rounded_volume(self)

    @property
    def volume_exact(self) -> Fraction:
        """Volume in cubic model units, as an exact fraction.

        Raises
        ------
        UnboundedError
            If the solid reaches to infinity; so for all measures.
        LimitError
            If the fraction might have more than 200 000 digits; see `exact_volume`.
        """
        return self.exact_volume()

    def exact_volume(self, most_digits: int = LONGEST_VOLUME) -> Fraction:
        """Return the volume in cubic model units, as an exact fraction.

        Its denominator has about as many digits as those of all constructed corners together.
        Reducing the fraction takes time quadratic in the number of digits, and cannot be
        interrupted.

        Parameters
        ----------
        most_digits : int
            The largest allowed number of decimal digits of numerator and denominator.

        Raises
        ------
        UnboundedError
            If the solid reaches to infinity.
        LimitError
            If numerator or denominator might have more digits; the message has their number.
        """
        return exact_volume(self, most_digits)

    @property
    def volume_near(self) -> Fraction:
        """Volume to within 2**-100 cubic lattice steps; deprecated, see `exact_volume`."""
        deprecated("Solid.volume_near", "volume or exact_volume")
        return volume_near(self)

    @property
    def volume_residues(self) -> tuple[int, int] | None:
        """Six times the volume modulo two primes; deprecated, compare solids by ``==``."""
        deprecated("Solid.volume_residues", "== or exact_volume")
        return volume_residues(self)

    @property
    def area(self) -> float:
        """Surface area in square model units; the complement has the same area.

        Raises
        ------
        UnboundedError
            If the solid and its complement both reach to infinity.
        """
        reduced = self.normalized()
        return (reduced if reduced.is_bounded else self._outside()).to_mesh().area

    @property
    def centroid(self) -> FloatArray:
        """Centre of volume, (3,) float64, in model units; NaN for the empty set."""
        return self.normalized().to_mesh().centroid

    @property
    def inertia(self) -> FloatArray:
        """Moments of inertia about the centroid at density 1, (3, 3) float64.

        In model units to the fifth power; NaN for the empty set.
        """
        return self.normalized().to_mesh().inertia

    @property
    def bounds(self) -> FloatArray | None:
        """The bounding box: lowest, then highest x, y and z, (2, 3) float64; None if empty."""
        return self.normalized().to_mesh().bounds

    @property
    def euler_number(self) -> int:
        """The number of vertices minus edges plus triangles of the boundary.

        Equal solids have equal Euler numbers, whatever their meshes. Where the boundary touches
        itself, a point or an edge counts once for each of the surfaces that `surface_count` has
        there.
        """
        return self._surfaces_and_euler_number()[1]

    @property
    def surface_count(self) -> int:
        """Number of connected surfaces of the boundary; the wall of a cavity counts separately.

        Formerly `components` was this number; now it is the tuple of connected parts. Parts that
        touch only in a point or an edge have separate surfaces, even if the edge lies inside a face
        that belongs to both and that the mesh does not divide there: around an edge, two walls go
        over into each other if they bound the same wedge of the inside. Equal solids have equally
        many surfaces, whatever their meshes.
        """
        return self._surfaces_and_euler_number()[0]

    @property
    def genus(self) -> int:
        """Number of handles, as a torus has one, summed over all connected surfaces."""
        surfaces, euler_number = self._surfaces_and_euler_number()
        return surfaces - euler_number // 2

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

        return normals(self, sharp_angle)

    def curvature(self) -> tuple[FloatArray, FloatArray]:
        """Return the Gaussian and the mean curvature at each vertex, (n,) float64 each.

        Gaussian: the angle defect at the vertex, in 1 / unit². Mean: half of the bend of its edges,
        in 1 / unit. Both are divided by a third of the area of the triangles around the vertex, and
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

        return curvature(self)

    # Motions

    @counted
    def _moved(self, factors: Factors) -> "Solid":
        kept = tuple(factor for factor in factors if not factor.is_identity)
        return from_node(self._node, self._factors.under(kept)) if kept else self

    def align(
        self,
        *,
        x: "Anchor | None" = None,
        y: "Anchor | None" = None,
        z: "Anchor | None" = None,
        to: "Vector | Solid" = (0, 0, 0),
    ) -> "Solid":
        """Return the solid translated so that its box meets a point or another solid's box.

        Parameters
        ----------
        x, y, z : {"min", "center", "max"} or a pair of these, optional
            For each axis, a position in this solid's box and the position in the target's box to
            which it moves; a single name means both. If omitted, the solid does not move along that
            axis.
        to : (3,) float or Solid
            The target: a point, or a solid whose box is meant.

        Raises
        ------
        InvalidParameterError
            If a position has another name, or one of the solids is empty.
        UnboundedError
            If one of the solids reaches to infinity.

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.cube(2).align(x="center", y="center", z="min").bounds[0].tolist()
        [-1.0, -1.0, 0.0]
        >>> table, lamp = csg.box((8, 8, 1)), csg.cube(2)
        >>> lamp.align(x="center", z=("min", "max"), to=table).bounds[0].tolist()
        [3.0, 0.0, 1.0]
        """
        from ..modelling.bodies.alignment import align

        return align(self, {"x": x, "y": y, "z": z}, to)

    # Modelling

    def split(self, normal: "str | Vector | Solid", offset: Scalar = 0.0) -> "tuple[Solid, Solid]":
        """Split the solid by a plane or by another solid.

        Both parts have the cut as a face; their union is exactly the solid.

        Parameters
        ----------
        normal : "x", "y", "z", (3,) float, or Solid
            The normal of the plane, of any length; or the solid to cut with.
        offset : float
            The plane consists of the points x with ``normal . x == offset``.

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
        As in `bspcsg.half_space`, the given plane is used if it contains lattice points, else the
        nearest parallel plane that does. In a block (see `bspcsg.block`) neither part is added.

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
        from ..modelling.bodies.splitting import split

        return split(self, normal, offset)

    def trim(self, normal: str | Vector, offset: Scalar = 0.0) -> "Solid":
        """Return the part of the solid on the side of a plane to which the plane's normal points.

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
        from ..modelling.bodies.splitting import trim

        return trim(self, normal, offset)

    def decompose(self) -> "list[Solid]":
        """Return the connected parts, the largest volume first; an empty list for the empty set.

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
        doubles is left out. In a block (see `bspcsg.block`) no part is added.

        Examples
        --------
        >>> import bspcsg as csg
        >>> pair = csg.cube(1) | csg.cube(2).translate(5, 0, 0)
        >>> [part.volume for part in pair.decompose()]
        [8.0, 1.0]
        """
        from ..modelling.bodies.splitting import decompose

        return decompose(self)

    @property
    def components(self) -> "tuple[Solid, ...]":
        """The connected parts, each with its cavities, the largest volume first (see `decompose`).

        Formerly this was the number of connected surfaces, now `surface_count`. The number of parts
        is ``len(solid.components)``. A comparison with an integer still uses the number of
        surfaces, with a `DeprecationWarning`.

        Examples
        --------
        >>> import bspcsg as csg
        >>> hollow = csg.cube(3) - csg.cube(1).translate(1, 1, 1)
        >>> len(hollow.components), hollow.surface_count
        (1, 2)
        """
        return Components.of(self)

    @uncounted
    def edges(self, *, all: bool = False, angle: Scalar = 30.0) -> "EdgeSelection":  # noqa: A002
        """Return the sharp edges of the solid as a selection (see `EdgeSelection`).

        Lines between the facets of a round surface do not count. The rim of a bore does; it
        consists of one edge for each facet.

        Parameters
        ----------
        all : bool
            True for all edges between plane faces, also between facets of a round surface.
        angle : float
            In degrees: the normals of the two faces at a sharp edge differ by more than this.

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

        return edges_of(self, all=all, angle=angle)

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
            A selection of edges of this solid.
        size : float
            Distance from the edge to the new surface, on both faces, in model units.

        Raises
        ------
        InvalidParameterError
            If the faces have no room for a chamfer, if convex and concave edges meet in any other
            way, or if a corner of more than three faces is not convex; the message has the
            coordinates.
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

        return chamfer(self, edges, size)

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
            A selection of edges of this solid.
        radius : float
            In model units.
        segments : int
            Sides of a full circle, at least 4. All fillets have the same number of sides, the one
            that the sharpest edge needs.

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

        return fillet(self, edges, radius, segments)

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

        return hole(self, face, at, d=d, r=r, depth=depth, segments=segments)

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
            self,
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
            The full opening angle of the cone in degrees: 90 for metric screws, 82 for inch screws.

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
            self,
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
            If the ball sweeps a volume with more than 10 million faces (see `bspcsg.minkowski`).
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

        return offset(self, r, segments)

    def rounded(self, r: Scalar, *, segments: int = SEGMENTS, inside: bool = False) -> "Solid":
        """Return the solid with its edges rounded: the points that a ball inside it can cover.

        Parameters
        ----------
        r : float
            Radius of the ball, in model units; parts thinner than the ball vanish.
        segments : int
            Sides of the ball's equator, as for `offset`; the errors are also those of `offset`.
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

        return rounded(self, r, segments, inside)

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

        return refine(self, n, edge_length)

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

        return warp(self, f, winding)

    def smooth(self, n: int, *, sharp_angle: Scalar = 60.0) -> "Solid":
        """Return the solid with a smooth surface through its corners, n² triangles for each face.

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
        The surface consists of cubic patches over the triangles, after Vlachos, Peters, Boyd,
        Mitchell 2001, "Curved PN triangles". The border between two patches follows from the
        normals of both patches at both ends of their common edge.

        Examples
        --------
        >>> import bspcsg as csg
        >>> can = csg.cylinder(h=2, r=1, segments=8)
        >>> round(can.volume, 2), round(can.smooth(8).volume, 1)
        (5.66, 6.2)
        """
        from ..modelling.bodies.smoothing import smooth

        return smooth(self, n, sharp_angle)

    @counted
    def simplify(self, tolerance: float) -> "Solid":
        """Return the solid without short edges and slivers, which trouble printers and meshers.

        An edge is short if it is not longer than `tolerance`; a triangle is a sliver if its height
        over its longest edge is not larger. Short edges collapse to one of their ends, and long
        edges of slivers are flipped. The remaining corners do not move, and large triangles stay,
        even if they are coplanar.

        Every point of the old surface lies within `tolerance` of the new one, and vice versa.
        Changed triangles cross nothing, which is tested exactly. The new surface has as many parts,
        handles and cavities as the old surface.

        Parameters
        ----------
        tolerance : float
            The largest distance that the surface may move, in model units. 0 returns the solid
            itself.

        Returns
        -------
        Solid
            The solid of a mesh, no longer of an expression. Its finding ``simplified`` has the
            numbers of triangles before and after, and the distance that was reached; ``small_left``
            counts the remaining small triangles. The solid itself if nothing can be removed, or if
            the result does not fit on the lattice.

        Raises
        ------
        InvalidParameterError
            If `tolerance` is negative or not finite.
        UnboundedError
            If the solid reaches to infinity.

        Notes
        -----
        Corners merge into one of them, and none moves farther than `tolerance`. So on a surface
        with much finer triangles, edges longer than about a third of `tolerance` remain. Thinner
        walls and bars stay, and a part that would vanish keeps at least four triangles.

        Examples
        --------
        >>> import bspcsg as csg
        >>> bump = csg.cube(1) | csg.cube(0.5).translate(0.5001, 0.25, 0.25)
        >>> simple = bump.simplify(0.001)
        >>> len(bump.faces), len(simple.faces), simple.volume
        (28, 20, 1.0)
        """
        limit = not_negative(tolerance, "tolerance")
        if limit == 0:
            return self
        with core_errors():
            tree = self.normalized().tree.simplified(limit)
        given = self._leaf().given_pitch
        return self if tree is None else from_leaf(TreeLeaf(tree, given_pitch=given))

    @counted
    def tagged(self, **values: Any) -> "Solid":
        """Return the solid with named face attributes, each with the same value on all faces.

        Parameters
        ----------
        **values : number, text or array
            Values by attribute name; they replace attributes of the same name. ``color`` is one
            colour: ``"orange"``, ``"#ff8800"``, floats from 0 to 1, or whole numbers from 0 to
            255. Half-spaces have no faces, so they stay without attributes.

        Raises
        ------
        InvalidParameterError
            If the colour is invalid.

        Examples
        --------
        >>> import bspcsg as csg
        >>> part = csg.cube(2).tagged(layer=1) - csg.cube(1).tagged(layer=2)
        >>> sorted({*part.to_mesh().face_attributes["layer"].tolist()})
        [1, 2]
        """
        leaf = self._leaf()
        told = tagged_leaf(leaf, values)
        return self if told is leaf else from_leaf(told)

    # Conversion

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
        """Return the section of the solid by a plane as a region of the plane (`bspcsg.Region`).

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
            (x, y), x gives (y, z), y gives (z, x), negative axes exchange the two coordinates; for
            other normals see
            `bspcsg.bsp.plane_frame`, whose coordinates are rounded a second time.
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
        A face in the plane counts as above it: the section is the limit of sections from the minus
        side. So the section of a box standing on z = 0 is empty at z = 0 and full at the top.
        """
        from ..bsp.sets.slicing import slice_solid

        return slice_solid(self, offset, normal, origin=origin)

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
        from ..modelling.planar.projection import shadow

        return shadow(self)

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
        return library_export.trimesh_of(self.normalized().to_mesh())

    def to_manifold(self) -> "manifold3d.Manifold":
        """Return the mesh as a `manifold3d.Manifold`; its ``status()`` says if it was accepted.

        Numeric attributes become vertex properties: ``"properties"`` first, then the other ones in
        order, colours as four numbers from 0 to 1. `Solid.from_mesh` restores their names, also
        after Manifold's operations, if all operands had the same attributes.

        Warns
        -----
        LossWarning
            If an attribute is text, as materials are, or not finite.
        """
        return library_export.manifold_of(self.normalized().to_mesh())

    def to_csg(self, *, flat: bool = False) -> str:
        """Return the solid's expression as an OpenSCAD `.csg` script (see `bspcsg.csg.dumps`)."""
        from ..csg.loading import dumps

        return dumps(self, flat=flat)

    def save(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Write the mesh to a file; the suffix names the format (see `bspcsg.save`)."""
        from ..io import save

        save(self, path, **options)

    def show(self) -> None:
        """Show the solid in a notebook or in a browser (see `bspcsg.show`)."""
        from ..script.run import show

        show(self)

    @uncounted
    def validate(self, **options: Any) -> "CheckReport":
        """Compare the operation that made this solid with manifold3d (see `bspcsg.validate`)."""
        from ..verify.check import check_result

        return check_result(self, **options)

    def check(self, **options: Any) -> "CheckReport":
        """Return the result of `validate`; deprecated name."""
        deprecated("Solid.check", "validate")
        return self.validate(**options)

    def _repr_html_(self) -> str | None:
        """Return the HTML for a notebook: an interactive view, or the reason why there is none."""
        from ..report.viewer.notebook import solid_html

        return solid_html(self)

    def _repr_svg_(self) -> str | None:
        """Return a picture as SVG, for notebooks that show neither HTML nor PNG."""
        from ..report.viewer.notebook import solid_svg

        return solid_svg(self)

    def _repr_png_(self) -> bytes | None:
        """Return a picture as PNG, for notebooks that show nothing else; None without Pillow."""
        from ..report.viewer.notebook import solid_png

        return solid_png(self)

    # As a value

    def __repr__(self) -> str:
        """Return a text of facts that are known or quickly found; nothing is evaluated."""
        mesh = self._mesh_at_hand()
        if self._placed is None:
            return f"Solid({describe(self._node, self._factors, mesh)})"
        return f"Solid({describe(ExpressionNode(self._placed), IDENTITY_CHAIN, mesh)})"

    def _mesh_at_hand(self) -> Mesh | None:
        """Return the mesh if it is cached, or if it is small and the solid is evaluated."""
        leaf = self._placed or self._node.content
        if self._mesh is not None or not isinstance(leaf, TreeLeaf) or leaf.result.is_empty:
            return self._mesh
        stats = leaf.result.stats()
        # Moved or loaded trees have no record of the kernels.
        if stats["elements"] + stats.get("kernel_elements", 0) > _MAX_FACES_FOR_REPR:
            return None
        try:
            return self.to_mesh()
        except BspcsgError:
            return None

    def _alias(self) -> "Solid":
        """Return the same solid as another object, with all cached results."""
        other = from_node(self._node, self._factors)
        other._placed, other._mesh, other._reduced = self._placed, self._mesh, self._reduced
        return other

    def __copy__(self) -> "Solid":
        """Return the solid itself, which never changes."""
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> "Solid":
        """Return the solid itself, which never changes."""
        return self

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle the evaluated tree exactly, with the transform separate.

        A solid that may have no mesh (it and its complement are unbounded) is transformed first:
        later transforms would need its operands, which are not pickled.
        """
        leaf, factors = evaluate(self._node), self._factors
        if leaf.extent is None:
            leaf, factors = self._leaf(), IDENTITY_CHAIN
        tree = tree_of(leaf)
        told = (_kept(tree, leaf.source_attributes), leaf.given_pitch)
        needed = 2 if leaf.given_pitch is not None else 1 if leaf.source_attributes else 0
        return _restored, (tree.dump(), tuple(factors), *told[:needed])


@dataclass(frozen=True, eq=False)
class LastOperation:
    """The set operation that made a solid: its program, its operands and its result.

    Parameters
    ----------
    program : list of (str, list of int)
        Lines ``("leaf", [k])`` for operand k, and "or", "and", "xor", "not" over earlier lines; the
        last line is the result.
    operands : tuple of Solid
    result : Solid
        The result, without transforms applied afterwards.
    """

    program: list[ProgramLine]
    operands: tuple[Solid, ...]
    result: Solid


def from_node(node: ExpressionNode, factors: FactorChain = IDENTITY_CHAIN) -> Solid:
    """Return the solid of an expression under a transform."""
    return Solid._of(node, factors)


def uncached_mesh(solid: Solid) -> Mesh:
    """Return the mesh of a solid, without making the solid cache it."""
    return solid._made_mesh() if solid._mesh is None else solid._mesh


def solid_of_mesh(mesh: Mesh, **options: Any) -> Solid:
    """Return the solid of a mesh of this package, with its attributes; options as for `Solid`."""
    said = None if mesh.carried is None else mesh.attributes
    return solid_with(mesh.vertices, mesh.faces, said, **options)


def solid_with(vertices: Any, faces: Any, attributes: Attributes | None, **options: Any) -> Solid:
    """Return the solid of a mesh with attributes; options as for `Solid`."""
    if attributes is None or attributes.is_empty:
        return Solid(vertices, faces, **options)
    return Solid(
        vertices,
        faces,
        vertex_attributes=attributes.vertex,
        corner_attributes=attributes.corner,
        face_attributes=attributes.face,
        materials=attributes.materials,
        **options,
    )


def given_pitch(solid: Solid) -> int | None:
    """Return the pitch that the user gave for a solid and that transforms keep, or None."""
    return solid._leaf().given_pitch


def keeping_pitch(solid: Solid, given: int | None) -> Solid:
    """Return a solid made of a mesh; transforms will keep its pitch only if that equals `given`."""
    leaf = solid._node.content
    if isinstance(leaf, MeshLeaf):
        leaf.given_pitch = given if leaf.pitch == given else None
    return solid


def from_leaf(leaf: ExpressionLeaf) -> Solid:
    """Return the solid of a leaf of an expression."""
    return Solid._of(ExpressionNode(leaf))


def expression_of(solid: Solid) -> PlacedNode:
    """Return the node of a solid's expression, and the transform that is applied to it."""
    return PlacedNode(solid._node, solid._factors)


def surfaces_meet(first: Solid, second: Solid) -> bool:
    """Return true if the surfaces of two bounded solids have a point in common, exactly."""
    leaves = [solid.normalized()._leaf() for solid in (first, second)]
    tree, other = bounded_on_one_lattice(leaves)
    with core_errors():
        return tree.meets(other)


def with_record(last: LastOperation, factors: FactorChain) -> Solid:
    """Return the result of an operation after a transform, with its `last_operation` restored.

    Pickling drops the last operation of a solid.
    """
    leaves = tuple(evaluate(operand._node) for operand in last.operands)
    record = Record(last.program, leaves)
    result = last.result
    given = given_pitch(result)
    leaf = TreeLeaf(
        result.tree, record, source_attributes=result._source_attributes, given_pitch=given
    )
    return from_node(ExpressionNode(leaf), factors)


def combine(operator: Operator, solids: Sequence[Solid]) -> Solid:
    """Combine solids by an operator, lazily; a transform common to all applies to the result."""
    prefix = common_prefix([solid._factors for solid in solids])
    operands = [PlacedNode(solid._node, solid._factors.without(len(prefix))) for solid in solids]
    return from_node(operation(operator, operands), prefix)


def _mesh_of(tree: Tree, source_attributes: SourceAttributes) -> Mesh:
    with core_errors():
        carried = later_attributes(tree, source_attributes)
        return Mesh(*tree.to_mesh(), tree.origins(), carried).frozen()


def _is_reduced(tree: Tree) -> bool:
    return tree.simple is True


def _kept(tree: Tree, source_attributes: SourceAttributes) -> SourceAttributes:
    """Return the attributes of a tree's sources, None for sources whose faces cannot bound it."""
    if not source_attributes:
        return ()
    kept = zip(tree.named, source_attributes, strict=True)
    return tuple(said if is_named else None for is_named, said in kept)


def _restored(
    data: bytes,
    factors: Factors,
    source_attributes: SourceAttributes = (),
    given: int | None = None,
) -> Solid:
    with core_errors():
        tree = Tree.load(data)
        # The empty set and all of space are stored without sources.
        leaf = TreeLeaf(
            tree, source_attributes=source_attributes if tree.sources else (), given_pitch=given
        )
        return from_node(ExpressionNode(leaf), FactorChain.of(factors))
