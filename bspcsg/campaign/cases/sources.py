"""Make the cases of a command line: from mesh files, scripts and files of cases."""

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import FormatError, unreadable
from ...formats.registry import FORMATS
from ...parameters import SET_OPS
from .case import SCRIPT, Case, Operand, command_for, digest_of, digest_of_mesh
from .poses import COINCIDENT

_SCRIPTS = frozenset({".csg", ".scad"})
_CASES = ".json"

#: An example of a file of cases, for error messages.
_EXAMPLE = '{"cases": [{"operation": "union", "operands": [{"file": "a.stl"}, {"file": "b.stl"}]}]}'


@dataclass(frozen=True)
class CaseInputs:
    """The files of a command line, sorted by kind.

    Parameters
    ----------
    meshes, scripts, cases : tuple of Path
    """

    meshes: tuple[Path, ...]
    scripts: tuple[Path, ...]
    cases: tuple[Path, ...]


@dataclass(frozen=True)
class PairSelection:
    """How pairs of meshes are chosen and placed.

    Parameters
    ----------
    count : int
        The number of random pairs; 0 for all pairs of files.
    seed : int
    pose : str or None
        The name of the pose of each pair. None for random pairs alternates between "random" and
        coincident poses; with `count` 0 it leaves the meshes as they are.
    number : int or None
        Instead of `count`: the number of the one case to draw, for the first two files.
    """

    count: int = 0
    seed: int = 0
    pose: str | None = None
    number: int | None = None


def inputs_in(paths: Sequence[Path]) -> CaseInputs:
    """Return the given paths, sorted by kind.

    Raises
    ------
    FormatError
        If a path is missing, or its suffix is not of a known format.
    """
    meshes: list[Path] = []
    scripts: list[Path] = []
    cases: list[Path] = []
    for path in paths:
        if not path.is_file():
            raise unreadable(path)
        _kind_of(path, meshes, scripts, cases).append(path)
    return CaseInputs(tuple(meshes), tuple(scripts), tuple(cases))


def _kind_of(path: Path, meshes: list[Path], scripts: list[Path], cases: list[Path]) -> list[Path]:
    suffix = path.suffix.lower()
    kinds = [(FORMATS, meshes), (_SCRIPTS, scripts), ((_CASES,), cases)]
    for suffixes, kind in kinds:
        if suffix in suffixes:
            return kind
    known = ", ".join(sorted({*FORMATS, *_SCRIPTS, _CASES}))
    raise FormatError(
        f"{path}: the file has no known suffix; its name must end in one of {known}.",
        "unknown_format",
    )


def cases_of(inputs: CaseInputs, operations: Sequence[str], *draws: PairSelection) -> list[Case]:
    """Return the cases of the inputs, in the order in which they are run.

    Parameters
    ----------
    inputs : CaseInputs
    operations : sequence of str
        The operations for pairs of meshes; files of cases have their own.
    *draws : PairSelection
        Ways to choose and place pairs, each of which gives cases.

    Raises
    ------
    FormatError
        If a file of cases is malformed.
    """
    cases = [case for draw in draws for case in _pairs(inputs.meshes, operations, draw)]
    cases += [_script(path) for path in inputs.scripts]
    cases += [case for path in inputs.cases for case in _listed_cases(path)]
    return cases


def _pairs(paths: Sequence[Path], operations: Sequence[str], draw: PairSelection) -> Iterator[Case]:
    if not paths:
        return
    operand = _Operands()
    if draw.number is not None or draw.count:
        yield from _drawn_pairs(paths, operations, draw, operand)
        return
    if draw.pose is not None:
        yield from _posed(paths, operations, draw, operand)
        return
    for number, (first, second) in enumerate(combinations(paths, 2)):
        operands = (operand("a", first), operand("b", second))
        for op in operations:
            command = command_for([str(first), str(second)], "--op", op)
            name = _name(number, first, second, op)
            yield Case(name, "pair", op, operands, command=command)


def _posed(
    paths: Sequence[Path], operations: Sequence[str], draw: PairSelection, operand: "_Operands"
) -> Iterator[Case]:
    """Yield the cases of all pairs of files in the pose of `draw`."""
    for number, (first, second) in enumerate(combinations(paths, 2)):
        yield from _in_pose(first, second, operations, draw.pose, draw.seed, number, operand)


