"""A small table of parts: what they weigh, and that none clashes with another."""

from itertools import combinations

from model import finish

import bspcsg as b

OAK, STEEL = 7.2e-7, 7.85e-6  # kg/mm³

board = b.box(600, 400, 24, center=True)
top = board.fillet(board.edges().parallel("z"), 40)
top = top.chamfer(top.edges().where(lambda e: e.ends[:, :, 2].min(axis=1) > 0), 3)
leg = b.cylinder(400, d1=26, d2=40, segments=48)
sink = b.cone(3, d=12, segments=32).mirror((0, 0, 1)).translate(0, 0, 3)
screw = b.cylinder(30, d=5, segments=32).translate(0, 0, -30) | sink.translate(0, 0, -3)

corners = [(x, y, 400) for x in (-240, 240) for y in (-140, 140)]
parts = [("top", "#c9a26b", OAK, top.translate(0, 0, 412))]
for x, y, z in corners:
    parts.append(("leg", "#8b6b45", OAK, leg.translate(x, y, 0)))
    parts.append(("screw", "#b8bcc4", STEEL, screw.translate(x, y, z + 24)))
# Screws sit in bores of their own shape.
screws = b.union(part for name, _, _, part in parts if name == "screw")
parts = [(n, c, d, part if n == "screw" else part - screws) for n, c, d, part in parts]

total = 0.0
for name in ("top", "leg", "screw"):
    masses = [density * part.volume for own, _, density, part in parts if own == name]
    total += sum(masses)
    print(f"{len(masses)} x {name:6} {masses[0]:7.3f} kg each {sum(masses):7.3f} kg")
print(f"all together       {total:7.3f} kg")

pairs = combinations([part for *_, part in parts], 2)
print("clashes:", sum(not one.isdisjoint(other) for one, other in pairs))
finish("assembly", *(part for *_, part in parts), colours=[colour for _, colour, *_ in parts])
