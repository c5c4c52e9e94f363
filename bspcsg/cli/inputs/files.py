"""Reading of inputs and writing of outputs, as files or as standard input and output."""

import io
import os
import shlex
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, TypeVar

import click

from ...errors import Finding, FormatError, InvalidMeshError, unreadable
from ..console import standard_streams
from ..console.output import Output, counted
from .lengths import MILLIMETRES
from .objects import ObjectNames
from .scripts import STREAMED, SUFFIXES, solid_of_script

if TYPE_CHECKING:
    from ...formats.files import Encoded
    from ...formats.raw import RawMesh
    from ...mesh.mesh import Mesh
    from ...solid.solid import Solid

_Kind = TypeVar("_Kind", bound="Mesh | RawMesh")

#: The name that stands for standard input or standard output.
STREAM = "-"

#: The format of an output to the null device if none is given: one that stores doubles.
_DEFAULT_SUFFIX = ".ply"

#: Advice in the error about a mesh that is not closed.
ON_INVALID = "  --on-invalid repair closes the mesh; --on-invalid warn leaves it out."


@dataclass(frozen=True)
class Inputs:
    """A reader of input files for a verb, with the settings of its options.

    Parameters
    ----------
    out : Output
        The output to which findings are printed.
    suffix : str
        The suffix of the format of standard input, and of files whose own suffix names no format.
    unit : str or None
        The unit of files that state none; None if the user did not give it.
    winding : str
    pitch : int or None
    on_invalid : {"error", "warn", "repair"} or None
        The treatment of a file that is not closed; None if the verb has no such option.
    noticed_findings : list of Finding
        The findings about solids that have been read; results repeat them.
    objects : ObjectNames
        The named objects to which the triangles of the read solids belong.
    """

    out: Output
    suffix: str = ""
    unit: str | None = None
    winding: Any = "positive"
    pitch: int | None = None
    on_invalid: str | None = None
    noticed_findings: list[Finding] = field(default_factory=list)
    objects: ObjectNames = field(default_factory=ObjectNames)

    @classmethod
    def of(cls, out: Output, settings: dict[str, Any]) -> "Inputs":
        """Return the reader for the options of a verb, given by name."""
        names = ("unit", "winding", "pitch", "on_invalid")
        found = {name: settings[name] for name in names if settings.get(name) is not None}
        return cls(out, settings.get("from_format") or "", **found)

    def refuse_early(self, paths: Sequence[Path]) -> None:
        """Raise an error if reading one of the files is certain to fail, before any is read."""
        from ...formats.files import format_of
        from ...formats.registry import FORMATS

        if sum(str(path) == STREAM for path in paths) > 1:
            raise click.UsageError("standard input can be read only once; give “-” only once.")
        for path in paths:
            if str(path) == STREAM and not self.suffix:
                raise click.UsageError(
                    "to read standard input, give its format, such as --from stl."
                )
            if self.is_script(path) and self.suffix_of(path) != path.suffix.lower():
                self._refuse_programs(path)
            if not path.suffix and path.is_dir():
                message = (
                    f"{path}: this is a folder, and a file is needed; name the files in it, as in"
                    f" {path / '*.stl'}."
                )
                raise FormatError(message, "unreadable")
            if self.suffix_of(path) not in FORMATS and not self.is_script(path):
                if not path.suffix and not path.exists():
                    message = f"{path}: there is no such file or folder."
                    raise FormatError(message, "unreadable")
                format_of(path)

    def _refuse_programs(self, path: Path) -> None:
        """Raise a usage error if ``--from`` names a language whose scripts need a file suffix."""
        if self.suffix not in STREAMED:
            message = (
                f"{display_name(path)}: {self.suffix} scripts cannot be read from standard input"
                " or a"
                f" file without suffix; save the script as a {self.suffix} file."
            )
            raise click.UsageError(message)

    def note_missing_units(self, pairs: Iterable[tuple[Path, "Target"]]) -> None:
        """Print a note if inputs have no unit and their output formats state one."""
        from ...formats.registry import FORMATS

        unknown = [
            path
            for path, target in pairs
            if not self.is_script(path)
            and FORMATS[target.suffix.lower()].unit
            and not FORMATS[self.suffix_of(path)].unit
        ]
        if unknown and self.unit is None:
            more = f" and {len(unknown) - 1} more have" if len(unknown) > 1 else " has"
            self.out.note(
                f"{display_name(unknown[0])}{more} no length unit, so mm is assumed; --unit in"
                " changes it"
            )

    def suffix_of(self, path: Path) -> str:
        """Return the suffix of the format in which a file is read: its own or ``--from``'s."""
        from ...formats.registry import FORMATS

        own = path.suffix.lower()
        return own if own in FORMATS or own in SUFFIXES or not self.suffix else self.suffix

    def is_script(self, path: Path) -> bool:
        """Say whether a file is read as a script, by its own suffix or that of ``--from``."""
        return self.suffix_of(path) in SUFFIXES

    def up_axis_of(self, path: Path) -> str:
        """Return the axis, "y" or "z", that points upwards in files of a file's format."""
        from ...formats.registry import FORMATS

        return "z" if self.is_script(path) else FORMATS[self.suffix_of(path)].up

    def raw(self, path: Path) -> "RawMesh":
        """Read a mesh or evaluate a script, without requiring that it is closed.

        The result is in millimetres if the format states a unit or ``--unit`` was given.
        """
        from ...formats.files import decoded, read_as
        from ...formats.mesh_placement import rescaled

        if self.is_script(path):
            raw = self._mesh_of_script(path)
        elif str(path) == STREAM:
            raw = decoded(STREAM, sys.stdin.buffer.read(), self.suffix, {})
        else:
            raw = read_as(path, self.suffix_of(path))
        if raw.unit or self.unit is None:
            return raw
        return replace(rescaled(raw, MILLIMETRES[self.unit]), unit="mm")

    def _solid_of_script(self, path: Path) -> "Solid":
        """Return the solid that a script makes, in the language of its suffix or of ``--from``."""
        if path.suffix.lower() in SUFFIXES:
            return solid_of_script(path, self.out)
        return solid_of_script(path, self.out, _text_of(path), self.suffix)

    def _mesh_of_script(self, path: Path) -> "RawMesh":
        from ...formats.storable_attributes import attributes_or_none, with_attributes

        mesh = self._solid_of_script(path).normalized().to_mesh()
        raw = with_attributes(mesh, attributes_or_none(mesh))
        return replace(raw, name=path.stem, is_empty_set=not len(mesh.faces))

    def solid(self, path: Path) -> "Solid":
        """Read a mesh as a solid, or evaluate a script, and print the findings about the file."""
        if self.is_script(path):
            made = self._solid_of_script(path)
            return made if self.unit is None else made.scale(MILLIMETRES[self.unit])
        raw = self.raw(path)
        solid = self.as_solid(raw, path)
        noticed = [Finding.from_core(found) for found in solid.tree.findings]
        self.noticed_findings.extend(noticed)
        self.print_findings(path, (*raw.findings, *noticed))
        self.out.detail(f"{display_name(path)}: {counted(len(raw.faces), 'triangle')}")
        return solid

    def as_solid(self, raw: "RawMesh", path: Path) -> "Solid":
        """Return the solid of a mesh; treat a mesh that is not closed as ``--on-invalid`` says."""
        try:
            return self._solid_of(raw, path)
        except InvalidMeshError as error:
            if self.on_invalid == "warn" and error.code in ("not_closed", "empty_mesh"):
                return self._left_out(error)
            if error.code != "not_closed":
                raise
            if self.on_invalid == "repair":
                return self._repaired(raw, path)
            message = f"{error.message}\n  Try: {repair_command(path)}"
            message += f"\n{ON_INVALID}" if self.on_invalid is not None else ""
            raise InvalidMeshError(message, error.code, error.where) from error

    def _solid_of(self, raw: "RawMesh", path: Path) -> "Solid":
        from ...formats.solids import solid_of

        solid = solid_of(raw, display_name(path), winding=self.winding, pitch=self.pitch)
        self.objects.note(solid, raw, path.stem)
        return solid

    def _left_out(self, error: InvalidMeshError) -> "Solid":
        from ...solid.solid import Solid

        self.out.warning(f"{error.message} This file is left out.")
        return Solid.empty()

    def _repaired(self, raw: "RawMesh", path: Path) -> "Solid":
        from ...assembly.object_repair import repaired

        made = repaired(raw)
        try:
            solid = self._solid_of(made.mesh, path)
        except InvalidMeshError as error:
            message = (
                f"{error.message}\n  The automatic repair could not close the mesh;"
                f" {repair_command(path)} shows why."
            )
            raise InvalidMeshError(message, error.code, error.where) from error
        counts = f"{counted(len(raw.faces), 'triangle')} became {len(made.mesh.faces)}"
        turned = f", {made.turned} of them with reversed orientation" if made.turned else ""
        strays = f"; {counted(made.dropped, 'stray triangle')} removed" if made.dropped else ""
        self.out.warning(
            f"{display_name(path)} was not closed and was repaired: {counts}{turned}{strays}."
        )
        self.print_findings(path, made.lost)
        return solid

    def print_findings(self, path: Path, findings: Sequence[Finding]) -> None:
        """Print findings about a file on standard error."""
        for finding in findings:
            self.out.finding(display_name(path), finding)


