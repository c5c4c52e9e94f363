"""Types of the compiled core; `docs/design/binding.md` says what each call means."""

from collections.abc import Callable
from typing import (
    Literal,
    TypeAlias,
    TypedDict,
    final,
    type_check_only,
)

import numpy as np
import numpy.typing as npt

__all__ = [
    "CoreError",
    "FragmentTree",
    "ObjectTree",
    "PanicException",
    "RayScene",
    "RayTree",
    "Tree",
    "__version__",
    "are_triangles",
    "are_words",
    "fail_on_purpose",
    "find_numpy",
    "hull_mesh",
    "mesh_counts",
    "mesh_faults",
    "mesh_in_single",
    "mesh_measures",
    "mesh_moments",
    "mesh_moved",
    "normal_bits",
    "numbers_in_rows",
    "outline_triangles",
    "set_threads",
    "suited_pitch",
    "surfaces_of",
    "watch",
    "welded_points",
    "whole_numbers_in_rows",
]

__version__: str

class CoreError(Exception):
    code: str
    where: list[int]
    message: str
    # Only for defects: the call of the core and its inputs, for the report.
    call: str
    inputs: dict[str, object]

class PanicException(BaseException): ...

@type_check_only
class Finding(TypedDict):
    code: str
    severity: str
    message: str
    where: list[int]
    count: int

@type_check_only
class Faults(TypedDict):
    crossings: npt.NDArray[np.int64]
    flat: npt.NDArray[np.int64]

@type_check_only
class Settled(Faults):
    vertices: npt.NDArray[np.float64]
    triangles: npt.NDArray[np.int64]
    kept: npt.NDArray[np.int64]
    mended: int

_MeshArrays: TypeAlias = tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]
_PieceArrays: TypeAlias = tuple[
    npt.NDArray[np.float64], npt.NDArray[np.int64], npt.NDArray[np.int64]
]
_SplitCase: TypeAlias = Literal[
    "leaf", "same", "opposite", "minus-minus", "minus-plus", "plus-minus", "plus-plus", "crossing"
]

def fail_on_purpose(panic: bool, size: int) -> None: ...
def hull_mesh(
    points: npt.NDArray[np.float64], pitch: int
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64], bool]: ...
def mesh_faults(vertices: npt.NDArray[np.float64], triangles: npt.NDArray[np.int64]) -> Faults: ...
def mesh_moved(
    before: npt.NDArray[np.float64],
    vertices: npt.NDArray[np.float64],
    triangles: npt.NDArray[np.int64],
    pitch: int,
) -> Settled | None: ...
def mesh_in_single(
    vertices: npt.NDArray[np.float64], triangles: npt.NDArray[np.int64]
) -> Settled: ...
def set_threads(n: int) -> None: ...
def watch(watcher: Callable[[], object] | None) -> Callable[[], object] | None: ...
def find_numpy() -> None: ...
def normal_bits(dimension: int) -> int: ...
def suited_pitch(largest: float, extent: float) -> int: ...
def numbers_in_rows(text: bytes, row: bytes) -> npt.NDArray[np.float64]: ...
def whole_numbers_in_rows(text: bytes, row: bytes) -> npt.NDArray[np.int64]: ...
def are_words(data: bytes, words: npt.NDArray[np.uint64], big_endian: bool) -> bool: ...
def are_triangles(faces: bytes, triangles: npt.NDArray[np.int64]) -> bool: ...
def welded_points(
    points: npt.NDArray[np.float64],
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]: ...
def outline_triangles(
    points: npt.NDArray[np.float64], edges: npt.NDArray[np.int64]
) -> npt.NDArray[np.int64] | None: ...
def surfaces_of(triangles: npt.NDArray[np.int64], vertex_count: int) -> npt.NDArray[np.int64]: ...
def mesh_counts(
    triangles: npt.NDArray[np.int64], vertex_count: int
) -> tuple[int, int, int, int]: ...
def mesh_measures(
    vertices: npt.NDArray[np.float64],
    triangles: npt.NDArray[np.int64],
    middle: tuple[float, float, float],
) -> tuple[float, float]: ...
def mesh_moments(
    vertices: npt.NDArray[np.float64],
    triangles: npt.NDArray[np.int64],
    middle: tuple[float, float, float],
) -> tuple[float, list[float], list[list[float]]]: ...

