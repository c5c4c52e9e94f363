"""The verb `bench`, which times set operations of this package and of other engines."""

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...errors import FormatError
from ..console import output, status_line
from ..console.tables import table_text
from ..inputs.files import STREAM, refuse_folder
from ..options.shared import SECONDS, FilePath, FiniteRange, rare_option, verb

if TYPE_CHECKING:
    from ...bench.runner import Settings

_EPILOG = """\b
Examples:
  bspcsg bench --list
  bspcsg bench spheres-328k cubes --against manifold3d,trueform
  bspcsg bench --all -o bench.json --plot sizes.svg        (an hour or more)
  bspcsg bench --cliffs --runs 1 --against manifold3d
  bspcsg bench --all --continue -o bench.json              (after an interrupt)
  bspcsg bench --from bench.json --format md
"""

_PATH = FilePath(dir_okay=False, readable=True)

#: The largest bound on memory, in GiB: in bytes it must fit into 64 bits.
_MAX_MEMORY_GIB = 2**20


def _as_engines(
    context: click.Context, option: click.Parameter, value: str | None
) -> list[str] | None:
    """Convert names of engines, separated by commas, to a list with our engine first.

    Without names, return all installed engines.
    """
    from ...bench.engines import ENGINES, installed

    if value is None:
        return list(installed())
    asked = [name.strip() for name in value.split(",") if name.strip()]
    for name in asked:
        if name not in ENGINES:
            known = ", ".join(list(ENGINES)[1:])
            raise click.BadParameter(
                f"{name!r} is not a known engine; known are {known}.", context, option
            )
        if name not in installed():
            raise click.BadParameter(
                f"{name} is not installed: pip install {name}", context, option
            )
    return list(dict.fromkeys([next(iter(ENGINES)), *asked]))


def _cases_from(context: click.Context, option: click.Parameter, begun: str) -> list[str]:
    """Return the names of cases that begin with a text, for shell completion."""
    from ...bench.cases import CASES

    return [name for name in CASES if name.startswith(begun)]


def _as_cases(context: click.Context, option: click.Parameter, value: tuple[str, ...]) -> list[str]:
    """Return names of cases without repetitions; raise a usage error for an unknown name."""
    from ...bench.cases import CASES

    for name in value:
        if name not in CASES:
            raise click.BadParameter(
                f"{name!r} is not a known case; --list shows all cases.", context, option
            )
    return list(dict.fromkeys(value))


@verb("bench", short_help="Time set operations beside other engines.", epilog=_EPILOG)
@click.argument(
    "cases", nargs=-1, callback=_as_cases, metavar="[CASE]...", shell_complete=_cases_from
)
@click.option("--list", "listed", is_flag=True, help="Name the cases and what each is to reach.")
@click.option("--all", "everything", is_flag=True, help="All cases: an hour or more.")
@rare_option("--cliffs", is_flag=True, help="Only dense places, each at two sizes.")
@click.option(
    "--against",
    "engines",
    metavar="ENGINES",
    callback=_as_engines,
    help="Engines to compare with, as in manifold3d,trueform; by default all that are installed.",
)
@click.option(
    "--runs",
    metavar="N",
    type=click.IntRange(1),
    default=5,
    show_default=True,
    help="Timed runs of each engine, after one that warms up.",
)
@click.option("--quick", is_flag=True, help="Small forms of the cases, in seconds.")
@rare_option(
    "--limit",
    metavar="SECONDS",
    type=SECONDS,
    help="Seconds after which a call is stopped; by default 120 to 900.",
)
@rare_option(
    "--budget",
    metavar="SECONDS",
    type=SECONDS,
    default=150.0,
    show_default=True,
    help="Seconds for all runs of an engine; slow ones are timed fewer times.",
)
@rare_option(
    "--steps",
    metavar="N",
    type=click.IntRange(1),
    help="Steps of the dome that are carved; by default all.",
)
@rare_option(
    "--memory",
    "memory_gb",
    metavar="GIB",
    type=FiniteRange(0, _MAX_MEMORY_GIB),
    default=12.0,
    show_default=True,
    help="GiB of addresses beyond which an engine gets none; 0 for no bound.",
)
@rare_option(
    "--data",
    "shared",
    metavar="FOLDER",
    type=FilePath(file_okay=False, readable=True),
    default=Path("../shared"),
    show_default=True,
    help="Folder with meshes/ and chains/; cases that need them are left out without.",
)
@rare_option("--core", type=_PATH, help="Measure with another build of the compiled core.")
@click.option(
    "-o",
    "--output",
    "record_path",
    metavar="FILE",
    type=_PATH,
    help="Write the record there.",
)
@rare_option(
    "--continue",
    "continued",
    is_flag=True,
    help="Keep what the record of -o has, and measure what it lacks and what is named.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the record instead of a table.")
