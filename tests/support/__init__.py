"""Helpers shared by all tests: plain shapes as arrays, and the checks of a sound result."""

import os
import subprocess
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")

#: True to take the time for everything, as `scripts/check --deep` does.
DEEP = bool(os.environ.get("BSPCSG_DEEP"))


def _commit() -> str:
    command = ["git", "-C", str(Path(__file__).parent), "rev-parse", "HEAD"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return ""
    return done.stdout.strip()


#: The commit that draws the sampled cases and seeds random ones; BSPCSG_COMMIT repeats another's.
COMMIT = os.environ.get("BSPCSG_COMMIT") or _commit()


def draw(name: str, count: int) -> int:
    """Return a number below `count` that depends only on the commit and on `name`."""
    return zlib.crc32(f"{COMMIT} {name}".encode()) % count


def drawn(values: Sequence[T], step: int) -> Sequence[T]:
    """Return one value of every `step`, chosen by the commit; all values in a deep run."""
    return values if DEEP else values[draw(repr(values), step) :: step]