def _drawn_pairs(
    paths: Sequence[Path], operations: Sequence[str], draw: PairSelection, operand: "_Operands"
) -> Iterator[Case]:
    if draw.number is not None:
        first, second = paths[0], paths[min(1, len(paths) - 1)]
        yield from _in_pose(first, second, operations, draw.pose, draw.seed, draw.number, operand)
        return
    for number in range(draw.count):
        rng = np.random.default_rng([draw.seed, number, 1])
        first, second = (paths[int(k)] for k in rng.integers(len(paths), size=2))
        other = COINCIDENT[int(rng.integers(len(COINCIDENT)))]
        pose = draw.pose or ("random" if number % 2 == 0 else other)
        yield from _in_pose(first, second, operations, pose, draw.seed, number, operand)


def _in_pose(
    first: Path,
    second: Path,
    operations: Sequence[str],
    pose: str | None,
    seed: int,
    number: int,
    operand: "_Operands",
) -> Iterator[Case]:
    pose = pose or "random"
    operands = (operand("a", first), operand("b", second))
    for op in operations:
        options = ["--op", op, "--pose", f"{pose}:{number}", "--seed", str(seed)]
        command = command_for([str(first), str(second)], *options)
        name = _name(number, first, second, pose, op)
        yield Case(name, "pose", op, operands, pose, seed, number, command)


def _name(number: int, first: Path, second: Path, *words: str) -> str:
    """Return the name of a case of two files; the number makes it unique."""
    return "-".join([f"{number:04d}", first.stem, second.stem, *words])


class _Operands:
    """Makes operands from files and hashes each file once."""

    def __init__(self) -> None:
        self._digests: dict[Path, str] = {}

    def __call__(self, name: str, path: Path) -> Operand:
        if path not in self._digests:
            self._digests[path] = _readable(digest_of, path)
        return Operand(name, str(path), self._digests[path])


def _script(path: Path) -> Case:
    operand = Operand("a", str(path), _readable(digest_of, path))
    return Case(path.name, "csg", SCRIPT, (operand,), command=command_for([str(path)]))


def _readable(reader: Callable[[Path], Any], path: Path) -> Any:
    try:
        return reader(path)
    except OSError as error:
        raise unreadable(path, error) from error


def _listed_cases(path: Path) -> Iterator[Case]:
    """Yield the cases that a JSON file of cases lists."""
    try:
        document = json.loads(_readable(Path.read_bytes, path))
        entries = [(entry, _operations_in(entry)) for entry in document["cases"]]
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError) as error:
        raise _malformed(path, str(error)) from error
    for number, (entry, operations) in enumerate(entries):
        operands = tuple(_listed_operands(path, entry))
        name = str(entry.get("name", f"{number:04d}"))
        for op in operations:
            case = Case(f"{name}-{op}", "pair", op, operands)
            yield replace(case, command=command_for([str(path)], "--only", case.name))


def _operations_in(entry: dict[str, Any]) -> Iterable[str]:
    given = entry.get("operation", list(SET_OPS))
    operations = [given] if isinstance(given, str) else list(given)
    for op in operations:
        if op not in SET_OPS:
            raise ValueError(f"unknown operation {op!r}; known are {', '.join(SET_OPS)}")
    return operations


def _listed_operands(path: Path, entry: dict[str, Any]) -> Iterator[Operand]:
    try:
        given = list(entry["operands"])
        for number, values in enumerate(given):
            yield _listed_operand(path, chr(ord("a") + number), values)
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise _malformed(path, f"{type(error).__name__}: {error}") from error


def _listed_operand(path: Path, name: str, values: dict[str, Any]) -> Operand:
    pose = values.get("pose")
    if pose is not None and np.shape(pose) != (3, 4):
        raise ValueError(
            f"the pose of operand {name} must be a matrix of three rows of four numbers"
        )
    if "file" in values:
        file = path.parent / values["file"]
        return Operand(name, str(file), _readable(digest_of, file), pose)
    mesh = {"vertices": values["vertices"], "faces": values["faces"]}
    for part in mesh.values():
        if np.shape(np.array(part, dtype=np.float64))[1:] != (3,):
            raise ValueError(
                f"the vertices and faces of operand {name} must be lists of three numbers each"
            )
    return Operand(name, None, digest_of_mesh(mesh), pose, mesh)


def _malformed(path: Path, reason: str) -> FormatError:
    message = (
        f"{path}: the file is not a valid list of cases ({reason}). A valid one looks like"
        f" {_EXAMPLE}"
    )
    return FormatError(message, "malformed")
