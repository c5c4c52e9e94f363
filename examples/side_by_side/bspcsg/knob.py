import bspcsg as csg

part = csg.rounded_box((40, 30, 12), 3, center=True) - csg.cylinder(h=20, d=8, center=True)
print(part.volume)
