"""The verb that looks for parts in each other's way: clash."""

import math
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .. import output
from ..files import Inputs, shown
from ..lengths import as_length
from ..options import PATH, common, reading, sets
from ..output import Output, counted
from ..tables import table_text

if TYPE_CHECKING:
    from ...solid.solid import Solid

_EPILOG = """\b
Examples:
  bspcsg clash housing.stl gear1.stl gear2.stl
  bspcsg clash *.stl --clearance 0.2mm
"""


@click.command("clash", short_help="Say which files are in each other's way.", epilog=_EPILOG)
@click.argument("files", nargs=-1, required=True, type=PATH, metavar="A B [C ...]")
@click.option(
    "--clearance",
    metavar="LENGTH",
    callback=as_length,
    help="Also name pairs that are nearer than this, as 0.2mm.",
)
@reading
@sets
@common
def clash(files: tuple[Path, ...], clearance: float | None, **given: Any) -> int:
    """Say which pairs of files have volume in common, how much and where.

    It is decided exactly; files that only touch do not clash. Exits with 1 if a pair does, or if it
    is nearer than the clearance.
    """
    from ...parameters import set_threads

    if len(files) < 2:
        raise click.UsageError("clash needs at least two files.")
    set_threads(given["threads"])
    out = Output.of(given)
    inputs = Inputs.of(out, given)
    inputs.refuse_early(files)
    solids = [inputs.solid(path) for path in files]
    found = _clashes([shown(path) for path in files], solids, clearance or 0.0)
    values = [one.values() for one in found]
    named = {"files": [str(path) for path in files], "clearance": clearance or 0.0}
    out.result(_text(found, len(files)), {**named, "clashes": values})
    return output.FOUND if found else output.DONE


@dataclass(frozen=True)
class _Clash:
    """Two files in each other's way.

    Parameters
    ----------
    a, b : str
    volume : float
        What they have in common, in cubic model units.
    gap : float
        Their distance, 0 if they touch or overlap.
    place : list of float
        The middle of what they have in common, or of the gap.
    """

    a: str
    b: str
    volume: float
    gap: float
    place: list[float]

    def values(self) -> dict[str, Any]:
        """Return a part of the document."""
        pair = {"files": [self.a, self.b], "volume": self.volume}
        return {**pair, "gap": self.gap, "place": self.place}


def _clashes(names: list[str], solids: "list[Solid]", clearance: float) -> list[_Clash]:
    boxes = [solid.bounds for solid in solids]
    found = []
    for i, j in combinations(range(len(solids)), 2):
        low, high = boxes[i], boxes[j]
        if low is None or high is None or _box_gap(low, high) > clearance:
            continue
        one = _clash_of(names[i], names[j], solids[i], solids[j], clearance)
        found.extend([one] if one is not None else [])
    return found


def _clash_of(a: str, b: str, one: "Solid", other: "Solid", clearance: float) -> _Clash | None:
    common_part = (one & other).normalized()
    bounds = common_part.bounds
    if bounds is not None:
        return _Clash(a, b, common_part.volume, 0.0, bounds.mean(axis=0).tolist())
    if not clearance or (gap := one.min_gap(other)) >= clearance:
        return None
    near, far = one.closest_points(other)
    middle = (near + far) / 2
    return _Clash(a, b, 0.0, gap, middle.tolist())


def _box_gap(box: Any, other: Any) -> float:
    """Return the distance of two boxes, each as lowest and highest corner."""
    sides = zip(*box.tolist(), *other.tolist(), strict=True)
    return math.hypot(*(max(low - end, begin - high, 0.0) for low, high, begin, end in sides))


def _text(found: list[_Clash], count: int) -> str:
    pairs = counted(count * (count - 1) // 2, "pair")
    if not found:
        return f"{pairs} of files, none clashes."
    rows = [
        (f"{one.a}, {one.b}", f"{one.volume:.6g}", f"{one.gap:.6g}", _spoken(one.place))
        for one in found
    ]
    table = table_text(("files", "common volume", "gap", "near"), rows, ("common volume", "gap"))
    return f"{table}\n{pairs} of files, {len(found)} in each other's way."


def _spoken(place: list[float]) -> str:
    return "({:.6g}, {:.6g}, {:.6g})".format(*place)
