"""Attributes of a tree's sources (input meshes), carried through operations and motions."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from .._core import Tree
from ..attributes.attributes import Attributes, GivenAttributes, Later, array_of
from ..attributes.transfer import SourceArrays, Surface, inherited_attributes, patches_of
from ..errors import core_errors
from ..geometry import transform

#: The attributes of each source of a tree; empty if no source has any.
SourceAttributes: TypeAlias = tuple[Attributes | None, ...]


def with_patches(tree: Tree, source_attributes: SourceAttributes) -> Tree:
    """Return a tree whose mesh joins only faces with the same attributes."""
    return tree.patched(patches_of(source_attributes)) if source_attributes else tree


def attributes_of(tree: Tree, source_attributes: SourceAttributes) -> Attributes:
    """Return the attributes of a tree's mesh."""
    with core_errors():
        surface = Surface(*tree.to_mesh(), tree.origins(), tree.flips())
    return inherited_attributes(surface, source_attributes, tree.source_arrays)


def later_attributes(tree: Tree, source_attributes: SourceAttributes) -> Later | None:
    """Return an object that computes a tree's mesh attributes on demand; None if it has none."""
    return Later(lambda: attributes_of(tree, source_attributes)) if source_attributes else None


def inherited(result: Tree, operands: Sequence[tuple[Tree, SourceAttributes]]) -> SourceAttributes:
    """Return the attributes of a result's sources, found among its operands' sources."""
    if not any(source_attributes for _, source_attributes in operands):
        return ()
    # An empty or full operand may have lost its sources when its lattice was changed.
    known = {
        identity: attributes
        for tree, source_attributes in operands
        if source_attributes and tree.sources
        for identity, attributes in zip(tree.sources, source_attributes, strict=True)
    }
    found = tuple(known.get(identity) for identity in result.sources)
    return found if any(attributes is not None for attributes in found) else ()


def all_tagged(
    tree: Tree, source_attributes: SourceAttributes, values: Mapping[str, object]
) -> SourceAttributes:
    """Return the attributes of a tree's sources after all faces are given the same values."""
    return tuple(
        None if (arrays := tree.source_arrays(slot)) is None else _tagged(old, arrays, values)
        for slot, old in enumerate(source_attributes or (None,) * len(tree.sources))
    )


def _tagged(
    old: Attributes | None, arrays: SourceArrays, values: Mapping[str, object]
) -> Attributes:
    """Return a source's attributes after all its faces are given the same values, by name."""
    count = int(arrays[3].max(initial=-1)) + 1
    faces = np.zeros((count, 3), dtype=np.int64) if old is None else old.faces
    attributes = Attributes(faces) if old is None else old.without(values)
    given = {name: array_of(value, name) for name, value in values.items()}
    face = {
        name: np.broadcast_to(value, (len(faces), *value.shape)) for name, value in given.items()
    }
    more = GivenAttributes(face=face).over(0, faces)
    return (
        attributes if more is None else replace(attributes, face={**attributes.face, **more.face})
    )


def after_motion(
    motion: transform.LatticeMotion, source_attributes: SourceAttributes
) -> SourceAttributes:
    """Return the attributes of sources after a lattice motion, which turns normals."""
    if not source_attributes:
        return ()
    linear = motion.linear
    mirrored = np.linalg.det(linear) < 0
    turned = [
        None if attributes is None else attributes.turned(linear)
        for attributes in source_attributes
    ]
    if not mirrored:
        return tuple(turned)
    # The core exchanges the last two corners of every face that is mirrored.
    return tuple(
        None if attributes is None else attributes.reordered([0, 2, 1]) for attributes in turned
    )
