"""Leaves of expressions: operands that are partition trees, or can become one directly.

A leaf returns its tree at a pitch, and can be placed by a transform. Placing follows one rule
(`_place`): the outermost factors that are lattice motions move the tree exactly; the other factors
act on the leaf's coordinates with one rounding, before they are snapped to the lattice again.
"""

from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any, TypeAlias
from weakref import WeakKeyDictionary

import numpy as np

from .._core import Tree
from .._types import FloatArray, IndexArray, ProgramLine, WindingRule
from ..attributes.attributes import Attributes
from ..attributes.colours import COLOR, one_color
from ..errors import InvalidMeshError, LimitError, UnboundedError, core_errors
from ..geometry import transform
from ..geometry.chain import BLOCK, FactorBlock, FactorChain
from ..geometry.hyperplane import DEFAULT_PITCH, Hyperplane, exact_number
from ..once import Last, Once
from ..parameters import MAX_PITCH
from .extent import EXTENTS, Extent
from .moving import AttributedMesh
from .program import COMPLEMENT
from .sewing import sewn
from .source_attributes import (
    SourceAttributes,
    after_motion,
    all_tagged,
    attributes_of,
    inherited,
    patched,
)


def _crosses_there(tree: Tree, motion: transform.LatticeMotion) -> bool:
    with core_errors():
        return tree.moving_crosses(list(motion.axes), list(motion.shift))


class Pitches(Last[int, Tree]):
    """A cache of a tree on the last finer lattice, so that all users there share one mesh."""

    __slots__ = ()

    def of(self, tree: Tree, pitch: int) -> Tree:
        """Return the same solid on the lattice of this pitch, which must not be coarser."""
        if tree.pitch == pitch:
            return tree
        known = self.get(pitch)
        if known is not None:
            return known
        with core_errors():
            return self.keep(pitch, tree.refined(pitch))


#: The smallest number of lattice steps across a mesh whose corners may be rounded to the lattice of
#: other operands. Import uses no fewer either.
_MIN_STEPS_ACROSS = 10**6


