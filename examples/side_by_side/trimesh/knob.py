from itertools import product

import trimesh
from trimesh.creation import cylinder, icosphere

corners = product((-17, 17), (-12, 12), (-3, 3))
balls = [icosphere(3, 3).apply_translation(corner) for corner in corners]
body = trimesh.util.concatenate(balls).convex_hull
part = body.difference(cylinder(4, 20, 32))
print(part.volume)
