"""The verb `clash`, which finds pairs of parts with common volume or too little clearance."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..console import output
from ..console.output import Output, counted
from ..console.tables import table_text
from ..inputs.files import STREAM, Inputs, display_name
from ..inputs.lengths import MILLIMETRES, as_length
from ..options.patterns import files_argument
from ..options.shared import common_options, reading_options, set_options, verb

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..._types import FloatArray
    from ...assembly.clashes import Clash
    from ...assembly.tree import Assembly

#: The end of messages about missing operands: the second form in which they can be given.
_ONE = ", or one mesh or .csg file that contains several closed objects."

_EPILOG = """\b
Examples:
  bspcsg clash housing.stl gear1.stl gear2.stl
  bspcsg clash *.stl --clearance 0.2mm
  bspcsg clash machine.3mf
"""


@verb("clash", short_help="Say which parts are in each other's way.", epilog=_EPILOG)
@files_argument("A [B ...]")
@click.option(
    "--clearance",
    metavar="LENGTH",
    callback=as_length,
    help="Also name pairs that are nearer than this, as 0.2mm.",
)
@reading_options
@set_options
@common_options
def clash(files: tuple[Path, ...], clearance: float | None, **given: Any) -> int:
    """Say which pairs of files have volume in common, how much and where.

    If only one file is given, such as 3MF, GLB, OBJ or a script, pairs of its objects are examined.
    The decision is exact; solids that only touch do not clash. The exit code is 1 if a pair
    clashes, or is nearer than the clearance.
    """
    from ...parameters import set_threads

    set_threads(given["threads"])
    out = Output.of(given)
    inputs = Inputs.of(out, given)
    inputs.refuse_early(files)
    whole = _objects(inputs, files[0]) if len(files) == 1 else _files(inputs, files)
    found = whole.clashes(clearance or 0.0)
    kind = "objects" if len(files) == 1 else "files"
    values = [_values(one, kind) for one in found]
    named = {"files": [str(path) for path in files], "clearance": clearance or 0.0}
    out.result(_text(found, len(whole), kind), {**named, "clashes": values})
    return output.FOUND if found else output.DONE


def _files(inputs: Inputs, files: "Sequence[Path]") -> "Assembly":
    """Return an assembly in which each file is a part."""
    from ...assembly.tree import Assembly

    return Assembly("", [Assembly(display_name(path), inputs.solid(path)) for path in files])


def _objects(inputs: Inputs, path: Path) -> "Assembly":
    """Return an assembly in which each object of one file is a part."""
    from ...assembly.files import load_as
    from ...formats.registry import FORMATS

    if str(path) == STREAM or path.suffix.lower() == ".py" or inputs.on_invalid != "error":
        raise click.UsageError(f"clash needs at least two files{_ONE}")
    is_script = inputs.is_script(path)
    options = {} if is_script else {"winding": inputs.winding, "pitch": inputs.pitch}
    suffix = inputs.suffix_of(path)
    if suffix == ".json" and path.suffix.lower() != suffix:
        message = (
            f"{display_name(path)}: clash reads a script in JSON only from a file whose name ends"
            " in"
            " .json; save it there."
        )
        raise click.UsageError(message)
    whole = load_as(path, suffix, **options)
    if len(whole) < 2:
        raise click.UsageError(
            f"{display_name(path)} contains one object only; clash needs two files{_ONE}"
        )
    says_unit = not is_script and FORMATS[suffix].unit
    return whole if inputs.unit is None or says_unit else whole.scale(MILLIMETRES[inputs.unit])


def _values(one: "Clash", kind: str) -> dict[str, Any]:
    """Return a clash as JSON values; `kind` is the key of the pair's names."""
    pair = {kind: [one.first, one.second], "volume": one.volume}
    return {**pair, "gap": one.gap, "place": one.place.tolist()}


def _text(found: "list[Clash]", count: int, kind: str) -> str:
    pairs = counted(count * (count - 1) // 2, "pair")
    if not found:
        return f"{pairs} of {kind}, none clashes."
    rows = [
        (
            f"{one.first}, {one.second}",
            f"{one.volume:.6g}",
            f"{one.gap:.6g}",
            _point_text(one.place),
        )
        for one in found
    ]
    table = table_text((kind, "common volume", "gap", "near"), rows, ("common volume", "gap"))
    return f"{table}\n{pairs} of {kind}, {len(found)} in each other's way."


def _point_text(place: "FloatArray") -> str:
    return "({:.6g}, {:.6g}, {:.6g})".format(*place.tolist())