class MeshLeaf:
    """A leaf of a given mesh.

    Parameters
    ----------
    vertices : (n, 3) float64, in model units
    faces : (m, 3) int64, indices of `vertices`
        Both may belong to the caller until `let_go` is called.
    pitch : int or None
        Exponent of the lattice step; by default the core chooses it from the size.
    trusted : bool
        True if the caller guarantees that the mesh is closed and its faces meet only in edges and
        vertices.
    winding : str
        The winding numbers that are inside.
    attributes : Attributes, optional
        The attributes of the mesh.
    """

    def __init__(
        self,
        vertices: FloatArray,
        faces: IndexArray,
        pitch: int | None = None,
        trusted: bool = False,
        winding: WindingRule = "positive",
        attributes: Attributes | None = None,
    ) -> None:
        self._content: _Settled | _Moved = _Settled((vertices, faces), attributes)
        self._chosen_pitch = pitch
        self._trusted = trusted
        self._winding = winding
        self._tree: Once[Tree] = Once()
        self._rounded: str | None = None
        self._is_moved = False
        #: The pitch that transforms keep, as far as its lattice reaches; None for one that suits.
        self.given_pitch = pitch
        self._pitches = Pitches()
        self.last_moved: Last[FactorChain, ExpressionLeaf] = Last()

    @property
    def pitch(self) -> int | None:
        """Exponent of the lattice step."""
        return self.grown().pitch if self._chosen_pitch is None else self._chosen_pitch

    @property
    def extent(self) -> Extent:
        """A closed mesh is bounded."""
        return True

    @property
    def source_attributes(self) -> SourceAttributes:
        """The attributes of the mesh."""
        said = self._settled().attributes
        return () if said is None else (said,)

    def arrays(self) -> tuple[FloatArray, IndexArray]:
        """Return vertices and faces as given or as moved."""
        arrays = self._settled().arrays
        return self.grown().given_arrays() if arrays is None else arrays

    def let_go(self) -> None:
        """Release the given arrays: the tree holds their data, or they are copied."""
        vertices, faces = self.arrays()
        held = self.grown().holds_given
        arrays = None if held else (vertices.copy(), faces.copy())
        self._content = replace(self._settled(), arrays=arrays)

    def grown(self) -> Tree:
        """Return the tree on the leaf's own lattice, made on first use."""
        return self._tree.of(self._grow)

    def tree(self, pitch: int) -> Tree:
        """Return the tree on the lattice of this pitch."""
        return self._pitches.of(self.grown(), pitch)

    def placed(self, factors: FactorChain) -> "ExpressionLeaf":
        """Return the leaf moved by the factors, outermost first."""
        return _place(self, factors)

    def coarsened(self, pitch: int) -> "MeshLeaf | None":
        """Return the leaf on a coarser lattice, with a note if that moves its corners.

        Return None if they would move, and the mesh has few steps there.
        """
        vertices, faces = self.arrays()
        is_exact = np.array_equal(np.round(vertices, -pitch), vertices)
        if not is_exact and np.ptp(vertices, axis=0).max() < _MIN_STEPS_ACROSS * 10.0**pitch:
            return None
        leaf = MeshLeaf(vertices, faces, pitch, False, self._winding)
        leaf._content = replace(self._settled(), arrays=(vertices, faces))
        if not is_exact:
            leaf._rounded = (
                f"an operand was rounded to a coarser lattice of step 10^{pitch}, because"
                f" another operand is too large for its own lattice of step 10^{self.pitch}"
            )
        return leaf

    def transformed(self, factors: FactorChain) -> "MeshLeaf":
        """Return the leaf of the mesh with vertices moved by the factors."""
        # Rounding moves vertices, so the caller's guarantee no longer holds.
        said = AttributedMesh(*self.arrays(), self._settled().attributes)
        found = None if self._trusted else sewn(said, self.grown())
        mesh = said if found is None else found.mesh
        return MeshLeaf.moved(mesh, factors, self.given_pitch, self._winding)

    def touches_itself(self, motion: transform.LatticeMotion) -> bool:
        """Return whether rounding made the mesh cross itself, or would after this motion.

        If so, its coordinates must be moved and mended instead of its tree.
        """
        return self._settled().is_mended or _crosses_there(self.grown(), motion)

    @classmethod
    def moved(
        cls,
        mesh: AttributedMesh,
        factors: FactorChain,
        pitch: int | None = None,
        winding: WindingRule = "positive",
    ) -> "MeshLeaf":
        """Return the leaf of a moved mesh; crossings from moving are mended before its first use.

        The leaf is on the lattice of the given pitch, unless the mesh reaches beyond that.
        """
        moved = mesh.moved(factors)
        held = moved.held_pitch(pitch)
        leaf = cls(moved.vertices, moved.faces, held, False, winding, moved.attributes)
        leaf._is_moved = True
        leaf._chosen_pitch = moved.suited_pitch() if held is None else held
        if leaf._chosen_pitch is not None:
            leaf._content = _Moved(moved, mesh.vertices, leaf._chosen_pitch)
        return leaf

    @cached_property
    def shown(self) -> Tree:
        """The tree as it is made into a mesh."""
        return patched(self.grown(), self.source_attributes)

    def _settled(self) -> "_Settled":
        """Return the content; crossings from moving the vertices are mended on first use."""
        content = self._content
        if isinstance(content, _Moved):
            content = self._content = content.mended()
        return content

    def _grow(self) -> Tree:
        try:
            return self._imported()
        except InvalidMeshError as error:
            # A transform may make a mesh so thin that rounding leaves nothing.
            if not self._is_moved or error.code != "empty_mesh":
                raise
            pitch = DEFAULT_PITCH if self._chosen_pitch is None else self._chosen_pitch
            return Tree.empty(pitch)

    def _imported(self) -> Tree:
        with core_errors():
            tree = Tree.from_mesh(*self.arrays(), self._chosen_pitch, self._trusted, self._rounded)
            # A mended mesh touches itself, and may cross on the lattice.
            if self._settled().is_mended or self._winding != "positive":
                tree = tree.normalized(self._winding)
        return tree


@dataclass(frozen=True, eq=False)
class _Settled:
    """The content of a leaf that needs no more mending.

    Parameters
    ----------
    arrays : (n, 3) float64 and (m, 3) int64, or None
        None if the tree holds them.
    attributes : Attributes or None
    is_mended : bool
        True if moving the vertices made the mesh cross itself.
    """

    arrays: tuple[FloatArray, IndexArray] | None
    attributes: Attributes | None
    is_mended: bool = False


