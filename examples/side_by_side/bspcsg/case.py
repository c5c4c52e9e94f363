import bspcsg as csg

outline = csg.Region.rectangle(80, 50, center=True).fillet(6)
room = outline.offset(-2).extrude(28).translate(z=2)
rim = outline.offset(-1).extrude(2).translate(z=28)
part = outline.extrude(30) - room - rim
print(part.volume)