@rare_option("--plot", "plot_path", type=_PATH, help="Draw time against size, as SVG.")
@click.option("--from", "source", type=_PATH, help="Measure nothing; show this record.")
@click.option(
    "--format",
    "style",
    type=click.Choice(["text", "md"]),
    default="text",
    show_default=True,
    help="How the table is printed.",
)
@rare_option(
    "--details", is_flag=True, help="Print first and later times, page faults and memory, too."
)
@rare_option("--counters", is_flag=True, help="Print what our core counted, too.")
@rare_option("-q", "--quiet", is_flag=True, help="Do not say what is under way.")
@rare_option("--debug", is_flag=True, help="Show where an error comes from.")
def bench(
    cases: list[str], listed: bool, everything: bool, cliffs: bool, continued: bool, **given: Any
) -> int:
    """Time set operations of bspcsg and of other engines, and compare their results.

    Without names, only cases are measured that take a minute or two in all. Engines take turns in
    one process, and the tables show medians. A call that takes longer than the limit is stopped,
    and an engine that crashes is left out of that case; all other engines go on.

    The exit code is 1 if a result differs from that of bspcsg by more than rounding explains, if
    bspcsg fails, or if its cost where faces are dense grows faster than input and result.
    """
    wanted = _wanted(cases, listed or everything, cliffs)
    if listed:
        _tell_cases(wanted, given["as_json"])
        return output.DONE
    _refuse_early(given)
    source: Path | None = given["source"]
    from ...bench import record as records

    if source:
        record = records.read(source)
    else:
        kept = _recorded_rows(given["record_path"]) if continued else []
        record = _measured(_missing(wanted, cases, kept), kept, given)
    with _whole_record(source):
        text = json.dumps(record) + "\n" if given["as_json"] else _table(record, given["style"])
        text += "" if given["as_json"] else _more_tables(record, given)
        plotted = _plot(record) if given["plot_path"] else ""
        found = _is_wrong(record) or _has_cliff(record)
        code = output.FOUND if found else output.DONE
    click.echo(text, nl=False)
    _write(record, plotted, given["record_path"], given["plot_path"])
    return code


def _wanted(cases: list[str], everything: bool, cliffs: bool) -> list[str]:
    """Return the names of the cases that arguments and options select."""
    from ...bench.cases import CASES, SHORT

    if cliffs:
        return _dense(cases or list(CASES))
    return cases or list(CASES if everything else SHORT)


def _recorded_rows(path: Path | None) -> list[dict[str, Any]]:
    """Return the rows of the record that ``--continue`` names; none if the file does not exist."""
    from ...bench import record as records
    from ...bench.cases import CASES

    if path is None:
        raise click.UsageError("--continue needs -o FILE, the record that is to be continued.")
    if not path.exists():
        return []
    found = records.read(path)
    with _whole_record(path):
        other = records.other_place(found)
        rows = [row for row in found["cases"] if row["case"] in CASES]
    if other:
        message = (
            f"{path}: this record was measured with {other}, so it cannot be continued; measure"
            " again without --continue."
        )
        raise FormatError(message, "unreadable")
    return rows


def _missing(wanted: list[str], named: list[str], kept: list[dict[str, Any]]) -> list[str]:
    """Return the cases to measure: those named as arguments, and those missing in the record."""
    there = {row["case"] for row in kept}
    return [name for name in wanted if name in named or name not in there]


def _dense(cases: list[str]) -> list[str]:
    """Return the cases that have a bound on the growth of cost where faces are close together."""
    from ...bench.dense_cases import DENSE_CASES

    found = [name for name in cases if name in DENSE_CASES]
    if not found:
        raise click.UsageError(
            "none of these cases belongs to --cliffs; --cliffs --list shows its cases."
        )
    return found


def _refuse_early(given: dict[str, Any]) -> None:
    """Raise errors about output files and the core's file before anything is measured."""
    for path in (given["record_path"], given["plot_path"]):
        if path and str(path) == STREAM:
            raise click.UsageError(
                "-o and --plot need the name of a file, not “-”; --json prints the record."
            )
        if path:
            refuse_folder(path)
    core: Path | None = given["core"]
    if core and not core.exists():
        raise FormatError(f"{core}: the compiled core for --core does not exist.", "unreadable")


@contextmanager
def _whole_record(source: Path | None) -> Iterator[None]:
    """Turn errors from a damaged record into a `FormatError` that names its file."""
    try:
        yield
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        if source is None:
            raise
        message = f"{source}: this record of measurements is damaged; run bspcsg bench again."
        raise FormatError(message, "malformed") from error


