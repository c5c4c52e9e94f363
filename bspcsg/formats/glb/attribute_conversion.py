"""Conversion of attributes and materials from and to GLB.

Colours are converted between sRGB and linear (see `linear_colours`); other numbers are stored
unchanged. glTF counts texture coordinates from the upper left corner of a picture, attributes count
from the lower left, so they are flipped.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray
from ...attributes.attributes import Attributes, Kind, Values, is_normal
from ...attributes.colours import as_bytes, is_color, opaque
from ...attributes.material import Material
from ...errors import InvalidMeshError
from ..storable_attributes import selected_attributes
from .accessors import fractions, numbers, stored
from .container import Container, picture_of, uv_of
from .linear_colours import as_read, color_of, linear_words, srgb_colours, to_linear

#: The name and the material of each material in a file, in file order.
Named: TypeAlias = list[tuple[str, Material]]

#: glTF's names of standard attributes, and our names of them.
_KNOWN = {"NORMAL": "normal", "TEXCOORD_0": "uv", "COLOR_0": "color"}

#: The prefix that glTF requires for the names of attributes that it does not define.
_CUSTOM_PREFIX = "_"


def stored_name(name: str) -> str:
    """Return a name in which “?” replaces lone surrogates, which UTF-8 cannot encode."""
    return name.encode("utf-8", "replace").decode("utf-8")


def storable(attributes: Attributes, vertices: FloatArray) -> Attributes:
    """Return the attributes that GLB can store, in single precision.

    These are normals, texture coordinates, colours, materials of faces, and float arrays of
    vertices and corners with up to four components. A missing normal becomes that of its face.
    """
    told = _with_all_normals(attributes.without_empty_material(), vertices)
    held = selected_attributes(told, _storable_values).with_renamed_materials(stored_name)
    names = held.face.get("material")
    if names is None:
        return Attributes(held.faces, held.vertex, held.corner, held.face)
    used = [name for name in np.unique(names).tolist() if name]
    given = {name: held.materials.get(name, Material()) for name in used}
    materials = {name: replace(one, color=as_read(one.color)) for name, one in given.items()}
    return Attributes(held.faces, held.vertex, held.corner, held.face, materials)


def _with_all_normals(attributes: Attributes, vertices: FloatArray) -> Attributes:
    if attributes.kind_of("normal") not in ("vertex", "corner"):
        return attributes
    normals = attributes.at_corners("normal")
    if not is_normal("normal", normals):
        return attributes
    missing: BoolArray = np.asarray(np.isnan(normals).any(axis=-1))
    if not missing.any():
        return attributes
    a, b, c = (vertices[attributes.faces[:, k]] for k in range(3))
    outward = np.cross(b - a, c - a)
    lengths = np.linalg.norm(outward, axis=1, keepdims=True)
    unit = np.divide(outward, lengths, out=np.zeros_like(outward), where=lengths > 0)
    filled = np.where(missing[..., None], unit[:, None], normals).astype(normals.dtype)
    vertex = {name: values for name, values in attributes.vertex.items() if name != "normal"}
    return replace(attributes, vertex=vertex, corner={**attributes.corner, "normal": filled})


def _storable_values(kind: Kind, name: str, values: Values) -> Values | None:
    shape = values.shape[2 if kind == "corner" else 1 :]
    if name == "material":
        return values if kind == "face" and values.dtype.kind == "U" and not shape else None
    if is_color(name, values, values.ndim - 1):
        return _color(values)
    if kind == "face" or values.dtype.kind != "f" or shape not in ((), (2,), (3,), (4,)):
        return None
    single = values.astype(np.float32)
    if name == "uv":
        return _flipped_uv(_flipped_uv(np.nan_to_num(single))) if shape == (2,) else None
    if name == "normal":
        is_whole = shape == (3,) and not np.isnan(single).any()
        return single if is_whole else None
    # A file must not contain NaN, or names that UTF-8 cannot encode.
    is_fit = name not in _KNOWN.values() and stored_name(name) == name
    return single if is_fit and not np.isnan(single).any() else None


def _color(values: Values) -> Values:
    """Return colours as four bytes each, since rows in a file must be multiples of four bytes."""
    return opaque(as_bytes(values))


def _flipped_uv(uv: Values) -> Values:
    """Flip texture coordinates vertically: v becomes 1 - v, in single precision."""
    turned: Values = np.stack([uv[..., 0], np.float32(1) - uv[..., 1]], axis=-1)
    return turned


def columns_of(attributes: Attributes, rows: IndexArray) -> dict[str, Values]:
    """Return the attributes at the corners of the triangles `rows`, (k, 3, …), by glTF's names."""
    called = {name: semantic for semantic, name in _KNOWN.items()}
    found = {}
    for name in attributes.names:
        if name != "material":
            values = attributes.at_corners(name, rows)
            found[called.get(name, _CUSTOM_PREFIX + name)] = _in_file(name, values)
    return found


