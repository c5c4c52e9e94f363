"""A toy brick of four by two studs, with tubes that hold the studs of the next one."""

from model import finish

import bspcsg as csg

unit, height, wall, play = 8.0, 9.6, 1.5, 0.1
along, across = 4, 2
length, width = along * unit - 2 * play, across * unit - 2 * play

stud = csg.cylinder(1.8, d=4.8, segments=48)
studs = csg.grid(stud, (along, across), (unit, unit), center=True)
tube = csg.cylinder(height - 1, d=6.5137, segments=48) - csg.cylinder(height, d=4.8, segments=48)
tubes = csg.grid(tube, (along - 1, across - 1), (unit, unit), center=True)

hollow = csg.box(length - 2 * wall, width - 2 * wall, height - 1, center=True)
shell = csg.box(length, width, height, center=True).translate(0, 0, height / 2)
shell = shell - hollow.translate(0, 0, (height - 1) / 2)
brick = shell | tubes | studs.translate(0, 0, height)

above = brick.translate(0, 0, height)
print("two bricks, one on the other, share", round((brick & above).volume, 3), "mm³")
turned = brick.rotate(180, "x").translate(0, 24, height)
finish("brick", brick, turned, colours=["#d1495b", "#edae49"])
