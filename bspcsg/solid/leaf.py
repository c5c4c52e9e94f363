"""Leaves of expressions: what is already known as a partition tree, or can become one directly.

A leaf answers with its tree at a pitch, and can be placed by a transform. Placing follows one rule
(`_place`): the outermost factors that are a lattice motion move the tree exactly; whatever remains
acts on the leaf's coordinates in one rounding, before they are snapped to the lattice again.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TypeAlias

import numpy as np

from .._core import Tree
from .._types import FloatArray, IndexArray, ProgramLine, WindingRule
from ..errors import LimitError, UnboundedError, core_errors
from ..geometry import transform
from ..geometry.hyperplane import DEFAULT_PITCH, Hyperplane, exact_number
from ..geometry.transform import Factors
from .program import COMPLEMENT, Algebra


def at_pitch(tree: Tree, pitch: int) -> Tree:
    """Return the same solid on the lattice of this pitch, which must not be coarser."""
    if tree.pitch == pitch:
        return tree
    with core_errors():
        return tree.refined(pitch)


class MeshLeaf:
    """A mesh as it was given.

    Parameters
    ----------
    vertices : (n, 3) float64, in model units
    faces : (m, 3) int64, indices of `vertices`
        Both may belong to somebody else until `let_go` is called.
    pitch : int or None
        Exponent of the lattice step; None lets the core choose it from the size.
    trusted : bool
        The caller's word that the mesh is closed and its faces meet in edges and vertices only.
    winding : str
        Which winding numbers are inside.
    """

    def __init__(
        self,
        vertices: FloatArray,
        faces: IndexArray,
        pitch: int | None = None,
        trusted: bool = False,
        winding: WindingRule = "positive",
    ) -> None:
        self._arrays: tuple[FloatArray, IndexArray] | None = (vertices, faces)
        self._chosen_pitch = pitch
        self._trusted = trusted
        self._winding = winding
        self._tree: Tree | None = None

    @property
    def pitch(self) -> int | None:
        """Exponent of the lattice step."""
        return self.grown().pitch

    @property
    def extent(self) -> "Extent":
        """A closed mesh is bounded."""
        return True

    def arrays(self) -> tuple[FloatArray, IndexArray]:
        """Return vertices and faces as they were given."""
        return self.grown().given_arrays() if self._arrays is None else self._arrays

    def let_go(self) -> None:
        """Let go of the given arrays: the tree holds them, or else they are copied."""
        if self._arrays is not None:
            vertices, faces = self._arrays
            held = self.grown().holds_given
            self._arrays = None if held else (vertices.copy(), faces.copy())

    def grown(self) -> Tree:
        """Return the tree on the leaf's own lattice, made on first use."""
        if self._tree is None:
            self._tree = self._grow()
        return self._tree

    def tree(self, pitch: int) -> Tree:
        """Return the tree on the lattice of this pitch."""
        return at_pitch(self.grown(), pitch)

    def placed(self, factors: Factors) -> "ExpressionLeaf":
        """Return the leaf moved by the factors, outermost first."""
        return _place(self, factors)

    def transformed(self, factors: Factors) -> "MeshLeaf":
        """Return the leaf of the mesh whose vertices the factors have moved."""
        vertices, faces = transformed_arrays(*self.arrays(), factors)
        # Rounding may make faces cross, so the word given for the original no longer counts.
        return MeshLeaf(vertices, faces, self._chosen_pitch, winding=self._winding)

    def _grow(self) -> Tree:
        with core_errors():
            tree = Tree.from_mesh(*self.arrays(), self._chosen_pitch, self._trusted)
            if self._winding != "positive":
                tree = tree.normalized(self._winding)
        return tree


@dataclass(frozen=True, eq=False)
class Record:
    """How a tree was made: a program and the leaves it names, one operation deep."""

    program: list[ProgramLine]
    leaves: tuple["ExpressionLeaf", ...]


