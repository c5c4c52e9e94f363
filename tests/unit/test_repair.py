"""Repairs: holes, orientation, duplicates, and failures of pymeshlab."""

import sys
from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from bspcsg.errors import BspcsgError, InvalidMeshError, MissingPartError
from bspcsg.io import RawMesh
from bspcsg.mesh.weld import welded
from bspcsg.repair import repair as repairing
from bspcsg.repair.diagnosis import diagnose
from bspcsg.repair.pymeshlab_child import stray_faces
from bspcsg.repair.repair import repair
from support.shapes import Arrays, cube, cuboid, flipped, icosphere, joined, moved


def volume_after(mesh: Arrays) -> float:
    made = repair(RawMesh(*mesh))
    found = diagnose(made.mesh)
    assert found.is_solid, found.findings
    assert found.volume is not None
    return found.volume


def test_holes_are_filled() -> None:
    vertices, faces = icosphere(2)
    full = b.Solid(vertices, faces).volume
    low = vertices[faces].mean(axis=1)[:, 2] < 0.9
    assert 2 < low.sum() < len(faces) - 5
    assert volume_after((vertices, faces[low])) == pytest.approx(full, rel=0.03)
    assert volume_after((vertices, faces[1:])) == pytest.approx(full, rel=1e-9)


def test_triangles_are_turned() -> None:
    vertices, faces = cube(2)
    faces[4] = faces[4, ::-1]
    assert volume_after((vertices, faces)) == 8
    assert volume_after(flipped(cube(2))) == 8


def test_one_part_inside_out() -> None:
    assert volume_after(joined(cube(2), flipped(cuboid((5, 0, 0), (6, 1, 1))))) == 9


def test_cavities_stay_cavities() -> None:
    hollow = joined(cube(3), flipped(cuboid((1, 1, 1), (2, 2, 2))))
    assert volume_after(hollow) == 26
    assert volume_after(flipped(hollow)) == 26


def test_duplicates_and_flat_triangles_go() -> None:
    vertices, faces = cube(2)
    made = repair(RawMesh(vertices, np.concatenate([faces, faces[:3], [[0, 1, 1]]])))
    assert len(made.mesh.faces) == 12 and diagnose(made.mesh).is_solid


@pytest.mark.parametrize("draw", range(3))
def test_a_sphere_with_31_faces_missing_becomes_a_solid(draw: int) -> None:
    vertices, faces = (np.array(part) for part in b.sphere(r=10, segments=32).to_mesh())
    nearest = np.argsort(-vertices[faces].mean(axis=1)[:, 0])[:40]
    missing = np.random.default_rng(draw).choice(nearest, 31, replace=False)
    made = repair(RawMesh(vertices, np.delete(faces, missing, axis=0)))
    found = diagnose(made.mesh)
    # What stays of the forty in the hole are loose triangles and pairs of them.
    assert found.is_solid and 0 < made.dropped < 10
    assert found.volume == pytest.approx(b.sphere(r=10, segments=32).volume, rel=0.02)


def strays(*meshes: Arrays) -> list[int]:
    """Return the faces of stray fragments, after joining equal vertices of the meshes."""
    vertices, faces = joined(*meshes)
    _, same = welded(vertices)
    return np.flatnonzero(stray_faces(same[faces])).tolist()


LOOSE = (np.array([[9.0, 9, 9], [9, 9, 8], [9, 8, 9], [8, 8, 8]]), np.array([[0, 1, 2]]))


def test_fragments_bound_nothing() -> None:
    pair = (LOOSE[0], np.array([[0, 1, 2], [2, 1, 3]]))
    assert strays(cube(), LOOSE, moved(pair, (5, 0, 0))) == [12, 13, 14]
    # A fin: one edge is the cube's, which then has three triangles.
    vertices, faces = cube()
    fin = (np.vstack([vertices[faces[0][:2]], [[7.0, 7, 7]]]), np.array([[0, 1, 2]]))
    assert strays(cube(), fin) == [12]