@final
class Tree:
    @classmethod
    def from_mesh(
        cls,
        vertices: npt.NDArray[np.float64],
        faces: npt.NDArray[np.int64],
        pitch: int | None = None,
        trusted: bool = False,
        rounded: str | None = None,
    ) -> Tree: ...
    @classmethod
    def half_space(cls, hyperplane: list[int], pitch: int, rounded: str | None = None) -> Tree: ...
    @classmethod
    def empty(cls, pitch: int) -> Tree: ...
    @classmethod
    def full(cls, pitch: int) -> Tree: ...
    @classmethod
    def evaluate(
        cls, program: list[tuple[str, list[int]]], operands: list[Tree], threads: int = 0
    ) -> Tree: ...
    @classmethod
    def load(cls, data: bytes) -> Tree: ...
    def dump(self) -> bytes: ...
    def normalized(self, rule: str = "positive", threads: int = 0) -> Tree: ...
    def simplified(self, tolerance: float, threads: int = 0) -> Tree | None: ...
    def to_mesh(self, threads: int = 0) -> _MeshArrays: ...
    def origins(self) -> npt.NDArray[np.int64]: ...
    def flips(self) -> npt.NDArray[np.bool_]: ...
    def patched(self, patches: list[npt.NDArray[np.uint32] | None]) -> Tree: ...
    def source_arrays(
        self, slot: int
    ) -> (
        tuple[
            npt.NDArray[np.float64],
            npt.NDArray[np.float64],
            npt.NDArray[np.int64],
            npt.NDArray[np.int64],
        ]
        | None
    ): ...
    def given_arrays(self) -> _MeshArrays: ...
    def mesh_findings(self) -> list[Finding]: ...
    def volume6_exact(self, most_bits: int) -> tuple[int, int]: ...
    def volume_rounded(self) -> float | None: ...
    def volume_near(self) -> tuple[int, int]: ...
    def volume_residues(self) -> tuple[int, int] | None: ...
    def planes(self) -> list[list[int]]: ...
    def meets(self, other: Tree) -> bool: ...
    def divided(self) -> Tree | None: ...
    def surfaces_and_euler_number(self) -> tuple[int, int]: ...
    def classify(self, points: npt.NDArray[np.float64]) -> npt.NDArray[np.int8]: ...
    def sections(self, hyperplanes: list[list[int]]) -> list[npt.NDArray[np.float64]]: ...
    def moving_crosses(self, axes: list[int], shift: list[int]) -> bool: ...
    def moved(self, axes: list[int], shift: list[int]) -> Tree: ...
    def renamed(self) -> Tree: ...
    def refined(self, pitch: int) -> Tree: ...
    def stats(self) -> dict[str, int]: ...
    def profile(self) -> tuple[list[tuple[str, float, int]], str | None]: ...
    @property
    def closes_when_moved(self) -> bool: ...
    @property
    def holds_given(self) -> bool: ...
    @property
    def simple(self) -> bool | None: ...
    @property
    def snapped_by(self) -> float: ...
    @property
    def sources(self) -> list[int]: ...
    @property
    def named(self) -> list[bool]: ...
    @property
    def source_id(self) -> int | None: ...
    @property
    def findings(self) -> list[Finding]: ...
    @property
    def is_empty(self) -> bool: ...
    @property
    def is_full(self) -> bool: ...
    @property
    def is_bounded(self) -> bool: ...
    @property
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]] | None: ...
    @property
    def pitch(self) -> int: ...

_Floats: TypeAlias = npt.NDArray[np.float64]
_Indices: TypeAlias = npt.NDArray[np.int64]

_DivisionRow: TypeAlias = tuple[
    tuple[int, int, int, int, list[int], _Reason],
    list[tuple[int, int, int, int, float]],
    list[list[int]],
]
_RayEventRow: TypeAlias = tuple[
    Literal["visit", "test", "leaf"],
    int,
    int,
    int,
    float | None,
    float | None,
    float | None,
]
_StabRow: TypeAlias = tuple[
    Literal["visit", "leaf", "test", "count", "divide"], int, int, int, list[list[int]] | None
]
_MergeRow: TypeAlias = tuple[Literal["pair", "split", "halves", "join"], int, int, str, str]
_Reason: TypeAlias = Literal[
    "first",
    "random",
    "least-splits",
    "balanced",
    "weighted",
    "least-cost",
    "end-points",
    "median",
    "given",
    "asked",
]

@type_check_only
class StabArrays(TypedDict):
    visits: _Indices
    depth: _Indices
    minus: _Indices
    plus: _Indices
    offsets: _Indices
    facets: _Indices
    hits: _Indices
    hyperplanes: list[list[int]]

@type_check_only
class CasterArrays(TypedDict):
    low: _Floats
    high: _Floats
    parent: _Indices
    deferred: npt.NDArray[np.bool_]
    offsets: _Indices
    facets: _Indices

