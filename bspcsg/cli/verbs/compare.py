"""The verb `compare`, which compares two files as sets of points."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..console import output
from ..console.output import Output, grouped
from ..console.tables import table_text
from ..inputs.files import Inputs, display_name
from ..inputs.lengths import as_length
from ..options.patterns import file_argument
from ..options.shared import SAMPLES, Renamed, common_options, reading_options, set_options, verb
from ..pages.page_output import PAGE, refuse_page, write_page

if TYPE_CHECKING:
    from ...solid.solid import Solid
    from ...verify.comparison import SetComparison

_EPILOG = """\b
Examples:
  bspcsg compare old.stl new.stl --tolerance 1e-6 || echo changed
  bspcsg compare old.stl new.stl --html difference.html
"""


@verb("compare", short_help="Say whether two files hold the same set of points.", epilog=_EPILOG)
@file_argument("A", "a")
@file_argument("B", "b")
@click.option(
    "--tolerance",
    cls=Renamed,
    old="--tol",
    metavar="LENGTH",
    callback=as_length,
    help="Distance of the surfaces, as 0.01mm, up to which they count as the same.",
)
@click.option(
    "--samples",
    metavar="N",
    type=SAMPLES,
    default=10_000,
    help="Points on the difference to measure distances from; 0 for none.",
)
@click.option(
    "--seed", metavar="N", type=click.IntRange(min=0), default=0, help="Seed of the random points."
)
@PAGE
@reading_options
@set_options
@common_options
def compare(
    a: Path,
    b: Path,
    tolerance: float | None,
    samples: int,
    seed: int,
    page: Path | None,
    **given: Any,
) -> int:
    """Say whether two files describe the same set of points, and how they differ.

    Only the points inside matter, not the triangles. Equality is decided exactly; the distance of
    the surfaces is estimated from points of their difference. The exit code is 1 if the sets
    differ.
    """
    from ...parameters import set_threads
    from ...verify.comparison import compare as compared

    tol = tolerance or 0.0
    if tol and not samples:
        raise click.UsageError(
            "--tolerance needs sample points to measure distances, so --samples must be above 0."
        )
    set_threads(given["threads"])
    out = Output.of(given)
    inputs = Inputs.of(out, given)
    inputs.refuse_early([a, b])
    if page is not None:
        refuse_page(page)
    solids = inputs.solid(a), inputs.solid(b)
    found = compared(*solids, samples, seed)
    same = found.equal or _within(found, tol)
    names = {"files": [str(a), str(b)], "same": same, "tolerance": tol}
    document = {**names, **found.to_dict()} if out.as_json else {}
    if page is not None:
        _write_page(page, solids, (a, b), found, same)
    out.result(_text(found, display_name(a), display_name(b), same), document)
    return output.DONE if same else output.FOUND


def _write_page(
    page: Path,
    solids: "tuple[Solid, Solid]",
    files: tuple[Path, Path],
    found: "SetComparison",
    same: bool,
) -> None:
    from ...report.viewer.comparison_page import compared_page

    first, second = (path.name for path in files)
    names = (first, second if first != second else f"{second} (2)")
    *figures, verdict = _differences(found, same)
    write_page(page, compared_page(solids, names, found, [verdict, *figures]))


def _within(found: "SetComparison", tolerance: float) -> bool:
    """Say whether sampled distance and thickest difference of two sets are within a tolerance."""
    return found.hausdorff is not None and max(found.hausdorff, found.difference.thickness) <= (
        tolerance
    )


def _text(found: "SetComparison", a: str, b: str, same: bool) -> str:
    rows = [
        ("triangles", grouped(found.a.triangles), grouped(found.b.triangles)),
        ("volume", f"{found.a.volume:.12g}", f"{found.b.volume:.12g}"),
        ("area", f"{found.a.area:.12g}", f"{found.b.area:.12g}"),
        ("surfaces", grouped(found.a.components), grouped(found.b.components)),
        ("Euler number", str(found.a.euler_number), str(found.b.euler_number)),
    ]
    table = table_text(("", a, b), rows, right=(a, b))
    return "\n".join([table, *_differences(found, same)])


def _differences(found: "SetComparison", same: bool) -> list[str]:
    if found.equal:
        return ["The sets are equal, exactly."]
    part = found.difference
    lines = [f"symmetric difference: volume {part.volume:.6g}, area {part.area:.6g}"]
    if part.place is not None:
        place = "({:.6g}, {:.6g}, {:.6g})".format(*part.place)
        lines.append(f"thickest piece of it: {part.thickness:.3g} thick, near {place}")
    if found.hausdorff is not None:
        points = grouped(found.samples)
        lines.append(f"Hausdorff distance: at least {found.hausdorff:.6g}, from {points} points")
    lines.append("The sets differ, within the tolerance." if same else "The sets differ.")
    return lines
