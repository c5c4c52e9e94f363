import bspcsg as csg

body = csg.hull(csg.sphere(6).translate(-20, 0, 0), csg.sphere(10).translate(20, 0, 0))
part = body - csg.cylinder(h=30, r=4, center=True).translate(20, 0, 0)
print(part.volume)