@dataclass(frozen=True, eq=False)
class _Moved:
    """A moved mesh, whose crossings are mended on demand.

    Parameters
    ----------
    mesh : AttributedMesh
    before : (n, 3) float64
        The vertices before they were moved.
    pitch : int
    """

    mesh: AttributedMesh
    before: FloatArray
    pitch: int
    _result: Once[_Settled] = field(default_factory=Once, init=False, repr=False)

    def mended(self) -> _Settled:
        """Return the mended mesh."""
        return self._result.of(self._mend)

    def _mend(self) -> _Settled:
        found = self.mesh.mended(self.before, self.pitch)
        mesh = self.mesh if found is None else found.mesh
        return _Settled((mesh.vertices, mesh.faces), mesh.attributes, found is not None)


@dataclass(frozen=True, eq=False)
class Record:
    """The evaluation of a tree: a program and its leaves, which have no records themselves."""

    program: list[ProgramLine]
    leaves: tuple["ExpressionLeaf", ...]


@dataclass(frozen=True, eq=False)
class TreeLeaf:
    """A leaf of a tree that was evaluated, loaded or moved.

    Parameters
    ----------
    result : Tree
    record : Record or None
        The record of its evaluation, if it is kept.
    extent : Extent
    source_attributes : tuple of Attributes or None
        The attributes of each source of the tree; empty if there are none.
    given_pitch : int or None
        As for `MeshLeaf`.
    tags : mapping of str to object
        The attributes that `tagged` set on all faces, in case the record is run again.
    """

    result: Tree
    record: Record | None = None
    extent: Extent = None
    source_attributes: SourceAttributes = ()
    given_pitch: int | None = None
    tags: Mapping[str, object] = field(default_factory=dict)
    _pitches: Pitches = field(default_factory=Pitches, init=False, repr=False)
    last_moved: "Last[FactorChain, ExpressionLeaf]" = field(
        default_factory=Last, init=False, repr=False
    )

    @property
    def pitch(self) -> int | None:
        """Exponent of the lattice step."""
        return self.result.pitch

    def tree(self, pitch: int) -> Tree:
        """Return the tree on the lattice of this pitch."""
        return self._pitches.of(self.result, pitch)

    def placed(self, factors: FactorChain) -> "ExpressionLeaf":
        """Return the leaf moved by the factors, outermost first."""
        return self if self.is_constant else _place(self, factors)

    def transformed(self, factors: FactorChain) -> "ExpressionLeaf | None":
        """Return the leaf of the moved output mesh; shared vertices stay shared.

        None if neither the solid nor its complement has an output mesh.
        """
        return self._made_anew(lambda leaf: _moved_output(leaf, factors))

    def coarsened(self, pitch: int) -> "ExpressionLeaf | None":
        """Return the leaf of the output mesh on a coarser lattice; None as for `transformed`."""
        return self._made_anew(lambda leaf: _moved_output(leaf, FactorChain()).coarsened(pitch))

    def _made_anew(self, make: "Callable[[TreeLeaf], MeshLeaf | None]") -> "ExpressionLeaf | None":
        """Apply a function to the solid's mesh, or to its complement's mesh and complement that."""
        if self._is_bounded():
            return make(self)
        outside = run(Record(COMPLEMENT, (self,)))
        mesh = make(outside) if outside._is_bounded() else None
        if mesh is None:
            return None
        made = run(Record(COMPLEMENT, (mesh,)))
        return replace(made, record=None, extent=False)

    def touches_itself(self, motion: transform.LatticeMotion) -> bool:
        """Return whether a mesh of the tree would cross itself after this motion."""
        return _crosses_there(self.result, motion)

    def forgetful(self) -> "TreeLeaf":
        """Return the leaf without its record, unless a later transform would need the record.

        A solid that is unbounded with an unbounded complement has no mesh to transform. Expressions
        with half-spaces may give such solids.
        """
        if self.extent is None:
            return self
        return replace(self, record=None)

    @cached_property
    def shown(self) -> Tree:
        """The tree as it is made into a mesh."""
        return patched(self.result, self.source_attributes)

    @property
    def is_constant(self) -> bool:
        """True for the empty set and for all of space, which no transform changes."""
        return self.result.is_empty or self.result.is_full

    def _is_bounded(self) -> bool:
        return self.result.is_bounded if self.extent is None else self.extent


