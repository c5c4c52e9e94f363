"""The verb `run`, which evaluates an OpenSCAD or Python script."""

import ast
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any
from unicodedata import category

import click

from ...errors import FormatError, InvalidMeshError
from ..console.output import Output
from ..inputs.files import ON_INVALID, STREAM, display_name, stream_text
from ..inputs.scripts import SUFFIXES, solid_of_script
from ..options.patterns import file_argument
from ..options.shared import (
    PORT,
    TIMEOUT,
    FilePath,
    common_options,
    is_given,
    rare_option,
    solid_or_view_options,
    verb,
)
from ..pages.script_page import NOWHERE, ScriptPage
from ..solid_verb import SolidVerb

if TYPE_CHECKING:
    from ...csg import Polish
    from ...solid.solid import Solid


def _is_plain_word(text: str) -> bool:
    """Say whether a text is one word, in any alphabet, which is a string without quotes."""
    starts = text[:1].isalpha() or text.startswith("_")
    return starts and all(c.isalnum() or c in "_.-" or category(c)[0] == "M" for c in text)


def _list_nodes(context: click.Context, option: click.Parameter, wanted: bool) -> None:
    """Print the names of the OpenSCAD nodes that can be evaluated, and exit."""
    if wanted and not context.resilient_parsing:
        from ...csg import node_names

        click.echo("\n".join(node_names()))
        context.exit()


def _as_texts(
    context: click.Context, option: click.Parameter, values: tuple[str, ...]
) -> dict[str, str]:
    """Convert texts such as “width=12.5” to a dictionary of text by name."""
    texts = {}
    for given in values:
        name, equals, text = given.partition("=")
        if not equals or not name.removeprefix("$").isidentifier():
            raise click.BadParameter(
                f"{given!r} is not of the form NAME=VALUE, as in width=12.5.", context, option
            )
        texts[name] = text
    return texts


def _value(text: str) -> Any:
    """Return the value of a text as an OpenSCAD expression; a single word is a string."""
    from ...csg import value_of

    try:
        return value_of(text)
    except FormatError:
        if _is_plain_word(text):
            return text
        wanted = "a number, text, true, false or [list]"
        message = f"{text!r} is not a value; give {wanted}."
        raise click.BadParameter(message, param_hint="-D") from None


def _python_value(text: str) -> Any:
    """Return the value of a text as a Python literal, or else as an OpenSCAD expression."""
    try:
        return ast.literal_eval(text)
    except (ValueError, SyntaxError, TypeError, MemoryError, RecursionError):
        return _value(text)


_EPILOG = """\b
Examples:
  bspcsg run bracket.scad -o bracket.3mf --polish -D width=12.5
  bspcsg run part.py -o part.stl
  bspcsg run part.py --watch --view
"""

#: The suffixes of scripts with which an option cannot be used, by the option's parameter name.
_NOT_FOR = {
    "polish": (".py",),
    "on_invalid": (".py",),
    "lenient": (".py",),
    "allow_paths": (".py",),
    "timeout": (".csg", ".json"),
    "defines": (".csg", ".json"),
}

#: How options are spelled, where that does not follow from the parameter name.
_OPTION_NAMES = {"defines": "-D", "allow_paths": "--allow-path"}


