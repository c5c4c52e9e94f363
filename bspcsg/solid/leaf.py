"""Leaves of expressions: operands that are partition trees, or can become one directly.

A leaf returns its tree on the lattice of a pitch, and its image under a transform, which is a chain
of affine maps (factors). Images follow one rule (`_transformed_leaf`): the outermost factors that
are lattice motions move the tree exactly; the other factors transform the coordinates of the leaf's
mesh, which are rounded once and snapped to the lattice again.
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
from ..caching import LastValueCache, LazyValue
from ..errors import InvalidMeshError, LimitError, UnboundedError, core_errors
from ..geometry import transform
from ..geometry.chain import BLOCK, FactorBlock, FactorChain
from ..geometry.hyperplane import DEFAULT_PITCH, Hyperplane, exact_number
from ..parameters import MAX_PITCH
from .boundedness import EXTENTS, Extent
from .mesh_transform import AttributedMesh
from .program import COMPLEMENT
from .sewing import sewn
from .source_attributes import (
    SourceAttributes,
    after_motion,
    all_tagged,
    attributes_of,
    inherited,
    with_patches,
)


def _crosses_there(tree: Tree, motion: transform.LatticeMotion) -> bool:
    with core_errors():
        return tree.moving_crosses(list(motion.axes), list(motion.shift))


class Pitches(LastValueCache[int, Tree]):
    """A cache of a solid's tree on the last finer lattice for which it was computed."""

    __slots__ = ()

    def of(self, tree: Tree, pitch: int) -> Tree:
        """Return the tree of the same solid on a lattice at least as fine, given its pitch."""
        if tree.pitch == pitch:
            return tree
        known = self.get(pitch)
        if known is not None:
            return known
        with core_errors():
            return self.keep(pitch, tree.refined(pitch))


#: The smallest extent, in lattice steps, of a mesh whose corners may be rounded to the coarser
#: lattice of another operand. Import chooses no lattice with fewer steps across a mesh either.
_MIN_STEPS_ACROSS = 10**6


