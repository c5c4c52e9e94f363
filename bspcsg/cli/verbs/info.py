"""The verb `info`, which prints counts, measures and findings of mesh files."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...errors import BspcsgError
from ..console import output, terminal
from ..console.output import Output, counted, grouped
from ..console.tables import table_text
from ..inputs.files import Inputs, display_name
from ..options.patterns import files_argument
from ..options.shared import common_options, reading_options, verb

if TYPE_CHECKING:
    from ...formats.raw import RawMesh
    from ...repair.diagnosis import Diagnosis

_EPILOG = """\b
Examples:
  bspcsg info part.3mf
  bspcsg info parts/ --json | jq '.files[].volume'
"""


@verb(
    "info", short_help="Say what is in each file: counts, size, volume, findings.", epilog=_EPILOG
)
@files_argument("FILE|FOLDER [...]")
@reading_options
@common_options
def info(files: tuple[Path, ...], **given: Any) -> int:
    """Print what is in each file: counts, size, volume, area, objects, unit and findings.

    A file that is no solid is described, too, and does not change the exit code; for that use
    bspcsg check.
    """
    from ...parameters import set_threads

    set_threads(given["threads"])
    out = Output.of(given)
    inputs = Inputs.of(out, given)
    inputs.refuse_early(files)
    described = [_described(inputs, path) for path in files]
    out.result("" if out.as_json else _text(described), {"files": [e.document for e in described]})
    for entry in described:
        if entry.error is not None:
            terminal.print_error(entry.error.message)
    return max(entry.code for entry in described)


class _Entry:
    """One file's mesh and diagnosis, or the error of reading it."""

    def __init__(
        self,
        path: Path,
        found: "tuple[RawMesh, Diagnosis] | None" = None,
        error: BspcsgError | None = None,
    ) -> None:
        self.path = path
        self.found = found
        self.error = error

    @property
    def code(self) -> int:
        return output.DONE if self.error is None else output.exit_code_of(self.error)

    @property
    def document(self) -> dict[str, Any]:
        if self.error is not None:
            return {"file": str(self.path), "error": output.error_values(self.error)}
        if self.found is None:
            return {"file": str(self.path)}
        raw, diagnosis = self.found
        objects = [{"name": name, "triangles": count} for name, count in raw.objects]
        facts = {"name": raw.name, "unit": raw.unit or None, "objects": objects}
        return {"file": str(self.path), **facts, **diagnosis.to_dict()}


def _described(inputs: Inputs, path: Path) -> _Entry:
    from ...assembly.object_diagnosis import examine

    try:
        raw = inputs.raw(path)
        return _Entry(path, (raw, examine(raw).diagnosis))
    except BspcsgError as error:
        return _Entry(path, error=error)


def _text(entries: list[_Entry]) -> str:
    blocks = [_block(entry.path, *entry.found) for entry in entries if entry.found is not None]
    return "\n\n".join(blocks)


def _block(path: Path, raw: "RawMesh", found: "Diagnosis") -> str:
    rows = [*_counts(raw, found), *_measures(raw, found)]
    lines = table_text((display_name(path), ""), rows).splitlines()
    lines += [f"{finding.severity}: {finding.message.rstrip('.')}." for finding in found.findings]
    return "\n".join(lines)


def _counts(raw: "RawMesh", found: "Diagnosis") -> list[tuple[str, str]]:
    rows = [
        ("verdict", found.verdict),
        ("triangles", grouped(found.triangles)),
        ("vertices", grouped(found.vertices)),
    ]
    if found.surfaces is not None:
        rows.append(("surfaces", grouped(found.surfaces)))
    if found.genus is not None:
        rows.append(("genus", grouped(found.genus)))
    names = ", ".join(name or "unnamed" for name, _ in raw.objects[:5])
    if raw.objects:
        more = ", …" if len(raw.objects) > 5 else ""
        rows.append(("objects", f"{counted(len(raw.objects), 'object')}: {names}{more}"))
    return rows


def _measures(raw: "RawMesh", found: "Diagnosis") -> list[tuple[str, str]]:
    unit = f" {raw.unit}" if raw.unit else ""
    rows = [("unit", raw.unit or "not stated")]
    if found.bounds is not None:
        low, high = found.bounds
        rows += [
            ("lowest", _numbers(low) + unit),
            ("highest", _numbers(high) + unit),
            ("size", " × ".join(f"{b - a:.6g}" for a, b in zip(low, high, strict=True)) + unit),
        ]
    rows.append(("area", f"{found.area:.9g}{unit + '²' if unit else ''}"))
    cubic = unit + "³" if unit else ""
    if found.volume is not None:
        rows.append(("volume", f"{found.volume:.9g}{cubic}"))
    else:
        rows.append(("signed volume", f"{found.signed_volume:.9g}{cubic} (not closed)"))
    return rows


def _numbers(values: tuple[float, ...]) -> str:
    return ", ".join(f"{value:.6g}" for value in values)
