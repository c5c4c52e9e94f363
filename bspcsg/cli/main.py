"""Entry point: the verbs, and what every failure becomes."""

import os
import sys
from collections.abc import Sequence

import click

from .. import __version__
from ..errors import BspcsgError
from . import output
from .combine import difference, intersection, union, xor
from .examine import check

_EPILOG = """\b
Exit codes:
  0    done, nothing found
  1    done, but a check failed: not a solid, or manifold3d disagrees
  2    wrong usage
  3    a file is missing, unreadable or of an unknown format
  4    geometry refused: not closed, too large, or an empty result
  5    the output could not be written
  70   a defect of bspcsg
  130  interrupted        141  closed pipe

\b
Example:
  bspcsg difference plate.stl hole.obj -o part.ply
"""


@click.group(
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog=_EPILOG,
)
@click.version_option(__version__, prog_name="bspcsg", message="%(prog)s %(version)s")
def commands() -> None:
    """Exact set operations on closed triangle meshes.

    Reads STL, OBJ, PLY, OFF and 3MF; writes STL, OBJ, PLY and OFF. The suffix names the format.
    """


for _verb in (union, difference, intersection, xor, check):
    commands.add_command(_verb)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and end the process with its exit code."""
    sys.exit(run(sys.argv[1:] if arguments is None else arguments))


def run(arguments: Sequence[str]) -> int:
    """Run the command line and return its exit code; no exception leaves but with ``--debug``."""
    try:
        code = _invoked(list(arguments))
        sys.stdout.flush()
        return code
    except BrokenPipeError:
        _discard_output()
        return output.CLOSED_PIPE
    except (KeyboardInterrupt, click.Abort):
        return output.INTERRUPTED
    except click.exceptions.Exit as done:
        return done.exit_code
    except click.exceptions.NoArgsIsHelpError as error:
        click.echo(error.format_message(), err=True)
        return output.USAGE
    except click.ClickException as error:
        return _usage_error(error)
    except Exception as error:
        if "--debug" in arguments:
            raise
        return _failed(error, "--json" in arguments)


def _invoked(arguments: list[str]) -> int:
    with commands.make_context("bspcsg", arguments) as context:
        code = commands.invoke(context)
    return code if isinstance(code, int) else output.DONE


def _usage_error(error: click.ClickException) -> int:
    context = error.ctx if isinstance(error, click.UsageError) else None
    click.echo(f"bspcsg: error: {error.format_message()}", err=True)
    if context is not None:
        click.echo(f"  Try: {context.command_path} --help", err=True)
    return error.exit_code


def _failed(error: Exception, as_json: bool) -> int:
    if isinstance(error, BspcsgError):
        return output.tell_error(error, as_json)
    said = "out of memory" if isinstance(error, MemoryError) else f"{type(error).__name__}: {error}"
    message = f"{said}. This is a defect of bspcsg; run it again with --debug to see where."
    return output.tell_error(BspcsgError(message), as_json) and output.INTERNAL


def _discard_output() -> None:
    """Point standard output at nothing, so that nothing is flushed into the closed pipe."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
