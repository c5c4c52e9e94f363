"""`PartitionTree`: a binary space partition tree over facets of any kind."""

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np

from ..._core import FragmentTree
from ..._types import FloatArray, IndexArray
from ...errors import core_errors, invalid_parameter
from ...formats.atomic import write_file
from ...formats.source import whole_content
from ...geometry.arrays import doubles
from ...geometry.polygon import convex_corners
from ...parameters import at_least, not_negative, one_of, shown
from .chosen_cuts import Chooser, lattice_rows, tree_with_chosen_cuts
from .cost import Query, Stats, cost, stats
from .dump import parsed, to_dot, to_json, to_svg
from .facets import chosen_pitch, corners_of, mesh_triangles, vector_rows
from .fragments import Fragments
from .leaf_form import LeafForm, leaf_form
from .node import Leaf, Node, RegionShape, Side, Visitor
from .order import back_to_front, far_to_near, front_to_back, near_to_far, visit, walk
from .policy import Policy, checked_policy, core_options
from .trace import Construction, PointTrace, RayCosts, RayTrace, division, point_trace, ray_trace
from .tree_motion import moved_core

if TYPE_CHECKING:
    from ..._core import NodeArrays

#: The default distance by which regions exceed the facets' box, as a fraction of its extent.
MARGIN = 0.05

#: Notebooks draw trees with at most this many nodes; such a picture takes a second and 2 MB.
_MAX_NODES_DRAWN = 10_000


