"""Conversion of meshes with attributes to trimesh and manifold3d, with warnings about losses.

The module `visuals` converts them back.
"""

import io
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .._types import IndexArray
from ..attributes.attributes import Attributes, Kind, Values, corners_to_faces
from ..attributes.colours import COLOR, as_bytes, as_floats, is_color, opaque
from ..attributes.material import Material
from ..errors import Finding, InvalidMeshError, warn_of_losses
from .interop import import_optional, to_manifold
from .mesh import Mesh

if TYPE_CHECKING:
    import manifold3d
    import trimesh

#: The keys in the metadata of a trimesh: attributes of corners, the faces to which these belong,
#: and materials by name.
CORNERS, CORNER_FACES, MATERIALS = "corner_attributes", "corner_faces", "materials"

#: The colour in trimesh of faces whose colour is not given.
_PLAIN = (102, 102, 102, 255)


def trimesh_of(mesh: Mesh) -> "trimesh.Trimesh":
    """Return a `trimesh.Trimesh` with copies of a mesh's vertices, faces and attributes."""
    made: trimesh.Trimesh = import_optional("trimesh", "trimesh").Trimesh(
        mesh.vertices.copy(), mesh.faces.copy(), process=False
    )
    attributes = _consistent_attributes(mesh, "trimesh")
    if attributes is not None:
        _TrimeshAttributes(made, attributes).run()
    return made


def _consistent_attributes(mesh: Mesh, library: str) -> Attributes | None:
    """Return a mesh's attributes; None if it has none, or with a warning if they are invalid."""
    if mesh.carried is None:
        return None
    try:
        attributes = mesh.attributes.without_empty_material()
    except InvalidMeshError as error:
        _warn_of_loss(f"the attributes were not passed to {library}: {error.message}", 1)
        return None
    return None if attributes.is_empty or not len(mesh.faces) else attributes


def _warn_of_loss(message: str, count: int) -> None:
    warn_of_losses([Finding("attributes_left_out", "warning", message, (), count)])


class _TrimeshAttributes:
    """A conversion of attributes to a trimesh: to its visual, its named arrays and its metadata."""

    def __init__(self, made: "trimesh.Trimesh", attributes: Attributes) -> None:
        self._made = made
        self._said = corners_to_faces(attributes)
        self._is_colored = False

    def run(self) -> None:
        """Set all attributes of the trimesh."""
        attributes, made = self._said, self._made
        names = set(attributes.names)
        if attributes.materials:
            made.metadata[MATERIALS] = dict(attributes.materials)
        color = attributes.at_corners(COLOR, np.zeros(0, np.int64)) if COLOR in names else None
        if color is not None and is_color(COLOR, color, 2):
            self._color()
            names.discard(COLOR)
        self._materials()
        made.vertex_attributes.update(
            {n: v.copy() for n, v in attributes.vertex.items() if n in names}
        )
        made.face_attributes.update({n: v.copy() for n, v in attributes.face.items() if n in names})
        self._corners()

    def _color(self) -> None:
        """Set the colours of the trimesh's visual; corners' colours become a mean for each face."""
        attributes, self._is_colored = self._said, True
        kind = attributes.kind_of(COLOR) or "face"
        values = attributes.of(kind)[COLOR]
        if kind == "vertex":
            self._show(vertex_colors=opaque(as_bytes(values)))
            return
        if kind == "corner":
            _warn_of_loss(
                "trimesh cannot store colours of corners, so each face gets the mean colour"
                f" of its corners; metadata[{CORNERS!r}] has the full colours.",
                1,
            )
            self._show(face_colors=mean_colors(values))
            return
        self._show(face_colors=opaque(as_bytes(values)))

    def _show(self, **colors: Values) -> None:
        visual = import_optional("trimesh.visual", "trimesh").ColorVisuals
        self._made.visual = visual(self._made, **colors)

    def _materials(self) -> None:
        """Set the material if there is only one and it fits, else the colours of all materials."""
        attributes = self._said
        if "material" not in attributes.face or not attributes.materials:
            return
        names = np.unique(attributes.face["material"]).tolist()
        has_picture = any(one.texture for one in attributes.materials.values())
        material = attributes.materials.get(names[0]) if len(names) == 1 else None
        uv = attributes.vertex.get("uv")
        if material is not None and _are_places(uv) and not (self._is_colored and not has_picture):
            visual = import_optional("trimesh.visual", "trimesh").TextureVisuals
            self._made.visual = visual(uv=np.array(uv), material=_material(names[0], material))
            self._color_as_array()
            return
        if has_picture:
            _warn_of_loss(
                "trimesh shows a texture only if all faces have one material and the texture"
                " coordinates belong to vertices, so the pictures were stored in its metadata"
                " only.",
                1,
            )
        if not self._is_colored:
            self._show(
                face_colors=colors_by_materials(attributes.face["material"], attributes.materials)
            )

    def _color_as_array(self) -> None:
        """Store colours as a named array, since the trimesh's visual already has a picture."""
        attributes = self._said
        if COLOR in attributes.vertex:
            self._made.vertex_attributes[COLOR] = attributes.vertex[COLOR].copy()
        if COLOR in attributes.face:
            self._made.face_attributes[COLOR] = attributes.face[COLOR].copy()

    def _corners(self) -> None:
        if self._said.corner:
            kept = {name: values.copy() for name, values in self._said.corner.items()}
            self._made.metadata[CORNERS] = kept
            self._made.metadata[CORNER_FACES] = self._said.faces.copy()


