"""`RawMesh`: the content of a file, unprocessed, with polygons divided into triangles.

Readers neither weld, orient, repair nor drop anything, with two exceptions: STL has no indices, so
its corners with equal coordinates become one vertex; and where a file transforms a mesh, crossings
that rounding causes are mended (`bspcsg/formats/mesh_placement.py`).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from .._types import FloatArray, IndexArray
from ..attributes.attributes import Attributes
from ..attributes.concatenation import MeshPart, concatenated
from ..errors import Finding, FormatError
from ..geometry.polygon import triangulate_face
from ..mesh.mesh import Mesh

#: The entry of `RawMesh.dropped` for faces that were divided into triangles.
POLYGONS = "faces of more than three corners"


@dataclass(frozen=True, eq=False)
class RawMesh:
    """Triangles as a file gives them; they need not enclose a volume.

    Parameters
    ----------
    vertices : (n, 3) float64
        In the file's unit; millimetres if the format has units.
    faces : (m, 3) int64
        Indices of `vertices`, all in range.
    name : str
        The mesh's name in the file, or the file's stem.
    findings : tuple of Finding
        The findings about the file.
    objects : tuple of (str, int)
        Names and triangle counts of the objects in the file, in order; empty if the file has no
        separate objects.
    unit : str
        ``"mm"`` if the format defines the unit of lengths, else empty.
    dropped : tuple of str
        Kinds of data in the file that were not read, such as "colours".
    is_empty_set : bool
        True if the file is one that this package writes for the empty set. Any other file without
        faces is not the empty set: its content may have been lost.
    attributes : Attributes, optional
        The values on vertices, corners and faces.
    is_mended : bool
        True if transforming made surfaces cross and they were mended in doubles. On the lattice
        they touch, or may still cross.
    """

    vertices: FloatArray
    faces: IndexArray
    name: str = ""
    findings: tuple[Finding, ...] = ()
    objects: tuple[tuple[str, int], ...] = ()
    unit: str = ""
    dropped: tuple[str, ...] = ()
    is_empty_set: bool = False
    attributes: Attributes | None = None
    is_mended: bool = False

    @property
    def passed_by(self) -> tuple[str, ...]:
        """The messages of the findings about data that the reader skipped."""
        return tuple(found.message for found in self.findings if found.code in _PASSED_BY)


def represents_empty_set(mesh: Mesh | RawMesh) -> bool:
    """Say whether a mesh is the empty set, so that a file of it must be marked as such.

    A `RawMesh` without triangles is the empty set only if `is_empty_set` is true.
    """
    return len(mesh.faces) == 0 and (isinstance(mesh, Mesh) or mesh.is_empty_set)


#: The comment that marks a text file as the empty set, not as a file that has lost its content.
EMPTY_SET = b"# bspcsg: the empty set\n"

#: The codes of findings about parts of a file that a reader skipped.
_PASSED_BY = frozenset({"ignored", "curves_ignored", "extra_data"})


def empty_set() -> RawMesh:
    """Return the mesh that is read from a file of the empty set."""
    finding = Finding(
        "empty", "note", "this file represents the empty set: it has no triangles.", (), 1
    )
    faces = np.zeros((0, 3), dtype=np.int64)
    return RawMesh(np.zeros((0, 3)), faces, "", (finding,), is_empty_set=True)


def parts_of(mesh: Mesh | RawMesh) -> list[tuple[str, IndexArray]]:
    """Return name and triangles of each object of a mesh; without objects, of the whole mesh."""
    objects = mesh.objects if isinstance(mesh, RawMesh) else ()
    if sum(count for _, count in objects) != len(mesh.faces):
        return [(mesh.name if isinstance(mesh, RawMesh) else "", mesh.faces)]
    ends = np.cumsum([0] + [count for _, count in objects]).tolist()
    names = [name for name, _ in objects]
    return [
        (name, mesh.faces[start:end])
        for name, start, end in zip(names, ends, ends[1:], strict=False)
    ]


def on_one_line(name: str) -> str:
    """Return a name with single spaces for line breaks and other blanks, valid in UTF-8."""
    words = " ".join("".join(" " if ord(letter) < _SPACE else letter for letter in name).split())
    return words.encode("utf-8", "replace").decode("utf-8")


#: The code of the blank; lower codes are control characters, such as line breaks and NUL.
_SPACE = 32


def compacted(faces: IndexArray) -> tuple[IndexArray, IndexArray]:
    """Return the vertex indices that triangles use, ascending, and the triangles renumbered.

    The renumbered triangles index the first array.
    """
    if len(faces) == 0:
        return np.zeros(0, dtype=np.int64), faces
    low = int(faces.min())
    is_used = np.zeros(int(faces.max()) + 1 - low, dtype=bool)
    is_used[faces - low] = True
    numbers = np.cumsum(is_used) - 1
    return np.flatnonzero(is_used) + low, numbers[faces - low]


def joined(meshes: Sequence[RawMesh]) -> RawMesh:
    """Return one mesh in which each of several meshes is a named object; nothing is welded."""
    starts = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes]).tolist()
    vertices = [np.zeros((0, 3))] + [mesh.vertices for mesh in meshes]
    faces = [np.zeros((0, 3), dtype=np.int64)]
    faces += [mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]
    objects = tuple((mesh.name, len(mesh.faces)) for mesh in meshes)
    whole = np.concatenate(faces)
    parts = [MeshPart(len(mesh.vertices), mesh.faces, mesh.attributes) for mesh in meshes]
    said = concatenated(parts, whole)
    return RawMesh(np.concatenate(vertices), whole, objects=objects, attributes=said)


@dataclass(frozen=True, eq=False)
class IndexPolygons:
    """Polygons with various numbers of corners, as vertex indices.

    Parameters
    ----------
    corners : (sum of counts,) int64
        Vertex indices, one polygon after another.
    counts : (p,) int64
        The number of corners of each polygon.
    """

    corners: IndexArray
    counts: IndexArray

    @classmethod
    def from_lists(cls, polygons: list[list[int]]) -> "IndexPolygons":
        """Return the polygons that are given as one list of vertex indices each.

        Raises
        ------
        OverflowError
            If an index does not fit into 64 bits.
        """
        counts = np.array([len(polygon) for polygon in polygons], dtype=np.int64)
        flat = [corner for polygon in polygons for corner in polygon]
        return cls(np.array(flat, dtype=np.int64), counts)

    def of_strips(self) -> "tuple[IndexPolygons, IndexArray]":
        """Return the triangles of polygons that are triangle strips, and each triangle's polygon.

        An index -1 ends a strip, and the next index begins a new one.
        """
        corners, strips = self.corners, np.repeat(np.arange(len(self.counts)), self.counts)
        is_gap = corners == -1
        is_first = np.zeros(len(corners), dtype=bool)
        is_first[:1] = True
        is_first[1:] |= (strips[1:] != strips[:-1]) | is_gap[:-1]
        runs = np.cumsum(is_first) - 1
        starts = np.flatnonzero(is_first)[runs]
        at = np.arange(max(len(corners) - 2, 0))
        at = at[(runs[at] == runs[at + 2]) & ~is_gap[at + 2]]
        rows = corners[at[:, None] + np.arange(3)]
        is_turned = (at - starts[at]) % 2 == 1
        rows[is_turned] = rows[is_turned][:, ::-1]
        return IndexPolygons.from_rows(rows), strips[at]

    @property
    def dropped(self) -> tuple[str, ...]:
        """The entries of `RawMesh.dropped`: a text if a polygon has more than three corners."""
        return (POLYGONS,) if self.counts.max(initial=0) > 3 else ()

    @classmethod
    def from_rows(cls, rows: IndexArray) -> "IndexPolygons":
        """Return a polygon for each row of vertex indices (p, n), all with n corners."""
        corners = np.ascontiguousarray(rows, dtype=np.int64).ravel()
        return cls(corners, np.full(len(rows), rows.shape[1], dtype=np.int64))

    def triangles(
        self, vertices: FloatArray, error_at: Callable[[int, str, str], FormatError]
    ) -> IndexArray:
        """Divide the polygons into triangles; return these, (m, 3), in the order of the polygons.

        Polygons may be concave. Every edge of a polygon is an edge of a triangle, so a closed
        surface of polygons becomes a closed surface of triangles.

        Parameters
        ----------
        vertices : (n, 3) float64
        error_at : callable
            Makes the error for a polygon from its number, a message and a code.

        Raises
        ------
        FormatError
            If a polygon has fewer than three corners, or names a vertex that does not exist.
        """
        self._check(len(vertices), error_at)
        starts = np.cumsum(self.counts) - self.counts
        parts, owners = [np.zeros((0, 3), dtype=np.int64)], [np.zeros(0, dtype=np.int64)]
        for count in np.unique(self.counts).tolist():
            which = np.flatnonzero(self.counts == count)
            rows = self.corners[starts[which][:, None] + np.arange(count)]
            faces, row = _triangulated(rows, vertices)
            parts.append(faces)
            owners.append(which[row])
        order = np.argsort(np.concatenate(owners), kind="stable")
        return np.concatenate(parts)[order]

    def positions(
        self, vertices: FloatArray, error_at: Callable[[int, str, str], FormatError]
    ) -> IndexArray:
        """Divide the polygons into triangles; return these as positions in `corners`, (m, 3)."""
        self._check(len(vertices), error_at)
        if (self.counts == 3).all():
            return np.arange(len(self.corners)).reshape(-1, 3)
        places = IndexPolygons(np.arange(len(self.corners)), self.counts)
        return places.triangles(vertices[self.corners], error_at)

    def owners(self, positions: IndexArray) -> IndexArray:
        """Return the polygon number of each triangle, given as positions in `corners`, (m, 3)."""
        return np.searchsorted(np.cumsum(self.counts), positions[:, 0], side="right")

    def _check(self, vertex_count: int, error_at: Callable[[int, str, str], FormatError]) -> None:
        if (self.counts < 3).any():
            polygon = int(np.flatnonzero(self.counts < 3)[0])
            number = int(self.counts[polygon])
            raise error_at(
                polygon, f"a face has {number} corners, but a polygon needs at least 3.", "syntax"
            )
        bad = (self.corners < 0) | (self.corners >= vertex_count)
        if bad.any():
            at = int(np.flatnonzero(bad)[0])
            polygon = int(np.searchsorted(np.cumsum(self.counts), at, side="right"))
            message = (
                f"a face has the vertex index {int(self.corners[at])} (counted from 0), but"
                f" the file has {vertex_count} vertices."
            )
            raise error_at(polygon, message, "index_out_of_range")


def _triangulated(rows: IndexArray, vertices: FloatArray) -> tuple[IndexArray, IndexArray]:
    """Return the triangles of k polygons with n corners, (k, n), and each triangle's polygon."""
    count = rows.shape[1]
    if count == 3:
        return rows, np.arange(len(rows))
    convex = _are_convex(vertices[rows])
    fans = rows[convex][:, _fan(count)].reshape(-1, 3)
    parts, owners = [fans], [np.repeat(np.flatnonzero(convex), count - 2)]
    for row in np.flatnonzero(~convex).tolist():
        corners = vertices[rows[row]]
        # Coordinates relative to the first corner keep the shape of a small polygon far from the
        # origin.
        faces = rows[row][triangulate_face(corners - corners[0])]
        parts.append(faces)
        owners.append(np.full(len(faces), row))
    return np.concatenate(parts), np.concatenate(owners)


def _fan(count: int) -> IndexArray:
    second = np.arange(1, count - 1)
    return np.column_stack([np.zeros_like(second), second, second + 1])


def _are_convex(corners: FloatArray) -> "np.ndarray[tuple[int], np.dtype[np.bool_]]":
    """Say for each polygon, (k, n, 3), whether it is strictly convex and a fan can divide it."""
    local = corners - corners[:, :1]
    with np.errstate(over="ignore", invalid="ignore"):
        normal = np.cross(local, np.roll(local, -1, axis=1)).sum(axis=1)
        ahead = np.roll(local, -1, axis=1) - local
        turns = np.cross(np.roll(ahead, 1, axis=1), ahead)
        fans = np.cross(local[:, 1:-1], local[:, 2:])
        sides = np.einsum("kni,ki->kn", np.concatenate([turns, fans], axis=1), normal)
    convex: np.ndarray[tuple[int], np.dtype[np.bool_]] = (sides > 0).all(axis=1)
    return convex
