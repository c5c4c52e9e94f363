"""A name plate: raised letters on a plate with round corners and screw holes."""

from model import finish

import bspcsg as csg

letters = csg.text("exactly.", size=20, halign="center", valign="center")
low, high = letters.bounds
plate = csg.Region.rectangle(*(high - low + 22), center=True).translate(*(low + high) / 2)
plate = plate.offset(-5).offset(5, segments=48)

hole = csg.Region.circle(2, 32)
middle, reach = (low + high) / 2, (high - low) / 2 + 6
holes = csg.grid(hole, (2, 2), 2 * reach, center=True).translate(*middle)

base = (plate - holes).extrude(3)
rim = (plate - plate.offset(-1.5)).extrude(4)

print("letters:", len(letters.components), "parts,", len(letters.outlines), "outlines")
raised = letters.extrude(2).translate(0, 0, 3)
finish("text_plate", base | rim, raised, colours=["#7fa88b", "#f2efe6"])