@dataclass(frozen=True, eq=False)
class TreeLeaf:
    """A tree that has been evaluated, loaded or moved.

    Parameters
    ----------
    result : Tree
    record : Record or None
        What it was evaluated from, as long as that is remembered.
    extent : Extent
    """

    result: Tree
    record: Record | None = None
    extent: "Extent" = None

    @property
    def pitch(self) -> int | None:
        """Exponent of the lattice step."""
        return self.result.pitch

    def tree(self, pitch: int) -> Tree:
        """Return the tree on the lattice of this pitch."""
        return at_pitch(self.result, pitch)

    def placed(self, factors: Factors) -> "ExpressionLeaf":
        """Return the leaf moved by the factors, outermost first."""
        if self.result.is_empty or self.result.is_full:
            return self
        return _place(self, factors)

    def transformed(self, factors: Factors) -> "ExpressionLeaf":
        """Return the leaf of the output mesh, moved as a whole: shared vertices stay shared.

        Raises
        ------
        UnboundedError
            If neither the solid nor its complement has an output mesh.
        """
        if self._is_bounded():
            return _moved_output(self.result, factors)
        outside = run(Record(COMPLEMENT, (self,)))
        if not outside._is_bounded():
            return self._moved_operands(factors)
        moved = run(Record(COMPLEMENT, (_moved_output(outside.result, factors),)))
        return TreeLeaf(moved.result, extent=False)

    def forgetful(self) -> "TreeLeaf":
        """Return the leaf without its history, unless a later transform would need that.

        Only a solid that is unbounded and has an unbounded complement has no mesh to transform.
        Expressions with half-spaces may be of that kind.
        """
        return self if self.extent is None else TreeLeaf(self.result, extent=self.extent)

    def _is_bounded(self) -> bool:
        return self.result.is_bounded if self.extent is None else self.extent

    def _moved_operands(self, factors: Factors) -> "ExpressionLeaf":
        if self.record is None:
            raise UnboundedError(
                "This solid and its complement both reach to infinity, so there is no mesh that"
                " the transform could act on; transform its operands instead.",
                "unbounded",
            )
        leaves = tuple(leaf.placed(factors) for leaf in self.record.leaves)
        return run(Record(self.record.program, leaves))


@dataclass(frozen=True, eq=False)
class PlaneLeaf:
    """The half-space on the minus side of a plane; it takes the pitch of what it meets.

    Parameters
    ----------
    plane : Hyperplane
    """

    plane: Hyperplane
    pitch: int | None = field(default=None, init=False)
    extent: "Extent" = field(default=None, init=False)

    def tree(self, pitch: int) -> Tree:
        """Return the tree on the lattice of this pitch."""
        plane = self.plane.on_lattice(pitch)
        with core_errors():
            return Tree.half_space(plane.row, pitch, plane.note)

    def placed(self, factors: Factors) -> "ExpressionLeaf":
        """Return the half-space moved by the factors, outermost first, in exact numbers."""
        plane = self.plane
        for factor in reversed(factors):
            plane = _moved_plane(plane, factor)
        return PlaneLeaf(plane)


def _moved_plane(plane: Hyperplane, factor: transform.Factor) -> Hyperplane:
    """Return the image of a plane; cofactors map its normal, so that no matrix is inverted."""
    linear = _linear_part(factor)
    determinant = transform.determinant(linear)
    old = [entry if determinant > 0 else -entry for entry in map(Fraction, plane.normal)]
    normal = [transform.exact_dot(row, old) for row in transform.cofactors(linear)]
    shift = [exact_number(entry) for entry in factor.matrix[:3, 3].tolist()]
    offset = abs(determinant) * plane.offset + transform.exact_dot(normal, shift)
    return Hyperplane.of(normal, offset, plane.exact).shortened()


def _linear_part(factor: transform.Factor) -> list[list[Fraction]]:
    """Return the rows as the decimals they were written as, if these keep or turn space alike."""
    rows = [[exact_number(entry) for entry in row] for row in factor.matrix[:3, :3].tolist()]
    sign = transform.determinant_sign(factor.matrix)
    return rows if sign * transform.determinant(rows) > 0 else transform.exact_linear(factor.matrix)


