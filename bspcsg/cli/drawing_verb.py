"""The base class of verbs that make a drawing: it checks, writes and reports."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import FormatError
from .console import clock, output
from .console.output import Output
from .inputs.files import STREAM, Inputs, display_name, is_dropped, refuse_unwritable, write_output

if TYPE_CHECKING:
    from ..bsp import Region


class DrawingVerb(ABC):
    """A verb's work of making a drawing from a file and writing it; subclasses implement `drawn`.

    Parameters
    ----------
    file, target : Path
        The input and the output.
    suffixes : sequence of str
        The suffixes of the formats that can be written.
    **settings
        All other options of the verb, by name.
    """

    def __init__(self, file: Path, target: Path, suffixes: Sequence[str], **settings: Any) -> None:
        self.file = file
        self.target = target
        self.settings = settings
        self._suffixes = suffixes
        self.suffix = self._suffix(settings["to_format"])
        self.out = Output.of(settings, self._is_stream)
        self.inputs = Inputs.of(self.out, settings)

    @abstractmethod
    def drawn(self) -> tuple[bytes, str, dict[str, Any]]:
        """Make the drawing: return its bytes, a text for the result line, and JSON values."""

    def sources(self) -> Sequence[Path]:
        """Return the input files."""
        return [self.file]

    def run(self) -> int:
        """Make, write and report the drawing, and return the exit code."""
        from ..parameters import set_threads

        set_threads(self.settings["threads"])
        refuse_unwritable(self.target, self.settings["overwrite"])
        self.inputs.refuse_early(self.sources())
        data, words, values = self.drawn()
        write_output(self.target, [data], self.settings["overwrite"])
        seconds = clock.elapsed()
        names = {"file": str(self.file), "output": str(self.target)}
        document = {**names, **values, "seconds": round(seconds, 4)}
        self.out.result(f"{display_name(self.target)}  {words}  {seconds:.2f} s", document)
        return output.DONE

    def data(self, region: "Region") -> bytes:
        """Return a region as the bytes of a drawing in the requested format, SVG or DXF."""
        from ..bsp.drawings.dxf import dxf_data
        from ..bsp.drawings.svg import svg_data

        return svg_data(region) if self.suffix == ".svg" else dxf_data(region)

    @property
    def _is_stream(self) -> bool:
        return str(self.target) == STREAM

    def _suffix(self, form: str | None) -> str:
        """Return the suffix of the output format, from ``--to`` or from the output's name."""
        known = " or ".join(self._suffixes)
        if form is not None:
            suffix = f".{form.lower().removeprefix('.')}"
            if suffix not in self._suffixes:
                raise click.UsageError(f"--to: {form!r} is not a drawing format; use {known}.")
        elif is_dropped(self.target):
            suffix = self._suffixes[0]
        elif self._is_stream:
            raise click.UsageError(
                f"to write to standard output, give the format with --to {known}."
            )
        else:
            suffix = self.target.suffix.lower()
        if self._is_stream and self.settings["as_json"]:
            raise click.UsageError(
                "--json and a drawing cannot both go to standard output; give -o a file name, or"
                " leave out --json."
            )
        if suffix not in self._suffixes:
            message = (
                f"{display_name(self.target)}: the format is unknown; the output name must end in"
                f" {known}."
            )
            raise FormatError(message, "unknown_format")
        return suffix
