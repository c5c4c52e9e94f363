"""GLB, the binary form of glTF 2.0: metres, y upwards, single precision.

The model's millimetres with z upwards become metres by the matrix of a node, so that no coordinate
is multiplied: numbers that single precision can hold read back as they were. Names need not
differ, so every object is a node and a mesh of its own.
"""

import json
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..._types import FloatArray
from ...errors import Finding
from ...mesh.mesh import Mesh
from .. import single
from ..raw import RawMesh, compacted, joined, parts_of, says_empty_set
from ..source import Source
from .container import container_of
from .nodes import Shown, shown

#: Millimetres with z upwards to metres with y upwards, for column vectors, and back.
TO_METRES = np.array(
    [[0.001, 0, 0, 0], [0, 0, 0.001, 0], [0, -0.001, 0, 0], [0, 0, 0, 1]], dtype=np.float64
)
_TO_MILLIMETRES = np.array(
    [[1000, 0, 0, 0], [0, 0, -1000, 0], [0, 1000, 0, 0], [0, 0, 0, 1]], dtype=np.float64
)

#: Numbers of glTF: types of components, and what a view of the data is for.
_FLOAT, _UNSIGNED, _VERTICES, _INDICES = 5126, 5125, 34962, 34963


def read(source: Source) -> RawMesh:
    """Read the triangles of every node as one mesh, in millimetres with z upwards.

    Raises
    ------
    FormatError
        If the file is cut off, is no GLB of version 2, or holds what cannot be read.
    """
    container = container_of(source)
    try:
        objects, hidden = shown(container)
    except IndexError as error:
        raise source.error(f"{error}.", "index_out_of_range") from error
    except (ValueError, LookupError, TypeError, AttributeError) as error:
        raise source.error(f"this GLB cannot be decoded: {error}.") from error
    mesh = joined([_placed(one) for one in objects if len(one.faces)])
    if not np.isfinite(mesh.vertices).all():
        raise source.error("a coordinate is not a finite number.", "non_finite")
    findings = (*container.findings, *_hidden(hidden), _unit())
    return RawMesh(mesh.vertices, mesh.faces, "", findings, mesh.objects, "mm", container.dropped)


def _placed(one: Shown) -> RawMesh:
    """Return the mesh of a node in millimetres; a mirrored one is turned right side out."""
    placing = _TO_MILLIMETRES @ one.matrix
    with np.errstate(invalid="ignore", over="ignore"):  # what is not finite is refused later
        vertices = _moved(one.vertices.astype(np.float64), placing)
        is_mirrored = np.linalg.det(placing[:3, :3]) < 0
    return RawMesh(vertices, one.faces[:, ::-1] if is_mirrored else one.faces, one.name)


def _moved(vertices: FloatArray, matrix: FloatArray) -> FloatArray:
    x, y, z = vertices.T
    # Not a matrix product: where a row has one entry, its result must be exact.
    rows = [row[0] * x + row[1] * y + row[2] * z + row[3] for row in matrix[:3]]
    return np.stack(rows, axis=1)


def _hidden(count: int) -> tuple[Finding, ...]:
    if not count:
        return ()
    message = f"{count} meshes outside the scene were ignored."
    return (Finding("ignored", "warning", message, (), count),)


def _unit() -> Finding:
    message = "GLB is in metres with y upwards; it was read in millimetres with z upwards."
    return Finding("unit", "note", message, (), 1)


def called(name: str) -> str:
    """Return a name without lone surrogates, which are no text."""
    return name.encode("utf-8", "replace").decode("utf-8")


def most_bytes(mesh: Mesh | RawMesh) -> int:
    """Return how many bytes of data the file has at most: each object has vertices of its own."""
    vertices = min(3 * len(mesh.faces), len(mesh.vertices) * len(parts_of(mesh)))
    return 12 * (len(mesh.faces) + vertices)


def binary(mesh: Mesh | RawMesh) -> Iterator[bytes]:
    """Yield the file; coordinates are rounded to single precision."""
    described = _Description(says_empty_set(mesh))
    blocks = []
    for name, faces in parts_of(mesh):
        if len(faces) == 0:
            continue
        used, corners = compacted(faces)
        vertices = mesh.vertices[used].astype("<f4")
        described.add(name, vertices, len(faces))
        blocks += [vertices.tobytes(), corners.astype("<u4").tobytes()]
    yield from _container(described.text(), blocks)


class _Description:
    """The JSON of a file, object by object."""

    def __init__(self, is_empty_set: bool) -> None:
        self._extras = {"extras": {"bspcsg": "the empty set"}} if is_empty_set else {}
        self._size = 0
        self._views: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []
        self._names: list[dict[str, str]] = []

    def add(self, name: str, vertices: "np.ndarray[Any, Any]", triangles: int) -> None:
        """Add an object whose vertices and indices follow in the data."""
        self._names.append({"name": called(name)} if name else {})
        low, high = vertices.min(axis=0).tolist(), vertices.max(axis=0).tolist()
        self._append(12 * len(vertices), _VERTICES, len(vertices), _FLOAT, "VEC3")
        self._accessors[-1] |= {"min": low, "max": high}
        self._append(12 * triangles, _INDICES, 3 * triangles, _UNSIGNED, "SCALAR")

    def _append(self, size: int, target: int, count: int, component: int, kind: str) -> None:
        view = {"buffer": 0, "byteOffset": self._size, "byteLength": size, "target": target}
        self._views.append(view)
        self._size += size
        accessor = {"bufferView": len(self._views) - 1, "componentType": component}
        self._accessors.append({**accessor, "count": count, "type": kind})

    def text(self) -> bytes:
        """Return the JSON."""
        asset = {"version": "2.0", "generator": "bspcsg", **self._extras}
        tree: dict[str, Any] = {"asset": asset, "scene": 0}
        tree["scenes"] = [{"nodes": list(range(len(self._names)))} if self._names else {}]
        if self._names:
            matrix = TO_METRES.T.ravel().tolist()
            tree["nodes"] = [
                {**named, "mesh": number, "matrix": matrix}
                for number, named in enumerate(self._names)
            ]
            tree["meshes"] = [
                {**named, "primitives": [_primitive(number)]}
                for number, named in enumerate(self._names)
            ]
            tree["accessors"] = self._accessors
            tree["bufferViews"] = self._views
            tree["buffers"] = [{"byteLength": self._size}]
        return json.dumps(tree, separators=(",", ":"), ensure_ascii=False).encode()


def _primitive(number: int) -> dict[str, Any]:
    return {"attributes": {"POSITION": 2 * number}, "indices": 2 * number + 1, "mode": 4}


def _container(description: bytes, blocks: list[bytes]) -> Iterator[bytes]:
    """Yield a file; the sizes of all blocks are multiples of four already."""
    text = description + b" " * (-len(description) % 4)
    held = sum(map(len, blocks))
    total = 20 + len(text) + (8 + held if blocks else 0)
    yield b"glTF" + _word(2) + _word(total) + _word(len(text)) + b"JSON" + text
    if blocks:
        yield _word(held) + b"BIN\0"
        yield from blocks


def _word(number: int) -> bytes:
    return number.to_bytes(4, "little")


def losses(mesh: Mesh | RawMesh) -> tuple[Finding, ...]:
    """Return what single precision would change, and that the unit changes.

    Raises
    ------
    OverflowError
        If a coordinate is beyond single precision.
    """
    message = "GLB is in metres with y upwards; the model was taken as millimetres with z upwards."
    return Finding("unit", "note", message, (), 1), *single.losses(mesh, "GLB")
