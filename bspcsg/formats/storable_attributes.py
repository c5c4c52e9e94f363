"""Selection of the attributes that a file format can store, and findings about lost attributes."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ..attributes.attributes import KINDS, Attributes, Kind, Values
from ..attributes.colours import COLOR, as_floats, is_color, is_opaque
from ..errors import Finding
from ..mesh.mesh import Mesh
from .raw import RawMesh


def attributes_or_none(mesh: Mesh | RawMesh) -> Attributes | None:
    """Return the attributes of a mesh; None if it has no attributes or no triangles."""
    has_none = isinstance(mesh, Mesh) and mesh.carried is None
    attributes = None if has_none or not len(mesh.faces) else mesh.attributes
    return None if attributes is None or attributes.is_empty else attributes


def with_attributes(mesh: Mesh | RawMesh, attributes: Attributes | None) -> RawMesh:
    """Return a mesh as a `RawMesh` whose attributes are replaced by `attributes`."""
    if isinstance(mesh, RawMesh):
        return replace(mesh, attributes=attributes)
    return RawMesh(mesh.vertices, mesh.faces, attributes=attributes)


def selected_attributes(
    attributes: Attributes, keep: Callable[[Kind, str, Values], Values | None]
) -> Attributes:
    """Return the attributes for which `keep` returns values, with these values.

    `keep` returns None for an attribute to drop.
    """
    vertex, corner, face = (
        {
            name: values
            for name, given in attributes.of(kind).items()
            if (values := keep(kind, name, given)) is not None
        }
        for kind in KINDS
    )
    names = face.get("material")
    materials = attributes.materials if names is not None and names.dtype.kind == "U" else {}
    return Attributes(attributes.faces, vertex, corner, face, materials)


def attribute_losses(
    attributes: Attributes, kept: Attributes | None, suffix: str
) -> tuple[Finding, ...]:
    """Return findings about attributes of `attributes` that are missing or changed in `kept`."""
    held = Attributes(attributes.faces) if kept is None else kept
    lost = [name for name in attributes.names if name not in held.names]
    told = [f"“{name}” of {_PLURAL[attributes.kind_of(name) or 'face']}" for name in lost]
    if COLOR in lost and "material" in held.names:
        told[lost.index(COLOR)] += " beside “material”"
    return (*unstorable_finding(told, suffix), *_changed_color(attributes, held, suffix))


def unstorable_finding(names: Sequence[str], suffix: str) -> tuple[Finding, ...]:
    """Return the finding that a format cannot store the attributes which `names` describes.

    Return nothing if `names` is empty.
    """
    if not names:
        return ()
    were = "was" if len(names) == 1 else "were"
    message = f"{suffix[1:].upper()} cannot store {', '.join(names)}, which {were} left out."
    return (Finding("attributes_left_out", "warning", message, (), len(names)),)


def _changed_color(attributes: Attributes, stored: Attributes, suffix: str) -> tuple[Finding, ...]:
    """Return a finding if a file stores colours rounded or without opacity, else nothing."""
    if COLOR not in attributes.names or COLOR not in stored.names:
        return ()
    given, kept = attributes.at_corners(COLOR), stored.at_corners(COLOR)
    if not is_color(COLOR, given, 2):
        return ()
    name = suffix[1:].upper()
    if not is_opaque(given) and kept.shape[2:] == (3,):
        message = (
            f"{name} cannot store the opacity of the attribute “color” here, so it was left out."
        )
        return (Finding("colors_left_out", "warning", message, (), 1),)
    if np.abs(as_floats(given)[..., :3] - as_floats(kept)[..., :3]).max(initial=0) <= _EQUAL:
        return ()
    message = (
        f"{name} stores colours as bytes, so the values of the attribute “color” were rounded."
    )
    return (Finding("colors_rounded", "note", message, (), 1),)


#: Colours that differ by at most this are equal: single precision rounds them by as much.
_EQUAL = 2.0**-22

_PLURAL: dict[Kind, str] = {"vertex": "vertices", "corner": "corners", "face": "faces"}