@final
class RayScene:
    def __new__(cls, dimension: int, corners: _Floats, pitch: int | None = None) -> RayScene: ...
    def __len__(self) -> int: ...
    @property
    def pitch(self) -> int: ...
    def complete(self, threads: int = 0) -> None: ...
    def refitted(self, corners: _Floats) -> RayScene: ...
    def nodes(self) -> CasterArrays: ...
    def first(
        self, origins: _Floats, directions: _Floats, threads: int = 0
    ) -> tuple[_Indices, _Floats, npt.NDArray[np.int8], _Floats, _Floats]: ...
    def first_facets(self, origins: _Floats, directions: _Floats, threads: int = 0) -> _Indices: ...
    def all(
        self, origins: _Floats, directions: _Floats, merge: bool = False, threads: int = 0
    ) -> tuple[_Indices, tuple[_Indices, _Floats, npt.NDArray[np.int8], _Floats, _Floats]]: ...
    def intervals(
        self,
        origins: _Floats,
        directions: _Floats,
        rule: str = "positive",
        unbounded: bool = False,
        threads: int = 0,
    ) -> tuple[_Indices, _Floats, _Indices]: ...
    def hidden(
        self, origins: _Floats, targets: _Floats, threads: int = 0
    ) -> npt.NDArray[np.bool_]: ...
    def blocked(
        self, origins: _Floats, directions: _Floats, limits: _Floats, threads: int = 0
    ) -> npt.NDArray[np.bool_]: ...

@final
class RayTree:
    def __new__(
        cls,
        dimension: int,
        corners: _Floats,
        pitch: int | None = None,
        threshold: int | None = None,
        hits: list[int] | None = None,
        limit: int | None = None,
        grown: bytes | None = None,
    ) -> RayTree: ...
    def dump(self) -> bytes: ...
    @property
    def pitch(self) -> int: ...
    def test(
        self, origins: _Floats, directions: _Floats
    ) -> tuple[tuple[_Indices, _Floats, npt.NDArray[np.int8], _Floats, _Floats], _Indices]: ...
    def test_watched(
        self, origin: _Floats, direction: _Floats
    ) -> tuple[
        tuple[_Indices, _Floats, npt.NDArray[np.int8], _Floats, _Floats],
        _Indices,
        list[_StabRow],
    ]: ...
    def nodes(self) -> StabArrays: ...
    def stats(self) -> dict[str, int]: ...

@final
class ObjectTree:
    @classmethod
    def build(
        cls,
        dimension: int,
        facets: npt.NDArray[np.float64],
        pitch: int,
        *,
        faces: npt.NDArray[np.int64] | None = None,
        winding: str = "positive",
        policy: str = "balanced",
        seed: int = 0,
        cuts: list[list[int]] | None = None,
    ) -> ObjectTree: ...
    @classmethod
    def half_space(cls, hyperplane: list[int], pitch: int) -> ObjectTree: ...
    @classmethod
    def uniform(cls, dimension: int, full: bool, pitch: int) -> ObjectTree: ...
    @classmethod
    def load(cls, data: bytes) -> ObjectTree: ...
    def dump(self) -> bytes: ...
    @classmethod
    def region(cls, segments: npt.NDArray[np.float64], pitch: int, winding: str) -> ObjectTree: ...
    def merge(self, other: ObjectTree, op: str) -> ObjectTree: ...
    def combined(self, other: ObjectTree, op: str) -> ObjectTree: ...
    def composed(self, others: list[ObjectTree]) -> ObjectTree: ...
    def merge_steps(self, other: ObjectTree, op: str) -> tuple[ObjectTree, list[_MergeRow]]: ...
    def hyperplanes(self) -> list[list[int]]: ...
    def equals(self, other: ObjectTree) -> bool: ...
    def complement(self) -> ObjectTree: ...
    def partitioned(self, hyperplane: list[int]) -> ObjectTree: ...
    def split(self, hyperplane: list[int]) -> tuple[ObjectTree, ObjectTree]: ...
    def split_case(self, hyperplane: list[int]) -> _SplitCase: ...
    def condensed(self) -> ObjectTree: ...
    def moved(self, axes: list[int], shift: list[int]) -> ObjectTree: ...
    def refined(self, pitch: int) -> ObjectTree: ...
    def boundary(self) -> _PieceArrays: ...
    def edges(self) -> _PieceArrays: ...
    def cells(self) -> _PieceArrays: ...
    def outlines(self) -> _PieceArrays: ...
    def exact_outlines(self) -> list[list[tuple[tuple[int, int], tuple[int, int]]]]: ...
    def measure(self) -> tuple[int, int]: ...
    def moments(self) -> list[tuple[int, int]]: ...
    def area_bounds(self) -> list[tuple[int, int]]: ...
    def nearest(self, points: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]: ...
    def cast(self, origin: list[float], direction: list[float]) -> _PieceArrays: ...
    def classify(self, points: npt.NDArray[np.float64]) -> npt.NDArray[np.int8]: ...
    def stats(self) -> dict[str, int]: ...
    @property
    def nodes(self) -> _PieceArrays: ...
    @property
    def dimension(self) -> int: ...
    @property
    def pitch(self) -> int: ...
    @property
    def is_empty(self) -> bool: ...
    @property
    def is_full(self) -> bool: ...
    @property
    def is_bounded(self) -> bool: ...

