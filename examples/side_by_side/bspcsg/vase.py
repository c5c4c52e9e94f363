import bspcsg as b

part = b.Region.circle(20, 6).extrude(60, twist=90, slices=60)
print(part.volume)