@dataclass(frozen=True, eq=False)
class PlaneLeaf:
    """The half-space on the minus side of a plane; it takes the pitch of the other operands.

    Parameters
    ----------
    plane : Hyperplane
    """

    plane: Hyperplane
    pitch: int | None = field(default=None, init=False)
    given_pitch: int | None = field(default=None, init=False)
    extent: Extent = field(default=None, init=False)
    source_attributes: SourceAttributes = field(default=(), init=False)
    _images: WeakKeyDictionary[FactorBlock, Hyperplane] = field(
        default_factory=WeakKeyDictionary, init=False, repr=False
    )
    _trees: Last[int, Tree] = field(default_factory=Last, init=False, repr=False)

    def tree(self, pitch: int) -> Tree:
        """Return the tree on the lattice of this pitch."""
        known = self._trees.get(pitch)
        if known is not None:
            return known
        plane = self.plane.on_lattice(pitch)
        with core_errors():
            return self._trees.keep(pitch, Tree.half_space(plane.row, pitch, plane.note))

    def beyond(self, pitch: int) -> "ConstantLeaf | None":
        """Return the empty set or all of space if the plane lies beyond the lattice, else None."""
        above = self.plane.is_above_lattice(pitch)
        return None if above is None else ConstantLeaf(above)

    def placed(self, factors: FactorChain) -> "ExpressionLeaf":
        """Return the half-space moved by the factors, outermost first, in exact numbers."""
        return PlaneLeaf(factors.fold(self.plane, _moved_plane, self._images))


def _moved_plane(plane: Hyperplane, factor: transform.Factor) -> Hyperplane:
    """Return the image of a plane; cofactors map its normal without inverting the matrix."""
    cofactors, determinant, shift = _exact_parts(factor)
    old = [entry if determinant > 0 else -entry for entry in map(Fraction, plane.normal)]
    normal = [transform.exact_dot(row, old) for row in cofactors]
    offset = abs(determinant) * plane.offset + transform.exact_dot(normal, shift)
    return Hyperplane.of(normal, offset, plane.exact).shortened()


@lru_cache(maxsize=2 * BLOCK)
def _exact_parts(
    factor: transform.Factor,
) -> tuple[list[list[Fraction]], Fraction, list[Fraction]]:
    """Return the cofactors and the determinant of the linear part, and the shift."""
    linear = _linear_part(factor)
    shift = [exact_number(entry) for entry in factor.matrix[:3, 3].tolist()]
    return transform.cofactors(linear), transform.determinant(linear), shift


def _linear_part(factor: transform.Factor) -> list[list[Fraction]]:
    """Return the rows as their decimals, if these have the same orientation as the doubles."""
    rows = [[exact_number(entry) for entry in row] for row in factor.matrix[:3, :3].tolist()]
    sign = transform.determinant_sign(factor.matrix)
    return rows if sign * transform.determinant(rows) > 0 else transform.exact_linear(factor.matrix)


@dataclass(frozen=True, eq=False)
class ConstantLeaf:
    """The empty set, or all of space; no transform changes it."""

    full: bool
    pitch: int | None = field(default=None, init=False)
    given_pitch: int | None = field(default=None, init=False)
    source_attributes: SourceAttributes = field(default=(), init=False)

    @property
    def extent(self) -> Extent:
        """The empty set is bounded; all of space has a bounded complement."""
        return not self.full

    def tree(self, pitch: int) -> Tree:
        """Return the tree on the lattice of this pitch."""
        with core_errors():
            return Tree.full(pitch) if self.full else Tree.empty(pitch)

    def placed(self, factors: FactorChain) -> "ExpressionLeaf":
        """Return the same set."""
        del factors
        return self


ExpressionLeaf: TypeAlias = MeshLeaf | TreeLeaf | PlaneLeaf | ConstantLeaf


def tree_of(leaf: ExpressionLeaf) -> Tree:
    """Return the leaf's tree on its own lattice, or on the default one if it has none."""
    return leaf.tree(_common_pitch([leaf]))