def repair_command(path: Path) -> str:
    """Return the shell command that repairs a file and writes it under a name with “-fixed”."""
    source = "open.stl" if str(path) == STREAM else str(path)
    target = Path(source).with_name(f"{Path(source).stem}-fixed{Path(source).suffix}")
    return f"bspcsg repair {shlex.quote(source)} -o {shlex.quote(str(target))}"


@dataclass(frozen=True)
class Target:
    """The file or stream to which a mesh is written, and the form of the output.

    Parameters
    ----------
    path : Path
    suffix : str
        The suffix of the format.
    text : bool
        True for the text form of the format.
    overwrite : bool
        True if an existing file may be replaced.
    digits : int or None
        The number of significant digits to which coordinates are rounded; None for no rounding.
    """

    path: Path
    suffix: str
    text: bool = False
    overwrite: bool = True
    digits: int | None = None

    @classmethod
    def of(cls, path: Path, settings: dict[str, Any]) -> "Target":
        """Return the target for an output path and the options of a verb, given by name."""
        suffix = (
            settings.get("to_format")
            or path.suffix
            or (_DEFAULT_SUFFIX if is_dropped(path) else "")
        )
        return cls(path, suffix, settings["text"], settings["overwrite"], settings["digits"])

    @property
    def is_stream(self) -> bool:
        """True if the target is standard output."""
        return str(self.path) == STREAM

    def refuse_early(self, as_json: bool = False) -> None:
        """Raise an error if writing is certain to fail, before anything is read.

        Raises
        ------
        click.UsageError
            If standard output is used twice, or its format is not given.
        FormatError
            If the format is unknown or the folder cannot be written to.
        """
        from ...formats.files import form_of

        if self.is_stream and not self.suffix:
            raise click.UsageError(
                "to write to standard output, give the format, such as --to stl."
            )
        if self.is_stream and as_json:
            raise click.UsageError(
                "--json and a mesh cannot both go to standard output; give -o a file name, or"
                " leave out --json."
            )
        named = self.path.suffix == self.suffix
        form_of(self.path if named else f"{self.path}{self.suffix}", self.text)
        refuse_unwritable(self.path, self.overwrite)

    @property
    def names_objects(self) -> bool:
        """True if the output's format can store named objects."""
        from ...formats.files import form_of

        return form_of(f"mesh{self.suffix}", self.text).name_in_file is not None

    @property
    def is_single(self) -> bool:
        """True if the output's format stores single precision only."""
        from ...formats.files import form_of

        return form_of(f"mesh{self.suffix}", self.text).is_single

    def rounded(self, mesh: "_Kind") -> "tuple[_Kind, tuple[Finding, ...]]":
        """Return the mesh with coordinates rounded to ``--digits``, if given, and the findings."""
        from ...formats.rounding import rounded

        return (mesh, ()) if self.digits is None else rounded(mesh, self.digits)

    def write(self, mesh: "Mesh | RawMesh") -> tuple[Finding, ...]:
        """Write a mesh, and return findings about losses by the format and by ``--digits``."""
        from ...formats.files import encoded

        shortened, moved = self.rounded(mesh)
        made = encoded(shortened, display_name(self.path), self.suffix, self.text)
        self.put(made, made.prove)
        return moved + made.findings

    def put(self, made: "Encoded", prove: Callable[[BinaryIO], None]) -> None:
        """Write the bytes of a file, checked by `prove`, and its companion files.

        Companion files are not written for a stream or the null device.
        """
        from ...formats.files import companion_paths, write_companions

        files = {} if self.is_stream or is_dropped(self.path) else made.files
        for place in companion_paths(self.path, files):
            refuse_unwritable(place, self.overwrite)

        def prove_and_write(file: BinaryIO) -> None:
            prove(file)
            write_companions(self.path, files)

        write_output(self.path, made.chunks, self.overwrite, prove_and_write)


