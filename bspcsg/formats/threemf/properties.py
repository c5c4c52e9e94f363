"""Properties of 3MF: colour groups are colours of corners, base materials are materials."""

from typing import TypeVar

import numpy as np

from ..._types import IndexArray
from ...attributes.attributes import Attributes, Kind, Values
from ...attributes.material import Material
from ..said import as_bytes, chosen, is_color
from .part import ModelPart, Object

_Entry = TypeVar("_Entry")

#: What corners have that have no colour: white.
_WHITE = (255, 255, 255, 255)


def properties_of(part: ModelPart, held: Object, faces: IndexArray) -> Attributes | None:
    """Return what is said of the triangles of an object, in the order of the file.

    Raises
    ------
    ValueError
        If a triangle names a property that does not exist.
    """
    if held.usual is None and not held.properties:
        return None
    usual = None if held.usual is None else (held.usual[0], (held.usual[1],) * 3)
    rows = [held.properties.get(k, usual) for k in range(len(held.triangles))]
    colors = np.full((len(rows), 3, 4), _WHITE, dtype=np.uint8)
    names: list[str] = []
    materials: dict[str, Material] = {}
    has_colors = False
    for k, row in enumerate(rows):
        names.append("")
        if row is not None and row[0] in part.colors:
            colors[k] = [_entry(part.colors[row[0]], number) for number in row[1]]
            has_colors = True
        elif row is not None and row[0] in part.bases:
            names[-1], color = _entry(part.bases[row[0]], row[1][0])
            materials[names[-1]] = Material(tuple(value / 255 for value in color))
    corner = {"color": colors} if has_colors else {}
    face = {"material": np.array(names)} if materials else {}
    if not corner and not face:
        return None
    return Attributes(faces, {}, corner, face, materials)


def _entry(group: list[_Entry], number: int) -> _Entry:
    if not 0 <= number < len(group):
        raise ValueError(f"a triangle names property {number} of a group of {len(group)}")
    return group[number]


def kept(said: Attributes) -> Attributes:
    """Return what 3MF holds of attributes: materials of faces, or else colours, both in bytes."""
    names = said.face.get("material")
    if names is not None and names.dtype.kind == "U" and names.ndim == 1:
        used = [name for name in np.unique(names).tolist() if name]
        given = {name: said.materials.get(name, Material()) for name in used}
        materials = {name: _in_bytes(material) for name, material in given.items()}
        return Attributes(said.faces, {}, {}, {"material": names}, materials)

    def keep(kind: Kind, name: str, values: Values) -> Values | None:
        if not is_color(name, values, 2 if kind == "corner" else 1):
            return None
        colors = as_bytes(values)
        if colors.shape[-1] == 4:
            return colors
        return np.concatenate([colors, np.full_like(colors[..., :1], 255)], axis=-1)

    return Attributes(said.faces, *_kinds(chosen(said, keep)))


def _kinds(said: Attributes) -> tuple[dict[str, Values], dict[str, Values], dict[str, Values]]:
    return dict(said.vertex), dict(said.corner), dict(said.face)


def _in_bytes(material: Material) -> Material:
    return Material(tuple(round(value * 255) / 255 for value in material.color))
