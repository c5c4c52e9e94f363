"""Two overlapping unit cubes near and far from the origin, here and in manifold3d."""

import manifold3d
import numpy as np

import bspcsg as csg

vertices, faces = csg.cube(1).to_mesh()


def theirs(points: np.ndarray) -> "manifold3d.Manifold":
    return manifold3d.Manifold(manifold3d.Mesh64(points, faces.astype(np.uint64)))


print(f"{'x':>8} {'exact':>8} {'manifold3d':>12}")
for far in (0.0, 1e6, 1e9, 1e12):
    first = vertices + np.array([far, 0, 0])
    second = first + 0.5
    union = csg.Solid(first, faces) | csg.Solid(second, faces)
    volume = (theirs(first) + theirs(second)).volume()
    print(f"{far:8.0e} {union.volume_exact!s:>8} {volume:12.6f}")