class MeshLeaf:
    """A leaf of an expression that is a mesh; its partition tree is made on first use.

    Parameters
    ----------
    vertices : (n, 3) float64, in model units
    faces : (m, 3) int64, indices of `vertices`
        Both arrays may belong to the caller until `release_arrays` is called.
    pitch : int or None
        Exponent of the lattice step; by default the core chooses it from the size.
    trusted : bool
        True if the caller guarantees that the mesh is closed and its faces meet only in edges and
        vertices.
    winding : str
        The rule that says which winding numbers are inside.
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
        self._tree: LazyValue[Tree] = LazyValue()
        self._rounded: str | None = None
        self._is_moved = False
        #: The pitch that transforms keep if its lattice has the range; None to choose by size.
        self.given_pitch = pitch
        self._pitches = Pitches()
        self.last_moved: LastValueCache[FactorChain, ExpressionLeaf] = LastValueCache()

    @property
    def pitch(self) -> int | None:
        """Exponent of the lattice step."""
        return self.own_tree().pitch if self._chosen_pitch is None else self._chosen_pitch

    @property
    def extent(self) -> Extent:
        """True, since a closed mesh is bounded."""
        return True

    @property
    def source_attributes(self) -> SourceAttributes:
        """The attributes of the mesh, as those of its only source; empty if it has none."""
        said = self._settled().attributes
        return () if said is None else (said,)

    def arrays(self) -> tuple[FloatArray, IndexArray]:
        """Return the mesh's vertices and faces, after the transform that made the leaf, if any."""
        arrays = self._settled().arrays
        return self.own_tree().given_arrays() if arrays is None else arrays

    def release_arrays(self) -> None:
        """Release the caller's arrays; copy them unless the tree stores the same data."""
        vertices, faces = self.arrays()
        held = self.own_tree().holds_given
        arrays = None if held else (vertices.copy(), faces.copy())
        self._content = replace(self._settled(), arrays=arrays)

    def own_tree(self) -> Tree:
        """Return the mesh's partition tree on its own lattice; the first call makes the tree."""
        return self._tree.get(self._grow)

    def tree(self, pitch: int) -> Tree:
        """Return the leaf's partition tree on the lattice of step ``10**pitch``."""
        return self._pitches.of(self.own_tree(), pitch)

    def placed(self, factors: FactorChain) -> "ExpressionLeaf":
        """Return the leaf's image under a chain of affine maps, the outermost map first."""
        return _transformed_leaf(self, factors)

    def coarsened(self, pitch: int) -> "MeshLeaf | None":
        """Return the leaf on a coarser lattice, with a finding if its corners must be rounded.

        Return None if corners must be rounded and the mesh measures less than `_MIN_STEPS_ACROSS`
        steps of the coarser lattice.
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
        """Return the leaf of the mesh whose vertices a chain of affine maps has transformed."""
        # Rounding moves vertices, so the image of a trusted mesh is not trusted.
        said = AttributedMesh(*self.arrays(), self._settled().attributes)
        found = None if self._trusted else sewn(said, self.own_tree())
        mesh = said if found is None else found.mesh
        return MeshLeaf.moved(mesh, factors, self.given_pitch, self._winding)

    def touches_itself(self, motion: transform.LatticeMotion) -> bool:
        """Return true if rounding made the mesh cross itself, or would after a lattice motion.

        If so, its coordinates must be moved and mended instead of its tree.
        """
        return self._settled().is_mended or _crosses_there(self.own_tree(), motion)

    @classmethod
    def moved(
        cls,
        mesh: AttributedMesh,
        factors: FactorChain,
        pitch: int | None = None,
        winding: WindingRule = "positive",
    ) -> "MeshLeaf":
        """Return the leaf of a transformed mesh; crossings due to rounding are mended on first use.

        The leaf is on the lattice of `pitch`, unless that is None or the mesh exceeds its range.
        """
        moved = mesh.moved(factors)
        held = moved.pitch_in_range(pitch)
        leaf = cls(moved.vertices, moved.faces, held, False, winding, moved.attributes)
        leaf._is_moved = True
        leaf._chosen_pitch = moved.suited_pitch() if held is None else held
        if leaf._chosen_pitch is not None:
            leaf._content = _Moved(moved, mesh.vertices, leaf._chosen_pitch)
        return leaf

    @cached_property
    def mesh_tree(self) -> Tree:
        """The tree from which the mesh is made: faces with different attributes are not joined."""
        return with_patches(self.own_tree(), self.source_attributes)

    def _settled(self) -> "_Settled":
        """Return the mesh's arrays and attributes, after mending crossings due to a transform."""
        content = self._content
        if isinstance(content, _Moved):
            content = self._content = content.mended()
        return content

    def _grow(self) -> Tree:
        try:
            return self._imported()
        except InvalidMeshError as error:
            # A transform may make a mesh so thin that rounding leaves no triangle with area.
            if not self._is_moved or error.code != "empty_mesh":
                raise
            pitch = DEFAULT_PITCH if self._chosen_pitch is None else self._chosen_pitch
            return Tree.empty(pitch)

    def _imported(self) -> Tree:
        with core_errors():
            tree = Tree.from_mesh(*self.arrays(), self._chosen_pitch, self._trusted, self._rounded)
            # A mended mesh touches itself, and may cross itself once it is snapped to the lattice.
            if self._settled().is_mended or self._winding != "positive":
                tree = tree.normalized(self._winding)
        return tree


@dataclass(frozen=True, eq=False)
class _Settled:
    """The arrays and attributes of a mesh, after mending if a transform made it cross itself.

    Parameters
    ----------
    arrays : (n, 3) float64 and (m, 3) int64, or None
        None if they are read from the tree instead.
    attributes : Attributes or None
    is_mended : bool
        True if moving the vertices made the mesh cross itself.
    """

    arrays: tuple[FloatArray, IndexArray] | None
    attributes: Attributes | None
    is_mended: bool = False


@dataclass(frozen=True, eq=False)
class _Moved:
    """A transformed mesh whose crossings due to rounding have not been mended.

    Parameters
    ----------
    mesh : AttributedMesh
    before : (n, 3) float64
        The vertices before they were moved.
    pitch : int
        Exponent of the lattice step.
    """

    mesh: AttributedMesh
    before: FloatArray
    pitch: int
    _result: LazyValue[_Settled] = field(default_factory=LazyValue, init=False, repr=False)

    def mended(self) -> _Settled:
        """Return the mesh without the crossings that rounding caused; computed once."""
        return self._result.get(self._mend)

    def _mend(self) -> _Settled:
        found = self.mesh.mended(self.before, self.pitch)
        mesh = self.mesh if found is None else found.mesh
        return _Settled((mesh.vertices, mesh.faces), mesh.attributes, found is not None)


@dataclass(frozen=True, eq=False)
class Record:
    """The program that made a tree, and its operands, which have no records themselves."""

    program: list[ProgramLine]
    leaves: tuple["ExpressionLeaf", ...]


