"""The viewer in pages is built from the sources beside it."""

import hashlib
from pathlib import Path

import bspcsg
from bspcsg.report.assets import asset

_SOURCES = Path(bspcsg.__file__).parent / "report" / "assets" / "viewer"


def test_the_bundle_is_that_of_the_sources() -> None:
    sources = b"".join(path.read_bytes() for path in sorted(_SOURCES.glob("*.js")))
    made_of = f"made of sources {hashlib.sha256(sources).hexdigest()},"
    assert made_of in asset("viewer.js")[:200], "run scripts/viewer"
