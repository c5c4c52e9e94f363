"""Files by name or as streams: how inputs are read, and where an output goes."""

import os
import shlex
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import Finding, FormatError, InvalidMeshError
from .output import Output, counted

if TYPE_CHECKING:
    from ..io import RawMesh
    from ..mesh import Mesh
    from ..solid import Solid

#: The name that stands for standard input or standard output.
STREAM = "-"

#: Millimetres in each unit that ``--unit`` takes.
MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "ft": 304.8, "um": 0.001}


@dataclass(frozen=True)
class Inputs:
    """How input files are read.

    Parameters
    ----------
    out : Output
        Where findings are told.
    suffix : str
        Of the format of standard input, and of files whose own suffix names none.
    unit : str or None
        What files that do not say are in; None if the user has not said either.
    winding : str
    pitch : int or None
    noticed : list of Finding
        What was told about the solids so far, which results repeat.
    """

    out: Output
    suffix: str = ""
    unit: str | None = None
    winding: Any = "positive"
    pitch: int | None = None
    noticed: list[Finding] = field(default_factory=list)

    @classmethod
    def of(cls, out: Output, settings: dict[str, Any]) -> "Inputs":
        """Return what the options of a verb say."""
        names = {"from_format": "suffix", "unit": "unit", "winding": "winding", "pitch": "pitch"}
        found = {to: settings[name] for name, to in names.items() if settings.get(name) is not None}
        return cls(out, **found)

    def refuse_early(self, paths: Sequence[Path]) -> None:
        """Refuse what can be known to fail before anything is read."""
        from ..io import format_of

        if sum(str(path) == STREAM for path in paths) > 1:
            raise click.UsageError("standard input can be read only once; name “-” once.")
        for path in paths:
            if str(path) == STREAM and not self.suffix:
                raise click.UsageError("to read standard input, say its format: --from stl.")
            if not path.suffix and path.is_dir():
                message = f"{path}: this is a folder; name the files in it, as in {path / '*.stl'}."
                raise FormatError(message, "unreadable")
            if self.suffix_of(path) != self.suffix:
                format_of(path)

    def tell_units(self, pairs: Iterable[tuple[Path, "Target"]]) -> None:
        """Say once which inputs have no unit although their outputs state one."""
        from ..io import FORMATS

        unknown = [
            path
            for path, target in pairs
            if FORMATS[target.suffix.lower()].unit and not FORMATS[self.suffix_of(path)].unit
        ]
        if unknown and self.unit is None:
            more = f" and {len(unknown) - 1} more have" if len(unknown) > 1 else " has"
            self.out.note(
                f"{shown(unknown[0])}{more} no unit; mm assumed (say --unit in to change)"
            )

    def suffix_of(self, path: Path) -> str:
        """Return the suffix of the format that a file is read as."""
        from ..io import FORMATS

        own = path.suffix.lower()
        return own if own in FORMATS or not self.suffix else self.suffix

    def raw(self, path: Path) -> "RawMesh":
        """Read a mesh as it is, in millimetres if a unit is known or said."""
        from ..io import decoded, read_as

        if str(path) == STREAM:
            raw = decoded(STREAM, sys.stdin.buffer.read(), self.suffix)
        else:
            raw = read_as(path, self.suffix_of(path))
        if raw.unit or self.unit is None:
            return raw
        scale = MILLIMETRES[self.unit]
        vertices = raw.vertices if scale == 1 else raw.vertices * scale
        return replace(raw, vertices=vertices, unit="mm")

    def solid(self, path: Path) -> "Solid":
        """Read a solid, and tell what was noteworthy about the file."""
        raw = self.raw(path)
        solid = self.as_solid(raw, path)
        noticed = [Finding.from_core(found) for found in solid.tree.findings]
        self.noticed.extend(noticed)
        self.tell(path, (*raw.findings, *noticed))
        self.out.detail(f"{shown(path)}: {counted(len(raw.faces), 'triangle')}")
        return solid

    def as_solid(self, raw: "RawMesh", path: Path) -> "Solid":
        """Return the solid of what was read; a mesh that is none is told how to become one."""
        from ..io import solid_of

        try:
            return solid_of(raw, shown(path), winding=self.winding, pitch=self.pitch)
        except InvalidMeshError as error:
            if error.code != "not_closed":
                raise
            message = f"{error.message}\n  Try: {repair_command(path)}"
            raise InvalidMeshError(message, error.code, error.where) from error

    def tell(self, path: Path, findings: Sequence[Finding]) -> None:
        """Say what was noteworthy about a file."""
        for finding in findings:
            self.out.finding(shown(path), finding)


