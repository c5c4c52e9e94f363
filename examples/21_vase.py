"""A twisted vase with a wavy wall of even thickness."""

import numpy as np
from model import finish

import bspcsg as csg

height, wall, waves = 120.0, 2.4, 9

angle = np.linspace(0, 2 * np.pi, 180, endpoint=False)
radius = 30 + 3 * np.cos(waves * angle)
outline = csg.Region(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]))


def belly(share: np.ndarray) -> np.ndarray:
    """Return the size at each share of the height."""
    return 0.75 + 0.45 * np.sin(np.pi * (0.15 + 0.9 * share)) ** 2


path = [(0, 0, 0), (0, 0, height)]
way = {"twist": lambda t: 100 * t, "scale": belly, "segments": 60}
outside = csg.sweep(outline, path, **way)
inside = csg.sweep(outline.offset(-wall), path, **way)
vase = outside - (inside & csg.half_space((0, 0, -1), -4))

print(f"holds {(outside.volume - vase.volume) / 1000:.0f} ml, weighs {vase.volume * 1.24e-3:.0f} g")
finish("vase", vase, colours=["#d6a184"])
