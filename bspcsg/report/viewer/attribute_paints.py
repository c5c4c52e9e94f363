"""Conversion of a mesh's attributes to paints: materials, colours, labels and numbers."""

from collections.abc import Iterator

import numpy as np

from ..._types import FloatArray
from ...attributes.attributes import NORMALS, Attributes, Values
from ...attributes.colours import as_bytes, hexadecimal, is_color, opaque
from ...attributes.material import Material
from .paint import DISTANCE, PALETTE, Colours, Labels, Paint, Scale

#: The largest number of attributes by which a page can colour faces.
_MAX_PAINTS = 6

#: The largest number of distinct values of an attribute that is shown by labels.
_MAX_LABELS = 1000

#: The colour of faces without a material.
_PLAIN = Material((0.7, 0.76, 0.82, 1.0))


def paints_of(attributes: Attributes | None) -> tuple[Paint, ...]:
    """Return at most six paints for the attributes of a mesh, scales of numbers last."""
    if attributes is None or attributes.is_empty:
        return ()
    found = [paint for paint in _each(attributes) if paint is not None]
    return tuple(sorted(found, key=lambda paint: isinstance(paint, Scale))[:_MAX_PAINTS])


def _each(attributes: Attributes) -> Iterator[Paint | None]:
    if "material" in attributes.face:
        yield _materials(attributes)
    for name in attributes.names:
        values = (
            attributes.at_corners(name)
            if attributes.kind_of(name) != "face"
            else attributes.face[name]
        )
        depth = 1 if attributes.kind_of(name) == "face" else 2
        if name == "material" or name == "uv" or name in NORMALS:
            continue
        if is_color(name, values, depth):
            yield Colours(name, opaque(as_bytes(values)))
        elif values.ndim == depth:
            yield _labels(name, values) if depth == 1 else _scale(name, values)


def _materials(attributes: Attributes) -> Labels:
    names, numbers = np.unique(attributes.face["material"], return_inverse=True)
    used = [attributes.materials.get(name, _PLAIN) for name in names.tolist()]
    colours = [_hexadecimal(material.color) for material in used]
    labels = [name or "no material" for name in names.tolist()]
    has_images = attributes.kind_of("uv") not in (None, "face") and any(one.texture for one in used)
    if not has_images:
        return Labels("material", numbers.ravel(), labels, colours)
    uv = np.asarray(attributes.at_corners("uv"), dtype=np.float64)
    images = [material.texture for material in used]
    return Labels("material", numbers.ravel(), labels, colours, uv, images)


def _labels(name: str, values: Values) -> Paint | None:
    """Return the values of faces as labels; floats, or too many integers, as a scale.

    Return None for too many texts.
    """
    if values.dtype.kind == "f":
        return _scale(name, values)
    kinds, numbers = np.unique(values, return_inverse=True)
    if len(kinds) > _MAX_LABELS:
        return _scale(name, values) if values.dtype.kind in "iu" else None
    colours = [PALETTE[k % len(PALETTE)] for k in range(len(kinds))]
    return Labels(name, numbers.ravel(), [str(kind) for kind in kinds.tolist()], colours)


def _scale(name: str, values: Values) -> Paint | None:
    if values.dtype.kind not in "iuf":
        return None
    numbers: FloatArray = values.astype(np.float64)
    return Scale(name, numbers, DISTANCE)


def _hexadecimal(colour: tuple[float, ...]) -> str:
    """Return a colour of four numbers as ``"#rrggbb"``, or ``"#rrggbbaa"`` if it is not opaque."""
    return hexadecimal(colour[:3] if round(colour[3] * 255) == 255 else colour)