def shown_tree(leaf: ExpressionLeaf) -> Tree:
    """Return the tree for the leaf's mesh: faces with different attributes are not joined."""
    if leaf.source_attributes and isinstance(leaf, (MeshLeaf, TreeLeaf)):
        return leaf.shown
    return tree_of(leaf)


def tagged(leaf: ExpressionLeaf, values: Mapping[str, object]) -> ExpressionLeaf:
    """Return a leaf with attribute values on every face; half-spaces have no faces.

    Its sources get new identities, since other copies of the leaf may have other values.
    """
    if COLOR in values:
        values = {**values, COLOR: one_color(values[COLOR])}
    if not values or isinstance(leaf, (PlaneLeaf, ConstantLeaf)):
        return leaf
    with core_errors():
        tree = tree_of(leaf).renamed()
    said = all_tagged(tree, leaf.source_attributes, values)
    if isinstance(leaf, MeshLeaf):
        return TreeLeaf(tree, None, leaf.extent, said, leaf.given_pitch)
    return replace(leaf, result=tree, source_attributes=said, tags={**leaf.tags, **values})


def _common_pitch(leaves: Sequence[ExpressionLeaf]) -> int:
    """Return the finest of the leaves' pitches; planes count only if there are no other leaves."""
    own = [leaf.pitch for leaf in leaves if leaf.pitch is not None]
    if own:
        return min(own)
    planes = [leaf.plane.pitch for leaf in leaves if isinstance(leaf, PlaneLeaf)]
    return min(planes, default=DEFAULT_PITCH)


def _given_pitch_of(leaves: Sequence[ExpressionLeaf], result: Tree) -> int | None:
    """Return the pitch of a result if it was given for all leaves of that pitch."""
    given = {leaf.given_pitch for leaf in leaves if leaf.pitch == result.pitch}
    return result.pitch if given == {result.pitch} else None


def run(record: Record) -> TreeLeaf:
    """Evaluate a program on its leaves, all on one lattice (see `_on_one_lattice`)."""
    extents = [leaf.extent for leaf in record.leaves]
    extent = EXTENTS.evaluate(record.program, extents)
    leaves, trees = _on_one_lattice(record.leaves, extent)
    with core_errors():
        result = Tree.evaluate(record.program, trees)
    operands = [(tree, leaf.source_attributes) for tree, leaf in zip(trees, leaves, strict=True)]
    given = _given_pitch_of(record.leaves, result)
    return TreeLeaf(result, record, extent, inherited(result, operands), given)


def bounded_on_one_lattice(leaves: Sequence[ExpressionLeaf]) -> list[Tree]:
    """Return the trees of bounded solids on a common lattice (see `_on_one_lattice`)."""
    return _on_one_lattice(leaves, True)[1]


def _on_one_lattice(
    leaves: Sequence[ExpressionLeaf], extent: Extent
) -> tuple[Sequence[ExpressionLeaf], list[Tree]]:
    """Return leaves and their trees on the finest of their lattices that holds all of them.

    Parameters
    ----------
    leaves : sequence of leaves
    extent : Extent
        The extent of the result. If it is known, planes beyond the lattice do not affect the
        result.
    """
    pitch = _common_pitch(leaves)
    try:
        return leaves, [leaf.tree(pitch) for leaf in leaves]
    except LimitError:
        coarser = _finest_for_all(leaves, extent)
        found = [_fitted(leaf, coarser, extent) for leaf in leaves]
        fitted = [leaf for leaf in found if leaf is not None]
        if len(fitted) < len(found):
            raise
        return fitted, [leaf.tree(coarser) for leaf in fitted]


def _finest_for_all(leaves: Sequence[ExpressionLeaf], extent: Extent) -> int:
    """Return the finest pitch whose lattice holds every leaf of a coarser pitch."""
    finest = _common_pitch(leaves)
    coarser = range(finest, MAX_PITCH)
    fitting = (
        pitch for pitch in coarser if all(_fits_lattice(leaf, pitch, extent) for leaf in leaves)
    )
    return next(fitting, finest)


