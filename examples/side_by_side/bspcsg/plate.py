import bspcsg as csg

holes = csg.grid(csg.cylinder(h=6, d=5, center=True), (4, 3), (20, 15), center=True)
part = csg.box(90, 60, 4, center=True) - holes
print(part.volume)
