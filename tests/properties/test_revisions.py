"""Two revisions of a mesh are equal except for a few corners, whatever the order of faces."""

from collections.abc import Callable

import numpy as np
import pytest

import bspcsg as b
from support.shapes import Arrays, icosphere, joined, moved

OPERATIONS: dict[str, Callable[[b.Solid, b.Solid], b.Solid]] = {
    "union": lambda a, c: a | c,
    "intersection": lambda a, c: a & c,
    "difference": lambda a, c: a - c,
    "xor": lambda a, c: a ^ c,
}


def revised(mesh: Arrays, seed: int) -> Arrays:
    """Return the mesh with a few neighbouring corners moved and its faces in another order."""
    rng = np.random.default_rng(seed)
    vertices, faces = mesh
    distances = np.linalg.norm(vertices - vertices[rng.integers(len(vertices))], axis=1)
    near = np.argsort(distances)[: rng.integers(1, 20)]
    later = vertices.copy()
    later[near] += 0.02 * rng.normal(size=3)
    shuffled = rng.permutation(faces)
    return later, np.array([np.roll(face, rng.integers(3)) for face in shuffled])


@pytest.mark.parametrize("seed", range(6))
def test_volumes_of_revisions_add_up(seed: int) -> None:
    ball = icosphere(4)
    first = ball if seed % 2 else joined(ball, moved(ball, (3, 0, 0)))
    a, c = b.Solid(*first), b.Solid(*revised(first, seed))
    union, common, less, different = (op(a, c).volume_exact for op in OPERATIONS.values())
    assert union + common == a.volume_exact + c.volume_exact
    assert less == a.volume_exact - common
    assert different == union - common
    assert different > 0


@pytest.mark.parametrize("operation", OPERATIONS)
def test_bytes_of_revisions_do_not_depend_on_threads(operation: str) -> None:
    first = icosphere(5)
    later = revised(first, 3)

    def made(threads: int) -> tuple[bytes, ...]:
        b.set_threads(threads)
        try:
            mesh = OPERATIONS[operation](b.Solid(*first), b.Solid(*later)).to_mesh()
        finally:
            b.set_threads(0)
        return mesh.vertices.tobytes(), mesh.faces.tobytes(), mesh.source.tobytes()

    assert made(1) == made(2) == made(5)


def test_steps_of_a_chain_differ_by_what_was_done() -> None:
    tools = [b.Solid(*moved(icosphere(2), (0.4 * k, 0, 0))) for k in range(1, 5)]
    steps = [b.box(4, 4, 4)]
    for tool in tools:
        steps.append(steps[-1] - tool)
    assert (steps[2] ^ steps[4]).equals(steps[2] & (tools[2] | tools[3]))
    assert (steps[4] - steps[2]).is_empty
