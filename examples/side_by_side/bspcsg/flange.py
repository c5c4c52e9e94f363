import bspcsg as csg

body = csg.cylinder(h=14, d=120) | csg.cylinder(h=40, d=60)
hole = csg.cylinder(h=14, d=9) | csg.cylinder(h=5, d=15).translate(z=9)
holes = csg.polar_pattern(hole.translate(x=45), 6)
part = body - csg.cylinder(h=40, d=45) - holes
print(part.volume)