def _in_file(name: str, values: Values) -> Values:
    if name == "uv":
        return _flipped_uv(values)
    return linear_words(values) if is_color(name, values, 2) else values


def read_columns(
    container: Container, primitive: dict[str, Any], count: int, used: IndexArray | None
) -> dict[str, Values]:
    """Return the attributes of a primitive's vertices by name, for all vertices or a selection.

    Parameters
    ----------
    container : Container
    primitive : dict
    count : int
        Number of the primitive's vertices.
    used : (k,) int64 or None
        Indices of the selected vertices; None for all.
    """
    found: dict[str, Values] = {}
    known = {**_KNOWN, "TEXCOORD_0": "", uv_of(container.tree, primitive): "uv"}
    for semantic, number in primitive["attributes"].items():
        name = known.get(semantic, semantic[1:] if semantic.startswith(_CUSTOM_PREFIX) else "")
        accessor = container.tree["accessors"][number]
        if not name or accessor["type"].startswith("MAT"):
            continue
        values = stored(container, number)
        if len(values) == count and _fits(name, values):
            some = values if used is None else values[used]
            found[name] = _decoded(name, some, bool(accessor.get("normalized")))
    return found


def _decoded(name: str, values: Values, is_fraction: bool) -> Values:
    """Convert stored numbers to an attribute: colours to sRGB, texture coordinates flipped."""
    if name == "color":
        return srgb_colours(fractions(values), is_whole=values.dtype.kind != "f")
    decoded = numbers(values, is_fraction)
    if name == "uv":
        return _flipped_uv(decoded.astype(np.float32))
    return decoded[:, 0] if decoded.shape[1] == 1 else decoded


def _fits(name: str, values: Values) -> bool:
    widths = {"normal": ((3,),), "uv": ((2,),), "color": ((3,), (4,))}
    return name not in widths or values.shape[1:] in widths[name]


def materials_of(tree: Mapping[str, Any], data: bytes) -> Named:
    """Return names and materials of a file; names that are missing or repeated get a number."""
    found: Named = []
    taken: set[str] = set()
    for number, told in enumerate(tree.get("materials", [])):
        name = str(told.get("name") or f"material {number}")
        while name in taken:
            name = f"{name} ({number})"
        taken.add(name)
        surface = told.get("pbrMetallicRoughness", {})
        texture = _texture(tree, data, surface.get("baseColorTexture"))
        try:
            color = color_of(surface.get("baseColorFactor", (1.0, 1.0, 1.0, 1.0)))
            found.append((name, Material(color, texture)))
        except (InvalidMeshError, TypeError, ValueError):
            found.append((name, Material()))
    return found


def _texture(tree: Mapping[str, Any], data: bytes, reference: Any) -> bytes | None:
    """Return the picture of a texture; None if the file does not contain it as PNG or JPEG."""
    try:
        image = tree["images"][tree["textures"][reference["index"]]["source"]]
        view = tree["bufferViews"][image["bufferView"]]
        start = view.get("byteOffset", 0)
        picture = bytes(data[start : start + view["byteLength"]])
        return Material(texture=picture).texture
    except (KeyError, IndexError, TypeError, InvalidMeshError):
        return None


def dropped_pictures(tree: Mapping[str, Any], data: bytes) -> tuple[str, ...]:
    """Return text for `RawMesh.dropped` if a material's picture cannot be read, else nothing."""
    textures = range(len(tree.get("textures", [])))
    named = [picture_of(material) for material in tree.get("materials", [])]
    given = [told for told in named if told.get("index") in textures]
    is_dropped = any(_texture(tree, data, told) is None for told in given)
    return ("pictures other than PNG and JPEG in the file",) if is_dropped else ()


class Pictures:
    """The materials of a GLB file that is being written, with their pictures.

    Parameters
    ----------
    materials : dict of str to Material
    append : callable
        Appends bytes to the binary data, and returns the number of their buffer view.
    """

    def __init__(self, materials: Mapping[str, Material], append: Callable[[bytes], int]) -> None:
        self.numbers = {name: number for number, name in enumerate(materials)}
        self._materials = materials
        self._append = append

    def described(self) -> dict[str, Any]:
        """Append the pictures to the data; return the JSON of materials, textures and images."""
        if not self._materials:
            return {}
        images: list[dict[str, Any]] = []
        found = []
        for name, material in self._materials.items():
            light = to_linear(material.color).tolist()
            surface: dict[str, Any] = {"metallicFactor": 0.0, "baseColorFactor": light}
            if material.texture is not None:
                images.append(
                    {"bufferView": self._append(material.texture), "mimeType": material.media}
                )
                surface["baseColorTexture"] = {"index": len(images) - 1}
            one: dict[str, Any] = {"name": name, "pbrMetallicRoughness": surface}
            found.append(one | ({"alphaMode": "BLEND"} if material.color[3] < 1 else {}))
        textures = [{"source": number} for number in range(len(images))]
        pictures = {"textures": textures, "images": images} if images else {}
        return {"materials": found, **pictures}
