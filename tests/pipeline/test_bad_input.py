"""Invalid input of Python functions leads to a clear error, or to a finding and a right result."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from support.checks import assert_sound
from support.shapes import Arrays, cube, cuboid, flipped, joined, moved, octahedron, tetrahedron


def with_vertex(value: float) -> Arrays:
    """Return a cube with one coordinate replaced."""
    vertices, faces = cube()
    vertices[3, 1] = value
    return vertices, faces


def without_face(count: int) -> Arrays:
    """Return a cube without its first faces."""
    vertices, faces = cube()
    return vertices, faces[count:]


def with_index(value: int) -> Arrays:
    """Return a cube with a face that uses a vertex that does not exist."""
    vertices, faces = cube()
    faces[5, 2] = value
    return vertices, faces


def turned_face() -> Arrays:
    """Return a cube with one face reversed."""
    vertices, faces = cube()
    faces[4] = faces[4, ::-1]
    return vertices, faces


REFUSED: dict[str, tuple[Callable[[], tuple[Any, Any]], str]] = {
    "nan": (lambda: with_vertex(float("nan")), "non_finite"),
    "infinite": (lambda: with_vertex(float("inf")), "non_finite"),
    "minus infinite": (lambda: with_vertex(float("-inf")), "non_finite"),
    "index too large": (lambda: with_index(8), "index_out_of_range"),
    "index negative": (lambda: with_index(-1), "index_out_of_range"),
    "index huge": (lambda: with_index(2**40), "index_out_of_range"),
    "one face missing": (lambda: without_face(1), "not_closed"),
    "side missing": (lambda: without_face(2), "not_closed"),
    "single triangle": (lambda: (cube()[0], cube()[1][:1]), "not_closed"),
    "face turned round": (turned_face, "not_closed"),
    "huge coordinate": (lambda: with_vertex(1e308), "too_large"),
    "no faces": (lambda: (cube()[0], np.zeros((0, 3), np.int64)), "empty_mesh"),
    "nothing at all": (lambda: (np.zeros((0, 3)), np.zeros((0, 3), np.int64)), "empty_mesh"),
    "flat vertices": (lambda: (cube()[0].ravel(), cube()[1]), "shape"),
    "plane vertices": (lambda: (cube()[0][:, :2], cube()[1]), "shape"),
    "one quad": (lambda: (cube()[0], np.array([[0, 1, 3, 2]])), "not_closed"),
    "two corners": (lambda: (cube()[0], np.array([[0, 1], [1, 0]])), "shape"),
    "ragged": (lambda: ([[0, 0, 0], [1, 0]], [[0, 1, 0]]), "shape"),
    "words": (lambda: ("no", "mesh"), "shape"),
    "fractional indices": (lambda: (cube()[0], cube()[1] + 0.5), "shape"),
    "no arrays": (lambda: (None, None), "shape"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused_with_a_code_and_a_sentence(name: str) -> None:
    make, code = REFUSED[name]
    with pytest.raises(b.BspcsgError) as caught:
        b.Solid(*make()).to_mesh()
    assert caught.value.code == code
    assert len(str(caught.value)) > 20


@pytest.mark.parametrize("name", ["nan", "index too large", "one face missing", "side missing"])
def test_refusals_say_where(name: str) -> None:
    make, _ = REFUSED[name]
    with pytest.raises(b.BspcsgError) as caught:
        b.Solid(*make()).to_mesh()
    assert len(caught.value.where) > 0
    assert all(index >= 0 for index in caught.value.where)


def test_the_hole_is_named_by_faces_around_it() -> None:
    vertices, faces = without_face(1)
    with pytest.raises(b.BspcsgError) as caught:
        b.Solid(vertices, faces).to_mesh()
    missing = set(cube()[1][0].tolist())
    around = {k for k, face in enumerate(faces) if len(missing & set(face.tolist())) == 2}
    assert set(caught.value.where) & around


def test_an_inverted_mesh_holds_nothing_and_says_so() -> None:
    inverted = b.Solid(*flipped(cube()))
    assert inverted.volume_exact == 0
    assert inverted.is_empty
    assert any(finding.code == "inside_out" for finding in inverted.findings)
    assert (b.Solid(*cube()) | inverted).volume_exact == 1


def test_an_inverted_shell_inside_is_a_cavity() -> None:
    shell = joined(cuboid((0, 0, 0), (3, 3, 3)), flipped(cuboid((1, 1, 1), (2, 2, 2))))
    solid = b.Solid(*shell)
    assert solid.volume_exact == 26
    assert (solid & b.Solid(*cuboid((1, 1, 1), (2, 2, 2)))).is_empty
    assert_sound(solid - b.Solid(*cuboid((1, 1, 1), (4, 4, 4))))


def test_faces_without_area_are_dropped_with_a_finding() -> None:
    vertices, faces = cube()
    vertices = np.concatenate([vertices, [(0.5, 0, 0)]])
    split = [(0, 4, 8), *map(tuple, faces.tolist()), (0, 8, 8)]
    solid = b.Solid(vertices, np.array([*split, (4, 0, 8)]))
    assert solid.volume_exact == 1
    assert any(finding.code for finding in solid.findings)
    assert_sound(solid - b.Solid(*moved(cube(), (0.5, 0.5, 0.5))))


@pytest.mark.parametrize("rule", ["positive", "nonzero", "even-odd"])
def test_overlap_inside_one_mesh_follows_the_rule(rule: Any) -> None:
    overlapping = joined(cube(), moved(cube(), (0.5, 0.5, 0.5)))
    expected = {"positive": 15, "nonzero": 15, "even-odd": 14}[rule]
    solid = b.Solid(*overlapping, winding=rule)
    assert solid.volume_exact * 8 == expected
    assert_sound(solid)


def test_a_doubled_shell_counts_once() -> None:
    solid = b.Solid(*joined(cube(), cube()))
    assert solid.volume_exact == 1
    assert len(assert_sound(solid).faces) == 12


def test_a_shell_and_its_inverse_cancel() -> None:
    solid = b.Solid(*joined(cube(), flipped(cube())))
    assert solid.is_empty
    assert solid.volume_exact == 0


def test_a_soup_of_separate_triangles_is_welded() -> None:
    vertices, faces = octahedron()
    soup = vertices[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3)
    solid = b.Solid(*soup)
    assert solid.volume_exact * 3 == 4
    assert len(assert_sound(solid).vertices) == 6


def test_t_junctions_are_closed() -> None:
    vertices, faces = tetrahedron([(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2)])
    middle = np.concatenate([vertices, [(1, 0, 0)]])
    first = next(face for face in faces.tolist() if 0 in face and 1 in face)
    at = first.index(0)
    a, c, d = first[at], first[(at + 1) % 3], first[(at + 2) % 3]
    rest = [face for face in faces.tolist() if face != first]
    halves = [(a, 4, d), (4, c, d)] if c == 1 else [(a, c, 4), (c, d, 4)] if d == 1 else []
    solid = b.Solid(middle, np.array([*rest, *halves]))
    assert solid.volume_exact * 3 == 4
    assert_sound(solid | b.Solid(*moved(cube(), (5, 0, 0))))


def test_a_tiny_mesh_gets_a_finer_lattice() -> None:
    solid = b.Solid(*cube(1e-12))
    assert solid.volume_exact == Fraction(1, 10**36)
    assert solid.pitch <= -12
    assert any(finding.code == "pitch" for finding in solid.findings)


def test_subnormal_coordinates_are_rounded() -> None:
    vertices, faces = cube()
    vertices[vertices == 0] = 5e-324
    assert b.Solid(vertices, faces).volume_exact == 1


@pytest.mark.parametrize("dtype", [np.float32, np.int32, np.int64, np.float64])
def test_other_number_types_are_taken(dtype: Any) -> None:
    vertices, faces = cube()
    assert b.Solid(vertices.astype(dtype), faces.astype(np.int32)).volume_exact == 1
    assert b.Solid(np.asfortranarray(vertices.astype(dtype)), faces.astype(np.uint64)).volume == 1
    assert b.Solid(vertices.tolist(), faces.tolist()).volume == 1
    vertices.flags.writeable = False
    assert b.Solid(vertices, faces[::-1]).volume == 1


@pytest.mark.parametrize("normal", [(0, 0, 0), (float("nan"), 0, 1), (float("inf"), 0, 0)])
def test_a_half_space_needs_a_direction(normal: Any) -> None:
    with pytest.raises(b.BspcsgError) as caught:
        b.half_space(normal, 0).classify(np.zeros((1, 3)))
    assert caught.value.code == "bad_normal"


def test_unbounded_solids_have_no_mesh() -> None:
    outside = ~b.Solid(*cube())
    for ask in (outside.to_mesh, lambda: outside.volume_exact, lambda: outside.volume):
        with pytest.raises(b.BspcsgError) as caught:
            ask()
        assert caught.value.code == "unbounded"
    assert (b.box((3, 3, 3), center=True) & outside).volume_exact == 26


def test_errors_survive_pickling() -> None:
    import pickle

    with pytest.raises(b.BspcsgError) as caught:
        b.Solid(*without_face(1)).to_mesh()
    again = pickle.loads(pickle.dumps(caught.value))
    assert (again.code, again.where, str(again)) == (
        caught.value.code,
        caught.value.where,
        str(caught.value),
    )


def test_arrays_in_arrays_out_refuses_unknown_operations() -> None:
    vertices, faces = cube()
    with pytest.raises(b.BspcsgError):
        b.boolean(vertices, faces, vertices, faces, "minus")  # type: ignore[arg-type]
    empty = b.boolean(vertices, faces, vertices, faces, "difference")
    assert [len(part) for part in empty] == [0, 0]
