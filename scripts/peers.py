"""Put small set operations with known results to all installed engines.

Each engine runs each operation in a process of its own, so that a crash or an endless run is
recorded as its answer. `--record` writes the answers; docs/trust.md shows them. To install the
engines: pip install libigl "bspcsg[bench]"
"""

import argparse
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from importlib.util import find_spec
from typing import Any

import numpy as np

from bspcsg._types import MeshArrays
from bspcsg.bench.engines import ENGINES, Engine, EngineError, Operation, installed
from recording import release, write_record
from support.documents import with_generated

#: The corners of the unit cube; its faces are counter-clockwise seen from outside.
CORNERS = np.array([[x, y, z] for x in (0.0, 1) for y in (0.0, 1) for z in (0.0, 1)])
FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]]
    + [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
)

#: The time limit of an answer, in seconds.
_TIMEOUT = 120

#: The number of times that the cube is cut by another cube and united again.
_ROUNDS = 10

#: The relative difference of volumes that rounding explains; some engines use single precision.
_ROUNDING = 1e-5


@dataclass(frozen=True)
class Question:
    """A set operation with a known result.

    Parameters
    ----------
    words : str
        A description of the operation.
    volume : float or None
        The volume of the correct result; None if the engine should refuse the input.
    triangles : int
        The number of triangles that suffice; 0 if any number is correct.
    ask : callable
        A function of an engine that returns the volume and the number of triangles of its result.
    """

    words: str
    volume: float | None
    triangles: int
    ask: Callable[[Engine], tuple[float, int]]


def cube(shift: tuple[float, ...] = (0, 0, 0)) -> MeshArrays:
    return CORNERS + shift, FACES


def turned() -> MeshArrays:
    """Return the unit cube, rotated by 45° about its vertical axis."""
    half = 0.5**0.5
    matrix = np.array([[half, half, 0], [-half, half, 0], [0, 0, 1]])
    return (CORNERS - [0.5, 0.5, 0]) @ matrix + [0.5, 0.5, 0], FACES


def both(first: MeshArrays, second: MeshArrays) -> MeshArrays:
    """Return two meshes as one mesh."""
    faces = np.concatenate([first[1], second[1] + len(first[0])])
    return np.concatenate([first[0], second[0]]), faces


def opened() -> MeshArrays:
    return CORNERS, FACES[1:]


def combined(
    first: MeshArrays, second: MeshArrays, operation: Operation
) -> Callable[[Engine], tuple[float, int]]:
    """Return a function of an engine that combines two meshes and measures the result."""
    return lambda engine: measured(engine.boolean(first, second, operation))


def measured(mesh: MeshArrays) -> tuple[float, int]:
    return volume_of(mesh), len(mesh[1])


def overlapping(engine: Engine) -> tuple[float, int]:
    """Return an engine's volume of the union of an overlapping mesh and a distant cube.

    The volume is the engine's own, since parts that nothing cuts may come back overlapping.
    """
    meshes = both(cube(), cube((0.5, 0, 0))), cube((9, 9, 9))
    return engine.volume(engine.combine("union", [engine.solid(mesh) for mesh in meshes])), 0


def put_back(engine: Engine) -> tuple[float, int]:
    """Cut the cube by rotated cubes in turn, and unite both parts after each cut.

    Return the volume and the number of triangles at the end.
    """

    def arrays(first: MeshArrays, second: MeshArrays, operation: Operation) -> MeshArrays:
        vertices, faces = engine.boolean(first, second, operation)
        return np.array(vertices, dtype=np.float64), np.array(faces, dtype=np.int64)

    mesh = cube()
    for number in range(_ROUNDS):
        random = np.random.default_rng(number)
        matrix, _ = np.linalg.qr(random.normal(size=(3, 3)))
        matrix *= np.sign(np.linalg.det(matrix))
        other = (CORNERS - 0.5) @ matrix + random.uniform(size=3), FACES
        parts = arrays(mesh, other, "difference"), arrays(mesh, other, "intersection")
        mesh = arrays(*parts, "union")
    return measured(mesh)


