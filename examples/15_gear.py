"""An involute gear with a keyway."""

import numpy as np
from model import finish

import bspcsg as csg

module, teeth, pressure, thickness, bore = 2.0, 24, np.radians(20), 12, 12

pitch_radius = module * teeth / 2
base_radius = pitch_radius * np.cos(pressure)
tip_radius, root_radius = pitch_radius + module, pitch_radius - 1.25 * module

# The involute unwinds from the base circle; its polar angle at roll t is t - atan(t).
roll = np.linspace(0, np.sqrt((tip_radius / base_radius) ** 2 - 1), 12)
radii = base_radius * np.hypot(1, roll)
involute = roll - np.arctan(roll)
half_tooth = np.pi / (2 * teeth) + np.tan(pressure) - pressure

flank = np.concatenate([[half_tooth], half_tooth - involute])
radii = np.concatenate([[root_radius], radii])
right = np.column_stack([radii * np.cos(flank), -radii * np.sin(flank)])
left = right[::-1] * (1, -1)
tooth = np.concatenate([right, left])

turns = 2 * np.pi * np.arange(teeth) / teeth
outline = [tooth @ np.array([(np.cos(a), np.sin(a)), (-np.sin(a), np.cos(a))]) for a in turns]
blank = csg.Region(np.concatenate(outline))

keyway = csg.Region.rectangle(4, bore / 2 + 1.8).translate(-2, 0)
pockets = csg.polar_pattern(csg.Region.circle(3.2, 32).translate(13, 0), 6)
gear = (blank - csg.Region.circle(bore / 2) - keyway - pockets).extrude(thickness)
hub = (csg.Region.circle(10) - csg.Region.circle(bore / 2) - keyway).extrude(thickness + 6)

part = gear | hub
print(f"{teeth} teeth of module {module}: tips at {part.bounds[1, 0]:.3f} mm")
finish("gear", part, colours=["#c9b27c"])
