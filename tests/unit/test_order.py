"""The order of a mesh's vertices and triangles tells nothing of how the solid was evaluated."""

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
    """Return solids in general position."""
    rng = np.random.default_rng(seed)
    made = [b.sphere(1, segments=9), b.torus(1, 0.4, segments=8), b.cube(1.5)]
    return [
        made[k % 3].rotate(rng.uniform(0, 360, 3).tolist()).translate(rng.uniform(-0.6, 0.6, 3))
        for k in range(count)
    ]


def boxes(seed: int, count: int) -> list[b.Solid]:
    """Return boxes on a grid, of which many touch."""
    rng = np.random.default_rng(seed)
    sizes, places = rng.integers(1, 4, (count, 3)), rng.integers(-2, 3, (count, 3))
    return [
        b.box(size.tolist()).translate(place) for size, place in zip(sizes, places, strict=True)
    ]


def bytes_of(solid: b.Solid) -> tuple[bytes, ...]:
    mesh = solid.to_mesh()
    return mesh.vertices.tobytes(), mesh.faces.tobytes(), mesh.source.tobytes()


def folded(operands: list[b.Solid], seed: int, ask: Callable[[b.Solid], object]) -> b.Solid:
    """Combine operands one by one, and ask something of each result on the way."""
    rng = np.random.default_rng(seed)
    result, *others = operands
    for operand in others:
        combined = (result | operand, result - operand, result ^ operand)
        result = combined[rng.integers(3)]
        ask(result)
    return result


@pytest.mark.parametrize("seed", range(6))
def test_what_was_asked_before_leaves_the_bytes_as_they_are(seed: int) -> None:
    def final(ask: Callable[[b.Solid], object]) -> tuple[bytes, ...]:
        return bytes_of(folded(balls(seed, 5), seed, ask))

    unasked = final(lambda _: None)
    for question in QUESTIONS:
        assert final(question) == unasked


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
