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

from . import transform
from ._core import Tree
from ._types import FloatArray, IndexArray, ProgramLine, WindingRule
from .errors import LimitError, UnboundedError, core_errors
from .transform import Factors

#: Exponent of the lattice step for solids that any lattice can hold.
DEFAULT_PITCH = -9

_COMPLEMENT: list[ProgramLine] = [("leaf", [0]), ("not", [0])]


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
        Both may belong to somebody else until `disown` is called.
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
        return self.own_tree().pitch

    @property
    def extent(self) -> "Extent":
        """A closed mesh is bounded."""
        return True

    def arrays(self) -> tuple[FloatArray, IndexArray]:
        """Return vertices and faces as they were given."""
        return self.own_tree().given_arrays() if self._arrays is None else self._arrays

    def disown(self) -> None:
        """Let go of the given arrays: the tree holds them, or else they are copied."""
        if self._arrays is not None:
            vertices, faces = self._arrays
            held = self.own_tree().holds_given
            self._arrays = None if held else (vertices.copy(), faces.copy())

    def own_tree(self) -> Tree:
        """Return the tree on the leaf's own lattice, made on first use."""
        if self._tree is None:
            self._tree = self._grow()
        return self._tree

    def tree(self, pitch: int) -> Tree:
        """Return the tree on the lattice of this pitch."""
        return at_pitch(self.own_tree(), pitch)

    def placed(self, factors: Factors) -> "Leaf":
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
    leaves: tuple["Leaf", ...]


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

    def placed(self, factors: Factors) -> "Leaf":
        """Return the leaf moved by the factors, outermost first."""
        if self.result.is_empty or self.result.is_full:
            return self
        return _place(self, factors)

    def transformed(self, factors: Factors) -> "Leaf":
        """Return the leaf of the output mesh, moved as a whole: shared vertices stay shared.

        Raises
        ------
        UnboundedError
            If neither the solid nor its complement has an output mesh.
        """
        if self._is_bounded():
            return _moved_output(self.result, factors)
        outside = run(Record(_COMPLEMENT, (self,)))
        if not outside._is_bounded():
            return self._moved_operands(factors)
        moved = run(Record(_COMPLEMENT, (_moved_output(outside.result, factors),)))
        return TreeLeaf(moved.result, extent=False)

    def forgetful(self) -> "TreeLeaf":
        """Return the leaf without its history, unless a later transform would need that.

        Only a solid that is unbounded and has an unbounded complement has no mesh to transform.
        Expressions with half-spaces may be of that kind.
        """
        return self if self.extent is None else TreeLeaf(self.result, extent=self.extent)

    def _is_bounded(self) -> bool:
        return self.result.is_bounded if self.extent is None else self.extent

    def _moved_operands(self, factors: Factors) -> "Leaf":
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
    """The half-space ``normal . x <= offset``; it takes the pitch of what it meets.

    Parameters
    ----------
    normal : tuple of three floats
    offset : float
    factors : tuple of Factor
        Where it was moved to, outermost first.
    """

    normal: tuple[float, float, float]
    offset: float
    factors: Factors = ()
    pitch: int | None = field(default=None, init=False)
    extent: "Extent" = field(default=None, init=False)

    @classmethod
    def through(cls, normal: Sequence[Fraction], offset: Fraction) -> "PlaneLeaf":
        """Return the half-space of an exact normal, not zero, and offset."""
        # Only the direction counts. A power of two brings it into range without rounding.
        size = _power_of_two_near(max(abs(entry) for entry in normal))
        x, y, z = (float(entry / size) for entry in normal)
        return cls((x, y, z), float(offset / size))

    def tree(self, pitch: int) -> Tree:
        """Return the tree on the lattice of this pitch."""
        rigid = transform.permuting_run(self.factors)
        motion = transform.lattice_motion(rigid, pitch)
        if motion is None:
            return self._moved_plane(self.factors).tree(pitch)
        plane = self._moved_plane(self.factors[len(rigid) :])
        with core_errors():
            tree = Tree.half_space(plane.normal, plane.offset, pitch)
            return tree.moved(list(motion.axes), list(motion.shift))

    def placed(self, factors: Factors) -> "Leaf":
        """Return the half-space moved by the factors, outermost first."""
        return PlaneLeaf(self.normal, self.offset, factors + self.factors)

    def _moved_plane(self, factors: Factors) -> "PlaneLeaf":
        """Return the moved plane; cofactors map its normal, so that no matrix is inverted."""
        plane = PlaneLeaf(self.normal, self.offset)
        for factor in reversed(factors):
            plane = plane._through(factor)
        return plane

    def _through(self, factor: transform.Factor) -> "PlaneLeaf":
        linear = transform.exact_linear(factor.matrix)
        cofactors = transform.cofactors(linear)
        determinant = transform.exact_dot(linear[0], cofactors[0])
        sign = 1 if determinant > 0 else -1
        old = [sign * Fraction(entry) for entry in self.normal]
        normal = [transform.exact_dot(row, old) for row in cofactors]
        shift = [Fraction(entry) for entry in factor.matrix[:3, 3].tolist()]
        offset = abs(determinant) * Fraction(self.offset) + transform.exact_dot(normal, shift)
        return PlaneLeaf.through(normal, offset)


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

    def placed(self, factors: Factors) -> "Leaf":
        """Return the same set."""
        del factors
        return self