@verb("run", short_help="Write the solid that an OpenSCAD or Python script makes.", epilog=_EPILOG)
@file_argument("SCRIPT", "script")
@click.option(
    "-D",
    "defines",
    metavar="NAME=VALUE",
    multiple=True,
    callback=_as_texts,
    help="Set a variable of a .scad or .py script, in place of what it assigns at its top level: a"
    " number, text, true, false or [list]; can be repeated.",
)
@rare_option(
    "--list-nodes",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_list_nodes,
    help="List the nodes that can be evaluated, and end.",
)
@click.option(
    "--polish",
    is_flag=True,
    help="Undo OpenSCAD's rounding to six digits, and say how far corners moved; not for Python.",
)
@click.option(
    "--on-invalid",
    type=click.Choice(["error", "warn", "repair"]),
    default="error",
    show_default=True,
    help="Refuse meshes that are not closed, leave them out, or close them; not for Python.",
)
@rare_option(
    "--lenient",
    is_flag=True,
    help="Leave out what cannot be made or is not closed, with a warning that names its place; not"
    " for Python.",
)
@rare_option(
    "--allow-path",
    "allow_paths",
    metavar="DIR",
    multiple=True,
    type=FilePath(exists=True, file_okay=False, readable=True),
    help="A folder beside the script's own whose files it may read; can be repeated; not for"
    " Python.",
)
@click.option(
    "--watch", "watches", is_flag=True, help="Run again whenever the script changes, until Ctrl-C."
)
@click.option(
    "--view",
    "shows",
    is_flag=True,
    help="Show the result in a browser, in a page that follows it, until Ctrl-C.",
)
@rare_option(
    "--open/--no-open", "opens", default=True, help="Open that page in a browser (default)."
)
@PORT
@TIMEOUT
@solid_or_view_options
@common_options
def run(
    script: Path,
    target: Path | None,
    watches: bool,
    shows: bool,
    opens: bool,
    port: int,
    **given: Any,
) -> int:
    """Evaluate a script and write the solid it makes.

    A .csg file is read as OpenSCAD writes it, and so is standard input, for which - stands. A
    .json file is the same tree (see bspcsg tree); a .scad file needs the program openscad. A .py
    file assigns its solid to the variable result, or calls bspcsg.show; it runs with all your
    rights, and its output goes to standard error.
    """
    if target is None and not shows:
        raise click.UsageError(
            "no output is given; write the solid with -o part.stl, or show it with --view."
        )
    if not shows and is_given("port"):
        raise click.UsageError("--port can only be used with --view.")

    def job() -> SolidVerb:
        return _Run(script, target=NOWHERE if target is None else target, **given)

    if not watches and not shows:
        return job().run()
    if str(script) == STREAM:
        raise click.UsageError("--watch and --view need a script file, not standard input.")
    return ScriptPage(script, job, Output.of(given), watches).run(port if shows else None, opens)


class _Run(SolidVerb):
    """The work of the verb `run`: it evaluates one script once."""

    def __init__(self, script: Path, **settings: Any) -> None:
        super().__init__("run", **settings)
        self._script = script
        self._suffix = ".csg" if str(script) == STREAM else script.suffix.lower()
        self._defines: dict[str, Any] = {}

    def paths(self) -> Sequence[Path]:
        return [self._script]

    @property
    def name(self) -> str:
        return super().name if self.target.path != NOWHERE else display_name(self._script)

    def refuse_inputs(self) -> None:
        if self._suffix not in SUFFIXES:
            known = ", ".join(SUFFIXES)
            message = (
                f"{display_name(self._script)}: the file is not a script; its name must end in one"
                " of"
                f" {known}."
            )
            raise FormatError(message, "unknown_format")
        self._refuse_options()
        value = _python_value if self._suffix == ".py" else _value
        texts = self.settings["defines"].items()
        self._defines = {name: value(text) for name, text in texts}

    def _refuse_options(self) -> None:
        for name, useless in _NOT_FOR.items():
            if self._suffix in useless and is_given(name):
                option = _OPTION_NAMES.get(name, f"--{name.replace('_', '-')}")
                raise click.UsageError(
                    f"{option} cannot be used with {self._suffix} files; leave it out."
                )

    def combined(self) -> "Solid":
        given = {"timeout": self.settings["timeout"], "defines": self._defines}
        options = {name: value for name, value in given.items() if value}
        if self._suffix == ".py":
            return solid_of_script(self._script, self.out, **options)
        names = ("polish", "on_invalid", "allow_paths", "lenient")
        options |= {name: self.settings[name] for name in names}
        text = stream_text() if str(self._script) == STREAM else None
        with self._advised():
            return solid_of_script(
                self._script, self.out, text, on_polish=self._tell_polish, **options
            )

    def _tell_polish(self, done: "Polish") -> None:
        if done.pitch is None:
            self.out.note("polish: no corners had to move")
        else:
            step = f"a lattice of step 1e{done.pitch:+03d}"
            self.out.note(f"polish: corners moved by {done.moved:.2g} at most, to {step}")

    @contextmanager
    def _advised(self) -> Iterator[None]:
        """Add advice on ``--on-invalid`` to an error about a mesh that is not closed."""
        try:
            yield
        except InvalidMeshError as error:
            if error.code != "not_closed" or self.settings["on_invalid"] != "error":
                raise
            message = f"{error.message}\n{ON_INVALID}"
            raise InvalidMeshError(message, error.code, error.where) from error
