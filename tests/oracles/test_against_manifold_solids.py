"""Methods of solids against manifold3d's: volume, area and Euler number on ten inputs each.

The last five inputs of each method are degenerate: empty, flat, touching, on a plane, in a corner.
"""

from collections.abc import Callable
from typing import Any, TypeAlias

import manifold3d
import numpy as np
import pytest

import bspcsg as b

Manifold = manifold3d.Manifold
Verb: TypeAlias = Callable[..., Any]

OpType = manifold3d.OpType

RNG = np.random.default_rng(15)


def frame() -> b.Solid:
    return b.box((4, 4, 1)) - b.box((2, 2, 1)).translate(1, 1, 0)


def pair() -> b.Solid:
    return b.cube(1) | b.cube(2).translate(3, 0, 0)


def bodies() -> list[b.Solid]:
    """Return five ordinary and five degenerate solids."""
    return [
        b.cube(2),
        b.sphere(1.5, segments=12),
        frame().rotate((10, 20, 30)),
        b.torus(3, 1, segments=12, tube_segments=8),
        b.cylinder(3, 1, segments=7) - b.cylinder(3, 0.5, segments=5),
        b.Solid.empty(),
        pair(),
        b.cube(3) - b.cube(1).translate(1, 1, 1),
        b.cube(1) | b.cube(1).translate(1, 0, 0),
        b.box((1, 1, 1e-3)),
    ]


def connected() -> list[b.Solid]:
    """Return solids with one surface, whose genus manifold3d counts as we do, also rotated."""
    own = [body for body in bodies() if len(body.decompose()) == 1 and body.surface_count == 1]
    return (own + [body.rotate(x=10, y=20, z=30) for body in own])[:10]


def summands() -> list[b.Solid]:
    """Return the ten solids with a tiny cube for the empty set, which manifold3d sums otherwise."""
    return [b.cube(1e-3) if body.is_empty else body for body in bodies()]


def clouds() -> list[Any]:
    grid = np.stack(np.meshgrid(*[np.arange(4.0)] * 3), axis=-1).reshape(-1, 3)
    return [
        RNG.normal(size=(10, 3)),
        RNG.normal(size=(300, 3)),
        RNG.uniform(size=(50, 3)) * (1, 1, 9),
        RNG.normal(size=(100, 3)) ** 3,
        np.eye(3).tolist() + [[0, 0, 0]],
        grid,
        np.repeat(grid[:8], 3, axis=0),
        np.zeros((5, 3)),
        grid[:, :] * (1, 1, 0),
        grid * (1, 1, 1e-6),
    ]


PLANES = [((0, 0, 1), 0.5), ((1, 2, 3), 1), ((0, 0, 1), 0), ((0, 0, -1), 0), ((1, 0, 0), 99)]

#: Of points (n, 3).
WARPS: list[Verb] = [
    lambda p: p * (1, 2, 3),
    lambda p: p + 0.1 * np.sin(np.roll(p, 1, axis=1)),
    lambda p: p,
    lambda p: p * (1 + 0.1 * p[:, 2:]),
    lambda p: p[:, [1, 2, 0]] - 7,
]

FIELDS: list[Verb] = [
    lambda p: 1.5 - np.linalg.norm(p, axis=1),
    lambda p: 0.5 - np.hypot(np.hypot(p[:, 0], p[:, 1]) - 1.2, p[:, 2]),
    lambda p: 1 - np.linalg.norm(p * (1, 2, 0.7), axis=1),
    lambda p: np.maximum(
        0.8 - np.linalg.norm(p - 0.7, axis=1), 0.8 - np.linalg.norm(p + 0.7, axis=1)
    ),
    lambda p: 1.2 - np.abs(p).sum(axis=1),
    lambda p: -1 - p[:, 0] ** 2,
    lambda p: 1.0501 - np.abs(p).max(axis=1),
    lambda p: 0.3 - np.abs(p[:, 2] - 0.01),
    lambda p: 2.0 - np.linalg.norm(p[:, :2], axis=1),
    lambda p: 0.2 + 0 * p[:, 0],
]

#: Heights at which bodies are cut, none of them in a face, where the two engines differ.
HEIGHTS = [0.5, 0.1, 0.3, 0.2, 1.5, 0.5, 0.25, 1.5, 0.5, 5e-4]

