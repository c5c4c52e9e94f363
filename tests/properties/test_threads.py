"""Many threads at once give the same results as one after the other."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import Region, csg
from bspcsg.formats.registry import FORMATS
from support.interleaving import interleaved

THREADS = 8
TIMES = 3

#: A solid that all threads share, and look at for the first time together.
SHARED = b.sphere(2, segments=20).rotate((1, 2, 3)) | b.box((3, 1, 1)).translate(0.1, 0.2, 0.3)


def mesh_of(solid: b.Solid) -> tuple[bytes, bytes]:
    mesh = solid.to_mesh()
    return mesh.vertices.tobytes(), mesh.faces.tobytes()


def cut() -> b.Solid:
    return b.sphere(1, segments=16).rotate((10, 20, 30)) - b.cube(1)


def through_file(suffix: str) -> object:
    """Return the bytes of a file of a solid, and the mesh read from it."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"x{suffix}"
        b.save(cut(), path)
        return path.read_bytes(), mesh_of(b.load(path))


def through_drawing(suffix: str) -> object:
    region = cut().project()
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"x{suffix}"
        getattr(region, f"to_{suffix[1:]}")(path)
        return path.read_bytes(), getattr(Region, f"from_{suffix[1:]}")(path).area_exact


def ball(points: Any) -> Any:
    return (np.asarray(points) ** 2).sum(axis=-1) - 1


JOBS: dict[str, Callable[[], object]] = {
    **{suffix: partial(through_file, suffix) for suffix in FORMATS},
    **{suffix: partial(through_drawing, suffix) for suffix in (".svg", ".dxf")},
    "a shared solid": lambda: (mesh_of(SHARED), SHARED.volume_exact, SHARED.findings),
    "a cut of a shared solid": lambda: mesh_of(SHARED - b.cube(1)),
    "text": lambda: mesh_of(b.extrude(b.text("bsp"), 1)),
    "script": lambda: mesh_of(csg.loads("difference() { sphere(2, $fn = 12); cube(1); }")),
    "hull": lambda: mesh_of(b.hull(b.cube(1), b.cube(2).translate(3, 1, 0))),
    "sum": lambda: mesh_of(b.minkowski(b.cube(1), b.sphere(0.3, segments=8))),
    "level set": lambda: mesh_of(b.level_set(ball, ((-1.2,) * 3, (1.2,) * 3), 0.4)),
    "offset": lambda: Region.rectangle(4, 2).offset(0.3).area_exact,
    "rays": lambda: str(SHARED.ray_cast((5, 0.1, 0.2), (-5, 0.1, 0.2))),
    "fewer faces": lambda: mesh_of(cut().simplify(0.05)),
}


def test_threads_get_the_same_answers() -> None:
    for module in ("meshio", "ezdxf", "svgelements", "uharfbuzz"):
        pytest.importorskip(module)
    names = [name for name in JOBS for _ in range(TIMES)]
    with ThreadPoolExecutor(THREADS) as pool:
        found = list(pool.map(lambda name: JOBS[name](), names))
    expected = {name: job() for name, job in JOBS.items()}
    assert [name for name, one in zip(names, found, strict=True) if one != expected[name]] == []


def turned() -> b.Solid:
    return b.box((1, 2, 3)).rotate((10, 20, 30))


#: Solids of which everything is still to be made.
PENDING: dict[str, Callable[[], b.Solid]] = {
    "turned": turned,
    "turned and moved": lambda: turned().translate(1, 2, 3).rotate(90, "z"),
    "union": lambda: turned() | b.cube(1),
    "turned union": lambda: (b.cube(1) | b.cube(1).translate(1, 1, 1)).rotate(30, "z"),
    "refined": lambda: b.cube(1).refine(2).rotate(10, "x"),
    "half-space": lambda: b.half_space((1, 2, 3), 0.5).rotate(10, "x") & b.cube(1),
    "tagged": lambda: turned().tagged(layer=1) - b.cube(1).tagged(layer=2),
}


def seen(solid: b.Solid) -> tuple[object, list[int]]:
    """Return a solid's mesh, and the indices of the meshes that it was made from."""
    return mesh_of(solid), solid.tree.sources


# Found: threads that queried one transformed solid for the first time at the same time got an
# error, or two meshes of it.
@pytest.mark.sampled(4)
@pytest.mark.parametrize("name", PENDING)
def test_a_thread_may_come_between_any_two_lines(name: str) -> None:
    expected = mesh_of(PENDING[name]())
    for ours, theirs in interleaved(PENDING[name], seen, seen):
        assert ours == theirs
        assert ours[0] == expected


def test_a_chain_is_shortened_by_several_threads_at_once() -> None:
    factors = [b.cube(1).translate(x, 0, 0)._factors for x in (1, 2, 3)]
    chain = factors[0].around(factors[1].around(factors[2]))
    for ours, _ in interleaved(
        lambda: type(chain).of(tuple(chain)), lambda c: c.without(1), lambda c: c.without(2)
    ):
        assert tuple(ours) == tuple(chain)[1:]
