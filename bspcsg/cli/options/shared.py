"""Options and option types that several verbs of the command line share."""

import math
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click
from click.core import ParameterSource

from ...parameters import MAX_PITCH, MAX_SECONDS, MAX_THREADS
from ...suggestions import suggestion_text
from ..inputs.lengths import MILLIMETRES, as_length
from ..inputs.scripts import STREAMED, SUFFIXES

_Command = TypeVar("_Command", bound=Callable[..., Any])


if TYPE_CHECKING:
    _Choice = click.Choice[str]
else:
    _Choice = click.Choice


class RareOption(click.Option):
    """A rarely used option, which the help lists under “More options”."""


class Verb(click.Command):
    """A command whose help lists its options under “Options” and “More options”."""

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the help of the common options, then of the rarely used ones."""
        options = [one for one in self.get_params(ctx) if isinstance(one, click.Option)]
        for title, is_further in (("Options", False), ("More options", True)):
            chosen = [one for one in options if isinstance(one, RareOption) == is_further]
            records = [record for one in chosen if (record := one.get_help_record(ctx))]
            if records:
                with formatter.section(title):
                    formatter.write_dl(records)


def verb(name: str, **settings: Any) -> Callable[[Callable[..., Any]], Verb]:
    """Return a decorator that makes a `Verb` of a function, as `click.command` does."""
    return click.command(name, cls=Verb, **settings)


#: Makes an option that the help lists under “More options”.
rare_option = partial(click.option, cls=RareOption)


class FilePath(click.Path):
    """The click type of options and arguments that are names of files or folders.

    It does not check whether a file can be read: click would report an unreadable file as wrong
    usage.
    """

    def __init__(self, *, readable: bool = False, **kinds: bool) -> None:
        super().__init__(path_type=Path, readable=readable, **kinds)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Convert a text to a path; the empty text is an error, not the current folder."""
        if value == "":
            self.fail("the file name is empty; perhaps a shell variable is not set.", param, ctx)
        return super().convert(value, param, ctx)


#: The type of an option or argument that is a file name, or "-" for a stream.
PATH = FilePath(allow_dash=True)


class FiniteRange(click.FloatRange):
    """The click type of options that are finite numbers within bounds."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Convert a text to a number; an infinite one or NaN is an error."""
        number = float(super().convert(value, param, ctx))
        if not math.isfinite(number):
            self.fail(f"{number} is not a finite number.", param, ctx)
        return number


class Renamed(click.Option):
    """An option with one value that also accepts an old name, which the help does not list.

    Parameters
    ----------
    *given, **options
        As for `click.Option`.
    old : str
        The old name, such as ``--tol``.
    """

    def __init__(self, *given: Any, old: str, **options: Any) -> None:
        super().__init__(*given, **options)
        self._old = old

    def add_to_parser(self, parser: Any, ctx: click.Context) -> None:
        """Add the option to the parser under both names."""
        super().add_to_parser(parser, ctx)
        parser.add_option(obj=self, opts=[self._old], dest=self.name, nargs=self.nargs)


class Words(_Choice):
    """The click type of options that are one of several words; an error suggests the nearest."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Return a text if it is one of the words; else raise an error with a suggestion."""
        try:
            return super().convert(value, param, ctx)
        except click.BadParameter as error:
            asks = suggestion_text(value, map(str, self.choices))
            raise click.BadParameter(error.message + asks, ctx, param) from error


SECONDS = FiniteRange(0, MAX_SECONDS, min_open=True)

#: The type of options that are counts of sample points; ten million take seconds and a gigabyte.
SAMPLES = click.IntRange(0, 10_000_000)

_THREADS = rare_option(
    "-j",
    "--jobs",
    "--threads",
    "threads",
    metavar="N",
    type=click.IntRange(0, MAX_THREADS),
    default=0,
    help="Number of threads; 0, the default, for all cores.",
)

_COMMON = [
    click.option("--json", "as_json", is_flag=True, help="Print one JSON document instead."),
    _THREADS,
    rare_option("-q", "--quiet", is_flag=True, help="Say nothing but results and errors."),
    rare_option("-v", "--verbose", is_flag=True, help="Say more about what is done."),
    rare_option("--debug", is_flag=True, help="Show where an error comes from."),
]


