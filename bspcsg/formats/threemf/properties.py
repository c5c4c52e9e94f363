"""Conversion between properties of 3MF and attributes of a mesh.

Colour groups become colours of corners; base materials and textures become materials; texture
coordinates become the attribute ``"uv"``.
"""

from collections import Counter
from collections.abc import Callable
from functools import lru_cache
from typing import TypeVar

import numpy as np

from ..._types import IndexArray
from ...attributes.attributes import Attributes, Kind, Values
from ...attributes.colours import as_bytes, is_color, opaque
from ...attributes.material import Material
from ...errors import InvalidMeshError
from ..storable_attributes import selected_attributes
from .part import Base, ModelPart, Object
from .textures import fit_for_parts, named_after
from .write import stored_name

_Entry = TypeVar("_Entry")

#: The colour of corners whose colour is not given: white.
_WHITE = (255, 255, 255, 255)


def properties_of(
    part: ModelPart, source: Object, faces: IndexArray, picture: Callable[[str], bytes]
) -> Attributes | None:
    """Return the attributes of the triangles of an object, in file order.

    Parameters
    ----------
    part : ModelPart
    source : Object
        An object of `part`.
    faces : (m, 3) int64
    picture : callable
        Returns the bytes of a part of the package, by name.

    Raises
    ------
    IndexError
        If a triangle names a property that does not exist.
    """
    if source.usual is None and not source.properties:
        return None
    usual = None if source.usual is None else (source.usual[0], (source.usual[1],) * 3)
    reading = _PropertyCollector(part, len(source.triangles))
    for k in range(len(source.triangles)):
        row = source.properties.get(k, usual)
        if row is not None:
            reading.take(k, *row)
    return reading.attributes(faces, picture)


class _PropertyCollector:
    """The properties of the triangles of one object, collected triangle by triangle."""

    def __init__(self, part: ModelPart, count: int) -> None:
        self._part = part
        self._colors = np.full((count, 3, 4), _WHITE, dtype=np.uint8)
        self._places = np.full((count, 3, 2), np.nan)
        self._names = [""] * count
        self._materials: dict[str, Material] = {}
        self._textures: dict[str, str] = {}
        self._has_colors = False
        bases = [base for group in part.bases.values() for base in group]
        pictures = [*map(named_after, part.textures.values())]
        self._base_names = _names_of_bases(bases, pictures)
        self._taken = Counter([*(name for name, _ in bases), *pictures])

    def take(self, k: int, group: str, numbers: tuple[int, ...]) -> None:
        """Store the properties of triangle `k`: entries of `group`, one index for each corner."""
        part = self._part
        if group in part.colors:
            self._colors[k] = [_entry(part.colors[group], number) for number in numbers]
            self._has_colors = True
        elif group in part.bases:
            base = _entry(part.bases[group], numbers[0])
            self._names[k] = self._base_names[base]
            self._materials[self._names[k]] = _plain(base[1])
        elif group in part.coordinates:
            texture, places = part.coordinates[group]
            self._names[k] = self._textures.setdefault(
                texture, self._distinct_texture_name(texture)
            )
            self._places[k] = [_entry(places, number) for number in numbers]

    def _distinct_texture_name(self, texture: str) -> str:
        """Return the material name of a texture, distinct from all other material names."""
        if texture not in self._part.textures:
            raise IndexError(f"it refers to texture {texture}, which does not exist")
        name = named_after(self._part.textures[texture])
        return name if self._taken[name] == 1 else f"{name} ({texture})"

    def attributes(self, faces: IndexArray, picture: Callable[[str], bytes]) -> Attributes | None:
        """Return the attributes of the triangles; None if no properties were stored."""
        materials = dict(self._materials)
        for texture, name in self._textures.items():
            materials[name] = _pictured(picture(self._part.textures[texture]))
            if materials[name].texture is None:
                self._part.dropped.add("textures")
        corner = {"color": self._colors} if self._has_colors else {}
        corner |= {"uv": self._places} if self._textures else {}
        face = {"material": np.array(self._names)} if materials else {}
        return Attributes(faces, {}, corner, face, materials) if corner or face else None


def _names_of_bases(bases: list[Base], pictures: list[str]) -> dict[Base, str]:
    """Return a material name for each base material, distinct from each other and from `pictures`.

    A repeated name gets a number, and an empty one becomes “material” and a number.
    """
    taken = {*(name for name, _ in bases), *pictures}
    found: dict[Base, str] = {}
    seen = {""}
    for number, (name, color) in enumerate(dict.fromkeys(bases)):
        free = name
        while name in seen and free in taken:
            free = f"{free} ({number})" if free else f"material {number}"
        seen.add(name)
        taken.add(free)
        found[name, color] = free
    return found


@lru_cache(maxsize=256)
def _plain(color: tuple[int, ...]) -> Material:
    """Return the material of a colour, given as bytes; equal colours share one object."""
    return Material(tuple(value / 255 for value in color))


def _pictured(data: bytes) -> Material:
    try:
        return Material(texture=data)
    except InvalidMeshError:  # an unknown picture format
        return Material()


def _entry(group: list[_Entry], number: int) -> _Entry:
    if not 0 <= number < len(group):
        raise IndexError(
            f"a triangle refers to property {number} of a group with {len(group)} properties"
        )
    return group[number]


def storable(attributes: Attributes) -> Attributes:
    """Return the attributes that 3MF can store: materials of faces or else colours, as bytes."""
    attributes = attributes.without_empty_material()
    names = attributes.face.get("material")
    if names is not None and names.dtype.kind == "U" and names.ndim == 1:
        return _storable_materials(attributes.with_renamed_materials(stored_name))

    def keep(kind: Kind, name: str, values: Values) -> Values | None:
        if not is_color(name, values, 2 if kind == "corner" else 1):
            return None
        return opaque(as_bytes(values))

    return Attributes(attributes.faces, *_kinds(selected_attributes(attributes, keep)))


def _storable_materials(attributes: Attributes) -> Attributes:
    names = attributes.face["material"]
    used = [name for name in np.unique(names).tolist() if name]
    given = {name: attributes.materials.get(name, Material()) for name in used}
    is_pair = _has_places(attributes)
    textured = [name for name, one in given.items() if one.texture is not None and is_pair]
    fit = fit_for_parts(textured, used)
    materials = {
        fit.get(name, name): Material(texture=one.texture) if name in fit else _in_bytes(one)
        for name, one in given.items()
    }
    if not fit:
        return Attributes(attributes.faces, {}, {}, {"material": names}, materials)
    renamed = np.array([fit.get(name, name) for name in names.tolist()])
    places = np.nan_to_num(attributes.at_corners("uv").astype(np.float64))
    places[~np.isin(names, textured)] = np.nan
    return Attributes(attributes.faces, {}, {"uv": places}, {"material": renamed}, materials)


def _has_places(attributes: Attributes) -> bool:
    """Say whether vertices or corners have texture coordinates: pairs of floats named “uv”."""
    if attributes.kind_of("uv") not in ("vertex", "corner"):
        return False
    places = attributes.at_corners("uv")
    return places.dtype.kind == "f" and places.shape[2:] == (2,)


def _kinds(
    attributes: Attributes,
) -> tuple[dict[str, Values], dict[str, Values], dict[str, Values]]:
    return dict(attributes.vertex), dict(attributes.corner), dict(attributes.face)


def _in_bytes(material: Material) -> Material:
    return Material(tuple(round(value * 255) / 255 for value in material.color))
