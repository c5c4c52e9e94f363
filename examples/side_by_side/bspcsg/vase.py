import bspcsg as csg

part = csg.Region.circle(20, 6).extrude(60, twist=90, slices=60)
print(part.volume)
