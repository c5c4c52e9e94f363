"""The command line: it runs a verb and turns each error into a message and an exit code."""

import codecs
import errno
import os
import sys
from collections.abc import Sequence
from importlib import import_module

import click

from .._core import __version__
from ..errors import BspcsgError, FormatError, InternalError, without_control_characters
from ..suggestions import suggestion_text
from .console import clock, output, standard_streams, status_line, terminal

_EPILOG = """\b
Exit codes:
  0    done, nothing found
  1    done, but: not a solid, files differ, manifold3d disagrees, or data lost with --fail-on-loss
  2    wrong usage
  3    a file is missing, unreadable or of an unknown format
  4    geometry refused: not closed, too large, or an empty result
  5    the output could not be written, or a mesh read back from it differs
  6    an optional part is missing; bspcsg doctor says which
  70   a defect of bspcsg
  124  a time limit was hit
  130  interrupted        141  closed pipe

\b
Completion of commands, options and files by the shell:
  eval "$(_BSPCSG_COMPLETE=bash_source bspcsg)"       in ~/.bashrc
  eval "$(_BSPCSG_COMPLETE=zsh_source bspcsg)"        in ~/.zshrc
  _BSPCSG_COMPLETE=fish_source bspcsg | source        in config.fish

\b
Example:
  bspcsg difference plate.stl hole.obj -o part.ply
"""

#: The verbs in the order of the help, each with the names of its module and of its function.
_VERBS = {
    "union": ("combine", "union"),
    "difference": ("combine", "difference"),
    "intersection": ("combine", "intersection"),
    "xor": ("combine", "xor"),
    "eval": ("eval", "evaluate"),
    "run": ("run", "run"),
    "tree": ("tree", "tree"),
    "hull": ("model", "hull"),
    "simplify": ("model", "simplify"),
    "split": ("split", "split"),
    "slice": ("slice", "section"),
    "project": ("project", "project"),
    "clash": ("clash", "clash"),
    "render": ("render", "render"),
    "convert": ("convert", "convert"),
    "info": ("info", "info"),
    "check": ("check", "check"),
    "repair": ("repair", "repair"),
    "compare": ("compare", "compare"),
    "crosscheck": ("crosscheck", "crosscheck"),
    "report": ("report", "report"),
    "view": ("view", "view"),
    "lecture": ("lecture", "lecture"),
    "bench": ("bench", "bench"),
    "doctor": ("doctor", "doctor"),
}

#: Other names of verbs, which the help does not list.
_ALIASES = {"cut": "difference", "explode": "split", "validate": "crosscheck"}

#: Former names of verbs, which will be removed.
_FORMER = frozenset({"explode", "validate"})

#: The system's error numbers of writing to a file or stream that is full, broken or closed.
_WRITE_ERRNOS = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF)

_COMPLETE = "_BSPCSG_COMPLETE"


class _Verbs(click.Group):
    """The group of all verbs; it imports the module of a verb when the verb is used."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(_VERBS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        verb = _ALIASES.get(cmd_name, cmd_name)
        if verb not in _VERBS:
            return None
        module, name = _VERBS[verb]
        found: click.Command = getattr(import_module(f".verbs.{module}", __package__), name)
        return found

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        known = {*_VERBS, *_ALIASES}
        if args and args[0] not in known and not args[0].startswith("-"):
            asks = suggestion_text(args[0], _VERBS)
            raise click.UsageError(f"there is no command {args[0]!r}.{asks}", ctx)
        if args and args[0] in _FORMER and not terminal.QUIET.intersection(ctx.obj or ()):
            terminal.print_line(
                "note",
                f"{args[0]} is now called {_ALIASES[args[0]]}; the old name will be removed"
                " later, so use the new one.",
            )
        return super().resolve_command(ctx, args)


@click.group(
    cls=_Verbs,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog=_EPILOG,
)
@click.version_option(__version__, prog_name="bspcsg", message="%(prog)s %(version)s")
def commands() -> None:
    """Exact set operations on closed triangle meshes.

    Reads and writes STL, OBJ, PLY, OFF, 3MF and GLB, and VTK and VTU if meshio is installed. The
    suffix names the format; - stands for standard input or output.
    """


def main(arguments: Sequence[str] | None = None, began: float | None = None) -> None:
    """Run the command line, and end the process with its exit code.

    `began` is the start time of the process, as `time.perf_counter` measures it.
    """
    _fill_closed_streams()
    standard_streams.replace_streams(_ERRORS)
    sys.exit(run(sys.argv[1:] if arguments is None else arguments, began))


def _fill_closed_streams() -> None:
    """Open the null device for each closed standard stream.

    Otherwise another file would get the descriptor of the stream. Reading then yields nothing, and
    writing to standard output fails as on a full disk.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            # The system assigns the lowest free number, which is that of the closed stream.
            handle = os.open(os.devnull, os.O_WRONLY if name == "stderr" else os.O_RDONLY)
            if handle == number:
                setattr(sys, name, os.fdopen(handle, "w" if number else "r", encoding="utf-8"))


