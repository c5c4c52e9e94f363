import bspcsg as csg

rib = csg.extrude([(0, 0), (35, 0), (0, 35)], 5).rotate(x=90).translate(y=22.5)
body = csg.box(50, 40, 5) | csg.box(5, 40, 50) | rib
foot, back = body.faces().on("z", 0), body.faces().on("x", 0)
drilled = body.hole(foot, [(38, 8, 0), (38, 32, 0)], d=6)
part = drilled.hole(back, [(0, 8, 38), (0, 32, 38)], d=6)
print(part.volume)
