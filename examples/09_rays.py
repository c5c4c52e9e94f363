"""A scan by ray casting: normals and depth of what a camera sees, with shadows, and a section."""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

import bspcsg as csg
from bspcsg import bsp

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
size = int(sys.argv[2]) if len(sys.argv) > 2 else 400
out.mkdir(exist_ok=True)

goat = csg.load(Path(__file__).parent / "meshes" / "goathead.obj")
low, high = goat.bounds
middle, reach = (low + high) / 2, float(np.linalg.norm(high - low))
caster = bsp.RayCaster(goat)

# A camera in front, a little to the side: one ray for each pixel.
eye = middle + reach * np.array([0.5, 0.25, 1.1])
forward = (middle - eye) / np.linalg.norm(middle - eye)
right = np.cross(forward, [0, 1, 0])
right /= np.linalg.norm(right)
up = np.cross(right, forward)
across = np.linspace(-0.3, 0.3, size)
x, y = np.meshgrid(across, -across)
directions = (forward + x[..., None] * right + y[..., None] * up).reshape(-1, 3)
hits = caster.first_hit(eye, directions)

# Shadow rays start a little above the surface and run to the lamp.
lamp = middle + reach * np.array([-1.2, 1.5, 1.0])
seen = hits.hit
start = hits.point[seen] + 1e-3 * hits.normal[seen]
towards = lamp - start
towards /= np.linalg.norm(towards, axis=1, keepdims=True)
lit = np.clip((hits.normal[seen] * towards).sum(axis=1), 0, 1) * ~caster.occluded(start, lamp)

# How much of each ray is inside: an X-ray.
thickness = caster.intervals(eye, directions).lengths()

tiles = np.ones((3, size * size, 3))
tiles[0, seen] = (0.25 + 0.75 * lit)[:, None] * (hits.normal[seen] * 0.35 + 0.65)
depth = hits.t[seen]
tiles[1, seen] = 1 - 0.9 * ((depth - depth.min()) / np.ptp(depth))[:, None]
tiles[2] = np.exp(-4 * thickness / thickness.max())[:, None]
picture = np.concatenate(list(tiles.reshape(3, size, size, 3)), axis=1)
Image.fromarray(np.round(picture * 255).astype(np.uint8)).save(out / "rays.png")

kinds = np.bincount(hits.kind + 1, minlength=4)
print(f"{len(directions)} rays at {len(caster)} triangles: {int(seen.sum())} hits")
for name, count in zip(("misses", "interior", "edge", "vertex"), kinds, strict=True):
    print(f"  {name:9}{count:7d}")
print(f"in shadow {np.mean(lit == 0):.0%}, deepest {thickness.max():.2f} units")
