"""Meshes and assertions for tests of readers and writers."""

from pathlib import Path

import numpy as np
import pytest

from bspcsg.errors import FormatError
from bspcsg.io import RawMesh, read

from .shapes import cube


def cube_mesh(side: float = 1.0) -> RawMesh:
    """Return a cube with its vertices numbered in the order of first use by faces."""
    vertices, faces = cube(side)
    _, first = np.unique(faces, return_index=True)
    order = np.argsort(first)
    return RawMesh(vertices[order], np.argsort(order)[faces], "cube")


def same_mesh(found: RawMesh, expected: RawMesh) -> None:
    """Assert that two meshes have the same vertices and faces, bit by bit."""
    assert found.vertices.dtype == np.float64 and found.faces.dtype == np.int64
    assert found.vertices.tobytes() == expected.vertices.tobytes()
    assert found.faces.tolist() == expected.faces.tolist()


def read_text(path: Path, text: str | bytes) -> RawMesh:
    """Write data to a file, and return the mesh read from it."""
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read(path)


def refusal(path: Path, data: str | bytes, code: str) -> str:
    """Assert that reading data fails with this code and the file's name; return the message."""
    with pytest.raises(FormatError) as caught:
        read_text(path, data)
    assert caught.value.code == code, caught.value.message
    assert caught.value.message.startswith(str(path))
    return caught.value.message


def signed_area(mesh: RawMesh) -> float:
    """Return the area of a mesh in the plane z = 0; clockwise triangles count negatively."""
    a, b, c = (mesh.vertices[mesh.faces[:, corner], :2] for corner in range(3))
    (x, y), (u, v) = (b - a).T, (c - a).T
    return float((x * v - y * u).sum() / 2)


def area(mesh: RawMesh) -> float:
    """Return the area of a mesh in the plane z = 0; all triangles count positively."""
    a, b, c = (mesh.vertices[mesh.faces[:, corner], :2] for corner in range(3))
    (x, y), (u, v) = (b - a).T, (c - a).T
    return float(np.abs(x * v - y * u).sum() / 2)
