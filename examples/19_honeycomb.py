"""A sandwich panel: two sheets and a honeycomb between them, one sheet drawn aside."""

import math

from model import finish

import bspcsg as csg

cell, web, width, depth, core, sheet = 10.0, 0.8, 120.0, 80.0, 12.0, 1.0

# Hexagons with their flats at x = ±cell/2 lie in two grids, one half a step behind the other.
hexagon = csg.Region.circle((cell - web) / math.sqrt(3), 6).rotate(30)
step = cell * math.sqrt(3)
row = csg.grid(hexagon, (14, 6), (cell, step), center=True)
cells = row | row.translate(cell / 2, step / 2)

panel = csg.Region.rectangle(width, depth, center=True)
frame = panel - csg.Region.rectangle(width - 4, depth - 4, center=True)
comb = ((panel - cells) | frame).extrude(core)
plate = panel.extrude(sheet)
sandwich = plate | comb.translate(0, 0, sheet) | plate.translate(0, 0, sheet + core)

print("closed cells inside:", sandwich.to_mesh().surface_count - 1)
solid = panel.extrude(core + 2 * sheet)
print(f"share of a solid panel's volume: {sandwich.volume / solid.volume:.3f}")
finish("honeycomb", plate | comb.translate(0, 0, sheet), colours=["#d9b23d"])