def test_what_may_bound_something_is_no_fragment() -> None:
    vertices, faces = cuboid((5, 0, 0), (6, 1, 1))
    heights = vertices[faces][:, :, 2]
    tube = vertices, faces[heights.min(axis=1) != heights.max(axis=1)]
    tent = LOOSE[0], np.array([[0, 1, 3], [1, 2, 3], [2, 0, 3]])
    assert len(tube[1]) == 8 and strays(cube(), tube, tent) == []
    # Walls that many cells share have no open edge.
    assert strays(cube(), moved(cube(), (1, 1, 0)), moved(cube(), (1, 0, 1))) == []
    # Where all is fragments, none is beside something.
    assert strays(LOOSE) == strays(LOOSE, moved(LOOSE, (3, 0, 0))) == []


# Found: `repair` of files without triangles, and of holes of 2^31 edges and more, ended in a
# message of pymeshlab's binding.
def test_nothing_cannot_be_repaired() -> None:
    with pytest.raises(InvalidMeshError, match=r"scan: the mesh has no triangles") as caught:
        repair(RawMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64), "scan"))
    assert caught.value.code == "empty_mesh"


def test_holes_may_be_of_any_size() -> None:
    vertices, faces = cube(2)
    assert diagnose(repair(RawMesh(vertices, faces[1:]), max_hole=2**40).mesh).is_solid


def test_sound_meshes_stay_as_they_are() -> None:
    made = repair(RawMesh(*icosphere(2)))
    assert (len(made.mesh.faces), made.failed, made.turned) == (320, {}, 0)
    assert b.Solid(made.mesh.vertices, made.mesh.faces).equals(b.Solid(*icosphere(2)))


def test_coordinates_keep_their_doubles() -> None:
    vertices, faces = cube(1 / 3)
    made = repair(RawMesh(vertices, faces[1:]))
    assert set(made.mesh.vertices.ravel().tolist()) == {0.0, 1 / 3}


def test_near_vertices_are_joined_only_on_request() -> None:
    vertices, faces = cube(1)
    corners = vertices[faces].reshape(-1, 3)
    corners[0] += 1e-7
    soup = RawMesh(corners, np.arange(36).reshape(-1, 3))
    assert diagnose(repair(soup, weld=1e-5).mesh).triangles == 12
    assert diagnose(repair(soup, ["weld", "dedup"]).mesh).verdict == "not closed"


def test_unknown_steps() -> None:
    with pytest.raises(InvalidMeshError, match="polish"):
        repair(RawMesh(*cube()), ["polish"])


def test_a_time_limit() -> None:
    with pytest.raises(BspcsgError) as caught:
        repair(RawMesh(*cube()), timeout=0.001)
    assert caught.value.code == "timed_out"


FAILURES = {
    "raise ImportError('libGL.so.1: cannot open shared object file')": "libgl1 libopengl0",
    "raise ImportError(\"No module named 'pymeshlab'\")": "bspcsg[repair]",
    "plugin_number = lambda: 49": "libgl1 libopengl0",
}


@pytest.mark.parametrize("text", FAILURES)
def test_what_is_missing_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str
) -> None:
    (tmp_path / "pymeshlab.py").write_text(text)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    with pytest.raises(MissingPartError) as caught:
        repair(RawMesh(*cube()))
    assert FAILURES[text] in caught.value.message and "pymeshlab" in caught.value.message


@pytest.mark.skipif(sys.platform == "win32", reason="signals as POSIX has them")
def test_a_crash_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    child = tmp_path / "child.py"
    child.write_text("import os\nos.abort()\n")
    monkeypatch.setattr(repairing, "_CHILD", child)
    with pytest.raises(BspcsgError) as caught:
        repair(RawMesh(*cube()))
    assert caught.value.code == "repair_failed" and "exit code -6" in caught.value.message