def write_output(
    path: Path,
    chunks: Iterable[bytes],
    overwrite: bool = True,
    prove: Callable[[BinaryIO], None] | None = None,
) -> None:
    """Write bytes to a file, which appears complete or not at all, or to standard output.

    `prove` checks the written content: if it raises an error, no file appears.
    """
    from ...formats.atomic import write_file

    if str(path) != STREAM:
        refuse_unwritable(path, overwrite)
        write_file(path, chunks, prove)
        return
    if sys.stdout.isatty():
        raise click.UsageError(
            "mesh data is not written to a terminal; redirect the output, or give -o FILE."
        )
    if prove is not None:
        chunks = [b"".join(chunks)]
        prove(io.BytesIO(chunks[0]))
    standard_streams.write_bytes(chunks)


def stream_text() -> str:
    """Read standard input as text.

    Raises
    ------
    FormatError
        If the input is not UTF-8, or a pointer of Git LFS.
    """
    from ...formats.source import refuse_pointer_file

    return _decoded(refuse_pointer_file(STREAM, sys.stdin.buffer.read()), STREAM)


def _text_of(path: Path) -> str:
    """Read a file or standard input as text."""
    from ...formats.source import limited_content

    if str(path) == STREAM:
        return stream_text()
    try:
        return _decoded(limited_content(path), str(path))
    except OSError as error:
        raise unreadable(path, error) from error


