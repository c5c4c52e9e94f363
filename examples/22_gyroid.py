"""A bracket whose inside is a gyroid: light, and open everywhere."""

import numpy as np
from model import finish

import bspcsg as csg

thick, skin, period, cell = 24.0, 2.0, 15.0, 1.5

corner = csg.Region([(0, 0), (60, 0), (60, 14), (30, 20), (20, 30), (14, 60), (0, 60)])
outline = corner.offset(-4).offset(4)
bracket = outline.extrude(thick)


def gyroid(points: np.ndarray) -> np.ndarray:
    """Return how far inside the wall of a gyroid points are, roughly in units of its slope."""
    x, y, z = (2 * np.pi / period * (points + 2)).T
    return 0.45 - np.abs(np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x))


lattice = csg.level_set(gyroid, [(0, 0, 0), (60, 60, thick)], cell)
wall = (outline - outline.offset(-skin)).extrude(thick)
bores = [csg.cylinder(3 * thick, d=8).translate(x, y, -thick) for x, y in ((48, 7), (7, 48))]
sleeves = [csg.cylinder(thick, d=12).translate(x, y, 0) for x, y in ((48, 7), (7, 48))]
part = (bracket & (lattice | wall | csg.union(sleeves))) - csg.union(bores)

print(f"share of the full bracket: {part.volume / bracket.volume:.3f}, handles: {part.genus}")
finish("gyroid", part, colours=["#8fb3a7"], crease=45)