def _fits_lattice(leaf: ExpressionLeaf, pitch: int, extent: Extent) -> bool:
    if isinstance(leaf, PlaneLeaf):
        return extent is not None or leaf.beyond(pitch) is None
    if leaf.pitch is None or leaf.pitch <= pitch:
        return True
    try:
        leaf.tree(pitch)
    except LimitError:
        return False
    return True


def _fitted(leaf: ExpressionLeaf, pitch: int, extent: Extent) -> ExpressionLeaf | None:
    """Return a leaf for a lattice that may be coarser than its own, or None if it has none."""
    if isinstance(leaf, PlaneLeaf):
        return leaf if extent is None else leaf.beyond(pitch) or leaf
    if isinstance(leaf, ConstantLeaf) or leaf.pitch is None or leaf.pitch >= pitch:
        return leaf
    return leaf if isinstance(leaf, TreeLeaf) and leaf.is_constant else leaf.coarsened(pitch)


def _moved_output(leaf: TreeLeaf, factors: FactorChain) -> MeshLeaf:
    tree = leaf.shown
    with core_errors():
        vertices, faces = tree.to_mesh()
    said = attributes_of(tree, leaf.source_attributes) if leaf.source_attributes else None
    return MeshLeaf.moved(AttributedMesh(vertices, faces, said), factors, leaf.given_pitch)


#: Something that is being moved: it asks for leaves under factors, and is sent them where they go.
_Moving: TypeAlias = Generator[tuple["ExpressionLeaf", FactorChain], "ExpressionLeaf", Any]


def _place(leaf: MeshLeaf | TreeLeaf, factors: FactorChain) -> ExpressionLeaf:
    """Move a leaf, or its operands instead, without recursion."""
    waiting = [_placing(leaf, factors)]
    answer: Any = None
    while waiting:
        try:
            operand, under = waiting[-1].send(answer)
        except StopIteration as ended:
            waiting.pop()
            answer = ended.value
            continue
        if isinstance(operand, TreeLeaf) and not operand.is_constant:
            waiting.append(_placing(operand, under))
            answer = None
        else:
            answer = operand.placed(under)
    moved: ExpressionLeaf = answer
    return moved


def _placing(leaf: MeshLeaf | TreeLeaf, factors: FactorChain) -> _Moving:
    """Move a leaf exactly by the outer factors that allow it, and by coordinates for the rest."""
    inner = factors.inner
    if len(inner) == len(factors):
        return (yield from _transforming(leaf, factors)) if factors else leaf
    base = (yield from _base(leaf, inner)) if inner else leaf
    motion = factors.outer_motion(_common_pitch([base]))
    if motion is None:
        return (yield from _transforming(leaf, factors))
    if isinstance(base, (MeshLeaf, TreeLeaf)) and base.touches_itself(motion):
        return (yield from _transforming(leaf, factors))
    try:
        with core_errors():
            moved = tree_of(base).moved(list(motion.axes), list(motion.shift))
        source_attributes = after_motion(motion, base.source_attributes)
        return TreeLeaf(moved, None, base.extent, source_attributes, base.given_pitch)
    except (LimitError, UnboundedError):
        # The leaf leaves this lattice; its coordinates let the core choose a coarser one. Or it is
        # cut off by the border of the lattice, which does not move with it.
        return (yield from _transforming(leaf, factors))


def _base(leaf: MeshLeaf | TreeLeaf, factors: FactorChain) -> _Moving:
    """Move the mesh of a leaf, once for all placements that differ by lattice motions."""
    known = leaf.last_moved.get(factors)
    if known is not None:
        return known
    return leaf.last_moved.keep(factors, (yield from _transforming(leaf, factors)))


def _transforming(leaf: MeshLeaf | TreeLeaf, factors: FactorChain) -> _Moving:
    """Move the mesh of a leaf, or its operands if it has none."""
    moved = leaf.transformed(factors)
    if moved is not None:
        return moved
    if not isinstance(leaf, TreeLeaf) or leaf.record is None:
        raise UnboundedError(
            "This solid and its complement both reach to infinity, so it has no mesh that"
            " could be transformed; transform the operands of the operation instead.",
            "unbounded",
        )
    leaves = []
    for operand in leaf.record.leaves:
        leaves.append((yield operand, factors))
    return tagged(run(Record(leaf.record.program, tuple(leaves))), leaf.tags)
