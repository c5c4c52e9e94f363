"""The checks that every result must pass."""

import manifold3d
import numpy as np
import trimesh

import bspcsg as b

from .shapes import Faces, Vertices

#: The codes of findings about a mesh that is not quite the boundary of its solid.
FAULTS = {"crossing", "turned", "mended", "collapsed", "flat", "self_overlap"}


def open_edges(faces: Faces) -> list[tuple[int, int]]:
    """Return the directed edges, by vertex indices, that do not have exactly one opposite edge."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    forth, count = np.unique(np.stack([start, end], axis=1), axis=0, return_counts=True)
    back = {(int(v), int(u)) for u, v in forth}
    return [
        (int(u), int(v))
        for (u, v), n in zip(forth, count, strict=True)
        if n != 1 or (int(u), int(v)) not in back
    ]


def assert_closed(faces: Faces) -> None:
    """Assert that each directed edge has exactly one opposite edge."""
    assert (faces[:, 0] != faces[:, 1]).all()
    assert (faces[:, 1] != faces[:, 2]).all()
    assert (faces[:, 2] != faces[:, 0]).all()
    loose = open_edges(faces)
    assert not loose, f"{len(loose)} directed edges without exactly one opposite, first {loose[:3]}"


def manifold_status(vertices: Vertices, faces: Faces) -> str:
    """Return manifold3d's status of a mesh in double precision."""
    mesh = manifold3d.Mesh64(np.array(vertices, order="C"), np.array(faces, np.uint64, order="C"))
    return str(manifold3d.Manifold(mesh).status().name)


def assert_accepted(vertices: Vertices, faces: Faces) -> None:
    """Assert that manifold3d and trimesh both accept a mesh as a solid."""
    assert manifold_status(vertices, faces) == "NoError"
    assert trimesh.Trimesh(vertices, faces, process=False).is_volume


def assert_sound(solid: "b.Solid") -> "b.Mesh":
    """Assert that the reduced mesh is closed, accepted and has the solid's volume; return it."""
    assert_closed(solid.to_mesh().faces)
    mesh = solid.normalized().to_mesh()
    assert mesh.vertices.dtype == np.float64 and mesh.vertices.shape[1:] == (3,)
    assert mesh.faces.dtype == np.int64 and mesh.faces.shape[1:] == (3,)
    assert mesh.source.dtype == np.int64 and mesh.source.shape == (len(mesh.faces), 2)
    if solid.is_empty:
        assert len(mesh.faces) == 0 and len(mesh.vertices) == 0
        assert solid.volume_exact == 0
        return mesh
    assert np.isfinite(mesh.vertices).all()
    assert len(np.unique(mesh.faces)) == len(mesh.vertices) == mesh.faces.max() + 1
    assert_closed(mesh.faces)
    assert_accepted(mesh.vertices, mesh.faces)
    # Rounding moves each vertex by less than a step, so the volume by less than area times that.
    assert abs(mesh.volume - float(solid.volume_exact)) <= mesh.area * 10.0**solid.pitch
    return mesh


def assert_counts(solid: "b.Solid", counts: tuple[int, int, int]) -> None:
    """Assert the numbers of parts, of surfaces and of Euler, and that the mesh has no faults."""
    assert (len(solid.components), solid.surface_count, solid.euler_number) == counts
    reduced = solid.normalized()
    certificate = reduced.to_mesh().certificate
    assert len(certificate.crossings) == len(certificate.flat) == 0
    assert not FAULTS & {finding.code for finding in reduced.findings}


def facts(mesh: "b.Mesh") -> tuple[int, int, int]:
    """Return the numbers of vertices, faces and connected surfaces of a mesh."""
    return len(mesh.vertices), len(mesh.faces), mesh.surface_count
