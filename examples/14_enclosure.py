"""An enclosure with bosses, and its lid with a lip that fits."""

from model import finish

import bspcsg as csg

length, width, height, wall, r, gap = 80, 50, 28, 2.5, 6, 0.2


def block(inset: float, h: float) -> csg.Solid:
    """Return an upright box with round corners, so far inside the outer walls."""
    box = csg.box(length - 2 * inset, width - 2 * inset, h, center=True).translate(0, 0, h / 2)
    return box.fillet(box.edges().parallel("z"), r - inset)


def at_screws(part: csg.Solid) -> csg.Solid:
    """Return a part at each of the four screws."""
    return csg.grid(part, (2, 2), (length - 15, width - 15), center=True)


shell = block(0, height) - block(wall, height).translate(0, 0, wall)
bosses = at_screws(csg.cylinder(height - 4, d=9)) & block(0, height)
pilots = at_screws(csg.cylinder(height, d=2.5).translate(0, 0, 6))
cable = csg.cylinder(20, d=6).rotate(90, "y").translate(length / 2 - 10, 0, 14)
body = (shell | bosses) - pilots - cable

lip = block(wall + gap, 3) - block(2 * wall, 3)
corners = at_screws(csg.cylinder(3, d=10))
sink = csg.cylinder(3, r1=0, d2=6)
screws = at_screws(csg.cylinder(9, d=3.2).translate(0, 0, -4) | sink)
lid = (block(0, 3) | (lip - corners).translate(0, 0, -3)) - screws
closed = lid.translate(0, 0, height)

print("the closed lid and the body share", (closed & body).volume, "mm³")
print("between lip and walls:", round((lip.translate(0, 0, height - 3)).min_gap(shell), 3), "mm")
finish("enclosure", body, lid.translate(0, 0, height + 22), colours=["#9db8d2", "#d2c49d"])
