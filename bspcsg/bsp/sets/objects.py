"""`ObjectTree`: a set of points in 1D, 2D or 3D as a partition tree with in and out leaves.

On the line, in the plane and in space, inner nodes divide a convex region by a hyperplane, and
leaves are inside or outside the set. Set operations merge two trees; nothing is rounded after the
coordinates are snapped to the lattice of step ``10**pitch``.

Sources: Thibault, Naylor 1987; Naylor, Amanatides, Thibault 1990.
"""

from collections.abc import Sequence
from typing import Any, Self, TypeVar, get_args

from ..._core import ObjectTree as CoreTree
from ..._types import FloatArray, Scalar, SetOp, WindingRule
from ...errors import LimitError, core_errors, invalid_parameter
from ...mesh import interop
from ...method_ownership import with_own_methods
from ...parameters import (
    SET_OPS,
    dimension_number,
    instance_of,
    one_of,
    pitch_exponent,
    seed_number,
    truth_value,
    winding_rule,
)
from ..trees.chosen_cuts import pairs_of
from ..trees.facets import chosen_pitch
from .boundary import boundary_arrays
from .nearest import nearest_on_boundary
from .pieces import BuildPolicy, NodeTable, NormalAndOffset, Pieces, SplitCase
from .rows import hyperplane, hyperplane_row, hyperplane_rows
from .trace import MergeTrace, merge_trace
from .tree_set import TreeSet, set_of

Set = TypeVar("Set", bound=TreeSet)