@dataclass(frozen=True, eq=False)
class TreeLeaf:
    """A leaf of an expression that is a partition tree: evaluated, loaded or moved.

    Parameters
    ----------
    result : Tree
    record : Record or None
        The program and the operands that made the tree, if they are stored.
    extent : Extent
        Whether the solid, or its complement, is bounded.
    source_attributes : tuple of Attributes or None
        The attributes of each source of the tree; empty if there are none.
    given_pitch : int or None
        As for `MeshLeaf`.
    tags : mapping of str to object
        The attributes that `tagged_leaf` set on all faces, in case the program is run again.
    """

    result: Tree
    record: Record | None = None
    extent: Extent = None
    source_attributes: SourceAttributes = ()
    given_pitch: int | None = None
    tags: Mapping[str, object] = field(default_factory=dict)
    _pitches: Pitches = field(default_factory=Pitches, init=False, repr=False)
    last_moved: "LastValueCache[FactorChain, ExpressionLeaf]" = field(
        default_factory=LastValueCache, init=False, repr=False
    )

    @property
    def pitch(self) -> int | None:
        """Exponent of the lattice step."""
        return self.result.pitch

    def tree(self, pitch: int) -> Tree:
        """Return the leaf's partition tree on the lattice of step ``10**pitch``."""
        return self._pitches.of(self.result, pitch)

    def placed(self, factors: FactorChain) -> "ExpressionLeaf":
        """Return the leaf's image under a chain of affine maps, the outermost map first."""
        return self if self.is_constant else _transformed_leaf(self, factors)

    def transformed(self, factors: FactorChain) -> "ExpressionLeaf | None":
        """Return the leaf of the solid's mesh after a transform; shared vertices stay shared.

        If the solid is unbounded, transform its complement. None if both are unbounded.
        """
        return self._via_bounded_leaf(lambda leaf: _moved_output(leaf, factors))

    def coarsened(self, pitch: int) -> "ExpressionLeaf | None":
        """Return the leaf of the solid's output mesh on a coarser lattice.

        None if the solid and its complement are unbounded, or if the mesh measures too few steps.
        """
        return self._via_bounded_leaf(
            lambda leaf: _moved_output(leaf, FactorChain()).coarsened(pitch)
        )

    def _via_bounded_leaf(
        self, make: "Callable[[TreeLeaf], MeshLeaf | None]"
    ) -> "ExpressionLeaf | None":
        """Return the result of a function of a bounded leaf, or None if there is none.

        Apply it to this leaf, or if the solid is unbounded, to its complement, and complement the
        result.
        """
        if self._is_bounded():
            return make(self)
        outside = evaluated_record(Record(COMPLEMENT, (self,)))
        mesh = make(outside) if outside._is_bounded() else None
        if mesh is None:
            return None
        made = evaluated_record(Record(COMPLEMENT, (mesh,)))
        return replace(made, record=None, extent=False)

    def touches_itself(self, motion: transform.LatticeMotion) -> bool:
        """Return true if a mesh of the tree would cross itself after a lattice motion."""
        return _crosses_there(self.result, motion)

    def without_record(self) -> "TreeLeaf":
        """Return the leaf without the record of its operands, unless later transforms need that.

        If a solid and its complement are both unbounded, as results of half-spaces may be, there is
        no mesh to transform.
        """
        if self.extent is None:
            return self
        return replace(self, record=None)

    @cached_property
    def mesh_tree(self) -> Tree:
        """The tree from which the mesh is made: faces with different attributes are not joined."""
        return with_patches(self.result, self.source_attributes)

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
    _trees: LastValueCache[int, Tree] = field(
        default_factory=LastValueCache, init=False, repr=False
    )

    def tree(self, pitch: int) -> Tree:
        """Return the leaf's partition tree on the lattice of step ``10**pitch``."""
        known = self._trees.get(pitch)
        if known is not None:
            return known
        plane = self.plane.on_lattice(pitch)
        with core_errors():
            return self._trees.keep(pitch, Tree.half_space(plane.row, pitch, plane.note))

    def constant_leaf(self, pitch: int) -> "ConstantLeaf | None":
        """Return the empty set or all of space for a plane beyond the lattice, else None."""
        above = self.plane.is_above_lattice(pitch)
        return None if above is None else ConstantLeaf(above)

    def placed(self, factors: FactorChain) -> "ExpressionLeaf":
        """Return the half-space's exact image under a chain of affine maps, outermost first."""
        return PlaneLeaf(factors.fold(self.plane, _moved_plane, self._images))


