import trimesh
from trimesh.creation import box, cylinder

places = [(20 * i - 30, 15 * j - 15, 0) for i in range(4) for j in range(3)]
holes = [cylinder(2.5, 6, 32).apply_translation(place) for place in places]
part = trimesh.boolean.difference([box((90, 60, 4)), *holes])
print(part.volume)