def _formats(context: click.Context, option: click.Parameter, begun: str) -> list[str]:
    """Return the names of formats that begin with a text, for shell completion."""
    from ...formats.registry import FORMATS

    known = (*FORMATS, *(STREAMED if option.name == "from_format" else ()))
    names = sorted(suffix.removeprefix(".") for suffix in known)
    return [name for name in names if name.startswith(begun.lower())]


def _as_source(context: click.Context, option: click.Parameter, value: str | None) -> str | None:
    """Convert the name of a mesh format or of a script's language to a suffix with a dot."""
    suffix = "" if value is None else f".{value.lower().lstrip('.')}"
    return suffix if suffix in SUFFIXES else _as_suffix(context, option, value)


def _as_suffix(context: click.Context, option: click.Parameter, value: str | None) -> str | None:
    """Convert the name of a mesh format, such as “stl” or “.stl”, to a suffix with a dot."""
    from ...formats.registry import FORMATS

    if value is None:
        return None
    suffix = f".{value.lower().lstrip('.')}"
    if suffix not in FORMATS:
        known = ", ".join(name[1:] for name in sorted(FORMATS))
        raise click.BadParameter(
            f"{value!r} is not a known format; known are {known}.", context, option
        )
    return suffix


_READING = [
    rare_option(
        "--from",
        "from_format",
        metavar="FORMAT",
        callback=_as_source,
        shell_complete=_formats,
        help="Format of standard input, and of files without a known suffix, e.g. stl or csg.",
    ),
    click.option(
        "--unit",
        type=click.Choice(list(MILLIMETRES)),
        help="Unit of inputs that do not state one; they are converted to millimetres.",
    ),
]

_SETS = [
    rare_option(
        "--winding",
        type=click.Choice(["positive", "nonzero", "even-odd"]),
        default="positive",
        help="Which winding numbers are inside a file that overlaps itself.",
    ),
    rare_option(
        "--pitch",
        metavar="PITCH",
        type=click.IntRange(-MAX_PITCH, MAX_PITCH),
        help="Lattice step 10^PITCH units; by default -9, or what the size asks for.",
    ),
    click.option(
        "--on-invalid",
        type=click.Choice(["error", "warn", "repair"]),
        default="error",
        show_default=True,
        help="Refuse files that are not closed, leave them out, or close them with pymeshlab.",
    ),
]

_WRITING = [
    click.option(
        "--to",
        "to_format",
        metavar="FORMAT",
        callback=_as_suffix,
        shell_complete=_formats,
        help="Format of the output, e.g. ply.",
    ),
    rare_option("--ascii", "text", is_flag=True, help="Write STL and PLY as text."),
    rare_option(
        "--digits",
        metavar="N",
        type=click.IntRange(1, 17),
        help="Significant digits of coordinates; by default as many as give the same doubles.",
    ),
    rare_option(
        "--overwrite/--no-overwrite",
        default=True,
        help="Whether to replace a file that is there (default).",
    ),
]

_DRAWING = [
    click.option(
        "-o",
        "--output",
        "target",
        required=True,
        metavar="FILE",
        type=PATH,
        help="File to write, its format by its suffix; - for standard output.",
    ),
    click.option("--to", "to_format", metavar="FORMAT", help="Format of the output, e.g. svg."),
    _WRITING[-1],
]

OUTPUT = _DRAWING[0]

_MAYBE_OUTPUT = click.option(
    "-o",
    "--output",
    "target",
    metavar="FILE",
    type=PATH,
    help="File to write, its format by its suffix; - for standard output. Needed unless --view"
    " shows the result.",
)

_ONE_BY_ONE = [
    click.option(
        "-o",
        "--output",
        "target",
        metavar="FILE",
        type=PATH,
        help="File to write; with several inputs, % stands for the name of each.",
    ),
    click.option(
        "--outdir",
        metavar="FOLDER",
        type=PATH,
        help="Folder for the files, under their own names; it is made if it is not there.",
    ),
]

OVERWRITE = _WRITING[-1]

ALLOW_EMPTY = rare_option(
    "--allow-empty", is_flag=True, help="Write a file even if nothing is left."
)

#: The values of ``--validate``: how thoroughly a result is compared with manifold3d's.
_CHECKS = ("quick", "full", "off")


def check_depth(command: _Command) -> _Command:
    """Add the options for the comparison with manifold3d to a command."""
    leave_out = rare_option(
        "--no-validate", "--no-check", "check", flag_value="off", help="The same as --check=off."
    )
    compare = click.option(
        "--validate",
        "--check",
        "check",
        is_flag=False,
        flag_value="quick",
        default="quick",
        metavar="[=quick|full|off]",
        type=click.Choice(_CHECKS),
        help="Compare the result with manifold3d's: by measures and points at the seam, and as sets"
        " where these differ (quick, default); as sets in any case (full); not at all (off).",
    )
    return compare(leave_out(command))