@type_check_only
class NodeArrays(TypedDict):
    normal: npt.NDArray[np.float64]
    offset: npt.NDArray[np.float64]
    minus: npt.NDArray[np.int64]
    plus: npt.NDArray[np.int64]
    parent: npt.NDArray[np.int64]
    depth: npt.NDArray[np.int64]
    start: npt.NDArray[np.int64]
    end: npt.NDArray[np.int64]
    cut: npt.NDArray[np.int64]

@final
class FragmentTree:
    @classmethod
    def build(
        cls,
        corners: npt.NDArray[np.float64],
        offsets: npt.NDArray[np.int64],
        policy: str,
        seed: int = 0,
        sample: int = 8,
        alpha: float = 0.5,
        top: int = 0,
        pitch: int | None = None,
        lenience: tuple[bool, bool] = ...,
        own: list[list[int]] | None = None,
    ) -> FragmentTree: ...
    @classmethod
    def asked(
        cls,
        corners: npt.NDArray[np.float64],
        offsets: npt.NDArray[np.int64],
        answer: Callable[
            [int, int, list[tuple[int, int, int, int, float]]], tuple[int, list[int] | None]
        ],
        sample: int,
        pitch: int,
        lenience: tuple[bool, bool],
        own: list[list[int]],
    ) -> FragmentTree: ...
    def grown(
        self,
        corners: npt.NDArray[np.float64],
        offsets: npt.NDArray[np.int64],
        policy: str,
        seed: int,
        sample: int,
        alpha: float,
        lenience: tuple[bool, bool],
    ) -> FragmentTree: ...
    def construction(self) -> list[_DivisionRow]: ...
    def path(self, point: list[float]) -> list[tuple[int, int]]: ...
    def cast(
        self, origins: npt.NDArray[np.float64], directions: npt.NDArray[np.float64]
    ) -> tuple[_Indices, _Floats, _Indices, _Indices, _Indices]: ...
    def ray_events(
        self, origin: list[float], direction: list[float]
    ) -> tuple[tuple[int, float] | None, list[_RayEventRow]]: ...
    def own(self) -> list[list[int]]: ...
    @classmethod
    def rebuild(
        cls,
        corners: npt.NDArray[np.int64],
        offsets: npt.NDArray[np.int64],
        pitch: int,
        cuts: npt.NDArray[np.int64],
        lenience: tuple[bool, bool],
        own: list[list[int]] | None = None,
    ) -> FragmentTree: ...
    def __len__(self) -> int: ...
    def perfect_cuts(self) -> npt.NDArray[np.int64] | None: ...
    def nodes(self) -> NodeArrays: ...
    def coefficients(self, node: int) -> list[int] | None: ...
    def fragments(
        self,
    ) -> tuple[
        npt.NDArray[np.float64],
        npt.NDArray[np.int64],
        npt.NDArray[np.int64],
        npt.NDArray[np.int64],
        npt.NDArray[np.bool_],
        npt.NDArray[np.bool_],
    ]: ...
    def splits(self) -> npt.NDArray[np.int64]: ...
    def order(self, eye: list[float], at_infinity: bool) -> npt.NDArray[np.int64]: ...
    def sides(self, eye: list[float], at_infinity: bool) -> npt.NDArray[np.int8]: ...
    def measures(
        self, margin: float
    ) -> tuple[float, float, npt.NDArray[np.float64], npt.NDArray[np.float64]]: ...
    def region(
        self, node: int | None, side: int, margin: float
    ) -> list[npt.NDArray[np.float64]]: ...
    def span(self, node: int, margin: float) -> npt.NDArray[np.float64]: ...
    def lattice(self) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]: ...
    def piece_sources(self) -> npt.NDArray[np.int64]: ...
    @property
    def dimension(self) -> int: ...
    @property
    def pitch(self) -> int: ...
    @property
    def piece_count(self) -> int: ...