@dataclass(frozen=True, eq=False)
class ConstantLeaf:
    """The empty set, or all of space; no transform changes it."""

    full: bool
    pitch: int | None = field(default=None, init=False)

    @property
    def extent(self) -> "Extent":
        """Nothing is bounded; the complement of everything is."""
        return not self.full

    def tree(self, pitch: int) -> Tree:
        """Return the tree on the lattice of this pitch."""
        with core_errors():
            return Tree.full(pitch) if self.full else Tree.empty(pitch)

    def placed(self, factors: Factors) -> "ExpressionLeaf":
        """Return the same set."""
        del factors
        return self


#: What is known without asking the core: True if the solid is bounded, False if its complement is.
Extent: TypeAlias = bool | None

ExpressionLeaf: TypeAlias = MeshLeaf | TreeLeaf | PlaneLeaf | ConstantLeaf


def tree_of(leaf: ExpressionLeaf) -> Tree:
    """Return the leaf's tree on its own lattice, or on the default one if any will do."""
    return leaf.tree(_common_pitch([leaf]))


def _common_pitch(leaves: Sequence[ExpressionLeaf]) -> int:
    """Return the finest of the leaves' pitches; planes choose only where nothing else does."""
    own = [leaf.pitch for leaf in leaves if leaf.pitch is not None]
    if own:
        return min(own)
    planes = [leaf.plane.pitch for leaf in leaves if isinstance(leaf, PlaneLeaf)]
    return min(planes, default=DEFAULT_PITCH)


def run(record: Record) -> TreeLeaf:
    """Evaluate a program on its leaves, all on the finest of their lattices."""
    pitch = _common_pitch(record.leaves)
    trees = [leaf.tree(pitch) for leaf in record.leaves]
    with core_errors():
        result = Tree.evaluate(record.program, trees)
    extents = [leaf.extent for leaf in record.leaves]
    return TreeLeaf(result, record, _EXTENTS.evaluate(record.program, extents))


def _either(operands: Sequence[Extent]) -> Extent:
    # One operand of bounded complement is enough; bounded ones must be all.
    return False if False in operands else all(operands) or None


def _both(operands: Sequence[Extent]) -> Extent:
    return True if True in operands else None if None in operands else False


def _odd(operands: Sequence[Extent]) -> Extent:
    return None if None in operands else operands.count(False) % 2 == 0


def _other(operand: Extent) -> Extent:
    return None if operand is None else not operand


#: What a result's extent must be.
_EXTENTS: Algebra[Extent] = Algebra(_either, _both, _odd, _other)


def transformed_arrays(
    vertices: FloatArray, faces: IndexArray, factors: Factors
) -> tuple[FloatArray, IndexArray]:
    """Return the mesh moved by the product of the factors, its outside still outside."""
    moved = transform.apply(transform.product(factors), vertices)
    mirrored = math.prod(transform.determinant_sign(factor.matrix) for factor in factors) < 0
    return moved, np.ascontiguousarray(faces[:, ::-1]) if mirrored else faces


def _moved_output(tree: Tree, factors: Factors) -> MeshLeaf:
    with core_errors():
        vertices, faces = tree.to_mesh()
    return MeshLeaf(*transformed_arrays(vertices, faces, factors))


def _place(leaf: MeshLeaf | TreeLeaf, factors: Factors) -> ExpressionLeaf:
    """Move a leaf: exactly by the outer factors that allow it, by coordinates for the rest."""
    outer = transform.permuting_run(factors)
    inner = factors[len(outer) :]
    base = leaf.transformed(inner) if inner else leaf
    if not outer:
        return base
    tree = tree_of(base)
    motion = transform.lattice_motion(outer, tree.pitch)
    if motion is None:
        return leaf.transformed(factors)
    try:
        with core_errors():
            moved = tree.moved(list(motion.axes), list(motion.shift))
        return TreeLeaf(moved, extent=base.extent)
    except (LimitError, UnboundedError):
        # Too far out for this lattice, where coordinates let the core choose a coarser one; or cut
        # off by the border of the universe, which does not move with it.
        return leaf.transformed(factors)
