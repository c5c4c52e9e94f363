"""A plate, three holes and a slot: operators, exact volume, a file."""

import sys
from pathlib import Path

import bspcsg as csg

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
out.mkdir(exist_ok=True)

plate = csg.box((60, 30, 4))
hole = csg.cylinder(h=10, r=3, segments=48)
part = plate
for x in (10, 25, 40):
    part = part - hole.translate(x, 15, -3)
part = part - csg.box((4, 20, 10)).translate(50, 5, -3)

print(part)
print("volume", part.volume, "=", part.volume_exact)
print("holes", part.genus)
part.save(out / "plate.stl")
