"""`Landmark`: a named point of a model that a 3D view can show."""

from dataclasses import dataclass

from ..._types import FloatArray


@dataclass(frozen=True, eq=False)
class Landmark:
    """A named point of a model, such as a hole, that a 3D view can show.

    Parameters
    ----------
    name : str
        The label of the point.
    at : (3,) float64
        The point, in model units.
    size : float
        The radius of the surroundings to show, in model units.
    """

    name: str
    at: FloatArray
    size: float
