"""The verb that looks for parts in each other's way: clash."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .. import output
from ..files import Inputs, shown
from ..lengths import as_length
from ..options import common, reading, sets
from ..output import Output, counted
from ..patterns import files_argument
from ..tables import table_text

if TYPE_CHECKING:
    from ..._types import FloatArray
    from ...assembly.clashes import Clash

_EPILOG = """\b
Examples:
  bspcsg clash housing.stl gear1.stl gear2.stl
  bspcsg clash *.stl --clearance 0.2mm
"""


@click.command("clash", short_help="Say which files are in each other's way.", epilog=_EPILOG)
@files_argument("A B [C ...]")
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
    from ...assembly.tree import Assembly
    from ...parameters import set_threads

    if len(files) < 2:
        raise click.UsageError("clash needs at least two files.")
    set_threads(given["threads"])
    out = Output.of(given)
    inputs = Inputs.of(out, given)
    inputs.refuse_early(files)
    parts = [Assembly(shown(path), inputs.solid(path)) for path in files]
    found = Assembly("", parts).clashes(clearance or 0.0)
    values = [_values(one) for one in found]
    named = {"files": [str(path) for path in files], "clearance": clearance or 0.0}
    out.result(_text(found, len(files)), {**named, "clashes": values})
    return output.FOUND if found else output.DONE


def _values(one: "Clash") -> dict[str, Any]:
    """Return a part of the document."""
    pair = {"files": [one.first, one.second], "volume": one.volume}
    return {**pair, "gap": one.gap, "place": one.place.tolist()}


def _text(found: "list[Clash]", count: int) -> str:
    pairs = counted(count * (count - 1) // 2, "pair")
    if not found:
        return f"{pairs} of files, none clashes."
    rows = [
        (f"{one.first}, {one.second}", f"{one.volume:.6g}", f"{one.gap:.6g}", _spoken(one.place))
        for one in found
    ]
    table = table_text(("files", "common volume", "gap", "near"), rows, ("common volume", "gap"))
    return f"{table}\n{pairs} of files, {len(found)} in each other's way."


def _spoken(place: "FloatArray") -> str:
    return "({:.6g}, {:.6g}, {:.6g})".format(*place.tolist())
