"""Records of benchmark runs: the machine, the versions and the measured rows."""

import json
import os
import platform
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from ..errors import FormatError, unreadable
from ..formats.atomic import write_file
from ..machine import machine
from .engines import installed

#: The version of the schema, increased whenever a field changes its meaning.
SCHEMA = 1


def record_of(rows: list[dict[str, Any]], runs: int, command: str) -> dict[str, Any]:
    """Return the record of measured rows, with the machine, the versions and the date."""
    return {
        "schema": SCHEMA,
        "type": "bench",
        "command": command,
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        # The load by all users of the machine, averaged over five minutes.
        "machine": {**machine(), "load": round(os.getloadavg()[1], 2)},
        "versions": {**installed(), "python": platform.python_version()},
        "runs": runs,
        "cases": rows,
    }


def other_place(record: dict[str, Any]) -> str:
    """Return "another machine" or "other versions …" if a record was measured there, else ""."""
    ours = record_of([], 0, "")
    if {**ours["machine"], "load": 0} != {**record["machine"], "load": 0}:
        return "another machine"
    return "" if ours["versions"] == record["versions"] else "other versions of the engines"


def write(record: dict[str, Any], path: Path) -> None:
    """Write a record to a file as JSON.

    Raises
    ------
    FormatError
        If the file cannot be written; code ``"unwritable"``.
    """
    text = json.dumps(record, indent=1, ensure_ascii=False) + "\n"
    write_file(path, [text.encode("utf-8")])


def read(path: Path) -> dict[str, Any]:
    """Return the record from a file.

    Raises
    ------
    FormatError
        If the file is not a record, or has another schema.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise unreadable(path, error) from error
    try:
        record = json.loads(data)
    except (ValueError, RecursionError):
        record = None
    if not isinstance(record, dict) or record.get("type") != "bench":
        message = (
            f"{path}: the file is not a record of measurements; give a file that bspcsg bench -o"
            " wrote."
        )
        raise FormatError(message, "unreadable")
    if record.get("schema") != SCHEMA:
        said = f"the record has schema {record.get('schema')}, but this version reads {SCHEMA} only"
        raise FormatError(f"{path}: {said}; run bspcsg bench again.", "unreadable")
    return record