def _are_places(uv: Values | None) -> bool:
    return uv is not None and uv.dtype.kind == "f" and uv.shape[1:] == (2,)


def mean_colors(values: Values) -> Values:
    """Return the mean colour of each face's corners, (m, 4) uint8."""
    return opaque(as_bytes(as_floats(values).mean(axis=1)))


def colors_by_materials(names: Values, materials: Mapping[str, Material]) -> Values:
    """Return the colour of each face's material, (m, 4) uint8."""
    kinds, numbers = np.unique(names, return_inverse=True)
    found = [materials[kind].color if kind in materials else None for kind in kinds.tolist()]
    table = [_PLAIN if one is None else as_bytes(np.array(one)) for one in found]
    colors: Values = np.array(table, dtype=np.uint8)[numbers]
    return colors


def _material(name: str, material: Material) -> Any:
    """Return a material as a `trimesh.visual.material.PBRMaterial`."""
    kind = import_optional("trimesh.visual.material", "trimesh").PBRMaterial
    picture = None if material.texture is None else picture_of(material.texture)
    color = as_bytes(np.array(material.color))
    mode = "BLEND" if material.color[3] < 1 else None
    return kind(name=name, baseColorFactor=color, baseColorTexture=picture, alphaMode=mode)


def picture_of(data: bytes) -> Any:
    """Return the bytes of a picture file as a `PIL.Image.Image`."""
    return import_optional("PIL.Image", "pillow").open(io.BytesIO(data))


@dataclass(frozen=True)
class Column:
    """The columns of manifold3d's vertex properties that contain one attribute.

    Parameters
    ----------
    name, kind, dtype
        Those of the attribute.
    shape : tuple of int
        The shape of one value of the attribute.
    """

    name: str
    kind: Kind
    dtype: np.dtype[Any]
    shape: tuple[int, ...]

    @property
    def width(self) -> int:
        """The number of columns that the attribute needs."""
        return int(np.prod(self.shape, dtype=np.int64))

    @property
    def _is_color(self) -> bool:
        return self.name == COLOR and self.shape == (4,)

    def numbers(self, values: Values) -> Values:
        """Convert attribute values to columns, (k, width) float64; colours from 0 to 1."""
        found = opaque(as_floats(values)) if self._is_color else values.astype(np.float64)
        return found.reshape(-1, self.width)

    def values(self, numbers: Values) -> Values:
        """Convert columns (…, width) back to attribute values of the attribute's type."""
        values = numbers.reshape(*numbers.shape[:-1], *self.shape)
        if self._is_color and self.dtype.kind == "u":
            values = np.clip(values, 0, 1) * np.iinfo(self.dtype).max
        if self.dtype.kind == "b":
            return np.asarray(values > 0.5)
        rounded = np.rint(values) if self.dtype.kind in "iu" else values
        return np.asarray(rounded.astype(self.dtype))