QUESTIONS = {
    "itself": Question("a cube minus itself", 0, 0, combined(cube(), cube(), "difference")),
    "face": Question("cubes that share a face", 2, 12, combined(cube(), cube((1, 0, 0)), "union")),
    "edge": Question("cubes that share an edge", 2, 24, combined(cube(), cube((1, 1, 0)), "union")),
    "corner": Question(
        "cubes that share a corner", 2, 24, combined(cube(), cube((1, 1, 1)), "union")
    ),
    "caps": Question(
        "a cube minus itself, turned by 45°",
        3 - 2 * 2**0.5,
        32,
        combined(cube(), turned(), "difference"),
    ),
    "overlap": Question("the volume of a mesh that overlaps itself", 2.5, 0, overlapping),
    "open": Question(
        "a cube without one triangle", None, 0, combined(opened(), cube((0.5, 0.5, 0.5)), "union")
    ),
    "put back": Question(f"a cube, cut and put back {_ROUNDS} times", 1, 12, put_back),
}


class _Libigl(Engine):
    """CGAL's exact arrangement as an engine, through libigl."""

    name = "libigl"

    def solid(self, mesh: MeshArrays) -> MeshArrays:
        return mesh

    def combine(self, operation: Operation, solids: Sequence[MeshArrays]) -> MeshArrays:
        first, second = solids
        return self.boolean(first, second, operation)

    def volume(self, solid: MeshArrays) -> float:
        return volume_of(solid)

    def arrays(self, solid: MeshArrays) -> MeshArrays:
        return solid

    def resolution(self, size: float) -> float:
        return 1e-15 * size

    def boolean(self, first: MeshArrays, second: MeshArrays, operation: Operation) -> MeshArrays:
        from igl.copyleft import cgal

        word = {"union": "union", "difference": "minus", "intersection": "intersect"}[operation]
        operands = (first[0], first[1].astype(np.int64), second[0], second[1].astype(np.int64))
        found = cgal.mesh_boolean(*operands, word)
        return np.asarray(found[0]), np.asarray(found[1])


def volume_of(mesh: MeshArrays) -> float:
    if not len(mesh[1]):
        return 0.0
    a, b, c = (np.asarray(mesh[0], dtype=np.float64)[mesh[1][:, corner]] for corner in range(3))
    return float(np.einsum("ki,ki->", a, np.cross(b, c)) / 6)


def answer(name: str, question: str) -> str:
    """Return an engine's answer to a question as a short text."""
    asked = QUESTIONS[question]
    engine = _Libigl() if name == "libigl" else ENGINES[name]()
    try:
        volume, count = asked.ask(engine)
    except Exception as error:
        known = isinstance(error, EngineError) or asked.volume is None
        return "refused" if known else f"error: {type(error).__name__}"
    if asked.volume is None:
        return "taken, and nothing said"
    if abs(volume - asked.volume) > _ROUNDING * max(1.0, asked.volume):
        return f"volume {volume:.4g}, not {asked.volume:.4g}"
    if asked.volume == 0 and count:
        return f"{count} triangles left"
    return f"{count} triangles" if count > asked.triangles > 0 else "right"


def answers(name: str) -> Iterator[tuple[str, str]]:
    """Yield the name and the answer of each test question; a child process asks the engine."""
    for question in QUESTIONS:
        command = [sys.executable, __file__, "--ask", name, question]
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, timeout=_TIMEOUT, check=False
            )
        except subprocess.TimeoutExpired:
            yield question, "no answer"
            continue
        said = done.stdout.rpartition("answer: ")[2].strip()
        yield question, said if done.returncode == 0 else f"crashed, code {done.returncode}"


def table(found: dict[str, dict[str, str]]) -> str:
    """Return the answers of all engines as a Markdown table."""
    rows = [["", *found], ["---"] * (len(found) + 1)]
    rows += [
        [question.words, *(said[name] for said in found.values())]
        for name, question in QUESTIONS.items()
    ]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def recorded() -> dict[str, dict[str, Any]]:
    """Return the versions and answers of the engines, as recorded for the last release."""
    found: dict[str, dict[str, Any]] = release()["peers"]
    return found


def with_answers(page: str) -> str:
    """Return a page with the table of the recorded answers."""
    found = recorded()
    titled = {f"{name} {found['versions'][name]}": said for name, said in found["answers"].items()}
    return with_generated("trust", page, table(titled) + "\n")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ask", nargs=2, metavar=("ENGINE", "QUESTION"), help=argparse.SUPPRESS)
    parser.add_argument("--record", action="store_true", help="keep the answers")
    options = parser.parse_args()
    if options.ask:
        print("answer:", answer(*options.ask))
        return
    versions = installed() | ({"libigl": version("libigl")} if find_spec("igl") else {})
    found = {name: dict(answers(name)) for name in versions}
    print(table(found))
    if options.record:
        print(write_record("peers", {"versions": versions, "answers": found}))


if __name__ == "__main__":
    main()
