"""Processing of files one by one: finding the output of each, and collecting the results."""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

from ..errors import BspcsgError
from .console import output, status_line, terminal
from .console.output import Output
from .inputs.files import STREAM, Target, expanded, is_dropped
from .inputs.scripts import SUFFIXES

#: The smallest number of files for which a progress bar is shown.
_MIN_FILES_FOR_BAR = 4

#: A function that processes an input file; it returns a JSON document and the exit code.
FileProcessor = Callable[[Path, Target], tuple[dict[str, Any], int]]


def targets_of(
    files: Sequence[Path],
    target: Path | None,
    outdir: Path | None,
    suffix: str | None,
    *,
    keeps_format: bool = False,
) -> list[tuple[Path, Path]]:
    """Return each input file with its output path.

    Parameters
    ----------
    files : sequence of Path
    target : Path or None
        The output path; for several files, its name has a % for the name of each input.
    outdir : Path or None
        The folder for the outputs, which have the names of the inputs.
    suffix : str or None
        The suffix of the outputs in `outdir`.
    keeps_format : bool
        True if outputs in `outdir` have the suffix of the input when `suffix` is None.

    Raises
    ------
    click.UsageError
        If no output is given, two files have the same output, or an output would replace an input.
    """
    if (target is None) == (outdir is None):
        raise click.UsageError("no output is given; add either -o FILE or --outdir DIR.")
    if outdir is not None:
        pairs = [
            (path, outdir / f"{_stem(path)}{suffix or _own_suffix(path, keeps_format)}")
            for path in files
        ]
    elif len(files) == 1 or target is None:
        return [(files[0], target or Path(STREAM))]
    elif is_dropped(target):
        return [(path, target) for path in files]
    elif "%" not in target.name:
        raise click.UsageError(
            "with several inputs, the name in -o must contain a % for the name of each input,"
            " as in 'web/%.glb'; or give --outdir DIR."
        )
    else:
        pairs = [(path, expanded(target, _stem(path))) for path in files]
    _refuse_twins(pairs)
    return pairs


def _own_suffix(path: Path, keeps_format: bool) -> str:
    """Return the suffix of an input for its output; raise a usage error if it cannot be used."""
    if not keeps_format or str(path) == STREAM or path.suffix.lower() in SUFFIXES:
        raise click.UsageError("--outdir needs the output format, such as --to glb.")
    return path.suffix


def _stem(path: Path) -> str:
    return "stdin" if str(path) == STREAM else path.stem


def _refuse_twins(pairs: Sequence[tuple[Path, Path]]) -> None:
    seen: dict[Path, Path] = {}
    inputs = {path.resolve(): path for path, _ in pairs if str(path) != STREAM}
    for path, where in pairs:
        other = inputs.get(where.resolve(), path)
        if other.resolve() != path.resolve():
            raise click.UsageError(
                f"the result of {path} would overwrite {where}, which is also an input; choose"
                " another output."
            )
        if where in seen:
            raise click.UsageError(
                f"the results of {seen[where]} and {path} would both be written to {where}; rename"
                " one input, or convert them separately."
            )
        seen[where] = path


def process_each(
    pairs: Sequence[tuple[Path, Target]], out: Output, doing: FileProcessor, word: str
) -> tuple[list[dict[str, Any]], int]:
    """Apply a function to each file; return the JSON documents and the largest exit code.

    If one of several files fails, the error is printed and becomes the file's document, and the
    next file is processed.

    Parameters
    ----------
    pairs : sequence of (Path, Target)
        Inputs and their outputs.
    out : Output
    doing : callable
    word : str
        The label of the progress bar.
    """
    documents, worst = [], output.DONE
    with _progress(pairs, out, word) as shown:
        for path, target in shown:
            try:
                document, code = doing(path, target)
            except BspcsgError as error:
                if len(pairs) == 1:
                    raise
                terminal.print_error(error.message)
                document = {"file": str(path), "error": output.error_values(error)}
                code = output.exit_code_of(error)
            documents.append(document)
            worst = max(worst, code)
    return documents, worst


@contextmanager
def _progress(
    pairs: Sequence[tuple[Path, Target]], out: Output, word: str
) -> Iterator[Iterator[tuple[Path, Target]]]:
    """Yield an iterator over the pairs; for four or more it updates a progress bar."""
    if len(pairs) < _MIN_FILES_FOR_BAR or not sys.stderr.isatty() or out.verbosity < 0:
        yield iter(pairs)
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeElapsedColumn

    status_line.end()
    columns = (word, BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        yield iter(bar.track(pairs))
