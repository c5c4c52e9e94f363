"""A pipe flange with a raised face, a neck and eight bolt holes."""

from model import finish

import bspcsg as csg

bore, outer, circle, bolts = 54.5, 165, 125, 8

section = [
    (bore / 2, 0), (50, 0), (50, 3), (outer / 2, 3), (outer / 2, 21),
    (46, 21), (33, 40), (33, 48), (bore / 2, 48),
]  # fmt: skip
body = csg.revolve(section, segments=96)
rim = body.edges().where(lambda e: e.ends[:, :, 2].min(axis=1) >= 48)
inner = rim.where(lambda e: (e.middle[:, :2] ** 2).sum(axis=1) > 30**2)
body = body.chamfer(inner, 2)

hole = csg.cylinder(40, d=18).translate(circle / 2, 0, -5)
flange = body - csg.polar_pattern(hole, bolts)

print("holes:", flange.genus, "(eight bolts and the bore)")
print(f"mass in steel: {flange.volume * 7.85e-6:.2f} kg")
finish("flange", flange, colours=["#b7a6a0"])
