"""Rays through solids."""

from typing import Any

import numpy as np

from ...bsp import HitLists, Hits, RayCaster
from ...solid.ledger import uncounted
from ...solid.solid import Solid


@uncounted
def ray_cast(solid: Solid, origin: Any, direction: Any) -> Hits | HitLists:
    """Return the hits of one or more rays on a solid's surface, nearest first.

    One ray gives `Hits`, an array of rays gives `HitLists`; see `Solid.ray_cast`.
    """
    lists = RayCaster(solid).all_hits(origin, direction, merge=True)
    return lists[0] if np.ndim(origin) == np.ndim(direction) == 1 else lists
