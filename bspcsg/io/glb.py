"""GLB, the binary form of glTF 2.0: metres, y upwards, single precision.

trimesh decodes and encodes; what a file may claim is checked first (see `glb_container`). The
model's millimetres with z upwards become metres by the matrix of a node, so that no coordinate is
multiplied: numbers that single precision can hold read back as they were.
"""

import io
from collections.abc import Iterator
from typing import Any

import numpy as np

from .._types import FloatArray
from ..errors import Finding, words_of
from ..mesh import Mesh
from . import single
from .glb_container import check_container
from .raw import RawMesh, joined, parts_of
from .source import Source

#: Millimetres with z upwards to metres with y upwards, for column vectors, and back.
_TO_METRES = np.array(
    [[0.001, 0, 0, 0], [0, 0, 0.001, 0], [0, -0.001, 0, 0], [0, 0, 0, 1]], dtype=np.float64
)
_TO_MILLIMETRES = np.array(
    [[1000, 0, 0, 0], [0, 0, -1000, 0], [0, 1000, 0, 0], [0, 0, 0, 1]], dtype=np.float64
)

#: Objects must have names for trimesh; those that have none get this one and a number.
_UNNAMED = "unnamed"


def read(source: Source) -> RawMesh:
    """Read the triangles of every node as one mesh, in millimetres with z upwards.

    Raises
    ------
    FormatError
        If the file is cut off, is no GLB of version 2, or holds what cannot be read.
    """
    findings, dropped = check_container(source)
    try:
        scene = _decoded(source.data)
        parts = [_placed(scene, node) for node in _nodes(scene)]
    except Exception as error:  # what trimesh raises on damaged files is of any kind
        reason = f"{type(error).__name__}: {words_of(error)}"
        raise source.error(f"this GLB cannot be decoded: {reason}.") from error
    mesh = joined([part for part in parts if part is not None])
    if not np.isfinite(mesh.vertices).all():
        raise source.error("a coordinate is not a finite number.", "non_finite")
    if len(mesh.faces) and not 0 <= mesh.faces.min() <= mesh.faces.max() < len(mesh.vertices):
        raise source.error("a triangle names a vertex that does not exist.", "index_out_of_range")
    findings = (*findings, _unit())
    return RawMesh(mesh.vertices, mesh.faces, "", findings, mesh.objects, "mm", dropped)


def _decoded(data: bytes) -> Any:
    import trimesh

    if data == EMPTY:
        return trimesh.Scene()
    return trimesh.load_scene(
        io.BytesIO(data), file_type="glb", process=False, skip_materials=True, validate=False
    )


def _nodes(scene: Any) -> list[str]:
    """Return the nodes with a mesh, in the order of the meshes in the file."""
    order = {name: number for number, name in enumerate(scene.geometry)}
    return sorted(scene.graph.nodes_geometry, key=lambda node: order[scene.graph[node][1]])


def _placed(scene: Any, node: str) -> RawMesh | None:
    """Return the mesh of a node in millimetres; a mirrored one is turned right side out."""
    matrix, name = scene.graph[node]
    geometry = scene.geometry[name]
    faces = getattr(geometry, "faces", None)
    if faces is None or len(faces) == 0:
        return None
    placing = _TO_MILLIMETRES @ matrix
    vertices = _moved(np.asarray(geometry.vertices, dtype=np.float64), placing)
    turned = np.asarray(faces, dtype=np.int64)
    if np.linalg.det(placing[:3, :3]) < 0:
        turned = turned[:, ::-1]
    title = "" if str(name).startswith(_UNNAMED) else str(name)
    return RawMesh(vertices, turned, title)


def _moved(vertices: FloatArray, matrix: FloatArray) -> FloatArray:
    x, y, z = vertices.T
    # Not a matrix product: where a row has one entry, its result must be exact.
    with np.errstate(invalid="ignore"):  # what is infinite is refused later
        rows = [row[0] * x + row[1] * y + row[2] * z + row[3] for row in matrix[:3]]
    return np.stack(rows, axis=1)


def _unit() -> Finding:
    message = "GLB is in metres with y upwards; it was read in millimetres with z upwards."
    return Finding("unit", "note", message, (), 1)


def _container(description: bytes) -> bytes:
    """Return the file of a description without data."""
    text = description + b" " * (-len(description) % 4)
    sizes = (2, 20 + len(text), len(text))
    version, total, length = (size.to_bytes(4, "little") for size in sizes)
    return b"glTF" + version + total + length + b"JSON" + text


#: A file of nothing, which trimesh neither writes nor reads.
EMPTY = _container(b'{"asset":{"version":"2.0"},"scene":0,"scenes":[{}]}')


def binary(mesh: Mesh | RawMesh) -> Iterator[bytes]:
    """Yield the file; coordinates are rounded to single precision."""
    import trimesh

    if len(mesh.faces) == 0:
        yield EMPTY
        return
    scene: Any = trimesh.Scene()
    for number, (name, faces) in enumerate(parts_of(mesh), 1):
        if len(faces) == 0:
            continue
        used, corners = np.unique(faces, return_inverse=True)
        part = trimesh.Trimesh(mesh.vertices[used], corners.reshape(-1, 3), process=False)
        title = name or f"{_UNNAMED} {number}"
        scene.add_geometry(part, geom_name=title, node_name=title, transform=_TO_METRES)
    yield scene.export(file_type="glb", include_normals=False)


def losses(mesh: Mesh | RawMesh) -> tuple[Finding, ...]:
    """Return what single precision would change, and that the unit changes.

    Raises
    ------
    OverflowError
        If a coordinate is beyond single precision.
    """
    message = "GLB is in metres with y upwards; the model was taken as millimetres with z upwards."
    return Finding("unit", "note", message, (), 1), *single.losses(mesh, "GLB")
