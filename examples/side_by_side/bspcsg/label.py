import bspcsg as b

name = b.text("Workshop", size=8, halign="center", valign="center")
part = b.box(60, 16, 2, center=True) | name.extrude(2)
print(part.volume)
