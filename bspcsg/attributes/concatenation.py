"""Attributes of several concatenated meshes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .._types import IndexArray
from .attributes import Attributes, Kind, Values
from .material import Material
from .transfer import common_type, default_of, uniform_colors


@dataclass(frozen=True, eq=False)
class MeshPart:
    """One of several concatenated meshes: its number of vertices, its faces and its attributes."""

    vertex_count: int
    faces: IndexArray
    attributes: Attributes | None


def concatenated(parts: Sequence[MeshPart], faces: IndexArray) -> Attributes | None:
    """Return the attributes of concatenated meshes, or None if no mesh has attributes.

    Parameters
    ----------
    parts : sequence of MeshPart
    faces : (m, 3) int64
        The triangles of the concatenated mesh.
    """
    said = [part for part in parts if part.attributes is not None]
    if not said:
        return None
    parts, materials = _with_common_materials(parts)
    names = [name for part in said if part.attributes for name in part.attributes.names]
    found: dict[Kind, dict[str, Values]] = {"vertex": {}, "corner": {}, "face": {}}
    for name in dict.fromkeys(names):
        kinds = {part.attributes.kind_of(name) for part in said if part.attributes} - {None}
        kind: Kind = kinds.pop() or "corner" if len(kinds) == 1 else "corner"
        values = _values(name, kind, parts)
        values.flags.writeable = False
        found[kind][name] = values
    return Attributes(faces, **found, materials=materials)


def _values(name: str, kind: Kind, parts: Sequence[MeshPart]) -> Values:
    rows: Callable[[MeshPart], tuple[int, ...]] = {
        "vertex": lambda part: (part.vertex_count,),
        "corner": lambda part: (len(part.faces), 3),
        "face": lambda part: (len(part.faces),),
    }[kind]
    held = [_values_of(name, kind, part.attributes) for part in parts]
    depth = 2 if kind == "corner" else 1
    known = uniform_colors(name, [values for values in held if values is not None], depth)
    given = iter(known)
    dtype = common_type(name, known, depth)
    shape = known[0].shape[depth:]
    blank = default_of(name, known[0].astype(dtype, copy=False), depth)
    blocks = [
        np.full(rows(part) + shape, blank, dtype) if values is None else next(given)
        for part, values in zip(parts, held, strict=True)
    ]
    whole: Values = np.concatenate(blocks).astype(dtype, copy=False)
    return whole


def _values_of(name: str, kind: Kind, attributes: Attributes | None) -> Values | None:
    if attributes is None or attributes.kind_of(name) is None:
        return None
    return attributes.at_corners(name) if kind == "corner" else attributes.of(kind)[name]


def _with_common_materials(parts: Sequence[MeshPart]) -> tuple[list[MeshPart], dict[str, Material]]:
    """Return the parts with unique names of materials, and the materials of all parts by name.

    A number is appended to a name that an earlier part uses for another material.
    """
    materials: dict[str, Material] = {}
    found = []
    for part in parts:
        if part.attributes is None:
            found.append(part)
            continue
        found.append(replace(part, attributes=part.attributes.among(materials)))
    return found, materials
