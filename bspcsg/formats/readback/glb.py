"""A reader of GLB files that this package has just written, to check their content."""

from typing import BinaryIO

from ..glb.container import container_of
from ..glb.file import TO_METRES
from ..glb.nodes import visible_meshes
from ..source import Source
from .stored_mesh import StoredMesh


def objects(file: BinaryIO) -> list[StoredMesh]:
    """Return the meshes of the nodes as stored; raise an error if a matrix is not `TO_METRES`."""
    found, hidden = visible_meshes(container_of(Source("file", file.read())))
    if hidden or any((one.matrix != TO_METRES).any() for one in found):
        raise ValueError("a node has another transform than the one written")
    return [StoredMesh(one.vertices, one.faces, one.name) for one in found]