SIZES: list[tuple[float, float, float]] = [
    *[(1, 2, 3), (0.5, 0.5, 0.5), (2, 9, 0.1), (6, 6, 6), (3, 1e-3, 1)],
]

#: Height, both radii, sides; the last five are a cone upside down, thin, flat, coarse and long.
CYLINDERS: list[tuple[Any, ...]] = [
    *[(1, 2, 2, 8), (3, 2, 1, 7), (0.5, 1, 3, 12), (2, 1, 0, 5), (9, 1, 1, 32)],
    *[(2, 0.0, 1, 6), (2, 1e-3, 1e-3, 8), (1e-3, 2, 2, 8), (1, 2, 2, 3), (1e3, 0.1, 0.1, 4)],
]

CORNERS = [(-1, -1, 1), (-1, 1, -1), (1, -1, -1), (1, 1, 1)]

TOOLS = [b.cube(1, center=True), b.sphere(0.5, segments=8)]


def unit(normal: Any, offset: float) -> tuple[Any, float]:
    """Return a plane as manifold3d takes it, with unit normal and offset."""
    length = float(np.linalg.norm(normal))
    return tuple(np.asarray(normal) / length), offset / length


def measures(found: Any) -> list[float]:
    """Return volume, area and Euler number of a result, or of each part of a list.

    Both libraries' genus is converted to the Euler number. manifold3d also has figures without
    volume, which are no sets here.
    """
    if isinstance(found, (list, tuple)):
        return [number for part in found for number in measures(part)]
    if isinstance(found, b.Solid):
        return [found.volume, found.area, found.euler_number]
    if isinstance(found, b.Region):
        return [found.area, found.perimeter, len(found.decompose())]
    if isinstance(found, manifold3d.CrossSection):
        loops = [np.asarray(loop) for loop in found.to_polygons()]
        around = sum(np.linalg.norm(np.roll(p, 1, axis=0) - p, axis=1).sum() for p in loops)
        return [found.area(), around, 0 if found.is_empty() else len(found.decompose())]
    if found.is_empty() or abs(found.volume()) < 1e-12:
        return [0, 0, 0]
    euler = 2 - 2 * found.genus()
    return [found.volume(), found.surface_area(), euler]


def by_size(parts: Any) -> list[Any]:
    return sorted(parts, key=lambda part: -part.volume())


