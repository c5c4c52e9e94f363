"""The diagnosis names, counts and locates every flaw of a mesh."""

import json
from collections.abc import Callable

import numpy as np
import pytest

from bspcsg.assembly.object_diagnosis import examine
from bspcsg.io import RawMesh
from bspcsg.repair.diagnosis import diagnose
from support.shapes import Arrays, cube, cuboid, flipped, joined, moved


def without(*faces: int) -> Arrays:
    vertices, triangles = cube()
    return vertices, np.delete(triangles, faces, axis=0)


def with_turned_face() -> Arrays:
    vertices, faces = cube()
    faces[4] = faces[4, ::-1]
    return vertices, faces


def with_repeated_face() -> Arrays:
    vertices, faces = cube()
    return vertices, np.concatenate([faces, faces[2:3], faces[2:3, ::-1]])


def with_flat_face() -> Arrays:
    # A corner on the middle of an edge, and a triangle that fills the gap of no width.
    vertices, faces = cube()
    a, c, d = faces[0]
    middle = (vertices[a] + vertices[c]) / 2
    vertices = np.concatenate([vertices, middle[None]])
    more = np.array([(a, 8, d), (8, c, d), (a, c, 8)])
    return vertices, np.concatenate([more, faces[1:]])


def cubes_at_an_edge() -> Arrays:
    return joined(cube(), moved(cube(), (1, 1, 0)))


