"""Shared by the measuring scripts: the machine that they run on, and the writing of records."""

import json
import platform
import subprocess
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

from bspcsg.machine import machine as this_machine

REPOSITORY = Path(__file__).resolve().parent.parent

#: The folder of records of measuring scripts, from which `scripts/measured` makes a release's
#: table.
RECORDS = REPOSITORY / "out" / "records"

#: The tables of releases, one file each.
RELEASES = REPOSITORY / "docs" / "records"


def machine() -> dict[str, Any]:
    """Return the machine and the versions to which a measurement belongs."""
    return {
        "date": datetime.now(UTC).strftime("%Y-%m-%d"),
        "commit": _commit(),
        **this_machine(),
        "python": platform.python_version(),
        "manifold3d": version("manifold3d"),
        "numpy": version("numpy"),
    }


def write_record(name: str, result: dict[str, Any]) -> Path:
    """Write a result as a record, with the machine that it was measured on, and return its path."""
    RECORDS.mkdir(parents=True, exist_ok=True)
    path = RECORDS / f"{name}.json"
    path.write_text(json.dumps({"machine": machine(), **result}, indent=1) + "\n")
    return path


def release() -> dict[str, Any]:
    """Return the table of the last release; empty if there is none."""
    paths = sorted(RELEASES.glob("*.json"), key=lambda path: [int(n) for n in path.stem.split(".")])
    found: dict[str, Any] = json.loads(paths[-1].read_text("utf-8")) if paths else {}
    return found


def write_rows(name: str, rows: list[dict[str, Any]], key: str, order: list[str]) -> Path:
    """Write rows to a record, each with its commit, besides earlier rows with other keys.

    Parameters
    ----------
    name : str
        The name of the record, and of the list in it.
    rows : list of dict
    key : str
        The entry that identifies a row.
    order : list of str
        The possible values of this entry, in the order of the rows.
    """
    path = RECORDS / f"{name}.json"
    earlier = json.loads(path.read_text("utf-8"))[name] if path.is_file() else []
    fresh = [{**row, "commit": _commit()} for row in rows]
    known = {row[key]: row for row in [*earlier, *fresh]}
    return write_record(name, {name: [known[what] for what in order if what in known]})


def _commit() -> str:
    command = ["git", "-C", str(REPOSITORY), "rev-parse", "--short", "HEAD"]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()
