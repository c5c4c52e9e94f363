"""The shared part of the measuring scripts: the machine they ran on, and the keeping of results."""

import json
import platform
import subprocess
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

from bspcsg.machine import machine as this_machine

REPOSITORY = Path(__file__).resolve().parent.parent
RECORDS = REPOSITORY / "scripts" / "records"


def machine() -> dict[str, Any]:
    """Describe the machine and the versions that a figure belongs to."""
    return {
        "date": datetime.now(UTC).strftime("%Y-%m-%d"),
        "commit": commit(),
        **this_machine(),
        "python": platform.python_version(),
        "manifold3d": version("manifold3d"),
        "numpy": version("numpy"),
    }


def keep(name: str, result: dict[str, Any]) -> Path:
    """Write a result beside the earlier ones, with the machine it was measured on."""
    RECORDS.mkdir(exist_ok=True)
    path = RECORDS / f"{name}.json"
    path.write_text(json.dumps({"machine": machine(), **result}, indent=1) + "\n")
    return path


def commit() -> str:
    """Return the short name of the repository's commit."""
    command = ["git", "-C", str(REPOSITORY), "rev-parse", "--short", "HEAD"]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()
