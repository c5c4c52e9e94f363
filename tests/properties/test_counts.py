"""Equal sets have equally many parts and surfaces, and equal Euler numbers, for any meshes."""

from collections.abc import Iterator
from functools import reduce
from math import cos, pi, sin
from operator import xor
from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from support.checks import assert_counts
from support.kuhn import STEPS, Cells, KuhnGrid, Random, divided

#: A corner of a cube is a multiple of `STEPS`.
GRID = KuhnGrid(2, STEPS * np.eye(3, dtype=np.int64))

NORMALS = [(1, 0, 0), (1, 1, 0), (1, -1, 0), (1, 2, 3)]


def random_set(rng: Random) -> Cells:
    """Return some of the tetrahedra of one, two, four or eight cubes, at least one."""
    sizes = rng.integers(1, 3, 3)
    share = rng.choice((0.3, 0.5, 0.6))
    cells: Cells = np.array([(cell.low < sizes).all() for cell in GRID.cells])
    cells &= rng.random(len(cells)) < share
    cells[0] |= not cells.any()
    return cells


def ways(solid: b.Solid, rng: Random) -> Iterator[b.Solid]:
    """Yield a set several times, put together in different ways."""
    box = b.box(3 * STEPS, 3 * STEPS, 3 * STEPS)
    below, above = solid.split(NORMALS[rng.integers(len(NORMALS))], STEPS)
    yield solid
    yield solid.normalized()
    yield below | above
    yield b.Solid.from_mesh(solid.normalized().to_mesh())
    yield b.Solid.from_mesh(below.to_mesh()) | b.Solid.from_mesh(above.to_mesh())
    yield box - (box - solid)
    yield (solid | b.cube(1).translate(99, 0, 1e-9)) & box
    bite = b.cube(STEPS).translate(STEPS // 2, STEPS // 2, STEPS // 2)
    yield (solid - bite) | (solid & bite)


# Found: coplanar faces were joined across an edge of six walls, so that triangles crossed though
# all corners were exact; parts that touch in an edge were one for the mesh of an evaluation, but
# several for a given mesh.
@pytest.mark.sampled(15)
@pytest.mark.parametrize("seed", range(60))
def test_counts_do_not_depend_on_the_mesh(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cells = random_set(rng)
    whole = b.union(b.Solid(*GRID.mesh(shell.faces)) for shell in GRID.shells_of(cells))
    meshes = [divided(GRID, cells, rng, apart=apart) for apart in (False, True)]
    for given in (whole, *(b.Solid(*mesh) for mesh in meshes)):
        for same in ways(given, rng):
            assert same == whole
            assert_counts(same, GRID.counts(cells))


def half_spaces(count: int) -> b.Solid:
    """Return the points that lie in an odd number of half-spaces around the z axis."""
    turns = [(cos(pi * k / count), sin(pi * k / count), 0) for k in range(count)]
    return reduce(xor, (b.half_space(normal, 0) for normal in turns))


@pytest.mark.parametrize("count", range(2, 7))
def test_wedges_around_an_axis_are_parts(count: int, tmp_path: Path) -> None:
    cylinder = b.cylinder(2, r=3, segments=4 * count)
    wedges = cylinder & half_spaces(count)
    counts = (count, count, 2 * count)
    assert_counts(wedges, counts)
    lower, upper = wedges.split("z", 0.75)
    assert_counts(lower | upper, counts)
    assert_counts((wedges - b.sphere(1, segments=8)) | (wedges & b.sphere(1, segments=8)), counts)
    for name in ("a.stl", "a.3mf"):
        wedges.save(tmp_path / name)
        assert_counts(b.load(tmp_path / name), counts)


def test_three_wedges_of_a_cube_are_three_tetrahedra() -> None:
    planes = [(1, -1, 0), (0, 1, -1), (-1, 0, 1)]
    wedges = b.cube(1) & reduce(xor, (b.half_space(normal, 0) for normal in planes))
    assert_counts(wedges, (3, 3, 6))
    assert len(wedges.to_mesh().faces) == 12
    assert [(finding.code, finding.count) for finding in wedges.findings] == [("edge_contact", 1)]


def test_cavities_that_touch_in_an_edge_have_one_wall() -> None:
    first = b.hull([(0, 0, 0), (0, 0, 4), (2, 0, 2), (0, 2, 2)])
    block = b.box(10, 10, 10).translate(-5, -5, -3)
    second = first.rotate(180, "z")
    assert_counts(block - first - second, (1, 2, 4))
    lower, upper = second.split("z", 2)
    cut = b.Solid.from_mesh((block - first).to_mesh()) - lower - upper
    assert_counts(cut, (1, 2, 4))
    # If the edge is divided, the mesh need not part the cavities to be a manifold.
    assert (block - first - second).to_mesh().surface_count == 3


def test_a_groove_that_reaches_a_ridge_parts_a_mesh_with_other_vertices() -> None:
    outline = b.Region.polygon([(0, 0), (4, 0), (4, 3), (2, 4), (0, 3)])
    groove = b.Region.polygon([(1, 0), (3, 0), (2, 4)])
    prism = (outline - groove).extrude(6)
    assert_counts(prism, (2, 2, 4))
    pieces = [part.split("z", 2 + k) for k, part in enumerate(prism.components)]
    again = b.union(half for pair in pieces for half in pair)
    assert again == prism
    assert_counts(again, (2, 2, 4))