#: The columns of each mesh that was converted to manifold3d, by manifold3d's id of the original.
_LAYOUTS: dict[int, tuple[Column, ...]] = {}

#: The largest number of meshes whose columns are stored; the oldest are deleted first.
_MAX_LAYOUTS = 1 << 16


def layout_of(ids: Iterable[int]) -> tuple[Column, ...] | None:
    """Return the columns of original meshes, given their ids; None if the columns differ."""
    found = {_LAYOUTS.get(int(number)) for number in ids}
    return found.pop() if len(found) == 1 else None


def manifold_of(mesh: Mesh) -> "manifold3d.Manifold":
    """Return a `manifold3d.Manifold` of a mesh; numeric attributes become vertex properties."""
    attributes = _consistent_attributes(mesh, "manifold3d")
    if attributes is None:
        return to_manifold(mesh)
    others = [name for name in attributes.names if not _are_finite(attributes, name)]
    if others:
        told = ", ".join(f"“{name}”" for name in others)
        _warn_of_loss(
            f"manifold3d stores finite numbers only, so the attributes {told} were left out.",
            len(others),
        )
    columns = tuple(
        _column(attributes, name) for name in _in_order(attributes) if name not in others
    )
    return _with_properties(mesh, attributes, columns) if columns else to_manifold(mesh)


def _are_finite(attributes: Attributes, name: str) -> bool:
    values = attributes.at_corners(name)
    if is_color(name, values, 2):
        values = as_floats(values)
    return values.dtype.kind != "U" and bool(np.isfinite(values).all())


_NO_INDICES: IndexArray = np.zeros(0, dtype=np.int64)


def _in_order(attributes: Attributes) -> list[str]:
    """Return the names of attributes, “properties” first.

    “properties” are columns that came from manifold3d; as the first ones they get the same numbers.
    """
    return sorted(attributes.names, key=lambda name: name != "properties")


def _column(attributes: Attributes, name: str) -> Column:
    values = attributes.at_corners(name, _NO_INDICES)
    # Colours with and without opacity have four columns, so that both may occur in one mesh.
    shape = (4,) if is_color(name, values, 2) else values.shape[2:]
    return Column(name, attributes.kind_of(name) or "face", values.dtype, shape)


def _with_properties(
    mesh: Mesh, attributes: Attributes, columns: tuple[Column, ...]
) -> "manifold3d.Manifold":
    import manifold3d

    table = np.hstack([column.numbers(attributes.at_corners(column.name)) for column in columns])
    corners = mesh.faces.ravel()
    chosen, numbers = _distinct(corners, table)
    vertices = np.hstack([mesh.vertices[corners[chosen]], table[chosen]])
    # For the topology, vertices of one position with different values are merged into the first.
    same, first = np.unique(corners[chosen], return_index=True)
    target = first[np.searchsorted(same, corners[chosen])]
    source = np.flatnonzero(target != np.arange(len(chosen)))
    original = manifold3d.Manifold.reserve_ids(1)
    made = manifold3d.Mesh64(
        np.ascontiguousarray(vertices),
        np.ascontiguousarray(numbers.reshape(-1, 3), dtype=np.uint64),
        source.astype(np.uint64),
        target[source].astype(np.uint64),
        np.array([0, len(corners)], dtype=np.uint64),
        np.array([original], dtype=np.uint32),
    )
    while len(_LAYOUTS) >= _MAX_LAYOUTS:
        _LAYOUTS.pop(next(iter(_LAYOUTS)), None)
    _LAYOUTS[original] = columns
    return manifold3d.Manifold(made)


def _distinct(corners: IndexArray, table: Values) -> tuple[IndexArray, IndexArray]:
    """Split vertices whose corners have different values, the rows of `table`.

    Return the number of one corner for each new vertex, and the new vertex of each corner.
    """
    # Bytes in this order sort like the numbers of vertices, so vertices keep their order.
    keys = corners.astype(">u8")[:, None].view(np.uint8)
    rows: npt.NDArray[np.uint8] = np.hstack([keys, np.ascontiguousarray(table).view(np.uint8)])
    words = np.ascontiguousarray(rows).view(f"V{rows.shape[1]}").ravel()
    _, chosen, numbers = np.unique(words, return_index=True, return_inverse=True)
    return chosen, numbers.ravel()
