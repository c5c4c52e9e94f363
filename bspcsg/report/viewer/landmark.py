"""`Landmark`: a point of a model that somebody may want to look at."""

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
        The distance around it that is to be seen, in model units.
    """

    name: str
    at: FloatArray
    size: float