class PartitionTree:
    """A binary space partition tree over points, segments or polygons.

    Each node v has a hyperplane H(v), the coplanar set S(v) of fragments (parts of facets) that lie
    in H(v), and two subtrees over the fragments on the minus (inside) and the plus side of H(v).
    Every leaf is a region without facets. Immutable; safe to share between threads.

    Parameters
    ----------
    facets : array_like or sequence
        (n,) points in 1D; (n, 2, 2) segments in 2D, minus side to the left; (n, k, 3) polygons in
        3D or a list of (k, 3), planar, convex or not, counterclockwise seen from the plus side.
        They may cross, touch, overlap and repeat. An array without facets gives a tree without
        nodes.
    policy : str or callable
        The rule that chooses the facet whose hyperplane divides a region (see
        `bspcsg.bsp.trees.policy`). A callable takes a `Choice`, which has the candidates and their
        counts, and returns the index of a candidate, or a hyperplane (normal, offset).
    seed : int
        The seed of the random order, for the policy "random".
    top : int
        Regions with more facets than this are divided by axis-parallel hyperplanes; 0 for never.
        Use about 16 for surfaces: the autopartition of a convex body is a chain.
    sample : int
        The number of candidates that a policy compares at each node.
    alpha : float
        From 0 (least splits) to 1 (balance), for the policy "weighted".
    cuts : sequence of (normal, offset)
        Hyperplanes given by the caller, ``normal · x = offset`` in model units, with the minus side
        where the product is smaller. In each region, the first of these cuts with pieces on both
        sides is used before the policy. Cuts are snapped as by `ObjectTree.half_space`.
    pitch : int, optional
        The lattice step is ``10**pitch`` units. By default -9, or another if the size requires it.
    non_planar : {"error", "triangulate"}
        The treatment of polygons whose corners are not in one plane after snapping.
    degenerate : {"error", "drop"}
        The treatment of segments without length and polygons without area after snapping.
    margin : float, optional
        The distance by which regions exceed the box of the facets, in model units; by default a
        twentieth of the largest extent. Never less than one lattice step.

    Raises
    ------
    InvalidMeshError
        If a coordinate is not finite (`where` lists corners); a facet has no extent on the lattice,
        is not planar, or crosses itself (`where` lists facets); the shape is none of those above;
        or a parameter is out of its range.
    LimitError
        If coordinates do not fit the lattice.

    Notes
    -----
    Fuchs, Kedem, Naylor 1980, "On visible surface generation by a priori tree structures"; de Berg
    et al., Computational Geometry, chapter 12. Coordinates are snapped to the lattice, everything
    after that is exact.

    Examples
    --------
    >>> from bspcsg import bsp
    >>> tree = bsp.PartitionTree([[[0, 0], [4, 0]], [[2, -1], [2, 1]]], "first")
    >>> len(tree), len(tree.fragments)
    (3, 3)
    """

    def __init__(
        self,
        facets: Any,
        policy: Policy | Chooser = "random",
        *,
        seed: int = 0,
        top: int = 0,
        sample: int = 8,
        alpha: float = 0.5,
        cuts: Sequence[tuple[Any, Any]] = (),
        pitch: int | None = None,
        non_planar: Literal["error", "triangulate"] = "error",
        degenerate: Literal["error", "drop"] = "error",
        margin: float | None = None,
    ) -> None:
        options = core_options(seed, sample, alpha, top, pitch)
        lenience = (
            one_of(("error", "triangulate"), non_planar, "non_planar") == "triangulate",
            one_of(("error", "drop"), degenerate, "degenerate") == "drop",
        )
        corners, offsets = corners_of(facets)
        step = chosen_pitch(pitch, corners)
        own = lattice_rows(cuts, corners.shape[1], step)
        with core_errors():
            if callable(policy):
                count = options["sample"]
                core = tree_with_chosen_cuts((corners, offsets), policy, count, step, lenience, own)
            else:
                options["pitch"] = step if own else options["pitch"]
                name = checked_policy(policy)
                core = FragmentTree.build(
                    corners, offsets, name, lenience=lenience, own=own, **options
                )
        self._set(core, lenience, margin)

    def _set(self, core: FragmentTree, lenience: tuple[bool, bool], margin: float | None) -> None:
        self.core = core
        self.lenience = lenience
        self._margin = None if margin is None else not_negative(margin, "margin")

    @classmethod
    def from_core(
        cls, core: FragmentTree, lenience: tuple[bool, bool], margin: float | None = None
    ) -> "PartitionTree":
        """Wrap a tree of the compiled core (for the modules of this package)."""
        tree = cls.__new__(cls)
        tree._set(core, lenience, margin)
        return tree

    @classmethod
    def from_mesh(
        cls, mesh: Any, policy: Policy = "random", *, top: int = 16, **options: Any
    ) -> "PartitionTree":
        """Return the tree over the triangles of any mesh object, closed or not.

        Triangles without area are left out unless ``degenerate="error"``.

        Parameters
        ----------
        mesh : object
            A `Solid`, a pair (vertices, faces), or anything else that `Solid.from_mesh` takes.
        policy, top, **options
            Parameters of `PartitionTree`.
        """
        return cls(mesh_triangles(mesh), policy, top=top, **{"degenerate": "drop", **options})

    @classmethod
    def perfect(cls, facets: Any, **options: Any) -> "PartitionTree | None":
        """Return a tree whose cuts lie in facets' hyperplanes and split no facet, or None.

        None means that there is no such tree: the search is exhaustive. The problem is NP-hard, so
        at most 24 convex pieces are allowed.

        Parameters
        ----------
        facets, **options
            As for `PartitionTree`; there is no policy.

        Raises
        ------
        LimitError
            For more than 24 convex pieces.

        Notes
        -----
        de Berg, Khosravi, "Finding perfect auto-partitions is NP-hard", EuroCG 2008.
        """
        tree = cls(facets, "first", **options)
        with core_errors():
            cuts = tree.core.perfect_cuts()
        return None if cuts is None else tree.with_cuts(cuts)

    def with_cuts(self, cuts: Any) -> "PartitionTree":
        """Return a tree over the same facets, divided by the given cuts.

        Parameters
        ----------
        cuts : (n, 2) array_like of int
            One row for each node in preorder, encoded as in ``arrays["cut"]``.

        Raises
        ------
        FormatError
            If there are too many or too few cuts, or a cut names a facet outside the region that it
            should cut.
        """
        rows = _cut_rows(cuts)
        corners, offsets = self.core.lattice()
        own = [list(row) for row in self.own_hyperplanes]
        with core_errors():
            core = FragmentTree.rebuild(corners, offsets, self.pitch, rows, self.lenience, own)
        return self.from_core(core, self.lenience, self._margin)

    # Parts

    @property
    def dimension(self) -> int:
        """The dimension of the facets: 1, 2 or 3."""
        return self.core.dimension

    @property
    def pitch(self) -> int:
        """The exponent of the lattice step ``10**pitch``, in model units."""
        return self.core.pitch

    def __len__(self) -> int:
        """Return the number of inner nodes of the tree."""
        return len(self.core)

    @cached_property
    def arrays(self) -> "NodeArrays":
        """All inner nodes in preorder, as a dictionary of read-only arrays.

        ``normal`` (n, d) and ``offset`` (n,) as in `Node.hyperplane`; ``minus``, ``plus``,
        ``parent`` (n,) node indices or -1; ``depth`` (n,); ``start``, ``end`` (n,) the coplanar set
        as a range of `fragments`; ``cut`` (n, 2): (-1, convex piece), (axis, lattice coordinate) or
        (-2, index in `own_hyperplanes`).
        """
        nodes = self.core.nodes()
        _make_read_only(nodes)
        return nodes

    @cached_property
    def fragments(self) -> Fragments:
        """The fragments of the coplanar sets of all nodes, in preorder of the nodes; read-only."""
        with core_errors():
            fragments = Fragments(*self.core.fragments())
        _make_read_only(vars(fragments))
        return fragments

    @cached_property
    def own_hyperplanes(self) -> tuple[tuple[int, ...], ...]:
        """The cuts that come neither from a facet nor from an axis, each as integers (*n, c).

        The hyperplane consists of the points x with n·x = c, with x in lattice steps.
        """
        return tuple(tuple(row) for row in self.core.own())

    @property
    def root(self) -> Node | None:
        """The root node of the tree, None if there are no facets."""
        return Node(self, 0) if len(self) else None

    @property
    def nodes(self) -> tuple[Node, ...]:
        """All inner nodes in preorder: a node, its minus subtree, its plus subtree."""
        return tuple(Node(self, index) for index in range(len(self)))

    @property
    def splits(self) -> IndexArray:
        """The splits of fragments, (k, 2) int64: the node whose cut split, and the facet split."""
        return self.core.splits()

    @cached_property
    def margin(self) -> float:
        """The distance by which regions may exceed the box of the facets, in model units."""
        if self._margin is not None:
            return self._margin
        corners, _ = self.core.lattice()
        if not len(corners):
            return 1.0
        extent = int((corners.max(axis=0) - corners.min(axis=0)).max())
        return MARGIN * extent * 10.0**self.pitch

    def region(self, of: Node | Leaf | None = None, margin: float | None = None) -> RegionShape:
        """Return the region of a node or leaf, by default of the root, clipped to a box.

        The box is the bounding box of the facets, enlarged by the margin on all sides.

        Parameters
        ----------
        of : Node or Leaf, optional
        margin : float, optional
            The distance by which the box exceeds the facets, in model units; by default the
            `margin` of the tree.

        Returns
        -------
        (2,) float64, (k, 2) float64 or list of (k, 3) float64
            The region's ends in 1D; its corners, counterclockwise, in 2D; its faces,
            counterclockwise seen from outside, in 3D. Empty if the region does not reach into the
            box.
        """
        node, side = _place(of)
        reach = self.margin if margin is None else not_negative(margin, "margin")
        with core_errors():
            walls = self.core.region(node, side, reach)
        if self.dimension == 1:
            return np.sort(np.concatenate(walls).ravel())
        return convex_corners(walls) if self.dimension == 2 else walls

    # Traversals

    def back_to_front(self, *, eye: Any = None, direction: Any = None) -> Fragments:
        """Return the fragments in painter's order: none hides a later one from the eye.

        Parameters
        ----------
        eye : (d,) array_like, optional
            The viewpoint, in model units. It is not snapped: sides are decided for these doubles.
        direction : (d,) array_like, optional
            Instead of an eye: the direction of view of a parallel projection, away from the viewer.

        Returns
        -------
        Fragments
            Farthest first. If the eye lies in the hyperplane of a node, the node's fragments are
            seen edge-on and neither side hides the other; the plus side then comes first.

        Raises
        ------
        InvalidParameterError
            If not exactly one of eye and direction is given, a coordinate is not finite, or the
            direction is zero.

        Notes
        -----
        Fuchs, Kedem, Naylor 1980. Overlapping fragments of one coplanar set come in the order of
        the construction.
        """
        return back_to_front(self, eye, direction)

    def front_to_back(self, *, eye: Any = None, direction: Any = None) -> Fragments:
        """Return the fragments, nearest first: the reverse order of `back_to_front`."""
        return front_to_back(self, eye, direction)

    def near_to_far(self, *, eye: Any = None, direction: Any = None) -> Iterator[Node | Leaf]:
        """Yield nodes and leaves by distance: child on the eye's side, node, other child."""
        return near_to_far(self, eye, direction)

    def far_to_near(self, *, eye: Any = None, direction: Any = None) -> Iterator[Node | Leaf]:
        """Yield nodes and leaves from far to near: far child, node, child on the eye's side."""
        return far_to_near(self, eye, direction)

    def walk(self, order: Literal["pre", "in", "post"] = "pre") -> Iterator[Node | Leaf]:
        """Yield all nodes and leaves, minus child first; "in": a node between its two children."""
        return walk(self, order)

    def visit(self, visitor: Visitor, order: Literal["pre", "in", "post"] = "pre") -> None:
        """Call ``visitor.node(node)`` or ``visitor.leaf(leaf)`` for each, in the order given."""
        visit(self, visitor, order)

    # Traces

    def trace(self) -> Construction:
        """Return a trace of the construction: each region's cut, its reason, and where pieces went.

        The construction is repeated, as the tree itself keeps no trace. If the tree was made by a
        callable, read from a file or inserted into, the reason of its cuts is "given".
        """
        with core_errors():
            rows = self.core.construction()
            return Construction(tuple(map(division, rows)), self.core.piece_sources())

    def trace_point(self, point: Any) -> PointTrace:
        """Return the path of a point from the root to its leaf, or to a node whose cut contains it.

        Parameters
        ----------
        point : (d,) array_like of float
            In model units. It is not snapped to the lattice: sides are decided for exactly these
            doubles.
        """
        place = vector_rows(point, self.dimension, "The point")
        if len(place) != 1 or not np.isfinite(place).all():
            raise invalid_parameter(
                f"point must be one point of finite numbers, not {shown(point)}."
            )
        with core_errors():
            return point_trace(self, self.core.path(_padded(place[0])))

    def locate(self, point: Any) -> Node | Leaf:
        """Return the leaf in which a point lies, or the inner node in whose hyperplane it lies."""
        return self.trace_point(point).end

    def test_ray(self, origins: Any, directions: Any) -> RayCosts:
        """Return the first facet that each ray meets, and the nodes and facets visited until then.

        At each node the ray visits the child on the side of its origin, then the pieces in the
        hyperplane, then the other child, until there is a hit. Facets are closed sets. If several
        facets meet at the hit point, the hit is the facet visited first, and within one node the
        first in the input.

        Parameters
        ----------
        origins, directions : (n, d) or (d,) array_like of float
            Origins are snapped to the lattice; directions need no unit length.

        Raises
        ------
        InvalidMeshError
            For a direction that is zero or not finite (`where` has the ray's index).
        """
        first, second = self._rays(origins, directions)
        with core_errors():
            return RayCosts(*self.core.cast(first, second))

    def trace_ray(self, origin: Any, direction: Any) -> RayTrace:
        """Return the path of one ray through the tree, step by step, as `test_ray` follows it."""
        first, second = self._rays(origin, direction)
        if len(first) != 1:
            raise invalid_parameter(
                f"A trace is made for one ray only, but there are {len(first)} rays; pass one"
                " origin and one direction."
            )
        with core_errors():
            hit, rows = self.core.ray_events(_padded(first[0]), _padded(second[0]))
        if hit is None:
            return ray_trace(None, math.inf, rows)
        return ray_trace(int(self.core.piece_sources()[hit[0]]), hit[1], rows)

    def _rays(self, origins: Any, directions: Any) -> tuple[FloatArray, FloatArray]:
        first = vector_rows(origins, self.dimension, "Origins")
        second = vector_rows(directions, self.dimension, "Directions")
        if len(first) != len(second) and 1 not in (len(first), len(second)):
            raise invalid_parameter(
                f"There are {len(first)} origins but {len(second)} directions; give equally many,"
                " or one of either."
            )
        first, second = np.broadcast_arrays(first, second)
        return np.ascontiguousarray(first), np.ascontiguousarray(second)

    # More facets

    def insert(
        self,
        facets: Any,
        policy: Policy = "random",
        *,
        seed: int = 0,
        sample: int = 8,
        alpha: float = 0.5,
    ) -> "PartitionTree":
        """Return the tree with more facets: all nodes stay, and its leaves are divided further.

        New facets are cut by the hyperplanes of the old nodes; the policy chooses which of the new
        facets in a leaf divides it.

        Parameters
        ----------
        facets, policy, seed, sample, alpha
            As for `PartitionTree`. New facets must have the tree's dimension, are snapped to its
            lattice, and are numbered after the old facets.
        """
        corners, offsets = corners_of(facets)
        if corners.shape[1] != self.dimension:
            message = (
                f"The facets have dimension {corners.shape[1]}, but the tree has dimension"
                f" {self.dimension}."
            )
            raise invalid_parameter(message)
        options = core_options(seed, sample, alpha, 0, self.pitch)
        name = checked_policy(policy)
        with core_errors():
            core = self.core.grown(
                corners,
                offsets,
                name,
                options["seed"],
                options["sample"],
                options["alpha"],
                self.lenience,
            )
        return self.from_core(core, self.lenience, self._margin)

    def leaf_form(self) -> LeafForm:
        """Return the tree in leaf form, in which each leaf stores at most one fragment."""
        return leaf_form(self)

    def moved(
        self, axes: Sequence[int] | None = None, offset: Any = None, scale: int = 1
    ) -> "PartitionTree":
        """Return the image of the tree under a lattice motion: scaled, rotated, then translated.

        The facets and all cuts move; the structure stays.

        Parameters
        ----------
        axes : sequence of int, optional
            Entry i is the old axis, counted from 1 and with its sign, that becomes new axis i: in
            the plane (2, -1) is a quarter turn clockwise. Only rotations: a mirror image would
            exchange minus and plus sides.
        offset : (d,) array_like of float, optional
            The translation after the rotation, in model units; snapped to the lattice.
        scale : int
            A positive factor about the origin, applied first.

        Raises
        ------
        InvalidParameterError
            If the axes are not a rotation, or the scale is not positive.
        LimitError
            If the image does not fit the lattice.
        """
        factor = at_least(1, scale, "scale")
        core = moved_core(self.core, self.lenience, axes, offset, factor)
        return self.from_core(core, self.lenience, self._margin)

    # Quality

    def stats(self) -> Stats:
        """Return the tree's numbers of nodes, leaves, fragments and splits, depths and balance."""
        return stats(self)

    def cost(self, query: Query = "point", margin: float | None = None) -> float:
        """Return the expected number of nodes that a query visits (see `bspcsg.bsp.trees.cost`)."""
        return cost(self, query, margin)

    # Files

    def to_json(self) -> str:
        """Return the tree's facets and cuts, exactly, as JSON text that `from_json` reads."""
        return to_json(self)

    @classmethod
    def from_json(cls, text: str) -> "PartitionTree":
        """Rebuild a tree from the JSON text of `to_json`, by repeating the cuts.

        Raises
        ------
        FormatError
            If the text is something else, or its cuts do not suit its facets.
        """
        return cls.from_core(*parsed(text))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the tree to a file, as JSON text that `load` reads.

        Raises
        ------
        FormatError
            If the file cannot be written.
        """
        write_file(path, [self.to_json().encode()])

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> "PartitionTree":
        """Return the tree from a file that `save` wrote.

        Raises
        ------
        FormatError
            If the file cannot be read, and as for `from_json`.
        """
        return cls.from_json(whole_content(path).decode("utf-8", "replace"))

    def to_dot(self) -> str:
        """Return the tree as text in Graphviz's DOT language; leaves are drawn as dots."""
        return to_dot(self)

    def to_svg(self, size: int = 480) -> str:
        """Return a picture of a 2D tree as SVG text: cuts in grey, fragments in black."""
        return to_svg(self, size)

    def _repr_svg_(self) -> str | None:
        """Return the tree's picture for notebooks; None if it is not 2D or has too many nodes."""
        return self.to_svg() if self.dimension == 2 and len(self) <= _MAX_NODES_DRAWN else None

    # As a value

    def __eq__(self, other: object) -> bool:
        """Return true if both trees have the same facets on the same lattice, and the same cuts."""
        if not isinstance(other, PartitionTree):
            return NotImplemented
        mine, theirs = self.core.lattice(), other.core.lattice()
        return (
            (self.dimension, self.pitch, len(self)) == (other.dimension, other.pitch, len(other))
            and all(map(np.array_equal, mine, theirs))
            and np.array_equal(self.arrays["cut"], other.arrays["cut"])
            and self.own_hyperplanes == other.own_hyperplanes
        )

    def __hash__(self) -> int:
        """Return a hash value that equal trees share."""
        return hash((self.dimension, self.pitch, len(self)))

    def __copy__(self) -> Self:
        """Return the tree itself, which never changes."""
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """Return the tree itself, which never changes."""
        return self

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle the facets on the lattice and the cuts, from which the tree is rebuilt."""
        corners, offsets = self.core.lattice()
        own = [list(row) for row in self.own_hyperplanes]
        parts = corners, offsets, self.pitch, self.arrays["cut"], self.lenience, own
        return _restored, (type(self), parts, self._margin)

    def __repr__(self) -> str:
        """Return a text with the dimension and the numbers of facets and nodes."""
        facets = len(self.core.lattice()[1]) - 1
        return f"PartitionTree({self.dimension}D, {facets} facets, {len(self)} nodes)"


def _restored(kind: type[PartitionTree], parts: Any, margin: float | None) -> PartitionTree:
    with core_errors():
        return kind.from_core(FragmentTree.rebuild(*parts), parts[4], margin)


def _cut_rows(cuts: Any) -> IndexArray:
    message = "cuts must be an integer array of shape (n, 2), with one row for each node."
    rows = doubles(cuts, invalid_parameter(message))
    if rows.size % 2 or not (np.isfinite(rows) & (rows == np.trunc(rows))).all():
        raise invalid_parameter(message)
    if (np.abs(rows) >= 2.0**63).any():
        raise invalid_parameter(message)
    return np.ascontiguousarray(rows.reshape(-1, 2), dtype=np.int64)


def _make_read_only(arrays: Mapping[str, Any]) -> None:
    """Make all arrays of a mapping read-only."""
    for array in arrays.values():
        array.flags.writeable = False


def _place(of: Node | Leaf | None) -> tuple[int | None, int]:
    if of is None:
        return None, 0
    if isinstance(of, Node):
        return of.index, 0
    if not isinstance(of, Leaf):
        raise invalid_parameter(
            f"The argument of region must be a Node or a Leaf, not {shown(of)}."
        )
    sides: dict[Side, int] = {"minus": -1, "plus": 1}
    return (None, 0) if of.parent is None else (of.parent.index, sides[of.side])


def _padded(values: FloatArray) -> list[float]:
    """Return a vector of one to three coordinates as three, with zeros at the end."""
    return [*values.tolist(), 0.0, 0.0][:3]
