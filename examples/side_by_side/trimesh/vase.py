import numpy as np
import trimesh
from shapely import Polygon

turns = np.arange(6) * np.pi / 3
hexagon = Polygon(20 * np.column_stack([np.cos(turns), np.sin(turns)]))
path = np.linspace((0, 0, 0), (0, 0, 60), 61)
part = trimesh.creation.sweep_polygon(hexagon, path, angles=np.linspace(0, -np.pi / 2, 61))
print(part.volume)
