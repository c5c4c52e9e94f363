"""`Landmark`: a point of interest of a model."""

from dataclasses import dataclass

from ..._types import FloatArray


@dataclass(frozen=True, eq=False)
class Landmark:
    """A point with a name.

    Parameters
    ----------
    name : str
        The name of the place.
    at : (3,) float64
        In model units.
    size : float
        The radius of the surroundings to show, in model units.
    """

    name: str
    at: FloatArray
    size: float