SOLIDS: dict[str, tuple[Callable[[], Arrays], set[str]]] = {
    "cube": (cube, set()),
    "two cubes apart": (lambda: joined(cube(), moved(cube(), (5, 0, 0))), set()),
    "cubes at an edge": (cubes_at_an_edge, {"non_manifold"}),
    "overlapping cubes": (
        lambda: joined(cube(), moved(cube(), (0.5, 0.5, 0.5))),
        {"self_overlap"},
    ),
    "cavity": (lambda: joined(cuboid((-1, -1, -1), (2, 2, 2)), flipped(cube())), set()),
    "flat face": (with_flat_face, {"degenerate"}),
    "repeated face": (with_repeated_face, {"duplicate", "non_manifold", "self_overlap"}),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_solids(name: str) -> None:
    make, expected = SOLIDS[name]
    found = diagnose(RawMesh(*make()))
    assert found.verdict == "solid" and found.closed
    assert expected <= {finding.code for finding in found.findings}
    serious = {finding.code for finding in found.findings if finding.severity != "note"}
    assert serious <= expected | {"self_overlap"}


REFUSED: dict[str, tuple[Callable[[], Arrays], str, str, int]] = {
    "one face missing": (lambda: without(3), "not closed", "open_edges", 3),
    "side missing": (lambda: without(0, 1), "not closed", "open_edges", 4),
    "face turned": (with_turned_face, "not closed", "orientation", 3),
    "no faces": (lambda: (cube()[0], np.zeros((0, 3), np.int64)), "empty", "empty_mesh", 0),
    "huge": (lambda: moved(cube(), (1e308, 0, 0)), "refused", "too_large", 0),
}


@pytest.mark.parametrize("name", REFUSED)
def test_no_solids(name: str) -> None:
    make, verdict, code, count = REFUSED[name]
    found = diagnose(RawMesh(*make()))
    assert found.verdict == verdict and not found.is_solid and found.volume is None
    assert found.findings[0].severity == "error"
    finding = next(finding for finding in found.findings if finding.code == code)
    assert not count or finding.count == count


def test_places_are_named() -> None:
    found = diagnose(RawMesh(*moved(without(3), (7, 0, 0))))
    (finding,) = (finding for finding in found.findings if finding.code == "open_edges")
    assert "around 1 hole" in finding.message and "(8, 0, 0)" in finding.message
    assert len(finding.where) == 3


def test_inside_out() -> None:
    found = diagnose(RawMesh(*flipped(cube())))
    assert found.verdict == "inside out" and not found.is_solid
    assert (found.signed_volume, found.volume) == (-1.0, 0.0)


# Found: `check` called a file a solid where one body of several was inside out and left out, and
# told of overlaps that were none.
def test_one_body_inside_out() -> None:
    sound = cuboid((-1, -1, -1), (2, 2, 2))
    found = diagnose(RawMesh(*joined(sound, moved(flipped(cube()), (5, 0, 0)))))
    assert found.verdict == "inside out" and not found.is_solid
    assert (found.volume, found.self_overlapping) == (27.0, False)
    (finding,) = found.findings
    assert (finding.code, finding.where, finding.count) == ("inside_out", (12,), 1)
    assert "1 body is inside out" in finding.message


def test_bodies_inside_out_that_overlap_others() -> None:
    sound = cuboid((-1, -1, -1), (2, 2, 2))
    parts = (sound, moved(cube(), (1.5, 0, 0)), moved(flipped(cube()), (5, 0, 0)))
    found = diagnose(RawMesh(*joined(*parts)))
    assert {finding.code for finding in found.findings} == {"inside_out", "self_overlap"}
    assert found.verdict == "inside out" and found.self_overlapping is True


def test_cavities_of_bodies_that_overlap_are_not_inside_out() -> None:
    hollow = joined(cuboid((-1, -1, -1), (2, 2, 2)), flipped(cube()))
    found = diagnose(RawMesh(*joined(hollow, moved(hollow, (2, 0, 0)))))
    assert found.verdict == "solid" and found.self_overlapping is True


def test_measures() -> None:
    found = diagnose(RawMesh(*joined(cube(), moved(cube(), (0.5, 0.5, 0.5)))))
    assert (found.signed_volume, found.volume, found.surfaces) == (2.0, 1.875, 2)
    assert found.self_overlapping is True
    assert diagnose(RawMesh(*cube())).self_overlapping is False
    assert diagnose(RawMesh(*without(3))).self_overlapping is None


def test_loose_corners_are_joined_first() -> None:
    vertices, faces = cube()
    soup = RawMesh(vertices[faces].reshape(-1, 3), np.arange(36).reshape(-1, 3))
    found = diagnose(soup)
    assert found.verdict == "solid" and found.genus == 0 and found.surfaces == 1


def test_unused_vertices_are_a_note() -> None:
    vertices, faces = cube()
    found = diagnose(RawMesh(np.concatenate([vertices, [[9.0, 9, 9]]]), faces))
    assert [(finding.code, finding.severity) for finding in found.findings] == [
        ("unused_vertices", "note")
    ]


@pytest.mark.parametrize("make", [cube, lambda: moved(cube(), (1e308, 0, 0)), lambda: without(1)])
def test_as_json(make: Callable[[], Arrays]) -> None:
    json.dumps(diagnose(RawMesh(*make())).to_dict(), allow_nan=False)


# Objects


def with_objects(*meshes: Arrays) -> RawMesh:
    names = [chr(ord("a") + number) for number in range(len(meshes))]
    counts = [len(faces) for _, faces in meshes]
    return RawMesh(*joined(*meshes), objects=tuple(zip(names, counts, strict=True)))


# Found: a lid that rests on a body in the same file was reported as overlapping it and as
# non-manifold.
def test_objects_that_touch_are_solids_that_touch() -> None:
    for other in (moved(cube(), (0, 0, 1)), cuboid((0.25, 0.25, 1), (2, 0.75, 2)), cube()[:2]):
        raw = with_objects(cube(), other)
        found = examine(raw)
        clashes = [one for one in found.diagnosis.findings if one.code == "clash"]
        assert [one.diagnosis.verdict for one in found.objects] == ["solid", "solid"]
        assert found.diagnosis.manifold and found.diagnosis.verdict == "solid"
        # What is in the other's place clashes, as `clash` says, too.
        assert bool(clashes) == bool(found.clashes) == bool(found.diagnosis.self_overlapping)
        assert bool(clashes) == np.array_equal(other[0], cube()[0])


def test_objects_that_clash_are_told_with_place_and_measured_once() -> None:
    found = examine(with_objects(cube(2), moved(cube(), (5, 0, 0)), moved(cube(), (1.5, 0, 0))))
    (finding,) = found.diagnosis.findings
    assert (finding.code, finding.severity, finding.count) == ("clash", "warning", 1)
    assert "“a” and “c”, with a common volume of 0.5 near (1.75, 0.5, 0.5)" in finding.message
    assert found.diagnosis.volume == 8 + 1 + 0.5 and found.diagnosis.signed_volume == 10


def test_findings_name_the_object_and_the_triangles_of_the_file() -> None:
    found = examine(with_objects(cube(), moved(without(3), (5, 0, 0)), flipped(cube())))
    assert [one.diagnosis.verdict for one in found.objects] == ["solid", "not closed", "inside out"]
    assert found.diagnosis.verdict == "not closed" and found.diagnosis.volume is None
    messages = [(one.message[:3], one.code) for one in found.diagnosis.findings]
    assert messages == [("“b”", "open_edges"), ("“c”", "inside_out")]
    assert min(found.diagnosis.findings[0].where) >= 12
    assert max(found.objects[1].diagnosis.findings[0].where) < 11


def test_patches_of_one_surface_are_one_object() -> None:
    vertices, faces = cube()
    halves = [(vertices, faces[:5]), (vertices, faces[5:])]
    found = examine(with_objects(*halves, moved(cube(), (3, 0, 0))))
    assert [one.name for one in found.objects] == ["a + b", "c"]
    assert found.diagnosis.verdict == "solid" and found.diagnosis.volume == 2
    # Of nothing but patches there is one object, as of a file that tells none apart.
    assert examine(with_objects(*halves)).objects == ()
    assert examine(with_objects(*halves)).diagnosis.is_solid


def test_objects_of_one_name_are_told_apart() -> None:
    raw = RawMesh(*joined(cube(), moved(cube(), (3, 0, 0))), objects=(("a", 12), ("a", 12)))
    assert [one.name for one in examine(raw).objects] == ["a", "a (2)"]
    json.dumps(examine(raw).diagnosis.to_dict(), allow_nan=False)
