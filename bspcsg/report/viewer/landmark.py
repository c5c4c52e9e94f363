"""`Landmark`: a point of a model that somebody may want to look at."""

from dataclasses import dataclass

from ..._types import FloatArray


@dataclass(frozen=True, eq=False)
class Landmark:
    """A point with a name.

    Parameters
    ----------
    name : str
        What is there.
    at : (3,) float64
        In model units.
    size : float
        How far around it is to be seen, in model units.
    """

    name: str
    at: FloatArray
    size: float