@with_own_methods
class ObjectTree(TreeSet):
    """A set of points on the line, in the plane or in space as a partition tree; immutable.

    ``==``, ``<=``, ``<``, ``in`` and the like compare sets of points exactly, as Python compares
    sets: two trees are equal if they represent the same set of points, however they divide it.

    Parameters
    ----------
    facets : array_like
        The closed boundary: (n, 2) interval ends (1D); (n, 2, 2) segments with the inside on their
        left (2D); (n, 3, 3) triangles counterclockwise seen from outside (3D). They may cross,
        overlap and repeat: a point is inside if its winding number satisfies the rule.
    winding : {"positive", "nonzero", "even-odd"}
        The rule that says which winding numbers are inside.
    pitch : int, optional
        The lattice step is ``10**pitch`` units; by default -9, or another if the coordinates
        require it.
    policy : {"balanced", "random", "first", "fewest-splits"}
        The rule that chooses the cuts. "balanced" adds axis-parallel cuts, without which the tree
        of a convex outline is a chain; the other rules cut along facets only (autopartitions).
    seed : int
        The seed of the random order, for the policy "random".
    cuts : sequence of (normal, offset)
        Hyperplanes to cut along first, in this order, before cuts along the boundary.

    Raises
    ------
    InvalidMeshError
        If the boundary is not closed, a number is not finite or an array has another shape.
    LimitError
        If the coordinates do not fit on the lattice.

    Examples
    --------
    >>> from bspcsg import bsp
    >>> a = bsp.ObjectTree([[0, 2], [5, 6]])
    >>> b = bsp.ObjectTree([[1, 3]])
    >>> (a | b).measure, (a & b).measure, (a - b).measure
    (Fraction(4, 1), Fraction(1, 1), Fraction(2, 1))
    """

    __slots__ = ()

    def __init__(
        self,
        facets: Any,
        *,
        winding: WindingRule = "positive",
        pitch: int | None = None,
        policy: BuildPolicy = "balanced",
        seed: int = 0,
        cuts: Sequence[NormalAndOffset] = (),
    ) -> None:
        dimension, rows, faces = boundary_arrays(facets)
        rule, order = winding_rule(winding), seed_number(seed)
        order_of_facets = one_of(get_args(BuildPolicy), policy, "policy")
        chosen = chosen_pitch(pitch, rows[:, :dimension])
        with core_errors():
            self._tree = CoreTree.build(
                dimension,
                rows,
                chosen,
                faces=faces,
                winding=rule,
                policy=order_of_facets,
                seed=order,
                cuts=hyperplane_rows(cuts, dimension, chosen),
            )

    @classmethod
    def _of(cls, tree: CoreTree) -> Self:
        made = cls.__new__(cls)
        made._tree = tree
        return made

    @property
    def tree(self) -> "ObjectTree":
        """The object itself, which is its own partition tree."""
        return self

    # Making

    @classmethod
    def from_mesh(cls, mesh: Any, **options: Any) -> Self:
        """Return the set inside a closed mesh, given as any object that `Solid.from_mesh` takes.

        It is meant for small meshes: the number of nodes may grow with the square of the number of
        faces.

        Raises
        ------
        InvalidMeshError
            As for `Solid.from_mesh`.
        """
        vertices, faces = interop.own_arrays(*interop.arrays_from(mesh))
        return cls._of(ObjectTree(vertices[faces], **options)._tree)

    @classmethod
    def half_space(cls, normal: Any, offset: Scalar = 0.0, *, pitch: int | None = None) -> Self:
        """Return the minus side of a hyperplane: all points x with ``normal . x <= offset``.

        Floats are read as their shortest decimals. A hyperplane that contains lattice points is
        exact; any other is translated, by at most half a step, to the nearest parallel hyperplane
        that contains lattice points. This applies to all hyperplanes given to trees. (Normals of
        more than 62 bits in the plane, or 106 in space, are rounded to 61.)

        Parameters
        ----------
        normal : (1,), (2,) or (3,) float, or one number
            One number for each dimension.
        offset : float
        pitch : int, optional
            Exponent of the lattice step; by default -9, or down to -12 if the hyperplane needs it.
        """
        wanted = hyperplane(normal, offset)
        chosen = wanted.pitch if pitch is None else pitch_exponent(pitch)
        with core_errors():
            return cls._of(CoreTree.half_space(wanted.on_lattice(chosen).row, chosen))

    @classmethod
    def uniform(cls, dimension: int, *, full: bool, pitch: int = -9) -> Self:
        """Return the empty set (``full=False``) or the whole space, in 1, 2 or 3 dimensions."""
        count, step = dimension_number(dimension), pitch_exponent(pitch)
        with core_errors():
            return cls._of(CoreTree.uniform(count, truth_value(full, "full"), step))

    # Set operations

    def __invert__(self) -> Self:
        """Return the complement; its tree shares all nodes with this one."""
        return self._of(self._tree.complement())

    def _merged(self, other: TreeSet, op: SetOp) -> Self:
        a, b = self._aligned(other)
        with core_errors():
            return self._of(a.merge(b, op))

    def _aligned(self, other: TreeSet) -> tuple[CoreTree, CoreTree]:
        """Return the core trees of both sets on the finer of their two lattices."""
        if self.dimension != other.dimension:
            raise invalid_parameter(
                f"A set of dimension {self.dimension} cannot be combined with a set of"
                f" dimension {other.dimension}; both must have the same dimension."
            )
        # The empty set and the whole space fit on any lattice.
        pitches = [s.pitch for s in (self, other.tree) if not (s.is_empty or s.is_full)]
        pitch = min(pitches, default=self.pitch)
        return self._refined(pitch), other.tree._refined(pitch)

    def _refined(self, pitch: int) -> CoreTree:
        if pitch == self.pitch:
            return self._tree
        with core_errors():
            return self._tree.refined(pitch)

    def trace_merge(self, other: TreeSet, op: SetOp) -> MergeTrace:
        """Return the step-by-step trace of a set operation that merges two trees.

        Parameters
        ----------
        other : ObjectTree, Region or Intervals
            A set of the same dimension.
        op : {"union", "intersection", "difference", "xor"}

        Notes
        -----
        Indices of nodes in the trace refer to ``trace.first`` and ``trace.second``, the operands on
        one lattice. ``trace.result`` is the merged tree itself; the operators of `Region` may
        return another tree of the same set.
        """
        one_of(SET_OPS, op, "op")
        a, b = self._aligned(set_of(other))
        with core_errors():
            result, rows = a.merge_steps(b, op)
        return merge_trace(self._of(a), self._of(b), self._of(result), op, rows)

    def equals(self, other: TreeSet) -> bool:
        """Return true if both sets contain exactly the same points, as ``==`` does.

        Raises
        ------
        InvalidMeshError
            If the other set has another dimension; ``==`` then returns False.
        """
        tree = set_of(other).tree
        try:
            a, b = self._aligned(tree)
        except LimitError:
            # Measures are exact on any lattice, so different measures prove different sets.
            if self._size_key() == tree._size_key():
                raise
            return False
        with core_errors():
            return a.equals(b)

    def _size_key(self) -> object:
        if self.is_bounded:
            return self.dimension, self.measure
        outside = ~self
        # If the set and its complement are unbounded, only the dimension is cheap to compare.
        return self.dimension, -outside.measure - 1 if outside.is_bounded else None

    # Queries

    def nearest(self, points: Any) -> tuple[FloatArray, FloatArray]:
        """Return for each point the nearest boundary point, and its distance.

        Parameters
        ----------
        points : (k, d) array_like of float
            In model units; on the line, shape (k,) is allowed.

        Returns
        -------
        nearest : (k, d) float64
            The nearest boundary points, rounded; of several, the one on the first boundary piece.
        distance : (k,) float64

        Raises
        ------
        InvalidMeshError
            If the set has no boundary, or a point is not finite.
        """
        return nearest_on_boundary(self, points)

    def boundary(self) -> Pieces:
        """Return the boundary as convex pieces, each with the node in whose cut it lies.

        The pieces of an unbounded set end at the border of the lattice.
        """
        with core_errors():
            return Pieces(*self._tree.boundary())

    def cells(self) -> Pieces:
        """Return the set divided into convex cells, the inside leaves, each given by its faces.

        Raises
        ------
        UnboundedError
            If the set reaches to infinity.
        """
        with core_errors():
            return Pieces(*self._tree.cells())

    @property
    def nodes(self) -> NodeTable:
        """The inner nodes of the tree as arrays; empty if the tree is a single leaf."""
        with core_errors():
            return NodeTable(*self._tree.nodes, tuple(map(tuple, self._tree.hyperplanes())))

    def stats(self) -> dict[str, int]:
        """Return the tree's numbers of inner nodes, leaves and fragments, and its depth."""
        return self._tree.stats()

    # Division by a hyperplane

    def partitioned(self, normal: Any, offset: Scalar = 0.0) -> Self:
        """Return the same set as a tree whose root is cut by the given hyperplane.

        A tree of a single leaf stays a leaf, since both halves would be equal.
        """
        row = self._row(normal, offset)
        with core_errors():
            return self._of(self._tree.partitioned(row))

    def split(self, normal: Any, offset: Scalar = 0.0) -> tuple[Self, Self]:
        """Return the parts of the set on the minus and on the plus side of a hyperplane.

        If the hyperplane is outside the range of the lattice, a bounded set is on one side of it.
        """
        is_above = hyperplane(normal, offset, self.dimension).is_above_lattice(self.pitch)
        if is_above is not None and self.is_bounded:
            nothing = self.uniform(self.dimension, full=False, pitch=self.pitch)
            return (self, nothing) if is_above else (nothing, self)
        row = self._row(normal, offset)
        with core_errors():
            minus, plus = self._tree.split(row)
        return self._of(minus), self._of(plus)

    def split_case(self, normal: Any, offset: Scalar = 0.0) -> SplitCase:
        """Return how the cut of the root and a splitting hyperplane lie relative to each other.

        Returns
        -------
        str
            "leaf": the root is a leaf. "same", "opposite": the hyperplane coincides with the root's
            cut, with equal or exchanged sides. "crossing": each cuts the other. Otherwise
            "minus-minus", "minus-plus", "plus-minus" or "plus-plus": first the side of the root's
            cut on which the hyperplane lies, then the side of the hyperplane on which the root's
            cut lies, both within the root's region.

        Notes
        -----
        These are the cases of the table in Naylor, Amanatides, Thibault 1990, section 4.
        """
        row = self._row(normal, offset)
        with core_errors():
            return self._tree.split_case(row)

    def _row(self, normal: Any, offset: Scalar) -> list[int]:
        return hyperplane_row(normal, offset, self.dimension, self.pitch)

    def condensed(self) -> Self:
        """Return the same set as a balanced tree built from its own boundary (1D and 2D).

        This removes cuts that a merged tree does not need. In 3D the same tree is returned.
        """
        with core_errors():
            return self._of(self._tree.condensed())

    # As a value

    def __repr__(self) -> str:
        """Return a text with the dimension, the number of nodes and the depth."""
        if self.is_empty or self.is_full:
            what = "empty" if self.is_empty else "full"
        else:
            stats = self.stats()
            what = f"{stats['nodes']} nodes, depth {stats['depth']}"
        return f"{type(self).__name__}({self.dimension}D, {what})"

    def __reduce__(self) -> tuple[Any, tuple[type["ObjectTree"], bytes]]:
        """Pickle the nodes of the tree, exactly, without the input facets in their cuts."""
        return _restored, (type(self), self._tree.dump())


