"""Making layers of the objects of a file, and of a solid with its operands' origins."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..._types import IndexArray
from ...attributes.attributes import Attributes
from ...formats.raw import RawMesh, compacted
from ...formats.storable_attributes import attributes_or_none, with_attributes
from ...mesh.weld import welded
from ...solid.solid import Solid
from .attribute_paints import paints_of
from .layer import COLOURS, RESULT, Layer
from .paint import PALETTE, THICKNESS, Labels, Scale
from .thickness import thickness

#: The largest number of objects of one file that become a layer each. A file with more objects
#: becomes one layer.
_MAX_PARTS = 60

#: The largest number of operands that get a colour each; of more operands none gets a colour.
_MAX_OPERANDS_COLOURED = 200

#: The name of the paint, or attribute, that has the operand from which each face comes.
ORIGIN = "origin"


def layers_of_file(raw: RawMesh, name: str) -> list[Layer]:
    """Return a layer for each object of a file, all of one colour.

    Vertices with equal coordinates are merged, so that adjacent faces share vertices.
    """
    faces, objects = raw.faces, [one for one in raw.objects if one[1]]
    vertices = raw.vertices
    if len(vertices):
        vertices, same = welded(raw.vertices)
        faces = same[raw.faces]
    if not 1 < len(objects) <= _MAX_PARTS or sum(n for _, n in objects) != len(faces):
        return [Layer(name, vertices, faces, paints=paints_of(raw.attributes))]
    ends = np.cumsum([count for _, count in objects])
    layers = []
    for number, (own, count) in enumerate(objects):
        chosen = np.arange(ends[number] - count, ends[number])
        used, renumbered = compacted(faces[chosen])
        attributes = (
            None if raw.attributes is None else _attributes_of_faces(raw.attributes, chosen)
        )
        title = own or f"part {number + 1}"
        layers.append(Layer(title, vertices[used], renumbered, paints=paints_of(attributes)))
    return layers


def _attributes_of_faces(attributes: Attributes, faces: IndexArray) -> Attributes:
    return attributes.for_faces(faces).with_used_materials()


def layers_of_solid(solid: Solid, name: str) -> list[Layer]:
    """Return the layer of a solid, with a paint by the operand from which each face comes."""
    mesh = solid.normalized().to_mesh()
    layers = layers_of_file(
        replace(with_attributes(mesh, attributes_or_none(mesh)), name=name), name
    )
    found = _operands(solid)
    if not found or any(paint.name == ORIGIN for layer in layers for paint in layer.paints):
        return layers
    colours = [PALETTE[k % len(PALETTE)] for k in range(len(found))]
    origin = Labels(ORIGIN, mesh.source[:, 0], found, colours)
    return [replace(layer, paints=(*layer.paints, origin)) for layer in layers]


def with_origin(solid: Solid) -> Solid:
    """Return a solid whose face attribute “origin” names the operand from which a face comes."""
    found = _operands(solid)
    if not found:
        return solid
    mesh = solid.normalized().to_mesh()
    attributes = {**mesh.face_attributes, ORIGIN: np.array(found)[mesh.source[:, 0]]}
    return Solid(
        mesh.vertices,
        mesh.faces,
        vertex_attributes=mesh.vertex_attributes,
        corner_attributes=mesh.corner_attributes,
        face_attributes=attributes,
        materials=mesh.materials,
    )


def _operands(solid: Solid) -> list[str]:
    """Return names for the operands of the set operation that made a solid.

    Return an empty list if no operation made it, or its operands are too many.
    """
    last = solid.last_operation
    if last is None or not 1 < len(last.operands) <= _MAX_OPERANDS_COLOURED:
        return []
    return [f"operand {k + 1}{_size(operand)}" for k, operand in enumerate(last.operands)]


def _size(operand: Solid) -> str:
    if not operand.is_bounded:
        return ""
    count = len(operand.to_mesh().faces)
    return f": {count:,} triangle{'s' if count != 1 else ''}"


def with_thickness(layer: Layer) -> Layer:
    """Return a layer with one more paint: the thickness of the solid at each face."""
    values = thickness(layer.vertices, layer.faces)
    return replace(layer, paints=(*layer.paints, Scale("thickness", values, THICKNESS)))


def with_distinct_colours(layers: Sequence[Layer]) -> list[Layer]:
    """Return layers in different colours; a single layer gets the colour of a result."""
    if len(layers) == 1:
        return [replace(layers[0], colour=RESULT)]
    return [
        replace(layer, colour=COLOURS[number % len(COLOURS)]) for number, layer in enumerate(layers)
    ]