#: Verb: what is ours, what is Manifold's, and arguments of ours.
ROWS: dict[str, tuple[Verb, Verb, list[tuple[Any, ...]]]] = {
    "hull_points": (
        b.hull,
        lambda points: Manifold.hull_points(np.array(points, dtype=np.float64)),
        [(cloud,) for cloud in clouds()],
    ),
    "hull": (b.hull, Manifold.hull, [(s,) for s in bodies()]),
    "batch_hull": (
        lambda s: b.hull(s, s.translate(2, 0, 1)),
        lambda s: Manifold.batch_hull([s, s.translate((2, 0, 1))]),
        [(s,) for s in bodies()],
    ),
    "minkowski_sum": (
        b.minkowski,
        lambda s, tool: s.minkowski_sum(tool),
        [(s, TOOLS[0]) for s in summands()],
    ),
    "minkowski_difference": (
        lambda s, tool: ~b.minkowski(~s, tool),
        lambda s, tool: s.minkowski_difference(tool),
        [(s, TOOLS[0].scale(0.5)) for s in summands()],
    ),
    "split": (
        lambda s, tool: list(s.split(tool)),
        lambda s, tool: list(s.split(tool)),
        [(s, TOOLS[1]) for s in bodies()],
    ),
    "split_by_plane": (
        lambda s, n, d: list(s.split(n, d))[::-1],
        lambda s, n, d: list(s.split_by_plane(*unit(n, d))),
        [(s, *PLANES[k % 5]) for k, s in enumerate(bodies())],
    ),
    "trim_by_plane": (
        lambda s, n, d: s.trim(n, d),
        lambda s, n, d: s.trim_by_plane(*unit(n, d)),
        [(s, *PLANES[(k + 1) % 5]) for k, s in enumerate(bodies())],
    ),
    "decompose": (
        b.Solid.decompose,
        lambda s: by_size(s.decompose()),
        [(s,) for s in bodies() if not s.equals(bodies()[7])] + [(bodies()[6].rotate(x=45),)],
    ),
    "rotate": (
        lambda s: s.rotate(x=10, y=20, z=30) & b.cube(2),
        lambda s: s.rotate((10, 20, 30)) ^ Manifold.cube((2, 2, 2)),
        [(s,) for s in bodies()],
    ),
    "scale": (
        lambda s: s.scale((1, 2, 3)),
        lambda s: s.scale((1, 2, 3)),
        [(s,) for s in bodies()],
    ),
    "mirror": (
        lambda s: s.mirror((1, 1, 0)) & b.cube(2),
        lambda s: s.mirror((1, 1, 0)) ^ Manifold.cube((2, 2, 2)),
        [(s,) for s in bodies()],
    ),
    "simplify": (
        lambda s: s.simplify(1e-6),
        lambda s: s.simplify(1e-6),
        [(s,) for s in bodies()],
    ),
    "refine": (
        lambda s: s.refine(3),
        lambda s: s.refine(3),
        [(s,) for s in bodies()],
    ),
    "refine_to_length": (
        lambda s: s.refine(edge_length=0.5),
        lambda s: s.refine_to_length(0.5),
        [(s,) for s in bodies()],
    ),
    "warp_batch": (
        lambda s, f: s.warp(f),
        lambda s, f: s.warp_batch(f),
        [(s, WARPS[k % 5]) for k, s in enumerate(bodies())],
    ),
    "level_set": (
        lambda f, edge: b.level_set(f, [(-2.1, -2.1, -2.1), (2.1, 2.1, 2.1)], edge),
        lambda f, edge: Manifold.level_set(
            lambda *p: float(f(np.array([p]))[0]), [-2.1] * 3 + [2.1] * 3, edge
        ),
        [(f, 0.3) for f in FIELDS],
    ),
    "translate": (
        lambda s: s.translate(1, 2, 3),
        lambda s: s.translate((1, 2, 3)),
        [(s,) for s in bodies()],
    ),
    "slice": (
        lambda s, height: s.slice(height),
        lambda s, height: s.slice(height),
        [(s, height) for s, height in zip(bodies(), HEIGHTS, strict=True)],
    ),
    "batch_boolean union": (
        b.union,
        lambda s, tool: Manifold.batch_boolean([s, tool], OpType.Add),
        [(s, TOOLS[k % 2]) for k, s in enumerate(bodies())],
    ),
    "batch_boolean intersection": (
        b.intersection,
        lambda s, tool: Manifold.batch_boolean([s, tool], OpType.Intersect),
        [(s, TOOLS[k % 2]) for k, s in enumerate(bodies())],
    ),
    "batch_boolean difference": (
        b.difference,
        lambda s, tool: Manifold.batch_boolean([s, tool], OpType.Subtract),
        [(s, TOOLS[k % 2]) for k, s in enumerate(bodies())],
    ),
    "compose": (
        lambda s: b.union(s, s.translate(50, 0, 0)),
        lambda s: Manifold.compose([s, s.translate((50, 0, 0))]),
        [(s,) for s in connected()],
    ),
    "cube": (
        lambda size, is_central: b.cube(size, center=is_central) & b.cube(3),
        lambda size, is_central: Manifold.cube(size, is_central) ^ Manifold.cube((3, 3, 3)),
        [(size, is_central) for size in SIZES for is_central in (False, True)],
    ),
    "cylinder": (
        lambda h, low, high, sides: b.cylinder(h, r1=low, r2=high, segments=sides),
        Manifold.cylinder,
        CYLINDERS,
    ),
    "tetrahedron": (
        lambda move: b.hull(CORNERS).translate(move, 0, 0) & b.cube(2),
        lambda move: Manifold.tetrahedron().translate((move, 0, 0)) ^ Manifold.cube((2, 2, 2)),
        [(move,) for move in (-0.5, 0.3, 0.7, 1.1, 1.9, 0, 1, 2, 3, -1)],
    ),
    "transform": (
        lambda s: s.transform(np.eye(4) + np.diag([0, 0, 0.5], 1)),
        lambda s: s.transform((np.eye(4) + np.diag([0, 0, 0.5], 1))[:3]),
        [(s,) for s in bodies()],
    ),
}

