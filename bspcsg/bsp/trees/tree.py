"""`PartitionTree`: a binary space partition over facets of any kind."""

import os
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np

from ..._core import FragmentTree
from ..._types import IndexArray
from ...errors import core_errors, invalid_parameter
from ...geometry.polygon import convex_corners
from ...parameters import not_negative
from .cost import Query, Stats, cost, stats
from .dump import parsed, to_dot, to_json, to_svg
from .facets import corners_of, mesh_triangles
from .fragments import Fragments
from .node import Leaf, Node, RegionShape, Side
from .order import Ordered
from .policy import Policy, checked_policy, core_options

if TYPE_CHECKING:
    from ..._core import NodeArrays

#: Margin around the facets for regions, as a share of their largest extent.
MARGIN = 0.05


class PartitionTree(Ordered):
    """A binary space partition tree over points, segments or polygons.

    Each node v has a hyperplane H(v), the coplanar set S(v) of fragments that lie in it, and two
    subtrees over what lies on its minus (inside) and plus side. Every leaf is an empty region.
    Immutable; safe to share between threads.

    Parameters
    ----------
    facets : array_like or sequence
        (n,) points in 1D; (n, 2, 2) segments in 2D, minus side to the left; (n, k, 3) polygons in
        3D or a list of (k, 3), planar, convex or not, counterclockwise seen from the plus side.
        They may cross, touch, overlap and repeat. An array without facets gives a tree without
        nodes.
    policy : str
        Whose hyperplane divides a region, see `bspcsg.bsp.policy`.
    seed : int
        For the policy "random".
    top : int
        Regions with more facets than this are divided by axis-parallel hyperplanes; 0 for never.
        Use about 16 for surfaces: the autopartition of a convex body is a chain.
    sample : int
        How many candidates a policy compares at each node.
    alpha : float
        From 0 (least splits) to 1 (balance), for the policy "weighted".
    pitch : int, optional
        The lattice step is ``10**pitch`` units. By default -9 or what the size asks for.
    non_planar : {"error", "triangulate"}
        What to do with polygons whose corners are not in one plane after snapping.
    degenerate : {"error", "drop"}
        What to do with segments without length and polygons without area after snapping.
    margin : float, optional
        How far regions reach beyond the box of the facets, in model units; by default a twentieth
        of the largest extent. Never less than one lattice step.

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
        policy: Policy = "random",
        *,
        seed: int = 0,
        top: int = 0,
        sample: int = 8,
        alpha: float = 0.5,
        pitch: int | None = None,
        non_planar: Literal["error", "triangulate"] = "error",
        degenerate: Literal["error", "drop"] = "error",
        margin: float | None = None,
    ) -> None:
        name = checked_policy(policy)
        options = core_options(seed, sample, alpha, top, pitch)
        if non_planar not in ("error", "triangulate"):
            raise invalid_parameter(f"non_planar is 'error' or 'triangulate', not {non_planar!r}.")
        if degenerate not in ("error", "drop"):
            raise invalid_parameter(f"degenerate is 'error' or 'drop', not {degenerate!r}.")
        corners, offsets = corners_of(facets)
        lenience = non_planar == "triangulate", degenerate == "drop"
        with core_errors():
            core = FragmentTree.build(corners, offsets, name, lenience=lenience, **options)
        self._set(core, lenience, margin)

    def _set(self, core: FragmentTree, lenience: tuple[bool, bool], margin: float | None) -> None:
        self.core = core
        self.lenience = lenience
        self._margin = None if margin is None else not_negative(margin, "margin")

    @classmethod
    def from_core(
        cls, core: FragmentTree, lenience: tuple[bool, bool], margin: float | None = None
    ) -> "PartitionTree":
        """Return the tree of a core object (for the modules of this package)."""
        tree = cls.__new__(cls)
        tree._set(core, lenience, margin)
        return tree

    @classmethod
    def from_mesh(
        cls, mesh: Any, policy: Policy = "random", *, top: int = 16, **options: Any
    ) -> "PartitionTree":
        """Return the tree over the triangles of whatever holds a mesh, closed or not.

        Triangles without area are left out unless ``degenerate="error"``.

        Parameters
        ----------
        mesh : object
            A `Solid`, a pair (vertices, faces), or anything else that `Solid.from_mesh` takes.
        policy, top, **options
            As for `PartitionTree`.
        """
        return cls(mesh_triangles(mesh), policy, top=top, **{"degenerate": "drop", **options})

    @classmethod
    def perfect(cls, facets: Any, **options: Any) -> "PartitionTree | None":
        """Return an autopartition that cuts no facet, or None if there is none.

        An exhaustive search over sets of facets, for at most 24 convex pieces: the question is
        NP-hard.

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
            if cuts is None:
                return None
            corners, offsets = tree.core.lattice()
            core = FragmentTree.rebuild(corners, offsets, tree.pitch, cuts, tree.lenience)
        return cls.from_core(core, tree.lenience, tree._margin)

    # Parts

    @property
    def dimension(self) -> int:
        """1, 2 or 3."""
        return self.core.dimension

    @property
    def pitch(self) -> int:
        """The exponent of the lattice step ``10**pitch``, in model units."""
        return self.core.pitch

    def __len__(self) -> int:
        """Return the number of inner nodes."""
        return len(self.core)

    @cached_property
    def arrays(self) -> "NodeArrays":
        """All nodes in preorder as arrays.

        ``normal`` (n, d) and ``offset`` (n,) as in `Node.hyperplane`; ``minus``, ``plus``,
        ``parent`` (n,) node indices or -1; ``depth`` (n,); ``start``, ``end`` (n,) the coplanar set
        as a range of `fragments`; ``cut`` (n, 2): (-1, convex piece) or (axis, lattice coordinate).
        """
        return self.core.nodes()

    @cached_property
    def fragments(self) -> Fragments:
        """The fragments of all coplanar sets, node by node in preorder."""
        with core_errors():
            return Fragments(*self.core.fragments())

    @property
    def _tree(self) -> "PartitionTree":
        return self

    @property
    def nodes(self) -> tuple[Node, ...]:
        """All inner nodes in preorder, minus before plus."""
        return tuple(Node(self, index) for index in range(len(self)))

    @property
    def splits(self) -> IndexArray:
        """(k, 2) int64: each cut of a fragment, as the node that cut and the facet that was cut."""
        return self.core.splits()

    @cached_property
    def margin(self) -> float:
        """The distance by which regions reach beyond the box of the facets, in model units."""
        if self._margin is not None:
            return self._margin
        corners, _ = self.core.lattice()
        if not len(corners):
            return 1.0
        extent = int((corners.max(axis=0) - corners.min(axis=0)).max())
        return MARGIN * extent * 10.0**self.pitch

    def region(self, of: Node | Leaf | None = None, margin: float | None = None) -> RegionShape:
        """Return the region of a node or leaf, by default of the root.

        Parameters
        ----------
        of : Node or Leaf, optional
        margin : float, optional
            In place of the tree's own.

        Returns
        -------
        (2,) float64, (k, 2) float64 or list of (k, 3) float64
            Its ends in 1D; its corners, counterclockwise, in 2D; its faces, counterclockwise seen
            from outside, in 3D. Empty if nothing of the box is left.
        """
        node, side = _place(of)
        reach = self.margin if margin is None else not_negative(margin, "margin")
        with core_errors():
            walls = self.core.region(node, side, reach)
        if self.dimension == 1:
            return np.sort(np.concatenate(walls).ravel())
        return convex_corners(walls) if self.dimension == 2 else walls

    # Quality

    def stats(self) -> Stats:
        """Return size, depth, splits and balance (see `bspcsg.bsp.trees.cost`)."""
        return stats(self)

    def cost(self, query: Query = "point", margin: float | None = None) -> float:
        """Return the expected number of nodes that a query visits (see `bspcsg.bsp.trees.cost`)."""
        return cost(self, query, margin)

    # Files

    def to_json(self) -> str:
        """Return facets and cuts as JSON, exactly; `from_json` makes an equal tree of it."""
        return to_json(self)

    @classmethod
    def from_json(cls, text: str) -> "PartitionTree":
        """Return the tree that `to_json` wrote, by making its cuts again.

        Raises
        ------
        FormatError
            If the text is something else, or its cuts do not suit its facets.
        """
        return cls.from_core(*parsed(text))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write `to_json` to a file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.to_json())

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> "PartitionTree":
        """Read what `save` wrote; raises as `from_json` does."""
        with open(path, encoding="utf-8") as file:
            return cls.from_json(file.read())

    def to_dot(self) -> str:
        """Return the tree in the language of Graphviz; leaves are drawn as dots."""
        return to_dot(self)

    def to_svg(self, size: int = 480) -> str:
        """Return a picture of a 2D tree: regions in grey, fragments in black, as SVG."""
        return to_svg(self, size)

    # As a value

    def __eq__(self, other: object) -> bool:
        """Say whether both have the same facets, on the same lattice, and the same cuts."""
        if not isinstance(other, PartitionTree):
            return NotImplemented
        mine, theirs = self.core.lattice(), other.core.lattice()
        return (
            (self.dimension, self.pitch, len(self)) == (other.dimension, other.pitch, len(other))
            and all(map(np.array_equal, mine, theirs))
            and np.array_equal(self.arrays["cut"], other.arrays["cut"])
        )

    def __hash__(self) -> int:
        """Return a number that equal trees share."""
        return hash((self.dimension, self.pitch, len(self)))

    def __copy__(self) -> Self:
        """Return the tree itself, which never changes."""
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """Return the tree itself, which never changes."""
        return self

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Pickle facets on the lattice and cuts, of which the tree is made again."""
        corners, offsets = self.core.lattice()
        parts = corners, offsets, self.pitch, self.arrays["cut"], self.lenience
        return _restored, (type(self), parts, self._margin)

    def __repr__(self) -> str:
        """Say how large the tree is."""
        facets = len(self.core.lattice()[1]) - 1
        return f"PartitionTree({self.dimension}D, {facets} facets, {len(self)} nodes)"


def _restored(kind: type[PartitionTree], parts: Any, margin: float | None) -> PartitionTree:
    with core_errors():
        return kind.from_core(FragmentTree.rebuild(*parts), parts[-1], margin)


def _place(of: Node | Leaf | None) -> tuple[int | None, int]:
    if of is None:
        return None, 0
    if isinstance(of, Node):
        return of.index, 0
    sides: dict[Side, int] = {"minus": -1, "plus": 1}
    return (None, 0) if of.parent is None else (of.parent.index, sides[of.side])
