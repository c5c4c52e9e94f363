"""The targets of a row, and the figures that the row reached."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import exp, log
from statistics import mean
from typing import Any, Protocol

import numpy as np

from .times import seconds_text

#: The engine that the others are measured against.
OURS = "bspcsg"

#: The engine to match where a row names none.
MAIN_RIVAL = "manifold3d"

#: Results by item and engine, as in the records.
Items = Sequence[dict[str, Any]]


@dataclass(frozen=True)
class Reached:
    """The share of one target that a row reached.

    Parameters
    ----------
    value : float or None
        None if an engine that it needs has no time.
    text : str
    met : bool or None
        None if that is unknown.
    """

    value: float | None
    text: str
    met: bool | None


class Goal(Protocol):
    """One figure to reach."""

    @property
    def text(self) -> str:
        """The target in words."""

    def reached(self, items: Items) -> Reached:
        """Compare the target with what was measured."""


@dataclass(frozen=True)
class Faster:
    """So many times faster than another engine, on each item."""

    factor: float
    engine: str = MAIN_RIVAL

    @property
    def text(self) -> str:
        """The target in words."""
        return f"≥ {self.factor:g} × {self.engine}"

    def reached(self, items: Items) -> Reached:
        """Compare the target with what was measured."""
        ratios = [found for item in items if (found := ratio(item, self.engine)) is not None]
        if not ratios:
            return Reached(None, "—", None)
        least = min(ratios, key=lambda found: found.value)
        met = least.value >= self.factor
        return Reached(least.value, least.text, met or (None if least.is_bound else False))


@dataclass(frozen=True)
class MeanFaster:
    """So many times faster in the geometric mean over all items."""

    factor: float
    engine: str = MAIN_RIVAL

    @property
    def text(self) -> str:
        """The target in words."""
        return f"mean ≥ {self.factor:g} × {self.engine}"

    def reached(self, items: Items) -> Reached:
        """Compare the target with what was measured."""
        ratios = [found for item in items if (found := ratio(item, self.engine)) is not None]
        if not ratios:
            return Reached(None, "—", None)
        value = _geometric_mean([found.value for found in ratios])
        worked = [found.cpu for found in ratios if found.cpu is not None]
        both = Ratio(value, _geometric_mean(worked) if worked else None)
        over = f"over {len(ratios)} of {len(items)}"
        return Reached(value, f"{both.text} {over}", value >= self.factor)


def _geometric_mean(numbers: list[float]) -> float:
    return exp(mean(map(log, numbers)))


@dataclass(frozen=True)
class Within:
    """The median of each item is at most so many seconds."""

    seconds: float

    @property
    def text(self) -> str:
        """The target in words."""
        return f"< {seconds_text(self.seconds)}"

    def reached(self, items: Items) -> Reached:
        """Compare the target with what was measured."""
        times = [result_of(item, OURS).get("median") for item in items]
        known = [value for value in times if value is not None]
        if not known:
            return Reached(None, "unfinished", False)
        return Reached(max(known), seconds_text(max(known)), max(known) < self.seconds)


@dataclass(frozen=True)
class WorkWithin:
    """The median processor time of each item, of all threads and processes, is limited."""

    seconds: float

    @property
    def text(self) -> str:
        """The target in words."""
        return f"≤ {seconds_text(self.seconds)} of processors"

    def reached(self, items: Items) -> Reached:
        """Compare the target with what was measured."""
        known = [value for item in items if (value := result_of(item, OURS).get("cpu"))]
        if not known:
            return Reached(None, "unfinished", False)
        return Reached(max(known), seconds_text(max(known)), max(known) <= self.seconds)


@dataclass(frozen=True)
class StepWithin:
    """The steps of a chain take so many seconds in the mean."""

    seconds: float

    @property
    def text(self) -> str:
        """The target in words."""
        return f"≤ {seconds_text(self.seconds)} a step"

    def reached(self, items: Items) -> Reached:
        """Compare the target with what was measured."""
        found = [result_of(item, OURS) for item in items]
        times = [one["parts"]["steps"] / one["steps"] for one in found if one.get("steps")]
        if not times:
            return Reached(None, "—", None)
        return Reached(max(times), seconds_text(max(times)), max(times) <= self.seconds)


@dataclass(frozen=True)
class ScratchWithin:
    """Scratch memory in bytes per triangle of the operands, without operands and answer."""

    bytes_each: float

    @property
    def text(self) -> str:
        """The target in words."""
        return f"≤ {self.bytes_each:g} bytes a triangle beside operands and answer"

    def reached(self, items: Items) -> Reached:
        """Compare the target with what was measured."""
        found = [(item["triangles"], result_of(item, OURS)) for item in items]
        each = [
            (one["memory_mb"] - one["answer_mb"]) * 1e6 / triangles
            for triangles, one in found
            if one.get("memory_mb") and "answer_mb" in one
        ]
        if not each:
            return Reached(None, "—", None)
        met = _of_all(max(each) <= self.bytes_each, len(each), items)
        return Reached(max(each), f"{max(each):.0f} bytes", met)


@dataclass(frozen=True)
class MemoryWithin:
    """The memory of the whole process is limited."""

    megabytes: float

    @property
    def text(self) -> str:
        """The target in words."""
        return f"< {self.megabytes:g} MB"

    def reached(self, items: Items) -> Reached:
        """Compare the target with what was measured."""
        peaks = [result_of(item, OURS).get("peak_mb") for item in items]
        known = [value for value in peaks if value is not None]
        if not known:
            return Reached(None, "—", None)
        return Reached(max(known), f"{max(known):.0f} MB", max(known) < self.megabytes)


@dataclass(frozen=True)
class SteadySteps:
    """The last steps of a chain take at most so many times as long as the thousandth."""

    factor: float

    @property
    def text(self) -> str:
        """The target in words."""
        return f"last steps ≤ {self.factor:g} × step 1 000"

    def reached(self, items: Items) -> Reached:
        """Compare the target with what was measured."""
        windows = [result_of(item, OURS).get("windows") or {} for item in items]
        pairs = [(w["thousandth"], w["last"]) for w in windows if "thousandth" in w]
        if not pairs:
            return Reached(None, "—", None)
        value = max(last / early for early, last in pairs)
        return Reached(value, f"{value:.2f} ×", value <= self.factor)


@dataclass(frozen=True)
class GrowthTarget:
    """Processor time grows at most with this power of the number of triangles."""

    exponent: float

    @property
    def text(self) -> str:
        """The target in words."""
        return f"∝ n^{self.exponent:g}"

    def reached(self, items: Items) -> Reached:
        """Compare the target with what was measured."""
        value = exponent(items, OURS, "cpu")
        if value is None:
            return Reached(None, "—", None)
        timed = sum(bool(result_of(item, OURS).get("cpu")) for item in items)
        return Reached(value, f"n^{value:.3f}", _of_all(value <= self.exponent, timed, items))


def _of_all(met: bool, measured: int, items: Items) -> bool | None:
    """Return whether a target is met; None if it is met but some items were not measured."""
    return None if met and measured < len(items) else met


@dataclass(frozen=True)
class DoublingTarget:
    """From each item to the next, about twice as large, cost grows no faster than the sizes."""

    #: The factor by which processor time may outgrow the triangles read and written.
    share: float = 0.15

    @property
    def text(self) -> str:
        """The target in words."""
        return f"cost ≤ {1 + self.share:g} × growth of input and answer"

    def reached(self, items: Items) -> Reached:
        """Compare the target with what was measured."""
        if any(result_of(item, OURS).get("state") == "stopped" for item in items):
            # An item that finishes at one size and times out at the next has grown too fast.
            return Reached(None, "unfinished", False)
        grown = [_growth(a, b) for a, b in pairwise(items)]
        known = [found for found in grown if found is not None]
        if not known:
            return Reached(None, "—", None)
        cost, size = max(known, key=lambda found: found[0] / found[1])
        text = f"cost × {cost:.3g}, input and answer × {size:.3g}"
        return Reached(cost / size, text, cost <= (1 + self.share) * size)


def _growth(less: dict[str, Any], more: dict[str, Any]) -> tuple[float, float] | None:
    """Return the growth of processor time, and of the triangles read and written.

    An answer that grew less than the operands is ignored, because all operands have to be read.
    """
    ours = [result_of(item, OURS) for item in (less, more)]
    if not all(found.get("cpu") and "facts" in found for found in ours):
        return None
    read = [item["triangles"] for item in (less, more)]
    both = [n + found["facts"]["triangles"] for n, found in zip(read, ours, strict=True)]
    size = max(read[1] / read[0], both[1] / both[0])
    return ours[1]["cpu"] / ours[0]["cpu"], size


def result_of(item: dict[str, Any], engine: str) -> dict[str, Any]:
    """Return what an engine reached on an item; empty if it did not take part."""
    found: dict[str, Any] = item["engines"].get(engine, {})
    return found


@dataclass(frozen=True)
class Ratio:
    """How many times we are faster.

    Parameters
    ----------
    value : float
        Of the medians of wall time.
    cpu : float or None
        Of the medians of processor time of all threads, which other users of the machine disturb
        less.
    is_bound : bool
        True if the other engine was stopped before its end, so that the ratio is this or more.
    """

    value: float
    cpu: float | None = None
    is_bound: bool = False

    @property
    def text(self) -> str:
        """The ratio in words."""
        worked = "" if self.cpu is None else f" (processor {self.cpu:.3g} ×)"
        return f"{'> ' if self.is_bound else ''}{self.value:.3g} ×{worked}"


def ratio(item: dict[str, Any], engine: str) -> Ratio | None:
    """Compare our time with another engine's; None if a time is missing, or the answers differ."""
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
    """Fit the exponent by which an engine's time grows with the number of triangles.

    Parameters
    ----------
    items : sequence of dict
    engine : str
    time : {"median", "cpu"}
        Wall time or processor time.
    """
    points = [
        (item["triangles"], found) for item in items if (found := result_of(item, engine).get(time))
    ]
    if len(points) < 2:
        return None
    sizes, times = np.log(np.array(points)).T
    return float(np.polyfit(sizes, times, 1)[0])
