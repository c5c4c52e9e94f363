"""A profile drawn in the plane: holes, extrusion, sections, and back to a drawing."""

import sys
from pathlib import Path

from bspcsg import bsp

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
out.mkdir(exist_ok=True)

Region = bsp.Region
slot = Region.rectangle(30, 8, center=True) | Region.circle(4, 48).translate(15, 0)
slot = slot | Region.circle(4, 48).translate(-15, 0)
profile = Region.rectangle(80, 50, center=True) - slot
for x in (-32, 32):
    for y in (-17, 17):
        profile = profile - Region.circle(3, 32).translate(x, y)
profile = profile - Region([(-40, 25), (-40, 10), (-25, 25)], winding="nonzero")

print(profile)
print("area", profile.area, "perimeter", round(profile.perimeter, 6))
print("centroid", profile.centroid)
for number, outline in enumerate(profile.outlines):
    kind = f"hole of {outline.parent}" if outline.is_hole else "outer"
    print(f"outline {number}: {kind}, {len(outline.points)} corners, area {outline.area:.3f}")

print("line through the middle:", profile.cast((-50, 0), (1, 0)).round(6).tolist())
nearest, distance = profile.nearest([(0, 0)])
print("nearest to the origin:", nearest[0], "at", distance[0])
print("convex parts:", len(profile.convex_parts()))

solid = profile.extrude(12) - profile.scale(0.5).extrude(6).translate(0, 0, 6)
print(solid, "volume", solid.volume)
assert profile.extrude(12).slice(5).equals(Region(profile))
profile.to_svg(out / "profile.svg")
for name, section in {
    "section_low": solid.slice(3),
    "section_high": solid.slice(9),
    "section_side": solid.slice(5, (0, 1, 0)),
    "section_slanted": solid.slice(origin=(0, 0, 6), normal=(1, 0, 2)),
}.items():
    section.to_svg(out / f"{name}.svg")
    print(name, section)
print("again from the file:", Region.from_svg(out / "profile.svg").equals(Region(profile)))
