import bspcsg as b

part = b.rounded_box((40, 30, 12), 3, center=True) - b.cylinder(h=20, d=8, center=True)
print(part.volume)
