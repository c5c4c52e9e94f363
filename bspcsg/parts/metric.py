"""Sizes of metric threads, bolts and nuts, M3 to M20."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from ..errors import invalid_parameter
from ..parameters import shown

#: The height of the fundamental triangle of a thread profile, as a multiple of the thread's pitch.
_HEIGHT = math.sqrt(3) / 2


@dataclass(frozen=True)
class MetricSize:
    """The dimensions of a metric thread, bolt and nut of one nominal diameter, in millimetres.

    Parameters
    ----------
    diameter : float
        The nominal diameter, which is the major diameter (ISO 261).
    pitch : float
        The coarse pitch of the thread (ISO 261).
    allowance : float
        The least reduction in diameter of threads of tolerance 6g (ISO 965-1).
    flats : float
        The width across flats of bolts and nuts (ISO 4014, ISO 4032).
    head : float
        The height of a bolt's head (ISO 4014, nominal).
    nut : float
        The height of a nut (ISO 4032, maximum).

    Examples
    --------
    >>> import bspcsg as csg
    >>> size = csg.parts.metric("M10")
    >>> size.pitch, round(size.pitch_diameter, 3), round(size.minor_diameter, 3)
    (1.5, 9.026, 8.376)
    """

    diameter: float
    pitch: float
    allowance: float
    flats: float
    head: float
    nut: float

    @property
    def pitch_diameter(self) -> float:
        """The diameter at which ridges and grooves of the thread are equally wide (ISO 724)."""
        return self.diameter - 2 * 3 / 8 * _HEIGHT * self.pitch

    @property
    def minor_diameter(self) -> float:
        """The inner diameter of an internal thread (ISO 724)."""
        return self.diameter - 2 * 5 / 8 * _HEIGHT * self.pitch

    @property
    def root_diameter(self) -> float:
        """The inner diameter of an external thread, where its round root is deepest (ISO 68-1)."""
        return self.diameter - 2 * 17 / 24 * _HEIGHT * self.pitch

    def threaded(self, length: float) -> float:
        """Return the thread length of a bolt of a given length, in millimetres (ISO 4014)."""
        longer = 6 if length <= 125 else 12 if length <= 200 else 25
        return min(2 * self.diameter + longer, length)


#: The metric sizes from M3 to M20, by name.
METRIC: Mapping[str, MetricSize] = MappingProxyType(
    {
        "M3": MetricSize(3, 0.5, 0.020, 5.5, 2.0, 2.4),
        "M3.5": MetricSize(3.5, 0.6, 0.021, 6, 2.4, 2.8),
        "M4": MetricSize(4, 0.7, 0.022, 7, 2.8, 3.2),
        "M5": MetricSize(5, 0.8, 0.024, 8, 3.5, 4.7),
        "M6": MetricSize(6, 1.0, 0.026, 10, 4.0, 5.2),
        "M8": MetricSize(8, 1.25, 0.028, 13, 5.3, 6.8),
        "M10": MetricSize(10, 1.5, 0.032, 16, 6.4, 8.4),
        "M12": MetricSize(12, 1.75, 0.034, 18, 7.5, 10.8),
        "M14": MetricSize(14, 2.0, 0.038, 21, 8.8, 12.8),
        "M16": MetricSize(16, 2.0, 0.038, 24, 10.0, 14.8),
        "M18": MetricSize(18, 2.5, 0.042, 27, 11.5, 15.8),
        "M20": MetricSize(20, 2.5, 0.042, 30, 12.5, 18.0),
    }
)


def metric(size: str) -> MetricSize:
    """Return the dimensions of a metric size, given its name.

    Parameters
    ----------
    size : str
        A name such as ``"M6"``.

    Raises
    ------
    InvalidParameterError
        If there is no such size; the message lists the known ones.
    """
    if isinstance(size, str) and size.upper() in METRIC:
        return METRIC[size.upper()]
    raise invalid_parameter(f"Unknown metric size {shown(size)}; known are {', '.join(METRIC)}.")
