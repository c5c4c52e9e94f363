"""Short scripts, and the volumes of their results."""

from typing import Any

from bspcsg import csg
from bspcsg.bsp import Region

MOVED = "multmatrix([[1, 0, 0, {}], [0, 1, 0, {}], [0, 0, 1, {}], [0, 0, 0, 1]])"
TETRAHEDRON = "points = [[0, 0, 0], [6, 0, 0], [0, 1, 0], [0, 0, 1]]"


def moved(x: float, y: float, z: float) -> str:
    return MOVED.format(x, y, z)


def region(text: str) -> Region:
    found = csg.evaluate(csg.parse(text))
    assert isinstance(found, Region)
    return found


def volume(text: str, **options: Any) -> float:
    return csg.loads(text, **options).volume