def repair_command(path: Path) -> str:
    """Return the line to type for a file that is not closed, fit for a shell."""
    source = "open.stl" if str(path) == STREAM else str(path)
    target = Path(source).with_name(f"{Path(source).stem}-fixed{Path(source).suffix}")
    return f"bspcsg repair {shlex.quote(source)} -o {shlex.quote(str(target))}"


@dataclass(frozen=True)
class Target:
    """Where an output goes.

    Parameters
    ----------
    path : Path
    suffix : str
        Of the format.
    text : bool
        Whether the form as text is asked for.
    """

    path: Path
    suffix: str
    text: bool = False

    @classmethod
    def of(cls, path: Path, settings: dict[str, Any]) -> "Target":
        """Return the target that the options of a verb say."""
        return cls(path, settings.get("to_format") or path.suffix, settings["text"])

    @property
    def is_stream(self) -> bool:
        """Whether it is standard output."""
        return str(self.path) == STREAM

    def refuse_early(self, as_json: bool = False) -> None:
        """Refuse what can be known to fail before anything is read.

        Raises
        ------
        click.UsageError
            If standard output is asked for two things, or its format is not said.
        FormatError
            If the format is unknown or the folder cannot be written to.
        """
        from ..io import encoder_of

        if self.is_stream and not self.suffix:
            raise click.UsageError("to write to standard output, say the format: --to stl.")
        if self.is_stream and as_json:
            raise click.UsageError("--json and a mesh cannot both go to standard output.")
        named = self.path.suffix == self.suffix
        encoder_of(self.path if named else f"{self.path}{self.suffix}", self.text)
        if self.is_stream:
            return
        refuse_folder(self.path)

    def write(self, mesh: "Mesh | RawMesh") -> tuple[Finding, ...]:
        """Write a mesh, and return what the format could not keep."""
        from ..io import encoded

        chunks, findings = encoded(mesh, shown(self.path), self.suffix, self.text)
        self._put(chunks)
        return findings

    def write_data(self, data: bytes) -> None:
        """Write the bytes of a file."""
        self._put([data])

    def _put(self, chunks: Iterable[bytes]) -> None:
        from ..io.atomic import write_file

        if not self.is_stream:
            write_file(self.path, chunks)
            return
        if sys.stdout.isatty():
            raise click.UsageError("a mesh is no text for a terminal; use a pipe, or -o FILE.")
        try:
            sys.stdout.buffer.writelines(chunks)
            sys.stdout.buffer.flush()
        except BrokenPipeError:
            raise
        except OSError as error:
            message = f"standard output: cannot write: {error.strerror}."
            raise FormatError(message, "unwritable") from error


def refuse_folder(path: Path) -> None:
    """Refuse a file to be written to a folder that is not there or forbidden."""
    folder = path.parent
    if not folder.is_dir() or not os.access(folder, os.W_OK):
        message = f"{path}: there is no folder {folder} that can be written to."
        raise FormatError(message, "unwritable")


def refuse_drawing(path: Path, suffixes: Sequence[str]) -> None:
    """Refuse early a file for a drawing that cannot be written.

    Raises
    ------
    FormatError
        If its suffix is none of those, or its folder cannot be written to.
    """
    if path.suffix.lower() not in suffixes:
        known = " or ".join(suffixes)
        raise FormatError(f"{shown(path)}: the name must end in {known}.", "unknown_format")
    refuse_folder(path)


def shown(path: Path) -> str:
    """Return what to call a file in messages."""
    return "-" if str(path) == STREAM else str(path)


def expanded(pattern: Path, replacement: str) -> Path:
    """Return a path with a text for each ``%`` in its last part, or else before its suffix."""
    if "%" in pattern.name:
        return pattern.with_name(pattern.name.replace("%", replacement))
    return pattern.with_name(f"{pattern.stem}-{replacement}{pattern.suffix}")
