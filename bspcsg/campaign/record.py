"""The record of a campaign: a file of JSON lines, one for each run and each finished case.

Lines are appended as cases end, in any order; each is written completely before the next begins. A
runner that is killed while it writes leaves an incomplete last line. Readers ignore it, and writers
remove it first.
"""

import json
import os
import sys
import threading
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, NotRequired, Self, TypedDict, cast

from ..errors import FormatError, unreadable
from ..machine import Machine

#: The path that stands for standard input.
STREAM = "-"

#: The version of the format of the lines.
SCHEMA = 1

#: The verdicts with which a case, and so its campaign, fails.
FAILURES = frozenset({"DISAGREE", "subject failed", "timeout", "crash"})

#: All verdicts, the most serious first.
VERDICTS = (
    "DISAGREE",
    "subject failed",
    "crash",
    "timeout",
    "oracle failed",
    "oracle refused",
    "refused",
    "within rounding",
    "same set, other topology",
    "agree",
)

Kind = Literal["pair", "csg", "pose"]


class RunRecord(TypedDict):
    """The line at the start of a run: command, seed, time, versions and machine."""

    schema: int
    type: Literal["run"]
    command: str
    seed: int
    started: str
    versions: dict[str, str]
    machine: Machine


class FactsRecord(TypedDict):
    """The facts about a mesh; lengths in model units, inertia about the centroid at density 1.

    ``self_intersections`` is 0 if it is certain that no two faces cross or touch except in common
    edges and corners; otherwise, or if this was not checked, None.
    """

    vertices: int
    triangles: int
    volume: float
    area: float
    euler_number: int
    components: int
    open_edges: int
    centroid: list[float] | None
    inertia: list[list[float]] | None
    self_intersections: int | None


class OperandRecord(TypedDict):
    """An operand of a case; `pose` has the three rows of an affine map, or is None."""

    name: str
    file: str | None
    sha256: str
    pose: list[list[float]] | None
    triangles: int | None
    volume: float | None


class OracleRecord(TypedDict):
    """The opinion of another engine; `agrees` is None if its result could not be compared."""

    name: str
    version: str
    agrees: bool | None
    says: str
    facts: FactsRecord | None
    seconds: float


class DifferenceRecord(TypedDict):
    """The symmetric difference of our result and manifold3d's."""

    volume: float
    exact: str | None
    thickness: float
    equal: bool
    place: list[float] | None


class HausdorffRecord(TypedDict):
    """Lower bounds of the distances from our boundary to manifold3d's and back, from samples."""

    forward: float
    backward: float
    samples: int


class ThicknessBoundsRecord(TypedDict):
    """The thicknesses up to which sets count as equal, and as equal within rounding."""

    same_set: float
    rounding: float


class IdentityRecord(TypedDict):
    """An equation between exact volumes, and whether it holds."""

    equation: str
    holds: bool


class SecondsRecord(TypedDict):
    """The wall-clock time of each part of a case, in seconds."""

    load: float
    ours: float
    check: float
    total: float


class CaseRecord(TypedDict):
    """The line of one finished case: its input, its verdict and everything that was measured."""

    schema: int
    type: Literal["case"]
    key: str
    case: str
    kind: Kind
    operation: str
    operands: list[OperandRecord]
    command: str
    seed: int | None
    pose: str | None
    verdict: str
    reason: str
    ours: FactsRecord | None
    oracles: list[OracleRecord]
    set_difference: DifferenceRecord | None
    hausdorff: HausdorffRecord | None
    bounds: ThicknessBoundsRecord | None
    identity: NotRequired[IdentityRecord | None]
    seconds: SecondsRecord
    memory_mb: float | None
    meshes: str | None


def is_failure(case: CaseRecord) -> bool:
    """Return true if a case's verdict makes its campaign fail."""
    return case["verdict"] in FAILURES


@dataclass
class Results:
    """The runs and cases of one or several results files.

    Parameters
    ----------
    runs : list of RunRecord
        The runs in the order of the files and of their lines.
    cases : dict of str to CaseRecord
        The last record of each case, by its key.
    folders : dict of str to Path
        The folder to which the path of a case's meshes is relative, by the case's key.
    """

    runs: list[RunRecord] = field(default_factory=list)
    cases: dict[str, CaseRecord] = field(default_factory=dict)
    folders: dict[str, Path] = field(default_factory=dict)