def _moved_plane(plane: Hyperplane, factor: transform.Factor) -> Hyperplane:
    """Return the exact image of a plane under an affine map, by the map's cofactors."""
    cofactors, determinant, shift = _exact_parts(factor)
    old = [entry if determinant > 0 else -entry for entry in map(Fraction, plane.normal)]
    normal = [transform.exact_dot(row, old) for row in cofactors]
    offset = abs(determinant) * plane.offset + transform.exact_dot(normal, shift)
    return Hyperplane.of(normal, offset, plane.exact).shortened()


@lru_cache(maxsize=2 * BLOCK)
def _exact_parts(
    factor: transform.Factor,
) -> tuple[list[list[Fraction]], Fraction, list[Fraction]]:
    """Return an affine map's cofactors and determinant (of its linear part), and its shift."""
    linear = _linear_part(factor)
    shift = [exact_number(entry) for entry in factor.matrix[:3, 3].tolist()]
    return transform.cofactors(linear), transform.determinant(linear), shift


def _linear_part(factor: transform.Factor) -> list[list[Fraction]]:
    """Return the rows of an affine map's linear part as fractions.

    Doubles are read as their shortest decimals, or exactly if that would change the orientation.
    """
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
        """True for the empty set, which is bounded; False for all of space."""
        return not self.full

    def tree(self, pitch: int) -> Tree:
        """Return the leaf's partition tree on the lattice of step ``10**pitch``."""
        with core_errors():
            return Tree.full(pitch) if self.full else Tree.empty(pitch)

    def placed(self, factors: FactorChain) -> "ExpressionLeaf":
        """Return the leaf itself: no transform changes the empty set or all of space."""
        del factors
        return self


ExpressionLeaf: TypeAlias = MeshLeaf | TreeLeaf | PlaneLeaf | ConstantLeaf


def tree_of(leaf: ExpressionLeaf) -> Tree:
    """Return a leaf's tree on its own lattice, or on the default lattice if it has none."""
    return leaf.tree(_common_pitch([leaf]))


def mesh_tree_of(leaf: ExpressionLeaf) -> Tree:
    """Return the tree for a leaf's mesh, in which faces of different attributes are not joined."""
    if leaf.source_attributes and isinstance(leaf, (MeshLeaf, TreeLeaf)):
        return leaf.mesh_tree
    return tree_of(leaf)


def tagged_leaf(leaf: ExpressionLeaf, values: Mapping[str, object]) -> ExpressionLeaf:
    """Return a leaf of the same set with one value of each given attribute on all faces.

    A half-space, the empty set and all of space are returned unchanged, having no faces. The
    sources get new identities, since the faces of the original leaf have other values.
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
    """Return a result's pitch if the user gave it for every leaf of that pitch, else None."""
    given = {leaf.given_pitch for leaf in leaves if leaf.pitch == result.pitch}
    return result.pitch if given == {result.pitch} else None


def evaluated_record(record: Record) -> TreeLeaf:
    """Evaluate a program on its operands, brought to one lattice, and return the result's leaf."""
    extents = [leaf.extent for leaf in record.leaves]
    extent = EXTENTS.evaluate(record.program, extents)
    leaves, trees = _on_one_lattice(record.leaves, extent)
    with core_errors():
        result = Tree.evaluate(record.program, trees)
    operands = [(tree, leaf.source_attributes) for tree, leaf in zip(trees, leaves, strict=True)]
    given = _given_pitch_of(record.leaves, result)
    return TreeLeaf(result, record, extent, inherited(result, operands), given)


def bounded_on_one_lattice(leaves: Sequence[ExpressionLeaf]) -> list[Tree]:
    """Return the trees of bounded solids on the finest lattice whose range contains them all."""
    return _on_one_lattice(leaves, True)[1]


def _on_one_lattice(
    leaves: Sequence[ExpressionLeaf], extent: Extent
) -> tuple[Sequence[ExpressionLeaf], list[Tree]]:
    """Return leaves and their trees on the finest lattice whose range contains all of them.

    Parameters
    ----------
    leaves : sequence of leaves
    extent : Extent
        Whether the result, or its complement, is bounded. If that is known, planes outside the
        lattice's range do not affect the result.
    """
    pitch = _common_pitch(leaves)
    try:
        return leaves, [leaf.tree(pitch) for leaf in leaves]
    except LimitError:
        coarser = _finest_for_all(leaves, extent)
        found = [_on_lattice_or_none(leaf, coarser, extent) for leaf in leaves]
        fitted = [leaf for leaf in found if leaf is not None]
        if len(fitted) < len(found):
            raise
        return fitted, [leaf.tree(coarser) for leaf in fitted]


