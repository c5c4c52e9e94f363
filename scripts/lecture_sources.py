"""The digest of what the lecture's WebAssembly module is made of.

These are the crate `lecture` and the files of the core that it reaches, comments and tests left
out. `scripts/lecture_bundle` writes the digest beside the module; a test compares the two.
"""

import hashlib
import json
import re
from pathlib import Path

import networkx as nx

from import_graph import ROOT, code_of, rust_graph

CRATE = ROOT / "lecture"
FOLDER = ROOT / "bspcsg" / "report" / "assets" / "lecture"

#: Beside the module: what it was made of, and by what.
RECORD = FOLDER / "core.json"


def sources() -> list[Path]:
    """Return the files the module is made of, sorted."""
    graph = rust_graph()
    crate = sorted(CRATE.joinpath("src").glob("*.rs"))
    found: set[str] = set()
    for path in crate:
        for name in re.findall(r"\bbspcsg::((?:[a-z_0-9]+(?:::)?)+)", code_of(path)):
            found |= _reached(graph, name.removesuffix("::"))
    core = ROOT / "core" / "src"
    files = [path for name in found for path in _files(core, name)]
    return sorted({*crate, CRATE / "Cargo.toml", *files})


def _reached(graph: nx.DiGraph, name: str) -> set[str]:
    """Return the module that a path leads to, what lies in it, and all that these use."""
    while name and name not in graph:
        name = name.rpartition("::")[0]
    inner = {other for other in graph if name and f"{other}::".startswith(f"{name}::")}
    return inner.union(*(nx.descendants(graph, other) for other in inner))


def _files(core: Path, name: str) -> list[Path]:
    place = core.joinpath(*name.split("::"))
    return [p for p in (place.with_suffix(".rs"), place / "mod.rs") if name and p.exists()]


def digest() -> str:
    """Return the digest of all sources."""
    total = hashlib.sha256()
    for path in sources():
        name = path.relative_to(ROOT).as_posix()
        text = code_of(path) if path.suffix == ".rs" else path.read_text(encoding="utf-8")
        total.update(f"{name}\n{' '.join(text.split())}\n".encode())
    return total.hexdigest()


def module_digest() -> str:
    """Return the digest of the module and of the script that starts it."""
    parts = (FOLDER.joinpath(name).read_bytes() for name in ("core.wasm", "core.js"))
    return hashlib.sha256(b"".join(parts)).hexdigest()


if __name__ == "__main__":
    record = {"sources": digest(), "module": module_digest()}
    RECORD.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