def run(arguments: Sequence[str], began: float | None = None) -> int:
    """Run the command line and return its exit code; with ``--debug``, raise errors."""
    clock.start(began)
    try:
        code = _run_and_report(list(arguments))
        sys.stdout.flush()
        return code
    except BrokenPipeError:
        standard_streams.redirect_to_null()
        return output.CLOSED_PIPE
    except standard_streams.FullOutputError as error:
        return output.report_error(_unwritable(error), as_json=False)
    except KeyboardInterrupt:
        return output.INTERRUPTED


def _run_and_report(arguments: list[str]) -> int:
    """Run the command line, print its errors and return the exit code.

    Errors of writing to standard output are raised.
    """
    try:
        return _invoked(arguments)
    except (BrokenPipeError, standard_streams.FullOutputError):
        raise
    except click.Abort:
        return output.INTERRUPTED
    except click.exceptions.Exit as done:
        return done.exit_code
    except click.exceptions.NoArgsIsHelpError as error:
        click.echo(error.format_message(), err=True)
        return output.USAGE
    except click.ClickException as error:
        return _usage_error(error, _asks_for_json(arguments))
    except Exception as error:
        if "--debug" in arguments:
            raise
        return _failed(error, _asks_for_json(arguments))


def _unwritable(error: OSError) -> FormatError:
    """Return a `FormatError` that names the file which could not be written."""
    name = "a file" if error.filename is None else os.fsdecode(error.filename)
    return FormatError(f"{name}: cannot write: {error.strerror}.", "unwritable")


def _unencodable_replacement(error: UnicodeError) -> tuple[str | bytes, int]:
    """Handle encoding errors of printed text, as a codec's error handler.

    Bytes of file names that are no Unicode stay unchanged; other characters become ``?``.
    """
    if not isinstance(error, UnicodeEncodeError):
        raise error
    letters = error.object[error.start : error.end]
    data = b"".join(
        bytes([ord(letter) - 0xDC00]) if "\udc80" <= letter <= "\udcff" else b"?"
        for letter in letters
    )
    return data, error.end


_ERRORS = "bspcsg_names"
codecs.register_error(_ERRORS, _unencodable_replacement)


def _invoked(arguments: list[str]) -> int:
    if _COMPLETE in os.environ:
        from click.shell_completion import shell_complete

        return shell_complete(commands, {}, "bspcsg", _COMPLETE, os.environ[_COMPLETE])
    quiet = bool(terminal.QUIET.intersection(arguments))
    with (
        commands.make_context("bspcsg", arguments, obj=tuple(arguments)) as context,
        status_line.displayed(next(iter(arguments), ""), quiet),
    ):
        code = commands.invoke(context)
    return code if isinstance(code, int) else output.DONE


def _usage_error(error: click.ClickException, as_json: bool) -> int:
    context = error.ctx if isinstance(error, click.UsageError) else None
    message = without_control_characters(error.format_message())
    terminal.print_error(message)
    if as_json:
        values = {"code": "usage", "message": message, "where": []}
        output.print_error(values, error.exit_code)
    if context is not None:
        click.echo(f"  Try: {context.command_path} --help", err=True)
    return error.exit_code


def _asks_for_json(arguments: Sequence[str]) -> bool:
    """Say whether the arguments ask for a JSON document on standard output."""
    return "--json" in arguments


def _failed(error: Exception, as_json: bool) -> int:
    if isinstance(error, BspcsgError):
        return output.report_error(error, as_json)
    if isinstance(error, OSError) and error.errno in _WRITE_ERRNOS:
        return output.report_error(_unwritable(error), as_json)
    said = "out of memory" if isinstance(error, MemoryError) else f"{type(error).__name__}: {error}"
    message = (
        f"{said}. This is a defect of bspcsg; run the command again with --debug to see where it"
        " happens, and report it."
    )
    return output.report_error(InternalError(message), as_json)
