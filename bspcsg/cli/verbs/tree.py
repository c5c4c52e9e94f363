"""The verb `tree`, which shows or converts the tree of an OpenSCAD script."""

import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...errors import FormatError, without_control_characters
from ..console import output
from ..console.output import Output, counted
from ..inputs.files import (
    STREAM,
    display_name,
    is_dropped,
    refuse_unwritable,
    stream_text,
    write_output,
)
from ..options.patterns import file_argument
from ..options.shared import OVERWRITE, PATH, TIMEOUT, common_options, verb

if TYPE_CHECKING:
    from ...csg import CsgTree

_EPILOG = """\b
Examples:
  bspcsg tree bracket.csg
  bspcsg tree bracket.scad --simplify -o bracket.json
  bspcsg tree bracket.csg --to dot | dot -Tsvg -o bracket.svg
"""

#: Suffixes of scripts that are read, and the form of the output by its suffix.
_READ = (".csg", ".json", ".scad")
_FORMS = {
    ".csg": "csg",
    ".json": "json",
    ".scad": "scad",
    ".dot": "dot",
    ".gv": "dot",
    ".txt": "text",
}


@verb("tree", short_help="Show or convert the tree of an OpenSCAD script.", epilog=_EPILOG)
@file_argument()
@click.option(
    "-o",
    "--output",
    "target",
    metavar="FILE",
    type=PATH,
    help="File to write; standard output by default.",
)
@click.option(
    "--to",
    "form",
    type=click.Choice(["text", "csg", "json", "scad", "dot"]),
    help="What to write; by default what the suffix of -o says, else text.",
)
@click.option(
    "--from",
    "source",
    type=click.Choice(["csg", "json"]),
    default="csg",
    show_default=True,
    help="What standard input is.",
)
@click.option("--simplify", is_flag=True, help="Leave out nodes that make no difference.")
@OVERWRITE
@TIMEOUT
@common_options
def tree(file: Path, **given: Any) -> int:
    """Show the tree of an OpenSCAD script, or write it in another form.

    Reads .csg files, the same tree as .json, and .scad files through the program openscad. Nothing
    is evaluated, and nodes that bspcsg cannot evaluate stay. --json prints the number of nodes of
    each kind.
    """
    return _TreeVerb(file, **given).run()


class _TreeVerb:
    """The work of the verb `tree`: it reads the tree of one script and writes it."""

    def __init__(
        self, file: Path, target: Path | None, form: str | None, source: str, **settings: Any
    ) -> None:
        self._file = file
        self._target = target
        self._source = source
        self._settings = settings
        self._form = form or _form_of(target)
        self._out = Output.of(settings)
        if form and target is None and settings["as_json"]:
            raise click.UsageError(
                "--json and a tree cannot both go to standard output; give -o a file name, or"
                " leave out --json."
            )

    @property
    def _to_file(self) -> bool:
        return self._target is not None and str(self._target) != STREAM

    def run(self) -> int:
        from ...csg.syntax.simplification import simplified

        refuse_unwritable(self._target or Path(STREAM), self._settings["overwrite"])
        found = self._read()
        tree = simplified(found) if self._settings["simplify"] else found
        kinds = _kinds(tree)
        self._write(_written(tree, self._form))
        self._tell(kinds)
        return output.DONE

    def _read(self) -> "CsgTree":
        from ...csg import read_tree

        if str(self._file) == STREAM:
            return _from_stream(self._source)
        suffix = self._file.suffix.lower()
        if suffix not in _READ:
            message = (
                f"{display_name(self._file)}: the file is not a script with a tree; its name must"
                " end in"
                f" one of {', '.join(_READ)}."
            )
            raise FormatError(message, "unknown_format")
        timeout = self._settings["timeout"]
        if timeout is not None and suffix != ".scad":
            raise click.UsageError(f"--timeout cannot be used with {suffix} files; leave it out.")
        return read_tree(self._file, **({} if timeout is None else {"timeout": timeout}))

    def _write(self, text: str) -> None:
        if self._target and self._to_file:
            write_output(self._target, [text.encode()], self._settings["overwrite"])
        elif not self._out.as_json:
            # Without color=True, click would drop a terminal's control sequences from a pipe.
            said = without_control_characters(text) if sys.stdout.isatty() else text
            click.echo(said, nl=False, color=True)

    def _tell(self, kinds: "Counter[str]") -> None:
        from ...csg import node_names

        unknown = sorted(set(kinds) - set(node_names()))
        if unknown:
            self._out.note(
                f"{display_name(self._file)}: bspcsg run cannot evaluate {', '.join(unknown)}"
            )
        count = kinds.total()
        line = f"{display_name(self._target)}  {counted(count, 'node')}" if self._target else ""
        document = {
            "file": str(self._file),
            "output": str(self._target) if self._to_file else None,
            "nodes": count,
            "kinds": dict(kinds.most_common()),
            "unsupported": unknown,
        }
        self._out.result(line if self._to_file else "", document)


def _form_of(target: Path | None) -> str:
    """Return the form of the output by its suffix; text for standard output."""
    if target is None or str(target) == STREAM or is_dropped(target):
        return "text"
    suffix = target.suffix.lower()
    if suffix not in _FORMS:
        known = ", ".join(_FORMS)
        message = (
            f"{display_name(target)}: the format is unknown; the output name must end in one of"
            f" {known}, or give --to."
        )
        raise FormatError(message, "unknown_format")
    return _FORMS[suffix]


def _from_stream(source: str) -> "CsgTree":
    from ...csg import from_json, parse

    reader: Callable[[str, str], CsgTree] = from_json if source == "json" else parse
    return reader(stream_text(), STREAM)


def _written(tree: "CsgTree", form: str) -> str:
    from ... import csg

    if form == "json":
        return csg.to_json(tree, indent=1) + "\n"
    if form in ("csg", "scad"):
        return csg.written(tree, scad=form == "scad")
    return csg.graph(tree) if form == "dot" else csg.outline(tree)


def _kinds(tree: "CsgTree") -> "Counter[str]":
    """Return the number of nodes of a tree by name."""
    kinds: Counter[str] = Counter()
    waiting = list(tree.nodes)
    while waiting:
        node = waiting.pop()
        kinds[node.name] += 1
        waiting.extend(node.children)
    return kinds