def merge(a: Set, b: TreeSet, op: SetOp) -> Set:
    """Return the result of a set operation on two sets of one dimension, by merging their trees.

    Parameters
    ----------
    a, b : ObjectTree, Region or Intervals
    op : {"union", "intersection", "difference", "xor"}

    Notes
    -----
    Naylor, Amanatides, Thibault 1990, section 3. The result has the nodes of `a` above those of
    `b`. For regions this calls their operators, which may sweep over boundaries instead;
    ``merge(a.tree, b.tree, op)`` always merges trees.
    """
    one_of(SET_OPS, op, "op")
    set_of(a, "a")
    return a._merged(set_of(b, "b"), op)


def partition_tree(tree: ObjectTree, hyperplane: NormalAndOffset) -> ObjectTree:
    """Return the same set as a tree with `hyperplane` as root cut (`ObjectTree.partitioned`)."""
    return instance_of(ObjectTree, tree, "tree").partitioned(*pairs_of([hyperplane])[0])


def split_tree(tree: Set, hyperplane: NormalAndOffset) -> tuple[Set, Set]:
    """Return a tree's parts on the minus and on the plus side of a hyperplane.

    See `ObjectTree.split`.

    In the paper by Naylor et al. there is a third argument, the part of the hyperplane inside the
    root's region; here it is computed from the tree and the hyperplane.
    """
    set_of(tree, "tree")
    return tree.split(*pairs_of([hyperplane])[0])


def _restored(kind: type[ObjectTree], data: bytes) -> ObjectTree:
    with core_errors():
        return kind._of(CoreTree.load(data))
