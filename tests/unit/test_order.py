"""The order of a mesh's vertices and triangles does not depend on how the solid was evaluated."""

from collections.abc import Callable

import numpy as np
import pytest

import bspcsg as b

#: What may be asked of a solid that becomes an operand later.
QUESTIONS: list[Callable[[b.Solid], object]] = [
    lambda solid: solid.volume,
    lambda solid: solid.to_mesh(),
    lambda solid: solid.classify([[0.1, 0.2, 0.3]]),
    lambda solid: (solid & b.cube(1)).volume,
]


def balls(seed: int, count: int) -> list[b.Solid]:
    """Return random solids in general position."""
    rng = np.random.default_rng(seed)
    made = [b.sphere(1, segments=9), b.torus(1, 0.4, segments=8), b.cube(1.5)]
    return [
        made[k % 3].rotate(rng.uniform(0, 360, 3).tolist()).translate(rng.uniform(-0.6, 0.6, 3))
        for k in range(count)
    ]


def boxes(seed: int, count: int) -> list[b.Solid]:
    """Return random boxes on a grid, many of which touch."""
    rng = np.random.default_rng(seed)
    sizes, places = rng.integers(1, 4, (count, 3)), rng.integers(-2, 3, (count, 3))
    return [
        b.box(size.tolist()).translate(place) for size, place in zip(sizes, places, strict=True)
    ]


def bytes_of(solid: b.Solid) -> tuple[bytes, ...]:
    mesh = solid.to_mesh()
    return mesh.vertices.tobytes(), mesh.faces.tobytes(), mesh.source.tobytes()


def folded(operands: list[b.Solid], seed: int, ask: Callable[[b.Solid], object]) -> b.Solid:
    """Combine operands one by one, and evaluate each result with `ask`."""
    rng = np.random.default_rng(seed)
    result, *others = operands
    for operand in others:
        combined = (result | operand, result - operand, result ^ operand)
        result = combined[rng.integers(3)]
        ask(result)
    return result


def woven(operands: list[b.Solid], seed: int, ask: Callable[[b.Solid], object]) -> b.Solid:
    """Combine operands, some of them several times, and evaluate each result with `ask`."""
    rng = np.random.default_rng(seed)
    pool = list(operands)
    spare = len(pool)
    while len(pool) > 1:
        one, other = rng.permutation(len(pool))[:2]
        first, second = pool[one], pool[other]
        combined = (first | second, first - second, first & second, first ^ second, ~(~first))
        result = combined[rng.integers(5)]
        if rng.random() < 0.3:
            result = result.translate(rng.integers(-1, 2, 3))
        ask(result)
        stays = spare > 0 and rng.random() < 0.4
        spare -= stays
        pool = [solid for k, solid in enumerate(pool) if k != one and (stays or k != other)]
        pool.append(result)
    return pool[0]


# Found: querying the volume of an intermediate solid changed the order of vertices and triangles in
# the file.
@pytest.mark.sampled(5)
@pytest.mark.parametrize("combine", [folded, woven])
@pytest.mark.parametrize("make", [balls, boxes])
@pytest.mark.parametrize("seed", range(12))
def test_what_was_asked_before_leaves_the_bytes_as_they_are(
    seed: int,
    make: Callable[[int, int], list[b.Solid]],
    combine: Callable[[list[b.Solid], int, Callable[[b.Solid], object]], b.Solid],
) -> None:
    def final(ask: Callable[[b.Solid], object]) -> tuple[bytes, ...]:
        return bytes_of(combine(make(seed, 6), seed, ask))

    unasked = final(lambda _: None)
    for question in QUESTIONS:
        assert final(question) == unasked


def test_where_three_faces_coincide_the_owner_is_that_of_the_steps() -> None:
    # In x = 1 one box ends where another begins, and a third ends, whose face is left.
    def faces(ask: Callable[[b.Solid], object]) -> set[int]:
        both = b.cube(1) | b.cube(1).translate(1, 0, 0)
        ask(both)
        left = both & b.cube(1)
        mesh = left.to_mesh()
        at_wall = (mesh.vertices[mesh.faces][:, :, 0] == 1).all(axis=1)
        return set(mesh.source[at_wall, 0].tolist())

    assert [faces(ask) for ask in (lambda _: None, *QUESTIONS)] == [{2}] * 5


def test_a_moved_solid_is_one_mesh_to_all_operations() -> None:
    moved = b.sphere(1, segments=8).translate(1, 2, 3)
    plane = b.half_space([1, 0, 0], 1)
    parts = [moved & plane, moved - plane]
    for part in parts:
        part.to_mesh()
    whole = (parts[0] | parts[1]).to_mesh()
    assert set(whole.source[:, 0].tolist()) == {0}


@pytest.mark.parametrize("make", [balls, boxes])
@pytest.mark.parametrize("seed", range(3))
def test_unions_have_the_same_bytes_however_they_are_nested(
    seed: int, make: Callable[[int, int], list[b.Solid]]
) -> None:
    one, two, three, four = make(seed, 4)
    flat = bytes_of(b.union(one, two, three, four))
    assert bytes_of((one | two) | (three | four)) == flat
    assert bytes_of(one | (two | (three | four))) == flat
    assert bytes_of(((one | two) | three) | four) == flat


def test_the_order_follows_from_places_alone() -> None:
    mesh = (b.cube(2) - b.cube(2).translate(1, 1, 1)).to_mesh()
    # The corners of the first cube that are left, of the second, and what both made, by place.
    assert mesh.vertices[:7].tolist() == [p for p in b.cube(2).vertices.tolist() if min(p) < 2]
    assert mesh.vertices[7].tolist() == [1, 1, 1]
    made = mesh.vertices[8:].tolist()
    assert made == sorted(made)
    assert len(made) == 6


def test_a_corner_that_is_cut_off_names_no_vertex_of_another_solid() -> None:
    corners = [[6, 4, 2], [6, 3, 5], [1, 0, 2], [2, 5, 3]]
    spike = b.Solid(corners, [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]])
    assert spike.volume > 0
    # The cube has a corner where that of the spike was, and keeps all of its own together.
    cube = b.cube(1).translate(5, 3, 4)
    vertices = ((spike & b.box(2, 1, 1).translate(3, 2, 3)) | cube).to_mesh().vertices.tolist()
    first = vertices.index([6, 4, 5]) - 7
    assert vertices[first : first + 8] == cube.to_mesh().vertices.tolist()
