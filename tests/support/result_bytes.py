"""Short hashes of the bytes of results, by which two builds are compared."""

import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from itertools import combinations
from pathlib import Path

import numpy as np

import bspcsg as b
from bspcsg._types import FloatArray
from bspcsg.formats.registry import FORMATS
from corpus.test_corpus import CASES, evaluate, operand

REPOSITORY = Path(__file__).parents[2]

#: The meshes that are combined with each other beside the cases of the corpus.
MESHES = REPOSITORY / "examples" / "meshes"

#: A line for each result: its name and its word.
RECORD = REPOSITORY / "tests" / "corpus" / "bytes.tsv"

#: The operations by which each pair is combined.
OPERATIONS: dict[str, Callable[["b.Solid", "b.Solid"], "b.Solid"]] = {
    "or": lambda x, y: x | y,
    "and": lambda x, y: x & y,
    "minus": lambda x, y: x - y,
    "xor": lambda x, y: x ^ y,
}

#: The largest number of bytes of a file that is used: larger files take longer and show little
#: more.
MAX_FILE_BYTES = 100_000

#: Digits of a word: by chance two results agree in one of 2^64 cases.
_DIGITS = 16


def word(result: Callable[[], "b.Solid"]) -> str:
    """Return a hash of a result's snapshot, mesh and origins, or the code of its error."""
    try:
        solid = result()
        snapshot = solid.tree.dump()
    except b.BspcsgError as error:
        return error.code
    digest = hashlib.sha256(snapshot)
    try:
        mesh = solid.to_mesh()
    except b.BspcsgError as error:
        digest.update(error.code.encode())
    else:
        for array in (mesh.vertices, mesh.faces, mesh.source):
            digest.update(f"{array.shape}{array.dtype}".encode())
            digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()[:_DIGITS]


def words_of_cases(cases: Sequence[Path] = CASES) -> Iterator[tuple[str, str]]:
    """Yield name and hash of each case of the corpus, and of all operations on its operands."""
    for path in cases:
        case = json.loads(path.read_text("utf-8"))
        yield path.stem, word(lambda case=case: evaluate(case))  # type: ignore[misc]
        try:
            operands = [operand(given) for given in case["operands"]]
        except b.BspcsgError:
            continue
        names = [f"{path.stem} {chr(ord('a') + k)}" for k in range(len(operands))]
        yield from words_of_pairs(list(zip(names, operands, strict=True)))


def words_of_files(
    folder: Path = MESHES, *, largest: int = MAX_FILE_BYTES
) -> Iterator[tuple[str, str]]:
    """Yield name and hash of each mesh in a folder combined with its copy and with the next one."""
    named = [(path.name, solid) for path, solid in _solids(folder, largest)]
    for (name, solid), (after, other) in zip(named, [*named[1:], *named[:1]], strict=True):
        middle, size = _place(solid)
        yield from words_of_pairs([(name, solid), ("turned", _turned(solid, middle, size / 7))])
        yield from words_of_pairs(
            [(name, solid), (after, other.translate(middle - _place(other)[0]))]
        )


def _solids(folder: Path, largest: int) -> Iterator[tuple[Path, "b.Solid"]]:
    for path in sorted(folder.rglob("*")):
        if path.suffix.lower() in FORMATS and path.stat().st_size <= largest:
            with suppress(b.BspcsgError):
                yield path, b.load(path)


def _place(solid: "b.Solid") -> tuple[FloatArray, FloatArray]:
    vertices = solid.to_mesh().vertices
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return (low + high) / 2, high - low


def _turned(solid: "b.Solid", about: FloatArray, by: FloatArray) -> "b.Solid":
    """Return a solid rotated by an angle whose sine and cosine are short decimals, then shifted."""
    turn = np.array([[0.6, -0.8, 0, 0], [0.8, 0.6, 0, 0], [0, 0, 1, 0]])
    return solid.translate(-about).transform(turn).translate(about + by)


def words_of_pairs(named: Sequence[tuple[str, "b.Solid"]]) -> Iterator[tuple[str, str]]:
    """Yield name and hash of all operations on all pairs of solids."""
    for (first, x), (second, y) in combinations(named, 2):
        for name, combined in OPERATIONS.items():
            last = second.rsplit(" ", 1)[-1]
            yield f"{first} {name} {last}", word(lambda x=x, y=y, c=combined: c(x, y))  # type: ignore[misc]


def recorded() -> dict[str, str]:
    """Return the recorded hashes by name."""
    lines = RECORD.read_text(encoding="utf-8").splitlines()
    return dict(line.split("\t") for line in lines)


def write(words: dict[str, str]) -> None:
    """Record these hashes."""
    rows = "".join(f"{name}\t{word}\n" for name, word in words.items())
    RECORD.write_text(rows, encoding="utf-8")


def differences(before: dict[str, str], after: dict[str, str]) -> list[str]:
    """Return a line for each result whose hash differs or is missing on one side."""
    names = [*before, *(name for name in after if name not in before)]
    rows = ((name, before.get(name, "none"), after.get(name, "none")) for name in names)
    return [f"{name}: {old} before, {new} now" for name, old, new in rows if old != new]
