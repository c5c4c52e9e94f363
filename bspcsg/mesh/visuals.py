"""Conversion of colours and other data of the mesh objects of other libraries to attributes.

An object is recognized by its Python attributes, not by its type. Data that are no array over the
vertices or triangles are silently ignored.
"""

import io
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from .._types import IndexArray
from ..attributes.attributes import Values
from ..attributes.colours import as_bytes, color_of, is_color
from ..attributes.material import Material
from .library_export import (
    CORNER_FACES,
    CORNERS,
    MATERIALS,
    Column,
    colors_by_materials,
    layout_of,
    mean_colors,
    picture_of,
)
from .mesh import Mesh

#: numpy's letters for the types of arrays that can be attributes.
_TYPES = "biufU"


def attributes_from(mesh: Any, vertices: Any, faces: Any) -> dict[str, Any]:
    """Return the attributes of a mesh object of any known library, as keyword arguments of `Solid`.

    Parameters
    ----------
    mesh : object
    vertices, faces
        The arrays that `interop.arrays_from` returns for `mesh`.
    """
    if isinstance(mesh, (tuple, list)):
        return {}
    found: dict[str, dict[str, Any]] = {"vertex": {}, "corner": {}, "face": {}, "materials": {}}
    if hasattr(mesh, "to_mesh64"):
        _take_properties(mesh.to_mesh64(), found)
    elif hasattr(mesh, "vert_properties"):
        _take_properties(mesh, found)
    else:
        for kind, names in _DICTIONARIES.items():
            for name in names:
                found[kind].update(_arrays_in(getattr(mesh, name, None)))
        metadata = getattr(mesh, "metadata", None)
        told = metadata if isinstance(metadata, Mapping) else {}
        _take_metadata(told, faces, found)
        _take_visual(getattr(mesh, "visual", None), len(faces), found)
        if isinstance(mesh, Mesh):
            found["materials"].update(mesh.materials)
    return _fitting_arrays(found, len(vertices), faces)


#: The Python attributes with dictionaries of arrays: of trimesh and `Mesh`, of pyvista and meshio.
_DICTIONARIES = {
    "vertex": ("vertex_attributes", "point_data"),
    "corner": ("corner_attributes",),
    "face": ("face_attributes", "cell_data"),
}


def _arrays_in(container: Any) -> dict[str, Any]:
    if not isinstance(container, Mapping) and not hasattr(container, "items"):
        return {}
    pairs: Iterable[tuple[Any, Any]] = container.items()
    return {name: _one_array(values) for name, values in pairs if isinstance(name, str)}


def _one_array(values: Any) -> Any:
    """Return values as one array; a list of arrays, meshio's blocks of cells, is concatenated."""
    is_list = isinstance(values, list) and values
    if is_list and all(isinstance(block, np.ndarray) for block in values):
        return np.concatenate(values)
    return np.asarray(values)


def _fitting_arrays(
    found: dict[str, dict[str, Any]], vertex_count: int, faces: Any
) -> dict[str, dict[str, Any]]:
    """Return keyword arguments of `Solid` with the arrays that fit the mesh, each name once.

    An array fits if it has a row for each vertex, triangle or corner, and a supported type.
    """
    triangles = np.asarray(faces) if all(len(face) == 3 for face in faces) else np.zeros((0, 3))
    rows = {"vertex": (vertex_count,), "corner": triangles.shape, "face": triangles.shape[:1]}
    taken: set[str] = set()
    options: dict[str, dict[str, Any]] = {}
    for kind, shape in rows.items():
        fit = {
            name: values
            for name, values in found[kind].items()
            if values.dtype.kind in _TYPES
            and values.shape[: len(shape)] == shape
            and name not in taken
        }
        taken.update(fit)
        if fit:
            options[f"{kind}_attributes"] = fit
    if options and found["materials"]:
        options["materials"] = found["materials"]
    return options


def _take_properties(mesh: Any, found: dict[str, dict[str, Any]]) -> None:
    """Add the vertex properties of a manifold3d mesh to `found` as attributes."""
    properties = np.asarray(mesh.vert_properties)[:, 3:]
    if properties.shape[1] == 0:
        return
    triangles = np.asarray(mesh.tri_verts, dtype=np.int64)
    layout = layout_of(getattr(mesh, "run_original_id", ())) or ()
    if sum(column.width for column in layout) != properties.shape[1]:
        column = Column("properties", "vertex", properties.dtype, properties.shape[1:])
        layout = (column,)
    start = 0
    for column in layout:
        values = column.values(properties[:, start : start + column.width])
        start += column.width
        _take_column(column, values, triangles, bool(len(mesh.merge_from_vert)), found)


