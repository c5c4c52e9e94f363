"""Results do not depend on the order of faces and corners, on axes, position or threads."""

from collections.abc import Iterator
from itertools import permutations, product

import numpy as np
import pytest

import bspcsg as b
from support.checks import assert_sound
from support.shapes import (
    Arrays,
    affine,
    cube,
    cuboid,
    icosphere,
    joined,
    moved,
    random_rotation,
    tetrahedron,
    turned,
)

OPERATIONS = ("union", "intersection", "difference", "xor")


def pairs() -> list[tuple[Arrays, Arrays]]:
    """Return pairs of operands, from simple to difficult."""
    rng = np.random.default_rng(7)
    ball = icosphere(3)
    tilted = turned(cube(1.5), random_rotation(rng))
    overlapping = joined(cube(), moved(cube(), (0.5, 0.25, 0)))
    corner = tetrahedron([(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2)])
    return [
        (cube(), moved(cube(), (0.5, 0.5, 0.5))),
        (cube(), moved(cube(), (1, 0, 0))),
        (cuboid((0, 0, 0), (2, 2, 2)), corner),
        (ball, moved(ball, (1, 0, 0))),
        (ball, tilted),
        (overlapping, moved(tilted, (0.1, 0.2, 0.3))),
    ]


PAIRS = pairs()


@pytest.fixture(autouse=True)
def all_threads_again() -> Iterator[None]:
    """Restore the default number of threads after the test."""
    yield
    b.set_threads(0)


def result_bytes(first: Arrays, second: Arrays, operation: str) -> tuple[bytes, ...]:
    """Return the bytes of a result's arrays, computed from new operands."""
    a, c = b.Solid(*first), b.Solid(*second)
    result = {"union": a | c, "intersection": a & c, "difference": a - c, "xor": a ^ c}[operation]
    mesh = result.to_mesh()
    return mesh.vertices.tobytes(), mesh.faces.tobytes(), mesh.source.tobytes()


@pytest.mark.parametrize("operation", OPERATIONS)
@pytest.mark.parametrize("pair", range(len(PAIRS)))
def test_same_bytes_for_any_number_of_threads(pair: int, operation: str) -> None:
    seen = set()
    for threads in (1, 2, 8, 2, 1):
        b.set_threads(threads)
        seen.add(result_bytes(*PAIRS[pair], operation))
    assert len(seen) == 1


def test_crowds_of_few_faces_have_the_same_bytes_for_any_number_of_threads() -> None:
    rng = np.random.default_rng(12)
    cubes = [turned(cube(2), random_rotation(rng)) for _ in range(30)]
    seen = set()
    for threads in (1, 2, 8, 2, 1):
        b.set_threads(threads)
        mesh = b.union(*[b.Solid(*shape) for shape in cubes]).to_mesh()
        seen.add((mesh.vertices.tobytes(), mesh.faces.tobytes(), mesh.source.tobytes()))
    assert len(seen) == 1


@pytest.mark.parametrize("pair", range(len(PAIRS)))
def test_faces_in_any_order_bound_the_same_set(pair: int) -> None:
    rng = np.random.default_rng(11)
    (va, fa), (vc, fc) = PAIRS[pair]
    a, c = b.Solid(va, fa), b.Solid(vc, fc)
    renamed = rng.permutation(len(va))
    shuffled = np.argsort(renamed)[fa][rng.permutation(len(fa))]
    rolled = np.array(
        [np.roll(face, k) for face, k in zip(shuffled, rng.integers(0, 3, len(fa)), strict=True)]
    )
    other = b.Solid(va[renamed], rolled)
    assert other.equals(a)
    assert (other - c).equals(a - c)
    assert (other - c).volume_exact == (a - c).volume_exact
    assert (other | c).to_mesh().area == pytest.approx((a | c).to_mesh().area, rel=1e-12)


def signed_permutations() -> list[np.ndarray]:
    """Return the 48 matrices that permute and mirror the axes."""
    units = np.eye(3)
    return [
        units[list(order)] * np.array(signs)[:, None]
        for order in permutations(range(3))
        for signs in product((1.0, -1.0), repeat=3)
    ]


def oriented(mesh: Arrays, matrix: np.ndarray) -> Arrays:
    """Return a mesh under a matrix, with its faces reversed if the matrix mirrors."""
    vertices, faces = turned(mesh, matrix)
    return vertices, faces if np.linalg.det(matrix) > 0 else faces[:, ::-1].copy()


@pytest.mark.parametrize("pair", range(len(PAIRS)))
def test_axes_are_alike(pair: int) -> None:
    first, second = PAIRS[pair]
    volume = (b.Solid(*first) - b.Solid(*second)).volume_exact
    straight = b.Solid(*first) - b.Solid(*second)
    # The meshes of three thousand faces try one axis order each; the small ones try all 48.
    matrices = signed_permutations()[:: 16 if len(first[1]) > 100 else 1]
    for matrix in matrices:
        a, c = b.Solid(*oriented(first, matrix)), b.Solid(*oriented(second, matrix))
        result = a - c
        assert result.volume_exact == volume
        assert_sound(result)
        assert result.equals(straight.transform(affine(matrix)))


@pytest.mark.parametrize("pair", range(len(PAIRS)))
@pytest.mark.parametrize("shift", [(1, 2, 3), (-0.125, 1e-9, 7.5), (1e5, -1e5, 3e5)])
def test_whole_steps_move_results_exactly(pair: int, shift: tuple[float, float, float]) -> None:
    a, c = (b.Solid(*mesh) for mesh in PAIRS[pair])
    before, after = a - c, a.translate(*shift) - c.translate(*shift)
    assert after.volume_exact == before.volume_exact
    assert after.equals(before.translate(*shift))


def test_operands_are_not_changed() -> None:
    first, second = PAIRS[4]
    a, c = b.Solid(*first), b.Solid(*second)
    kept = [array.copy() for mesh in (first, second) for array in mesh]
    before = a.to_mesh().vertices.copy()
    for result in (a | c, a & c, a - c, a ^ c):
        result.to_mesh()
    for array, copy in zip([*first, *second], kept, strict=True):
        assert np.array_equal(array, copy)
    assert np.array_equal(a.to_mesh().vertices, before)


def test_what_is_not_cut_leaves_as_it_came() -> None:
    vertices, faces = icosphere(4)
    part = b.Solid(vertices, faces) - b.Solid(*moved(cube(0.5), (0.7, -0.25, -0.25)))
    mesh = part.to_mesh()
    assert_sound(part)
    given = {tuple(map(tuple, vertices[face].tolist())) for face in faces}
    whole = [tuple(map(tuple, mesh.vertices[face].tolist())) for face in mesh.faces]
    rotations = sum(any((t[k:] + t[:k]) in given for k in range(3)) for t in whole)
    assert rotations > 0.9 * len(faces)
    kept = mesh.source[:, 0] == 0
    for face, (_, index) in zip(mesh.faces[kept], mesh.source[kept], strict=True):
        a, c, d = vertices[faces[index]]
        normal = np.cross(c - a, d - a)
        distance = (mesh.vertices[face] - a) @ normal / np.linalg.norm(normal)
        assert np.abs(distance).max() < 1e-8