SIMPLIFY = click.option(
    "--simplify",
    "tolerance",
    metavar="LENGTH",
    callback=as_length,
    help="Remove edges and slivers up to this, as 0.01mm, moving no surface farther.",
)

TIMEOUT = click.option(
    "--timeout",
    metavar="SECONDS",
    type=SECONDS,
    help="Seconds to give it.",
)

PORT = rare_option(
    "--port",
    metavar="N",
    type=click.IntRange(0, 65535),
    default=0,
    help="Port of a page that is served; by default any free one.",
)


def is_given(name: str) -> bool:
    """Say whether the user gave an option of the running verb, by its parameter name."""
    context = click.get_current_context()
    return context.get_parameter_source(name) is not ParameterSource.DEFAULT


def finite_numbers(text: str, count: int) -> tuple[float, ...] | None:
    """Convert numbers separated by commas; return None unless they are `count` finite numbers."""
    try:
        found = tuple(float(word) for word in text.split(","))
    except ValueError:
        return None
    return found if len(found) == count and all(map(math.isfinite, found)) else None


#: The texts that replace the names of axes in options that are directions.
_DIRECTIONS = {"x": "1,0,0", "y": "0,1,0", "z": "0,0,1"}


def numbers(what: str, names: str, example: str) -> Callable[..., tuple[float, ...] | None]:
    """Return the click callback of an option that is a direction, or a direction and a number.

    Parameters
    ----------
    what : str
        The name of the value in errors, such as ``"normal"``.
    names : str
        Names of three or four numbers, separated by commas. The first three must not all be 0; the
        name of an axis may replace them.
    example : str
        A valid value, for errors.
    """
    count = names.count(",") + 1
    spoken = {3: "three", 4: "four"}[count]
    zeros = "not" if count == 3 else "the first three not"

    def as_numbers(
        context: click.Context, option: click.Parameter, value: str | None
    ) -> tuple[float, ...] | None:
        if value is None:
            return None
        first, comma, rest = value.partition(",")
        found = finite_numbers(_DIRECTIONS.get(first.strip().lower(), first) + comma + rest, count)
        if found is None or not any(found[:3]):
            wanted = (
                f"{spoken} numbers {names}, {zeros} all 0, as in {example}; x, y and z are axes"
            )
            raise click.BadParameter(f"{value!r} is not a {what}; give {wanted}.", context, option)
        return found

    return as_numbers


def common_options(command: _Command) -> _Command:
    """Add the options that every verb has to a command."""
    return _with(_COMMON, command)


def basic_options(command: _Command) -> _Command:
    """Add the options that every verb has, except ``-j``, to a command."""
    return _with([option for option in _COMMON if option is not _THREADS], command)


def reading_options(command: _Command) -> _Command:
    """Add the options for reading meshes to a command."""
    return _with(_READING, command)


def set_options(command: _Command) -> _Command:
    """Add the options for turning meshes into sets of points to a command."""
    return _with(_SETS, command)


def writing_options(command: _Command) -> _Command:
    """Add the options for writing meshes to a command."""
    return _with(_WRITING, command)


def per_file_options(command: _Command) -> _Command:
    """Add the options for writing one file for each input to a command."""
    return _with(_ONE_BY_ONE, command)


def drawing_options(command: _Command) -> _Command:
    """Add the options for writing a drawing to a command."""
    return _with(_DRAWING, command)


def solid_options(command: _Command) -> _Command:
    """Add the options for making one solid and writing it to a command; ``-o`` is required."""
    return _with([OUTPUT, writing_options, SIMPLIFY, ALLOW_EMPTY, check_depth], command)


def solid_or_view_options(command: _Command) -> _Command:
    """Add the options for making one solid and writing or only showing it; ``-o`` is optional."""
    return _with([_MAYBE_OUTPUT, writing_options, SIMPLIFY, ALLOW_EMPTY, check_depth], command)


def from_files(command: _Command) -> _Command:
    """Add the options for making one solid from mesh files to a command."""
    return _with([solid_options, reading_options, set_options, common_options], command)


def _with(options: list[Callable[[Any], Any]], command: _Command) -> _Command:
    for option in reversed(options):
        command = option(command)
    return command
