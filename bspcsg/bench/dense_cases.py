"""Benchmark cases in which many faces meet, each at two sizes.

Time should grow no faster than input and result.
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from .._types import MeshArrays
from . import dense_meshes
from .case import BenchCase
from .targets import DoublingTarget, Faster
from .workloads import Expression, OneMesh, OverlappingPair, Pair, Work

#: A function of a count that returns the work of an item.
_Maker = Callable[[int], Work]


def _union(meshes: Callable[[int], list[MeshArrays]]) -> _Maker:
    def make(count: int) -> Work:
        first, *others = meshes(count)
        return Expression(first, [[mesh] for mesh in others], "union")

    return make


def _difference(meshes: Callable[[int], list[MeshArrays]]) -> _Maker:
    def make(count: int) -> Work:
        first, *others = meshes(count)
        return Expression(first, [[mesh] for mesh in others])

    return make


def _intersection(meshes: Callable[[int], list[MeshArrays]]) -> _Maker:
    def make(count: int) -> Work:
        first, *others = meshes(count)
        return Expression(first, [[mesh] for mesh in others], "intersection")

    return make


def _one_mesh(meshes: Callable[[int], list[MeshArrays]]) -> _Maker:
    return lambda count: OneMesh(meshes(count))


def _pair(meshes: Callable[[int], tuple[MeshArrays, MeshArrays]]) -> _Maker:
    return lambda count: Pair(*meshes(count))


def _doubled(title: str, make: _Maker, count: int, small: int) -> BenchCase:
    """Return a benchmark case with the work of `make` for a count and for twice that count."""

    def item(size: int) -> Callable[[Path], Work]:
        return lambda _: make(size)

    return BenchCase(
        title,
        (DoublingTarget(), Faster(1)),
        {f"{n}": item(n) for n in (count, 2 * count)},
        {f"{n}": item(n) for n in (small, 2 * small)},
        ("bspcsg", "manifold3d"),
        limit=120.0,
    )


#: The cases by name; manifold3d takes seconds for these counts.
DENSE_CASES: dict[str, BenchCase] = {
    "dense-half-spaces": _doubled(
        "cubes around a ball, one side of each touching it, intersected",
        _intersection(dense_meshes.cubes_around_ball),
        100,
        4,
    ),
    "dense-turned-cubes": _doubled(
        "turned cubes at one place, united", _union(dense_meshes.turned_cubes), 60, 3
    ),
    "dense-boxes": _doubled(
        "aligned boxes that overlap, united", _union(dense_meshes.aligned_boxes), 400, 8
    ),
    "dense-needles": _doubled(
        "two bundles of needles across each other", _pair(dense_meshes.bundles), 300, 8
    ),
    "dense-cones": _doubled(
        "two cones with apexes near each other, by sides", _pair(dense_meshes.near_cones), 1500, 12
    ),
    "dense-cones-at-one-apex": _doubled(
        "two cones with one apex, by sides", _pair(dense_meshes.cones_at_one_apex), 500, 12
    ),
    "dense-equal-cones": _doubled(
        "two equal cones, by sides", _pair(dense_meshes.equal_cones), 500, 12
    ),
    "dense-fans": _doubled(
        "turned cones with one apex, united", _union(dense_meshes.turned_cones), 60, 3
    ),
    "dense-plate-and-boxes": _doubled(
        "turned plate minus boxes", _difference(dense_meshes.punched_plate), 900, 4
    ),
    "dense-plate-and-cylinders": _doubled(
        "plate minus cylinders", _difference(dense_meshes.drilled_plate), 800, 4
    ),
    "dense-plate-at-once": _doubled(
        "plate minus one mesh of cylinders", _pair(dense_meshes.drilled_at_once), 400, 4
    ),
    "dense-column": _doubled(
        "column minus a slab that parts it, by sides", _pair(dense_meshes.slab_and_column), 2000, 16
    ),
    "dense-shells": _doubled("balls in balls, united", _union(dense_meshes.nested_balls), 200, 4),
    "dense-film": _doubled(
        "ball minus itself a nanometre beside, by rows", _pair(dense_meshes.film), 2500, 50
    ),
    "dense-revisions": _doubled(
        "ball minus itself with one corner moved, by triangles",
        _pair(dense_meshes.revisions),
        20_000,
        50,
    ),
    "dense-moved-copies": _doubled(
        "copies of a ball, each moved by less than a step", _union(dense_meshes.moved_copies), 10, 3
    ),
    "dense-copies": _doubled("copies of a ball, united", _union(dense_meshes.copies), 30, 3),
    "dense-near-balls": _doubled(
        "balls that nearly coincide, united", _union(dense_meshes.near_balls), 10, 2
    ),
    "dense-touching-cubes": _doubled(
        "cubes that touch, united", _union(dense_meshes.touching_cubes), 1000, 8
    ),
    "dense-soup": _doubled(
        "turned cubes all over a room, united", _union(dense_meshes.cubes_in_room), 500, 8
    ),
    "dense-tetrahedra": _doubled(
        "turned tetrahedra all over a room, united", _union(dense_meshes.tetrahedra_in_room), 500, 8
    ),
    "dense-combs": _doubled(
        "two combs across each other, by teeth", _pair(dense_meshes.combs), 20, 3
    ),
    "dense-bar": _doubled(
        "bar with a round end in single precision, reduced, by sides",
        _one_mesh(dense_meshes.bar),
        300,
        12,
    ),
    "dense-bars": _doubled("two such bars across each other", _pair(dense_meshes.bars), 300, 12),
    "dense-one-mesh-of-cubes": _doubled(
        "turned cubes at one place in one mesh, reduced",
        _one_mesh(dense_meshes.turned_cubes),
        40,
        3,
    ),
    "dense-one-mesh-of-boxes": _doubled(
        "aligned boxes that overlap in one mesh, reduced",
        _one_mesh(dense_meshes.aligned_boxes),
        200,
        8,
    ),
    "dense-one-mesh-of-copies": _doubled(
        "copies of a ball in one mesh, reduced", _one_mesh(dense_meshes.copies), 30, 3
    ),
    "dense-one-mesh-of-touching-cubes": _doubled(
        "cubes that touch in one mesh, reduced", _one_mesh(dense_meshes.touching_cubes), 1000, 8
    ),
    "dense-tube": replace(
        _doubled(
            "tube through itself minus a box there, by rings",
            lambda rings: OverlappingPair(*dense_meshes.tube_and_box(rings)),
            400,
            12,
        ),
        other_sets=True,
    ),
    "dense-spikes": _doubled("spikes from one point, united", _union(dense_meshes.spikes), 250, 4),
}
