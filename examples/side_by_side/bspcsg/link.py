import bspcsg as b

body = b.hull(b.sphere(6).translate(-20, 0, 0), b.sphere(10).translate(20, 0, 0))
part = body - b.cylinder(h=30, r=4, center=True).translate(20, 0, 0)
print(part.volume)
