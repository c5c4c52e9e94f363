import trimesh
from trimesh.creation import cylinder, icosphere

left = icosphere(3, 6).apply_translation((-20, 0, 0))
right = icosphere(3, 10).apply_translation((20, 0, 0))
body = trimesh.util.concatenate([left, right]).convex_hull
part = body.difference(cylinder(4, 30, 32).apply_translation((20, 0, 0)))
print(part.volume)