def _finest_for_all(leaves: Sequence[ExpressionLeaf], extent: Extent) -> int:
    """Return the finest pitch whose lattice range contains every leaf."""
    finest = _common_pitch(leaves)
    coarser = range(finest, MAX_PITCH)
    fitting = (
        pitch for pitch in coarser if all(_fits_lattice(leaf, pitch, extent) for leaf in leaves)
    )
    return next(fitting, finest)


def _fits_lattice(leaf: ExpressionLeaf, pitch: int, extent: Extent) -> bool:
    if isinstance(leaf, PlaneLeaf):
        return extent is not None or leaf.constant_leaf(pitch) is None
    if leaf.pitch is None or leaf.pitch <= pitch:
        return True
    try:
        leaf.tree(pitch)
    except LimitError:
        return False
    return True


def _on_lattice_or_none(leaf: ExpressionLeaf, pitch: int, extent: Extent) -> ExpressionLeaf | None:
    """Return a leaf for the lattice of `pitch`, coarsened if need be; None if that fails."""
    if isinstance(leaf, PlaneLeaf):
        return leaf if extent is None else leaf.constant_leaf(pitch) or leaf
    if isinstance(leaf, ConstantLeaf) or leaf.pitch is None or leaf.pitch >= pitch:
        return leaf
    return leaf if isinstance(leaf, TreeLeaf) and leaf.is_constant else leaf.coarsened(pitch)


def _moved_output(leaf: TreeLeaf, factors: FactorChain) -> MeshLeaf:
    tree = leaf.mesh_tree
    with core_errors():
        vertices, faces = tree.to_mesh()
    said = attributes_of(tree, leaf.source_attributes) if leaf.source_attributes else None
    return MeshLeaf.moved(AttributedMesh(vertices, faces, said), factors, leaf.given_pitch)


#: A generator that transforms a leaf: it yields operands to transform, each with its factors, is
#: sent their images, and returns the image of the leaf.
_TransformSteps: TypeAlias = Generator[tuple["ExpressionLeaf", FactorChain], "ExpressionLeaf", Any]


def _transformed_leaf(leaf: MeshLeaf | TreeLeaf, factors: FactorChain) -> ExpressionLeaf:
    """Return a leaf's image under a transform, by a stack of generators, not by recursion."""
    waiting = [_transform_steps(leaf, factors)]
    answer: Any = None
    while waiting:
        try:
            operand, under = waiting[-1].send(answer)
        except StopIteration as ended:
            waiting.pop()
            answer = ended.value
            continue
        if isinstance(operand, TreeLeaf) and not operand.is_constant:
            waiting.append(_transform_steps(operand, under))
            answer = None
        else:
            answer = operand.placed(under)
    moved: ExpressionLeaf = answer
    return moved


def _transform_steps(leaf: MeshLeaf | TreeLeaf, factors: FactorChain) -> _TransformSteps:
    """Transform a leaf: its mesh by the inner factors, then its tree by the outer lattice motion.

    Transform the mesh by all factors if the outer ones are no exact motion of the tree.
    """
    inner = factors.inner
    if len(inner) == len(factors):
        return (yield from _operand_steps(leaf, factors)) if factors else leaf
    base = (yield from _inner_image(leaf, inner)) if inner else leaf
    motion = factors.outer_motion(_common_pitch([base]))
    if motion is None:
        return (yield from _operand_steps(leaf, factors))
    if isinstance(base, (MeshLeaf, TreeLeaf)) and base.touches_itself(motion):
        return (yield from _operand_steps(leaf, factors))
    try:
        with core_errors():
            moved = tree_of(base).moved(list(motion.axes), list(motion.shift))
        source_attributes = after_motion(motion, base.source_attributes)
        return TreeLeaf(moved, None, base.extent, source_attributes, base.given_pitch)
    except (LimitError, UnboundedError):
        # The leaf leaves this lattice; its coordinates let the core choose a coarser one. Or it is
        # cut off by the border of the lattice, which does not move with it.
        return (yield from _operand_steps(leaf, factors))


def _inner_image(leaf: MeshLeaf | TreeLeaf, factors: FactorChain) -> _TransformSteps:
    """Transform a leaf by the inner factors, and cache the result for other outer motions."""
    known = leaf.last_moved.get(factors)
    if known is not None:
        return known
    return leaf.last_moved.keep(factors, (yield from _operand_steps(leaf, factors)))


def _operand_steps(leaf: MeshLeaf | TreeLeaf, factors: FactorChain) -> _TransformSteps:
    """Transform the mesh of a leaf; if it has none, transform its operands and combine them."""
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
    return tagged_leaf(evaluated_record(Record(leaf.record.program, tuple(leaves))), leaf.tags)
