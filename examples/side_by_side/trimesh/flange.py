import numpy as np
from trimesh.creation import cylinder

turns = np.arange(6) * np.pi / 3
places = 45 * np.column_stack([np.cos(turns), np.sin(turns), np.zeros(6)])
holes = [cylinder(4.5, 20, 32).apply_translation(place) for place in places]
heads = [cylinder(7.5, 10, 32).apply_translation(place + (0, 0, 7)) for place in places]
body = cylinder(60, 14, 32).union(cylinder(30, 40, 32).apply_translation((0, 0, 13)))
part = body.difference([cylinder(22.5, 100, 32), *holes, *heads])
print(part.volume)