def _take_column(
    column: Column,
    values: Values,
    triangles: IndexArray,
    has_seams: bool,
    found: dict[str, dict[str, Any]],
) -> None:
    """Add one attribute to `found`: of faces, corners or vertices.

    It is an attribute of faces if it was one and still has one value for each face; of corners if
    the mesh has seams, which are vertices of one position with different values.
    """
    corners = values[triangles]
    if column.kind == "face" and np.array_equal(corners, np.repeat(corners[:, :1], 3, axis=1)):
        found["face"][column.name] = corners[:, 0]
    elif has_seams:
        found["corner"][column.name] = corners
    else:
        found["vertex"][column.name] = values


def _take_metadata(
    metadata: Mapping[str, Any], faces: Any, found: dict[str, dict[str, Any]]
) -> None:
    """Add the materials, and the attributes of corners if the faces are unchanged, to `found`.

    `metadata` is the metadata that `library_export.trimesh_of` has stored in a trimesh.
    """
    materials, corners = metadata.get(MATERIALS), metadata.get(CORNERS)
    if isinstance(materials, Mapping):
        kept = {name: one for name, one in materials.items() if isinstance(one, Material)}
        found["materials"].update(kept)
    if isinstance(corners, Mapping) and np.array_equal(metadata.get(CORNER_FACES, ()), faces):
        found["corner"].update(_arrays_in(corners))


def _take_visual(visual: Any, count: int, found: dict[str, dict[str, Any]]) -> None:
    kind = getattr(visual, "kind", None)
    if kind == "vertex":
        found["vertex"]["color"] = np.asarray(visual.vertex_colors)
    elif kind == "face":
        _take_face_colors(np.asarray(visual.face_colors), found)
    elif kind == "texture":
        if getattr(visual, "uv", None) is not None:
            found["vertex"]["uv"] = np.asarray(visual.uv)
        _take_materials(visual, count, found)


def _take_face_colors(colors: Values, found: dict[str, dict[str, Any]]) -> None:
    """Add the colours of faces to `found`, unless they follow from materials or corner colours."""
    names, corners = found["face"].get("material"), found["corner"].get("color")
    if found["materials"] and names is not None and len(names) == len(colors):
        shown = colors_by_materials(names, found["materials"])
    elif corners is not None and len(corners) == len(colors) and is_color("color", corners, 2):
        shown = mean_colors(corners)
    else:
        shown = np.zeros((0, 4))
    if not np.array_equal(shown, colors):
        found["corner"].pop("color", None)
        found["face"]["color"] = colors


def _take_materials(visual: Any, count: int, found: dict[str, dict[str, Any]]) -> None:
    """Add the materials of a trimesh to `found`: one for all faces, or one of several per face."""
    numbers = getattr(visual, "face_materials", None)
    several = list(getattr(visual.material, "materials", None) or ())
    if several and numbers is not None and len(numbers) == count:
        names = [_take_material(one, f"material {k}", found) for k, one in enumerate(several)]
        found["face"]["material"] = np.array(names)[np.asarray(numbers)]
        return
    name = _take_material(several[0] if several else visual.material, "material", found)
    found["face"]["material"] = np.full(count, name)


def _take_material(material: Any, usual: str, found: dict[str, dict[str, Any]]) -> str:
    """Add a material to `found`, unless an equal one of its name is there; return the name."""
    image = getattr(material, "baseColorTexture", None) or getattr(material, "image", None)
    name = str(getattr(material, "name", None) or usual)
    color = np.asarray(getattr(material, "main_color", (255, 255, 255, 255)))[:4]
    known = found["materials"].get(name)
    if known is None or not _is_same(known, color, image):
        texture = None if image is None else _as_png(image)
        found["materials"][name] = Material(color_of(color), texture)
    return name


def _is_same(known: Material, color: Values, image: Any) -> bool:
    """Say whether a material has this colour in bytes and the pixels of this image, or no image."""
    if as_bytes(np.array(known.color)).tolist() != color.tolist():
        return False
    if known.texture is None or image is None:
        return known.texture is None and image is None
    picture = picture_of(known.texture)
    return bool(
        picture.size == image.size
        and picture.convert("RGBA").tobytes() == image.convert("RGBA").tobytes()
    )


def _as_png(image: Any) -> bytes:
    stream = io.BytesIO()
    image.save(stream, format="PNG")
    return stream.getvalue()
