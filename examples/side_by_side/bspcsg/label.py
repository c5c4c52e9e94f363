import bspcsg as csg

name = csg.text("Workshop", size=8, halign="center", valign="center")
part = csg.box(60, 16, 2, center=True) | name.extrude(2)
print(part.volume)
