"""Layers for what is to be seen: objects of a file, and the solid that a script makes."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..._types import IndexArray
from ...attributes.attributes import Attributes
from ...formats.raw import RawMesh, compacted
from ...formats.said import said_of, saying
from ...mesh.weld import welded
from ...solid.solid import Solid
from .attributes import paints_of
from .layer import COLOURS, RESULT, Layer
from .paint import PALETTE, THICKNESS, Labels, Paint, Scale
from .thickness import thickness

#: Objects of one file that become parts with a button each; a file with more is one part.
_MOST_PARTS = 60

#: Operands that have a colour each.
_MOST_OPERANDS = 200

#: The paint that says which operand a face is from.
ORIGIN = "origin"


def layers_of_file(raw: RawMesh, name: str) -> list[Layer]:
    """Return a layer for each object of a file, without colours that tell them apart.

    Corners with equal coordinates become one, so that shading and edges see whether faces meet.
    """
    faces, objects = raw.faces, [one for one in raw.objects if one[1]]
    vertices = raw.vertices
    if len(vertices):
        vertices, same = welded(raw.vertices)
        faces = same[raw.faces]
    if not 1 < len(objects) <= _MOST_PARTS or sum(n for _, n in objects) != len(faces):
        return [Layer(name, vertices, faces, paints=paints_of(raw.attributes))]
    ends = np.cumsum([count for _, count in objects])
    layers = []
    for number, (own, count) in enumerate(objects):
        chosen = np.arange(ends[number] - count, ends[number])
        used, renumbered = compacted(faces[chosen])
        said = None if raw.attributes is None else _taken(raw.attributes, chosen)
        title = own or f"part {number + 1}"
        layers.append(Layer(title, vertices[used], renumbered, paints=paints_of(said)))
    return layers


def _taken(said: Attributes, faces: IndexArray) -> Attributes:
    return said.taken(faces).with_used_materials()


def layers_of_solid(solid: Solid, name: str) -> list[Layer]:
    """Return the layer of a solid, which can be coloured by the operand that faces come from."""
    mesh = solid.normalized().to_mesh()
    layers = layers_of_file(replace(saying(mesh, said_of(mesh)), name=name), name)
    origin = _origins(solid, mesh.source[:, 0])
    if origin is None:
        return layers
    return [replace(layer, paints=(*layer.paints, origin)) for layer in layers]


def _origins(solid: Solid, slots: IndexArray) -> Paint | None:
    last = solid.last_operation
    if last is None or not 1 < len(last.operands) <= _MOST_OPERANDS:
        return None
    labels = []
    for number, operand in enumerate(last.operands):
        count = len(operand.to_mesh().faces)
        labels.append(f"operand {number + 1}: {count:,} triangle{'s' if count != 1 else ''}")
    colours = [PALETTE[k % len(PALETTE)] for k in range(len(labels))]
    return Labels(ORIGIN, slots, labels, colours)


def with_thickness(layer: Layer) -> Layer:
    """Return a layer that can be coloured by thickness."""
    values = thickness(layer.vertices, layer.faces)
    return replace(layer, paints=(*layer.paints, Scale("thickness", values, THICKNESS)))


def told_apart(layers: Sequence[Layer]) -> list[Layer]:
    """Return layers with a colour each; a single one has that of results."""
    if len(layers) == 1:
        return [replace(layers[0], colour=RESULT)]
    return [
        replace(layer, colour=COLOURS[number % len(COLOURS)]) for number, layer in enumerate(layers)
    ]
