"""Attributes of other libraries' meshes, in and out.

As in `interop`, an object is asked what it has. What is no array over its vertices or triangles is
left, as nobody asked for it.
"""

import io
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from ..attributes.material import Material
from .mesh import Mesh

#: Types of arrays that are carried.
_TYPES = "biufU"


def attributes_from(mesh: Any, vertices: Any, faces: Any) -> dict[str, Any]:
    """Return the attributes of whatever holds a mesh, as `Solid` takes them.

    Parameters
    ----------
    mesh : object
    vertices, faces
        Its arrays, as `interop.arrays_from` found them.
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
        _take_visual(getattr(mesh, "visual", None), len(faces), found)
        if isinstance(mesh, Mesh):
            found["materials"].update(mesh.materials)
    return _fitting(found, len(vertices), faces)


#: The places of arrays with names in objects: trimesh and `Mesh`, then pyvista and meshio.
_DICTIONARIES = {
    "vertex": ("vertex_attributes", "point_data"),
    "corner": ("corner_attributes",),
    "face": ("face_attributes", "cell_data"),
}


def _arrays_in(held: Any) -> dict[str, Any]:
    if not isinstance(held, Mapping) and not hasattr(held, "items"):
        return {}
    pairs: Iterable[tuple[Any, Any]] = held.items()
    return {name: _one_array(values) for name, values in pairs if isinstance(name, str)}


def _one_array(values: Any) -> Any:
    """Return an array of values, of which meshio has one for each block of cells."""
    is_list = isinstance(values, list) and values
    if is_list and all(isinstance(block, np.ndarray) for block in values):
        return np.concatenate(values)
    return np.asarray(values)


def _fitting(
    found: dict[str, dict[str, Any]], vertex_count: int, faces: Any
) -> dict[str, dict[str, Any]]:
    """Return the arrays that have a row for each vertex or triangle, each name once."""
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
    """Take what manifold3d interpolates beside coordinates; seams have vertices of their own."""
    properties = np.asarray(mesh.vert_properties)[:, 3:]
    if properties.shape[1] == 0:
        return
    if len(mesh.merge_from_vert):
        found["corner"]["properties"] = properties[np.asarray(mesh.tri_verts, dtype=np.int64)]
    else:
        found["vertex"]["properties"] = properties


def _take_visual(visual: Any, count: int, found: dict[str, dict[str, Any]]) -> None:
    kind = getattr(visual, "kind", None)
    if kind == "vertex":
        found["vertex"]["color"] = np.asarray(visual.vertex_colors)
    elif kind == "face":
        found["face"]["color"] = np.asarray(visual.face_colors)
    elif kind == "texture" and getattr(visual, "uv", None) is not None:
        found["vertex"]["uv"] = np.asarray(visual.uv)
        _take_material(visual.material, count, found)


def _take_material(material: Any, count: int, found: dict[str, dict[str, Any]]) -> None:
    """Take the only material of a trimesh, which all faces have."""
    image = getattr(material, "baseColorTexture", None) or getattr(material, "image", None)
    name = getattr(material, "name", None) or "material"
    color = np.asarray(getattr(material, "main_color", (255, 255, 255, 255)))[:4] / 255
    texture = None if image is None else _as_png(image)
    found["materials"][str(name)] = Material(tuple(color.tolist()), texture)
    found["face"]["material"] = np.full(count, str(name))


def _as_png(image: Any) -> bytes:
    stream = io.BytesIO()
    image.save(stream, format="PNG")
    return stream.getvalue()
