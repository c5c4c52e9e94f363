"""A duct from a square flange to a round pipe, bent on its way, of even wall."""

import numpy as np
from model import finish

import bspcsg as csg

side, r, wall, bend, steps = 40.0, 16.0, 1.5, 60.0, 16


def place(turn: float) -> np.ndarray:
    """Return the matrix that stands a profile on an arc, so many degrees along it."""
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    return np.array([(c, 0, s, bend * (1 - c)), (0, 1, 0, 0), (-s, 0, c, bend * s), (0, 0, 0, 1)])


def duct(inset: float) -> csg.Solid:
    """Return the loft whose sections turn from a square to a circle."""
    angle = np.linspace(0, 2 * np.pi, 96, endpoint=False)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    square = circle / np.abs(circle).max(axis=1, keepdims=True)
    profiles = []
    for turn in np.linspace(-4, 94, steps) if inset else np.linspace(0, 90, steps):
        share = np.clip(turn / 90, 0, 1)
        share = share * share * (3 - 2 * share)
        outline = (1 - share) * (side / 2 - inset) * square + share * (r - inset) * circle
        profiles.append((outline, place(turn)))
    return csg.loft(profiles)


plate = csg.box(side + 16, side + 16, 4, center=True)
holes = csg.grid(csg.cylinder(9, d=4.5, center=True), (2, 2), (side + 7, side + 7), center=True)
part = (duct(0) | (plate - holes)) - duct(wall)

print("ways through:", part.genus, "(four screws and the duct)")
finish("duct", part, colours=["#a9b4c4"])