def _decoded(data: bytes, name: str) -> str:
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        message = f"{name}: the file is not UTF-8 text: byte {error.start} cannot be decoded."
        raise FormatError(message, "syntax", [error.start]) from error


def refuse_unwritable(path: Path, overwrite: bool = True) -> None:
    """Raise a `FormatError` if a file exists and `overwrite` is false, or its folder is unusable.

    A folder is unusable if it is missing or not writable.
    """
    if str(path) == STREAM:
        return
    if not overwrite and os.path.lexists(path) and not is_dropped(path):
        message = f"{path}: this file exists already; --overwrite replaces it."
        raise FormatError(message, "unwritable")
    refuse_folder(path)


def refuse_folder(path: Path) -> None:
    """Raise a `FormatError` if the folder of a file is missing or not writable."""
    if is_dropped(path):
        return
    folder = path.parent
    if not folder.is_dir() or not os.access(folder, os.W_OK):
        message = f"{path}: the folder {folder} does not exist or is not writable."
        raise FormatError(message, "unwritable")


def make_folder(folder: Path) -> None:
    """Make a folder and its parent folders; an existing one is left unchanged."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        message = f"{folder}: cannot create this folder: {error.strerror}."
        raise FormatError(message, "unwritable") from error


def is_dropped(path: Path) -> bool:
    """Say whether a path is the null device, which drops all output."""
    return str(path) == os.devnull


def is_among(path: Path, paths: Iterable[Path]) -> bool:
    """Say whether a path and one of `paths` are the same existing file, under any name."""
    return any(path.exists() and other.exists() and path.samefile(other) for other in paths)


def refuse_inputs(file: Path, targets: Iterable[Path], inputs: Sequence[Path]) -> None:
    """Raise a usage error if one of the outputs `targets` of a file would replace an input."""
    for number, where in enumerate(targets, 1):
        if not is_dropped(where) and is_among(where, inputs):
            message = (
                f"part {number} of {display_name(file)} would overwrite {where}, which is also an"
            )
            raise click.UsageError(f"{message} input; choose another output.")


def display_name(path: Path) -> str:
    """Return the name of a file for messages; “-” for standard input or output."""
    return "-" if str(path) == STREAM else str(path)


def expanded(pattern: Path, replacement: str) -> Path:
    """Replace each ``%`` in the name of a path; without ``%``, add “-” and the text to the stem.

    The null device stays unchanged.
    """
    if is_dropped(pattern):
        return pattern
    if "%" in pattern.name:
        return pattern.with_name(pattern.name.replace("%", replacement))
    return pattern.with_name(f"{pattern.stem}-{replacement}{pattern.suffix}")