def _tell_cases(cases: list[str], as_json: bool) -> None:
    from ...bench.cases import CASES

    told = [(name, CASES[name].title, [t.text for t in CASES[name].targets]) for name in cases]
    if as_json:
        values = [dict(zip(("case", "title", "targets"), one, strict=True)) for one in told]
        click.echo(json.dumps({"schema": output.SCHEMA, "cases": values}))
    else:
        rows = [(name, title, "; ".join(texts)) for name, title, texts in told]
        click.echo(table_text(["case", "what", "to reach"], rows))


def _measured(
    cases: list[str], kept: list[dict[str, Any]], given: dict[str, Any]
) -> dict[str, Any]:
    """Measure cases, and return a record of their rows and of the rows `kept`."""
    from ...bench import record as records
    from ...bench.runner import run_case

    settings = _settings(given)
    status_line.end()
    told = _silence if given["quiet"] else _tell
    rows = {row["case"]: row for row in kept}
    for name in cases:
        rows[name] = run_case(name, settings, told)
        rows = _sorted(rows) if kept else rows
        if given["record_path"]:
            # Write the record after each case, since a later one may fail.
            records.write(_record(rows, given), given["record_path"])
    _tell("") if not given["quiet"] else None
    return _record(rows, given)


def _sorted(rows: dict[str, dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """Return the rows of a record, by case name, in the order of `CASES`."""
    from ...bench.cases import CASES

    return {name: rows[name] for name in CASES if name in rows}


def _record(rows: dict[str, dict[str, Any]], given: dict[str, Any]) -> dict[str, Any]:
    from ...bench import record as records

    return records.record_of(
        list(rows.values()), given["runs"], " ".join(["bspcsg", *sys.argv[1:]])
    )


def _settings(given: dict[str, Any]) -> "Settings":
    from ...bench.runner import Settings

    return Settings(
        engines=given["engines"],
        runs=given["runs"],
        small=given["quick"],
        limit=given["limit"],
        budget=given["budget"],
        shared=given["shared"].absolute(),
        core=given["core"],
        memory_gb=given["memory_gb"],
        steps=given["steps"] or 0,
    )


def _silence(line: str) -> None:
    """Print nothing: the replacement of `_tell` with ``--quiet``."""


def _tell(line: str) -> None:
    """Replace the last line on standard error by the current step, if it is a terminal."""
    if sys.stderr.isatty():
        click.echo(f"\r\033[K{line}", nl=False, err=True)


def _table(record: dict[str, Any], style: str) -> str:
    from ...bench import table

    if style == "md":
        return table.markdown(record)
    head, *lines = table.lines_of(record, titles=False)
    said = [table.about(record), *table.remarks(record)]
    return "\n".join([table_text(head, lines), *said, ""])


def _more_tables(record: dict[str, Any], given: dict[str, Any]) -> str:
    found = [_details(record)] if given["details"] else []
    found += [_counters(record)] if given["counters"] else []
    return "".join(f"{text}\n" for text in found)


def _details(record: dict[str, Any]) -> str:
    from ...bench import table

    head, *lines = table.detail_lines(record)
    return table_text(head, lines, right=head[3:])


def _counters(record: dict[str, Any]) -> str:
    from ...bench import table

    head, *lines = table.counter_lines(record)
    return table_text(head, lines, right=head[2:])


def _plot(record: dict[str, Any]) -> str:
    from ...bench.plot import plot

    return plot(record)


def _write(
    record: dict[str, Any], plotted: str, record_path: Path | None, plot_path: Path | None
) -> None:
    from ...bench import record as records
    from ...formats.atomic import write_file

    if record_path:
        records.write(record, record_path)
    if plot_path:
        write_file(plot_path, [plotted.encode("utf-8")])


def _is_wrong(record: dict[str, Any]) -> bool:
    """Say whether in a record a result differs from ours, or ours failed or has open edges."""
    from ...bench.targets import OURS, result_of

    for row in record["cases"]:
        for item in row["items"]:
            ours = result_of(item, OURS)
            others = [*item["engines"].values(), item.get("at_once", {}), ours.get("proof", {})]
            if ours.get("state") in ("failed", "crashed") or _is_open(ours):
                return True
            if any(found.get("agrees") is False for found in others):
                return True
    return False


def _has_cliff(record: dict[str, Any]) -> bool:
    """Say whether in any row of a record our cost grows faster than its bound allows."""
    from ...bench.table import has_cliff

    return any(has_cliff(row) for row in record["cases"])


def _is_open(found: dict[str, Any]) -> bool:
    return bool(found.get("facts", {}).get("open_edges"))
