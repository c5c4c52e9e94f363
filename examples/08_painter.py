"""The painter's algorithm: pictures without a z-buffer, cyclic overlaps included."""

import sys
from pathlib import Path

import numpy as np

import bspcsg as csg
from bspcsg import bsp

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
out.mkdir(parents=True, exist_ok=True)

# A bracket with holes, shaded and as a line drawing.
plate = csg.box((60, 40, 8)) | csg.box((8, 40, 30)) | csg.cylinder(h=20, r=9).translate(38, 20, 0)
part = plate - csg.cylinder(h=60, r=5).translate(38, 20, -5)
for x, y in ((16, 7), (16, 33), (53, 7), (53, 33)):
    part = part - csg.cylinder(h=30, r=3).translate(x, y, -5)
part = part - csg.cylinder(h=30, r=6).rotate((0, 90, 0)).translate(-5, 20, 19)

shaded = bsp.picture(part, size=(560, 420))
shaded.save(out / "painter_part.svg")
bsp.picture(part, size=(560, 420), style="hidden").save(out / "painter_lines.svg")
print(f"bracket: {len(part.to_mesh().faces)} triangles, {shaded}")

# Three bars, each over the next one: no order of whole bars is right, so the tree cuts.
bars = []
for turn in np.radians([0, 120, 240]):
    c, s = np.cos(turn), np.sin(turn)
    corners = np.array([(-3, -1.4, 0.6), (3, -1.4, -0.6), (3, -0.6, -0.6)])
    first, second, third = np.round(corners @ [(c, s, 0), (-s, c, 0), (0, 0, 1)], 3)
    bars.append([first, second, third, first + third - second])
tree = bsp.PartitionTree(np.array(bars), "first")
above = bsp.Camera.orthographic((0, 0, -1), scale=6.5, target=(0, 0.1, 0))
cycle = bsp.picture(tree, camera=above, size=(320, 300), colors=["#d1495b", "#edae49", "#00798c"])
cycle.save(out / "painter_cycle.svg")
painted = tree.back_to_front(direction=above.direction).source.tolist()
print(f"cycle: bars in the order of painting {painted}")

# A scan in perspective; y is up.
goat = bsp.PartitionTree.from_mesh(csg.load(Path(__file__).parent / "meshes" / "goathead.obj"))
towards = bsp.Camera.perspective((7, 5, 14), (0, 0, 0), up=(0, 1, 0), field_of_view=25)
portrait = towards.fitted(goat.fragments.vertices, 1.0)
scan = bsp.picture(goat, camera=portrait, size=(360, 360), colors="#dec4a0", crease=60)
scan.save(out / "painter_scan.png")
print(f"scan: {goat}, {scan}")

# In the plane the picture is a strip.
random = np.random.default_rng(3)
starts, arms = random.uniform(-8, 8, (14, 2)), random.uniform(-3, 3, (14, 2))
segments = bsp.PartitionTree(np.stack([starts, starts + arms], axis=1))
bsp.panorama(segments, eye=(0, 0), size=(480, 400)).save(out / "painter_plane.svg")
print(f"plane: {segments} around the eye")