#: What is known without asking the core: True if the solid is bounded, False if its complement is.
Extent: TypeAlias = bool | None

Leaf: TypeAlias = MeshLeaf | TreeLeaf | PlaneLeaf | ConstantLeaf


def tree_of(leaf: Leaf) -> Tree:
    """Return the leaf's tree on its own lattice, or on the default one if any will do."""
    pitch = leaf.pitch
    return leaf.tree(DEFAULT_PITCH if pitch is None else pitch)


def run(record: Record) -> TreeLeaf:
    """Evaluate a program on its leaves, all on the finest of their lattices."""
    pitches = [leaf.pitch for leaf in record.leaves]
    pitch = min((pitch for pitch in pitches if pitch is not None), default=DEFAULT_PITCH)
    trees = [leaf.tree(pitch) for leaf in record.leaves]
    with core_errors():
        return TreeLeaf(Tree.evaluate(record.program, trees), record, _extent(record))


def _extent(record: Record) -> Extent:
    """Follow the program to what its result's extent must be."""
    known: list[Extent] = []
    for operator, arguments in record.program:
        if operator == "leaf":
            known.append(record.leaves[arguments[0]].extent)
        else:
            known.append(_extent_of(operator, [known[line] for line in arguments]))
    return known[-1]


def _extent_of(operator: str, operands: list[Extent]) -> Extent:
    if operator == "or":
        # One operand of bounded complement is enough; bounded ones must be all.
        return False if False in operands else all(operands) or None
    if operator == "and":
        return True if True in operands else None if None in operands else False
    if None in operands:
        return None
    return operands.count(False) % 2 == 0 if operator == "xor" else not operands[0]


def transformed_arrays(
    vertices: FloatArray, faces: IndexArray, factors: Factors
) -> tuple[FloatArray, IndexArray]:
    """Return the mesh moved by the product of the factors, its outside still outside."""
    moved = transform.apply(transform.product(factors), vertices)
    mirrored = math.prod(transform.determinant_sign(factor.matrix) for factor in factors) < 0
    return moved, np.ascontiguousarray(faces[:, ::-1]) if mirrored else faces


def _power_of_two_near(value: Fraction) -> Fraction:
    return Fraction(2) ** (value.numerator.bit_length() - value.denominator.bit_length())


def _moved_output(tree: Tree, factors: Factors) -> MeshLeaf:
    with core_errors():
        vertices, faces = tree.to_mesh()
    return MeshLeaf(*transformed_arrays(vertices, faces, factors))


def _place(leaf: MeshLeaf | TreeLeaf, factors: Factors) -> Leaf:
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
