"""The targets of benchmark cases, and the values that a row reached."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import exp, log
from statistics import mean
from typing import Any, Protocol

import numpy as np

from .times import seconds_text

#: The name of this package's engine.
OURS = "bspcsg"

#: The engine that targets refer to by default.
MAIN_RIVAL = "manifold3d"

#: The items of a row, with the results of each engine, as in records.
Items = Sequence[dict[str, Any]]


@dataclass(frozen=True)
class TargetResult:
    """The value that a row reached for one target, and whether it meets the target.

    Parameters
    ----------
    value : float or None
        The value; None if a necessary time is missing.
    text : str
    met : bool or None
        Whether the target is met; None if unknown.
    """

    value: float | None
    text: str
    met: bool | None


class Goal(Protocol):
    """A protocol: one target of a case."""

    @property
    def text(self) -> str:
        """The target as text."""

    def reached(self, items: Items) -> TargetResult:
        """Return the value that the items reached, and whether it meets the target."""


@dataclass(frozen=True)
class Faster:
    """The target to be `factor` times as fast as another engine, on each item."""

    factor: float
    engine: str = MAIN_RIVAL

    @property
    def text(self) -> str:
        """The target as text."""
        return f"≥ {self.factor:g} × {self.engine}"

    def reached(self, items: Items) -> TargetResult:
        """Return the least ratio of times, and whether it meets the target."""
        ratios = [found for item in items if (found := ratio(item, self.engine)) is not None]
        if not ratios:
            return TargetResult(None, "—", None)
        least = min(ratios, key=lambda found: found.value)
        met = least.value >= self.factor
        return TargetResult(least.value, least.text, met or (None if least.is_bound else False))


@dataclass(frozen=True)
class MeanFaster:
    """The target to be `factor` times as fast as another engine, in the geometric mean of items."""

    factor: float
    engine: str = MAIN_RIVAL

    @property
    def text(self) -> str:
        """The target as text."""
        return f"mean ≥ {self.factor:g} × {self.engine}"

    def reached(self, items: Items) -> TargetResult:
        """Return the geometric mean of the ratios of times, and whether it meets the target."""
        ratios = [found for item in items if (found := ratio(item, self.engine)) is not None]
        if not ratios:
            return TargetResult(None, "—", None)
        value = _geometric_mean([found.value for found in ratios])
        worked = [found.cpu for found in ratios if found.cpu is not None]
        both = Ratio(value, _geometric_mean(worked) if worked else None)
        over = f"over {len(ratios)} of {len(items)}"
        return TargetResult(value, f"{both.text} {over}", value >= self.factor)


def _geometric_mean(numbers: list[float]) -> float:
    return exp(mean(map(log, numbers)))


@dataclass(frozen=True)
class Within:
    """The target that the median wall-clock time of each item is below `seconds`."""

    seconds: float

    @property
    def text(self) -> str:
        """The target as text."""
        return f"< {seconds_text(self.seconds)}"

    def reached(self, items: Items) -> TargetResult:
        """Return the largest median time, and whether it meets the target."""
        times = [result_of(item, OURS).get("median") for item in items]
        known = [value for value in times if value is not None]
        if not known:
            return TargetResult(None, "unfinished", False)
        return TargetResult(max(known), seconds_text(max(known)), max(known) < self.seconds)


@dataclass(frozen=True)
class WorkWithin:
    """The target that the median processor time of each item is at most `seconds`."""

    seconds: float

    @property
    def text(self) -> str:
        """The target as text."""
        return f"≤ {seconds_text(self.seconds)} of processors"

    def reached(self, items: Items) -> TargetResult:
        """Return the largest median processor time, and whether it meets the target."""
        known = [value for item in items if (value := result_of(item, OURS).get("cpu"))]
        if not known:
            return TargetResult(None, "unfinished", False)
        return TargetResult(max(known), seconds_text(max(known)), max(known) <= self.seconds)


@dataclass(frozen=True)
class StepWithin:
    """The target that a step of a chain takes at most `seconds` on average."""

    seconds: float

    @property
    def text(self) -> str:
        """The target as text."""
        return f"≤ {seconds_text(self.seconds)} a step"

    def reached(self, items: Items) -> TargetResult:
        """Return the largest average time of a step, and whether it meets the target."""
        found = [result_of(item, OURS) for item in items]
        times = [one["parts"]["steps"] / one["steps"] for one in found if one.get("steps")]
        if not times:
            return TargetResult(None, "—", None)
        return TargetResult(max(times), seconds_text(max(times)), max(times) <= self.seconds)


@dataclass(frozen=True)
class ScratchWithin:
    """The target for scratch memory in bytes per triangle of the operands.

    Scratch memory is the memory besides operands and result.
    """

    bytes_each: float

    @property
    def text(self) -> str:
        """The target as text."""
        return f"≤ {self.bytes_each:g} bytes a triangle beside operands and answer"

    def reached(self, items: Items) -> TargetResult:
        """Return the largest scratch memory per triangle, and whether it meets the target."""
        found = [(item["triangles"], result_of(item, OURS)) for item in items]
        each = [
            (one["memory_mb"] - one["answer_mb"]) * 1e6 / triangles
            for triangles, one in found
            if one.get("memory_mb") and "answer_mb" in one
        ]
        if not each:
            return TargetResult(None, "—", None)
        met = _met_by_all(max(each) <= self.bytes_each, len(each), items)
        return TargetResult(max(each), f"{max(each):.0f} bytes", met)


@dataclass(frozen=True)
class MemoryWithin:
    """The target that the peak memory of the whole process is below `megabytes`."""

    megabytes: float

    @property
    def text(self) -> str:
        """The target as text."""
        return f"< {self.megabytes:g} MB"

    def reached(self, items: Items) -> TargetResult:
        """Return the largest peak memory, and whether it meets the target."""
        peaks = [result_of(item, OURS).get("peak_mb") for item in items]
        known = [value for value in peaks if value is not None]
        if not known:
            return TargetResult(None, "—", None)
        return TargetResult(max(known), f"{max(known):.0f} MB", max(known) < self.megabytes)


@dataclass(frozen=True)
class SteadySteps:
    """The target that the last steps of a chain take at most `factor` times the thousandth step."""

    factor: float

    @property
    def text(self) -> str:
        """The target as text."""
        return f"last steps ≤ {self.factor:g} × step 1 000"

    def reached(self, items: Items) -> TargetResult:
        """Return the largest ratio of the last to the thousandth step, and if it is low enough."""
        windows = [result_of(item, OURS).get("windows") or {} for item in items]
        pairs = [(w["thousandth"], w["last"]) for w in windows if "thousandth" in w]
        if not pairs:
            return TargetResult(None, "—", None)
        value = max(last / early for early, last in pairs)
        return TargetResult(value, f"{value:.2f} ×", value <= self.factor)


@dataclass(frozen=True)
class GrowthTarget:
    """The target that processor time grows at most with this power of the number of triangles."""

    exponent: float

    @property
    def text(self) -> str:
        """The target as text."""
        return f"∝ n^{self.exponent:g}"

    def reached(self, items: Items) -> TargetResult:
        """Return the fitted exponent of growth, and whether it meets the target."""
        value = exponent(items, OURS, "cpu")
        if value is None:
            return TargetResult(None, "—", None)
        timed = sum(bool(result_of(item, OURS).get("cpu")) for item in items)
        return TargetResult(
            value, f"n^{value:.3f}", _met_by_all(value <= self.exponent, timed, items)
        )


def _met_by_all(met: bool, measured: int, items: Items) -> bool | None:
    """Return whether a target is met; None if it is met but not all items were measured."""
    return None if met and measured < len(items) else met


@dataclass(frozen=True)
class DoublingTarget:
    """The target that processor time grows no faster than input and result, from item to item."""

    #: The fraction by which processor time may grow more than the triangles read and written.
    share: float = 0.15

    @property
    def text(self) -> str:
        """The target as text."""
        return f"cost ≤ {1 + self.share:g} × growth of input and answer"

    def reached(self, items: Items) -> TargetResult:
        """Return the largest growth of time relative to size, and whether it meets the target."""
        if any(result_of(item, OURS).get("state") == "stopped" for item in items):
            # A larger item that times out has grown too fast.
            return TargetResult(None, "unfinished", False)
        grown = [_growth(a, b) for a, b in pairwise(items)]
        known = [found for found in grown if found is not None]
        if not known:
            return TargetResult(None, "—", None)
        cost, size = max(known, key=lambda found: found[0] / found[1])
        text = f"cost × {cost:.3g}, input and answer × {size:.3g}"
        return TargetResult(cost / size, text, cost <= (1 + self.share) * size)


def _growth(less: dict[str, Any], more: dict[str, Any]) -> tuple[float, float] | None:
    """Return the factors by which processor time, and triangles read and written, grow; or None.

    If the result grows less than the operands, the growth of the operands counts, because all
    operands must be read.
    """
    ours = [result_of(item, OURS) for item in (less, more)]
    if not all(found.get("cpu") and "facts" in found for found in ours):
        return None
    read = [item["triangles"] for item in (less, more)]
    both = [n + found["facts"]["triangles"] for n, found in zip(read, ours, strict=True)]
    size = max(read[1] / read[0], both[1] / both[0])
    return ours[1]["cpu"] / ours[0]["cpu"], size


def result_of(item: dict[str, Any], engine: str) -> dict[str, Any]:
    """Return the results of an engine on an item; empty if the engine was not timed."""
    found: dict[str, Any] = item["engines"].get(engine, {})
    return found


@dataclass(frozen=True)
class Ratio:
    """How many times as fast as another engine we are.

    Parameters
    ----------
    value : float
        The ratio of the medians of wall-clock time.
    cpu : float or None
        The ratio of the medians of processor time of all threads, which other users of the machine
        disturb less.
    is_bound : bool
        True if the other engine was stopped, so that `value` is a lower bound.
    """

    value: float
    cpu: float | None = None
    is_bound: bool = False

    @property
    def text(self) -> str:
        """The ratio as text."""
        worked = "" if self.cpu is None else f" (processor {self.cpu:.3g} ×)"
        return f"{'> ' if self.is_bound else ''}{self.value:.3g} ×{worked}"


def ratio(item: dict[str, Any], engine: str) -> Ratio | None:
    """Return the ratio of another engine's time to ours; None without both or if results differ."""
    ours, theirs = result_of(item, OURS), result_of(item, engine)
    if theirs.get("agrees") is False or not ours.get("median"):
        return None
    if theirs.get("median"):
        worked = theirs["cpu"] / ours["cpu"] if ours["cpu"] and theirs["cpu"] else None
        return Ratio(theirs["median"] / ours["median"], worked)
    if theirs.get("state") == "stopped" and theirs["stopped_after"] > ours["median"]:
        return Ratio(theirs["stopped_after"] / ours["median"], is_bound=True)
    return None


def exponent(items: Items, engine: str, time: str = "median") -> float | None:
    """Return the fitted exponent with which an engine's time grows with the number of triangles.

    Parameters
    ----------
    items : sequence of dict
    engine : str
    time : {"median", "cpu"}
        Wall-clock time or processor time.
    """
    points = [
        (item["triangles"], found) for item in items if (found := result_of(item, engine).get(time))
    ]
    if len(points) < 2:
        return None
    sizes, times = np.log(np.array(points)).T
    return float(np.polyfit(sizes, times, 1)[0])
