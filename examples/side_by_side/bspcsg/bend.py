import bspcsg as csg

part = csg.pipe([(0, 0, 0), (30, 0, 0), (30, 30, 0), (30, 30, 30)], 4, inner=3)
print(part.volume)
