"""Normals, curvatures and smoothing against those of manifold3d, on ten inputs each."""

from typing import Any

import manifold3d
import numpy as np
import numpy.typing as npt
import pytest

import bspcsg as b

Floats = npt.NDArray[np.float64]

#: The last five are special: holed, apart, hollow, joined, thin.
BODIES = {
    "cube": b.cube(2),
    "ball": b.sphere(1.5, segments=12),
    "ring": b.torus(3, 1, segments=12, tube_segments=8),
    "pipe": b.cylinder(3, 1, segments=7) - b.cylinder(3, 0.5, segments=5),
    "eight": b.hull(np.concatenate([np.eye(3), -np.eye(3)])),
    "frame": ((b.box(4, 4, 1)) - b.box(2, 2, 1).translate(1, 1, 0)).rotate(x=10, y=20, z=30),
    "pair": b.cube(1) | b.cube(2).translate(3, 0, 0),
    "hollow": b.cube(3) - b.cube(1).translate(1, 1, 1),
    "joined": b.cube(1) | b.cube(1).translate(1, 0, 0),
    "foil": b.box((1, 1, 1e-3)),
}

#: None of their edges bends by 60 degrees, except around the ends of cans.
ROUND = {
    **{f"ball-{n}": b.sphere(1, segments=n) for n in (8, 12, 24)},
    **{f"ring-{n}": b.torus(3, 1, segments=n, tube_segments=n) for n in (12, 24)},
    **{f"can-{n}": b.cylinder(2, 1, segments=n) for n in (8, 12, 24)},
    "turned": b.sphere(2, segments=12).rotate(x=10, y=20, z=30),
    "long": b.sphere(1, segments=12).scale((1, 1, 3)),
}


def columns(made: manifold3d.Manifold) -> tuple[Floats, npt.NDArray[np.int64]]:
    """Return manifold3d's properties of vertices, after the coordinates, and its triangles."""
    mesh = made.to_mesh64()
    return np.array(mesh.vert_properties), np.array(mesh.tri_verts, dtype=np.int64)


def by_place(corners: Floats, values: Floats) -> dict[Any, Floats]:
    """Return the values at each triangle's corners, by the corners from the least one on."""
    found = {}
    for places, own in zip(np.round(corners, 6).tolist(), values, strict=True):
        first = min(range(3), key=lambda k: tuple(places[k]))
        order = [first, (first + 1) % 3, (first + 2) % 3]
        found[tuple(tuple(places[k]) for k in order)] = own[order]
    return found


def test_there_are_ten_of_each() -> None:
    assert len(BODIES) == len(ROUND) == 10


@pytest.mark.parametrize("angle", [20, 52.5, 180])
@pytest.mark.parametrize("name", BODIES)
def test_normals_are_those_of_manifold(name: str, angle: float) -> None:
    body = BODIES[name]
    mesh = body.normalized().to_mesh()
    ours = by_place(mesh.vertices[mesh.faces], body.normals(angle))
    table, triangles = columns(body.to_manifold().calculate_normals(0, angle))
    theirs = by_place(table[triangles][:, :, :3], table[triangles][:, :, 3:6])
    assert set(ours) == set(theirs)
    assert all(ours[place] == pytest.approx(theirs[place], abs=1e-9) for place in ours)


@pytest.mark.parametrize("name", BODIES)
def test_curvatures_are_those_of_manifold(name: str) -> None:
    """Manifold takes twice the average triangle at a vertex, here it is a third of their sum.

    It has no mean where the cosine between faces of one plane is rounded to more than 1, and takes
    the supplement of bends beyond 90 degrees, which no edge has here.
    """
    body = BODIES[name]
    mesh = body.normalized().to_mesh()
    gaussian, mean = body.curvature()
    weights = np.bincount(mesh.faces.ravel()) / 6
    ours = np.column_stack([gaussian, 2 * mean]) * weights[:, None]
    places = {tuple(point): k for k, point in enumerate(np.round(mesh.vertices, 6).tolist())}
    table, _ = columns(body.to_manifold().calculate_curvature(0, 1))
    rows = [places[tuple(point)] for point in np.round(table[:, :3], 6).tolist()]
    assert sorted(rows) == list(range(len(mesh.vertices)))
    is_told = np.isfinite(table[:, 3:5])
    assert is_told[:, 0].all()
    assert ours[rows][is_told] == pytest.approx(table[:, 3:5][is_told], rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("name", ROUND)
def test_smooth_bodies_gain_what_those_of_manifold_do(name: str) -> None:
    """The curves between the corners are others, and both come near the round body."""
    body = ROUND[name]
    ours = body.smooth(4, sharp_angle=60)
    theirs = body.to_manifold().smooth_out(60, 0).refine(4)
    assert len(ours.faces) == theirs.num_tri() == 16 * len(body.faces)
    assert ours.euler_number == 2 - 2 * theirs.genus()
    gain = theirs.volume() - body.volume
    assert gain > 0 and ours.volume - body.volume == pytest.approx(gain, rel=0.2)
    assert ours.area == pytest.approx(theirs.surface_area(), rel=0.02)
