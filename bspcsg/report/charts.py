"""Charts for a page, as paths and labels of SVG."""

import math
from collections.abc import Sequence
from typing import NamedTuple

_WIDTH, _HEIGHT = 360, 190
_LEFT, _RIGHT, _TOP, _BOTTOM = 42, 8, 8, 32

#: The largest number of steps of a curve: more could not be seen in a picture of this width.
_MAX_CURVE_STEPS = 200


class Mark(NamedTuple):
    """A label on an axis of a chart, and its position along the axis in pixels."""

    place: float
    text: str


class Curve(NamedTuple):
    """A curve of a chart: its name and its SVG path."""

    name: str
    path: str


class Chart(NamedTuple):
    """The data of a chart for the page's template: curves, axis labels, and the frame in pixels."""

    curves: list[Curve]
    across: list[Mark]
    upwards: list[Mark]
    width: int
    height: int
    left: int
    right: int
    top: int
    bottom: int


def share_below(series: Sequence[tuple[str, Sequence[float]]]) -> Chart | None:
    """Return the chart of the cumulative distribution of values, on a logarithmic axis.

    Parameters
    ----------
    series : sequence of (str, sequence of float)
        Names and values of the curves; values up to 0 count as smaller than all positive values.
        Without a positive value, return None.
    """
    positive = [value for _, values in series for value in values if value > 0]
    if not positive:
        return None
    low, high = math.floor(math.log10(min(positive))), math.ceil(math.log10(max(positive)))
    high = max(high, low + 1)
    curves = [Curve(name, _path(sorted(values), low, high)) for name, values in series if values]
    step = math.ceil((high - low) / 6)
    across = [Mark(_x(power, low, high), _power(power)) for power in range(low, high + 1, step)]
    upwards = [Mark(_y(share / 100), f"{share} %") for share in (0, 50, 100)]
    frame = (_WIDTH, _HEIGHT, _LEFT, _WIDTH - _RIGHT, _TOP, _HEIGHT - _BOTTOM)
    return Chart(curves, across, upwards, *frame)


def _path(values: Sequence[float], low: int, high: int) -> str:
    """Return the SVG path of the cumulative distribution of sorted values, a step curve."""
    count = len(values)
    picked = sorted(
        {round(k * (count - 1) / _MAX_CURVE_STEPS) for k in range(_MAX_CURVE_STEPS + 1)}
    )
    steps = [
        f"H{_x(math.log10(values[k]), low, high):.1f}V{_y((k + 1) / count):.1f}"
        for k in picked
        if values[k] > 0
    ]
    start = sum(value <= 0 for value in values) / count
    return f"M{_x(low, low, high):.1f},{_y(start):.1f}{''.join(steps)}H{_x(high, low, high):.1f}"


def _x(power: float, low: int, high: int) -> float:
    return _LEFT + (power - low) / (high - low) * (_WIDTH - _LEFT - _RIGHT)


def _y(share: float) -> float:
    return _TOP + (1 - share) * (_HEIGHT - _TOP - _BOTTOM)


def _power(exponent: int) -> str:
    if -3 <= exponent <= 4:
        return f"{10.0**exponent:g}"
    return f"1e{exponent}"
