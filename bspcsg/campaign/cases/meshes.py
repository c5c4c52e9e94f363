"""The meshes of one case in one `.npz` file, for pictures and later inspection."""

import io
import os
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...mesh.mesh import Mesh


@dataclass(frozen=True, eq=False)
class CaseMeshes:
    """The meshes of one case, as read from its file.

    Parameters
    ----------
    operands : dict of str to Mesh
        The operands by letter.
    result, difference : Mesh
        Our result, and the boundary of the symmetric difference with manifold3d's result, without
        faces if the sets are equal or were not compared.
    """

    operands: dict[str, Mesh]
    result: Mesh
    difference: Mesh


def packed(operands: Sequence[Mesh], result: Mesh, difference: Mesh | None) -> bytes:
    """Return meshes as the bytes of a `.npz` file with arrays ``a_vertices``, ``a_faces``, …."""
    named = {chr(ord("a") + number): mesh for number, mesh in enumerate(operands)}
    named["result"], named["difference"] = result, difference or _empty()
    arrays: dict[str, np.ndarray] = {}
    for name, mesh in named.items():
        arrays[f"{name}_vertices"] = mesh.vertices
        arrays[f"{name}_faces"] = mesh.faces.astype(np.int32)
    buffer = io.BytesIO()
    # numpy's type stubs mistake the arrays' names for the option `allow_pickle`.
    np.savez_compressed(buffer, **arrays)  # type: ignore[arg-type]
    return buffer.getvalue()


def unpacked(path: str | os.PathLike[str]) -> CaseMeshes:
    """Return the meshes from a file with the bytes that `packed` returned."""
    with np.load(path, allow_pickle=False) as arrays:
        names = [name.removesuffix("_faces") for name in arrays.files if name.endswith("_faces")]
        meshes = {
            name: _mesh(arrays[f"{name}_vertices"], arrays[f"{name}_faces"]) for name in names
        }
    return CaseMeshes(meshes, meshes.pop("result"), meshes.pop("difference"))


def _mesh(vertices: np.ndarray, faces: np.ndarray) -> Mesh:
    corners = faces.astype(np.int64)
    return Mesh(vertices, corners, np.zeros((len(corners), 2), dtype=np.int64))


def _empty() -> Mesh:
    return _mesh(np.zeros((0, 3)), np.zeros((0, 3)))
