"""Cut a random piece off and put it back, again and again: the solid does not change."""

import numpy as np

import bspcsg as csg

rng = np.random.default_rng(1)
start = csg.sphere(1, segments=32)
solid = start
for k in range(1, 21):
    tool = csg.cube(1, center=True).rotate(rng.uniform(0, 360, 3)).translate(rng.uniform(-1, 1, 3))
    solid = (solid - tool) | (solid & tool)
    if k % 5 == 0:
        mesh = solid.to_mesh()
        print(
            f"after {k:2d} rounds: {len(mesh.faces)} triangles, {mesh.surface_count} part,", end=" "
        )
        print("equal to the start:", solid.equals(start))