def read_results(paths: Iterable[str | os.PathLike[str]]) -> Results:
    """Return the records of results files, such as parts of one campaign; ``-`` is standard input.

    Raises
    ------
    FormatError
        If a file cannot be read, or a line other than an incomplete last one is not from a results
        file.
    """
    results = Results()
    for path in map(Path, paths):
        for line in _lines(path):
            if line["type"] == "run":
                results.runs.append(cast(RunRecord, line))
            else:
                case = cast(CaseRecord, line)
                results.cases[case["key"]] = case
                results.folders[case["key"]] = path.parent
    return results


def _lines(path: Path) -> list[dict[str, Any]]:
    try:
        # For standard input, the paths of meshes are relative to the current folder.
        data = sys.stdin.buffer.read() if str(path) == STREAM else path.read_bytes()
    except OSError as error:
        raise unreadable(path, error) from error
    text = data.decode("utf-8", errors="replace")
    *whole, _torn = text.split("\n")
    return [_parsed(line, path, number) for number, line in enumerate(whole, 1) if line.strip()]


def _parsed(line: str, path: Path, number: int) -> dict[str, Any]:
    try:
        found = json.loads(line)
    except (ValueError, RecursionError):
        found = None
    known = isinstance(found, dict) and found.get("type") in ("run", "case")
    if not known or (found["type"] == "case" and not isinstance(found.get("key"), str)):
        message = f"{path}:{number}: this line is not a record of a results file."
        raise FormatError(
            f"{message} Give a file that bspcsg crosscheck --results wrote.", "malformed"
        )
    if found.get("schema") != SCHEMA:
        message = (
            f"{path}:{number}: the record has schema {found.get('schema')!r}, but this version"
            f" reads {SCHEMA} only; run bspcsg crosscheck again."
        )
        raise FormatError(message, "unknown_schema")
    return cast(dict[str, Any], found)


#: The bytes with which every line begins.
_LINE_START = b'{"schema": '


class Journal:
    """A results file to which records are appended, possibly by several threads.

    Parameters
    ----------
    path : path-like
        The path of the file; if it exists, lines are appended to it.

    Raises
    ------
    FormatError
        If the file cannot be written, or exists and is not a results file.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self._lock = threading.Lock()
        try:
            self._closed_torn_line()
            self._file = self.path.open("ab")
        except OSError as error:
            raise self._unwritable(error) from error

    def append(self, record: RunRecord | CaseRecord) -> None:
        """Append a record as a line, and flush it to the operating system."""
        line = json.dumps(record, allow_nan=False, ensure_ascii=True) + "\n"
        try:
            with self._lock:
                self._file.write(line.encode("ascii"))
                self._file.flush()
        except OSError as error:
            raise self._unwritable(error) from error

    def close(self) -> None:
        """Close the file, or raise an error if its last line cannot be written."""
        try:
            self._file.close()
        except OSError as error:
            raise self._unwritable(error) from error

    def __enter__(self) -> Self:
        """Return the journal itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the file."""
        self.close()

    def _closed_torn_line(self) -> None:
        """Remove the incomplete last line that a killed writer has left."""
        if not self.path.exists():
            return
        with self.path.open("r+b") as file:
            start = file.read(len(_LINE_START))
            if start != _LINE_START[: len(start)]:
                message = (
                    f"{self.path}: this existing file is not a results file of bspcsg crosscheck,"
                    " so nothing is appended to it; choose another name."
                )
                raise FormatError(message, "unwritable")
            size = file.seek(0, os.SEEK_END)
            file.truncate(_end_of_last_line(self.path, size))

    def _unwritable(self, error: OSError) -> FormatError:
        return FormatError(f"{self.path}: cannot write: {error.strerror}.", "unwritable")


def _end_of_last_line(path: Path, size: int) -> int:
    with path.open("rb") as file:
        data = file.read(size)
    return data.rfind(b"\n") + 1