#: Methods of manifold3d without a row: those that `measures` uses, those that other tests of this
#: folder compare, and those without a counterpart here (see docs/compare.md).
TOLD_OTHERWISE = {
    *["volume", "surface_area", "genus", "is_empty", "bounding_box", "num_vert", "num_tri"],
    *["num_edge", "to_mesh", "to_mesh64", "status", "min_gap", "ray_cast", "project", "sphere"],
    *["extrude", "revolve", "calculate_normals", "calculate_curvature", "smooth", "smooth_out"],
    *["smooth_by_normals", "refine_to_tolerance", "get_tolerance", "set_tolerance", "warp"],
    *["original_id", "as_original", "reserve_ids", "num_prop", "num_prop_vert", "set_properties"],
    "with_context",
}


def theirs(argument: Any) -> Any:
    return argument.to_manifold() if isinstance(argument, b.Solid) else argument


@pytest.mark.parametrize("verb", ROWS)
def test_measures_are_those_of_manifold(verb: str) -> None:
    ours, other, inputs = ROWS[verb]
    # Coordinates differ by a step of the lattice, 1e-9; grids of fields by less than a cube.
    close = 0.05 if verb == "level_set" else 1e-7
    for number, given in enumerate(inputs):
        found, wanted = measures(ours(*given)), measures(other(*map(theirs, given)))
        assert found == pytest.approx(wanted, rel=close, abs=close), number


def test_each_verb_has_ten_inputs() -> None:
    assert all(len(inputs) == 10 for _, _, inputs in ROWS.values())


def test_balls_are_as_round_as_those_of_manifold() -> None:
    for r in (1e-3, 0.5, 1, 7, 1e3):
        for sides in (64, 128):
            ours, other = b.sphere(r, segments=sides), Manifold.sphere(r, sides)
            assert measures(ours) == pytest.approx(measures(other), rel=2e-2 * (64 / sides) ** 2)


def test_every_method_of_manifold_has_a_row() -> None:
    """Each is compared here or beside what the other modules of this folder compare."""
    rows = {name.split()[0] for name in ROWS}
    methods = {name for name in dir(Manifold) if not name.startswith("_")}
    assert methods - rows == TOLD_OTHERWISE


def test_genus_is_that_of_manifold_where_there_is_one_surface() -> None:
    single = [s for s in bodies() if len(s.faces) and s.normalized().to_mesh().surface_count == 1]
    assert len(single) >= 5
    for body in single:
        assert body.genus == body.to_manifold().genus() == 1 - body.euler_number // 2


def test_shadows_are_those_of_manifold() -> None:
    for body in bodies():
        turned = body.rotate((20, 30, 40))
        for one in (body, turned):
            wanted = one.to_manifold().project()
            assert one.project().area == pytest.approx(wanted.area(), rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("sides", [3, 4, 7, 32])
def test_straight_pipes_are_cylinders_of_manifold(sides: int) -> None:
    pipe = b.pipe([(0, 0, 0), (0, 0, 3)], 2, segments=sides)
    wanted = Manifold.cylinder(3, 2, 2, sides)
    assert measures(pipe) == pytest.approx(measures(wanted), rel=1e-7)


def test_gaps_are_those_of_manifold() -> None:
    moves = [(5, 0, 0), (5, 6, 7), (0, 0, 9), (-8, 3, 0), (6, 6, 0)]
    found = [
        (s, t.translate(move))
        for s, t in zip(bodies()[:5], bodies()[2:5] * 2, strict=False)
        for move in moves
    ]
    for one, other in found:
        wanted = one.to_manifold().min_gap(other.to_manifold(), 20)
        assert one.min_gap(other) == pytest.approx(wanted, abs=1e-8)


def test_rays_meet_what_manifolds_do() -> None:
    for body in bodies():
        start, end = RNG.normal(size=(2, 3)) * 5
        hits = body.to_manifold().ray_cast(tuple(start), tuple(end))
        found = body.ray_cast(start, end - start)
        assert found.t[found.t <= 1] == pytest.approx(
            sorted(hit.distance for hit in hits), abs=1e-7
        )
