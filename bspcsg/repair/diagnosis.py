"""The diagnosis of a mesh: findings that name and count its defects, and the faces that have them.

Corners with equal coordinates are joined before edges are examined, as every reader of STL has to
do. The core decides exactly whether faces cross or overlap.
"""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from .._types import FloatArray, IndexArray
from ..errors import BspcsgError, Finding
from ..formats.raw import RawMesh
from ..mesh.certificate import Certificate, Precision
from ..mesh.mesh import Mesh, surfaces_of
from ..mesh.weld import welded
from ..solid.ledger import uncounted
from ..solid.measure import overlaps_of
from ..solid.solid import Solid

#: The largest number of faces that a finding names.
_MAX_PLACES_NAMED = 8

#: The bound of height divided by longest edge below which a triangle's area is computed exactly.
_FLAT = 1e-6


@dataclass(frozen=True)
class Diagnosis:
    """The defects and the measures of a mesh.

    Parameters
    ----------
    triangles, vertices : int
        The counts in the file.
    closed, oriented, manifold : bool
        Closed: every edge has as many faces in one direction as in the other. Oriented: no edge
        with several faces has more in one direction. Manifold: no edge has more than two faces.
    self_overlapping : bool or None
        True if faces cross, overlap or repeat on the lattice; None if the mesh is not a solid.
    precision : {"double", "single"} or None
        Single if single precision represents all coordinates exactly; None if not closed.
    crossings : int or None
        The number of pairs of triangles that cross or overlap, decided exactly for the given
        coordinates; None if the mesh is not closed.
    verdict : {"solid", "inside out", "not closed", "empty", "refused"}
    findings : tuple of Finding
        Sorted by severity, the worst first.
    signed_volume, area : float
        Sums over the triangles, even if they enclose nothing; in cubic and square model units.
    volume : float or None
        The volume of the points with positive winding number; None if the mesh is not closed.
    surfaces, genus : int or None
        The number of connected surfaces, and of handles in all of them together.
    bounds : tuple or None
        Smallest and largest x, y and z.
    """

    triangles: int
    vertices: int
    closed: bool
    oriented: bool
    manifold: bool
    self_overlapping: bool | None
    precision: Precision | None
    crossings: int | None
    verdict: str
    findings: tuple[Finding, ...]
    signed_volume: float
    area: float
    volume: float | None
    surfaces: int
    genus: int | None
    bounds: tuple[tuple[float, ...], ...] | None

    @property
    def is_solid(self) -> bool:
        """True if the verdict is "solid": the mesh is closed and oriented outwards."""
        return self.verdict == "solid"

    def to_dict(self) -> dict[str, Any]:
        """Return the diagnosis as JSON values; a measure that overflows a double is None."""
        found = asdict(self)
        for name in ("signed_volume", "area"):
            found[name] = found[name] if math.isfinite(found[name]) else None
        return found


@uncounted
def diagnose(raw: RawMesh) -> Diagnosis:
    """Find all defects of a mesh, and measure it."""
    with np.errstate(over="ignore", invalid="ignore"):
        return _diagnosed(raw)


def _diagnosed(raw: RawMesh) -> Diagnosis:
    vertices, same = welded(raw.vertices) if len(raw.vertices) else (raw.vertices, np.zeros(0, int))
    mesh = Mesh(vertices, same[raw.faces], np.zeros((len(raw.faces), 2), dtype=np.int64))
    edges = EdgeUses(mesh.faces, len(vertices))
    findings = [*raw.findings, *_edge_findings(mesh, edges), *_face_findings(mesh, edges)]
    solid, verdict = _as_solid(raw, findings)
    # A mesh that is inside out encloses no points of positive winding number: nothing to compare.
    overlapping = None
    if solid is not None and verdict == "solid":
        overlaps = _overlaps(solid)
        codes = {found.code for found in overlaps}
        overlapping = "self_overlap" in codes
        verdict = "inside out" if "inside_out" in codes else verdict
        findings += overlaps
    proof = None if solid is None else _proof(solid, findings)
    return Diagnosis(
        triangles=len(raw.faces),
        vertices=len(raw.vertices),
        closed=solid is not None or edges.are_closed,
        oriented=len(edges.turned) == 0,
        manifold=len(edges.crowded) == 0,
        self_overlapping=overlapping,
        precision=None if proof is None else proof.precision,
        crossings=None if proof is None else len(proof.crossings),
        verdict=verdict,
        findings=by_severity(findings),
        signed_volume=mesh.volume,
        area=mesh.area,
        volume=None if solid is None else solid.volume,
        surfaces=mesh.surface_count if len(mesh.faces) else 0,
        genus=mesh.genus if edges.are_manifold else None,
        bounds=None if (box := mesh.bounds) is None else tuple(map(tuple, box.tolist())),
    )


_RANK = {"error": 0, "warning": 1, "note": 2}


def by_severity(findings: Sequence[Finding]) -> tuple[Finding, ...]:
    """Return findings sorted by severity, the worst first."""
    return tuple(sorted(findings, key=lambda found: _RANK[found.severity]))


class EdgeUses:
    """The undirected edges of triangles, sorted by how faces use each edge in both directions.

    `open` are the edges with one face, `turned` those with more faces in one direction, `crowded`
    those with more than two faces; all are indices of `ends`, the vertices of each edge.

    Parameters
    ----------
    faces : (m, 3) int64
    vertex_count : int
    """

    def __init__(self, faces: IndexArray, vertex_count: int) -> None:
        start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
        proper = start != end
        self.face = np.repeat(np.arange(len(faces)), 3)[proper]
        start, end = start[proper], end[proper]
        low, high = np.minimum(start, end), np.maximum(start, end)
        keys, self.edge = np.unique(
            low * np.int64(max(vertex_count, 1)) + high, return_inverse=True
        )
        self.ends = np.stack([keys // max(vertex_count, 1), keys % max(vertex_count, 1)], axis=1)
        forth = np.bincount(self.edge[start < end], minlength=len(keys))
        back = np.bincount(self.edge[start > end], minlength=len(keys))
        self.open = np.flatnonzero(forth + back == 1)
        self.turned = np.flatnonzero((forth != back) & (forth + back > 1))
        self.crowded = np.flatnonzero(forth + back > 2)

    @property
    def are_closed(self) -> bool:
        """True if every edge has as many faces in one direction as in the other."""
        return len(self.open) == 0 and len(self.turned) == 0

    @property
    def are_manifold(self) -> bool:
        """True if every edge has two faces, one in each direction."""
        return self.are_closed and len(self.crowded) == 0 and len(self.edge) > 0

    def faces_at(self, edges: IndexArray) -> tuple[int, ...]:
        """Return the first faces at the given edges, at most as many as a finding names."""
        at = np.flatnonzero(np.isin(self.edge, edges[:_MAX_PLACES_NAMED]))
        return tuple(np.unique(self.face[at])[:_MAX_PLACES_NAMED].tolist())


def _edge_findings(mesh: Mesh, edges: EdgeUses) -> list[Finding]:
    holes = ""
    if len(edges.open):
        count = int(connected(edges.ends[edges.open]).max()) + 1
        holes = f" around {_count_text(count, 'hole')}"
    kinds = (
        ("open_edges", "error", edges.open, f"with only one triangle (open edges),{holes}"),
        ("orientation", "error", edges.turned, "whose two triangles have opposite orientations"),
        ("non_manifold", "warning", edges.crowded, "with more than two triangles"),
    )
    found = []
    for code, severity, which, what in kinds:
        if len(which):
            first = _between(mesh.vertices, edges.ends[which[0]])
            message = f"{_count_text(len(which), 'edge')} {what}; the first {first}"
            found.append(Finding(code, severity, message, edges.faces_at(which), len(which)))
    return found


def connected(ends: IndexArray) -> IndexArray:
    """Return for each edge the number, from 0, of the connected chain to which it belongs, (k,).

    Edges are given by their vertices, (k, 2).
    """
    used, edges = np.unique(ends, return_inverse=True)
    # Represent an edge as a triangle that repeats a corner.
    return surfaces_of(edges.reshape(-1, 2)[:, [0, 1, 1]], len(used))


def _face_findings(mesh: Mesh, edges: EdgeUses) -> list[Finding]:
    del edges
    found = []
    flat = flat_faces(mesh)
    if len(flat):
        message = f"{_count_text(len(flat), 'triangle')} without area{_first(mesh, flat)}"
        found.append(Finding("degenerate", "warning", message, _first_indices(flat), len(flat)))
    repeated = repeated_faces(mesh.faces)
    if len(repeated):
        message = (
            f"{_count_text(len(repeated), 'triangle')} with the same corners as another triangle"
        )
        message += _first(mesh, repeated)
        found.append(
            Finding("duplicate", "warning", message, _first_indices(repeated), len(repeated))
        )
    unused = len(mesh.vertices) - len(np.unique(mesh.faces))
    if unused:
        message = f"{_count_text(unused, 'vertex', 'vertices')} that no triangle uses"
        found.append(Finding("unused_vertices", "note", message, (), unused))
    return found


def flat_faces(mesh: Mesh) -> IndexArray:
    """Return the numbers of the faces whose area is exactly zero."""
    corners = mesh.vertices[mesh.faces]
    scale = np.abs(corners - corners[:, :1]).max(axis=(1, 2))[:, None]
    # Scale each triangle to its own largest coordinate, so that no area over- or underflows.
    local = np.divide(
        corners - corners[:, :1], scale[:, None], np.zeros_like(corners), where=scale[:, None] > 0
    )
    doubled = np.linalg.norm(np.cross(local[:, 1], local[:, 2]), axis=1)
    suspects = np.flatnonzero(doubled < _FLAT)
    exact = [face for face in suspects.tolist() if _is_flat(corners[face])]
    return np.array(exact, dtype=np.int64)


def _is_flat(corners: FloatArray) -> bool:
    a, b, c = ([Fraction(value) for value in corner] for corner in corners.tolist())
    u, v = [q - p for p, q in zip(a, b, strict=True)], [q - p for p, q in zip(a, c, strict=True)]
    return all(u[k] * v[k - 1] == u[k - 1] * v[k] for k in range(3))


def repeated_faces(faces: IndexArray) -> IndexArray:
    """Return the numbers of the faces that have the same three corners as an earlier face."""
    if len(faces) == 0:
        return np.zeros(0, dtype=np.int64)
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    return np.setdiff1d(np.arange(len(faces)), first)


def _as_solid(raw: RawMesh, findings: list[Finding]) -> tuple[Solid | None, str]:
    """Return the mesh as a solid, or None, and the verdict; add the core's findings to `findings`.

    If the mesh is closed on the lattice, its open edges become notes.
    """
    try:
        solid = Solid(raw.vertices, raw.faces)
    except BspcsgError as error:
        known = any(found.severity == "error" for found in findings)
        if not known or error.code != "not_closed":
            where = error.where[:_MAX_PLACES_NAMED]
            findings.append(Finding(error.code, "error", error.message, where, len(error.where)))
        names = {"not_closed": "not closed", "empty_mesh": "empty"}
        return None, names.get(error.code, "refused")
    for index, found in enumerate(findings):
        if found.code in ("open_edges", "orientation"):
            message = (
                f"{found.message}; the gaps have no width on the lattice, so the mesh counts as"
                " closed"
            )
            findings[index] = Finding(found.code, "note", message, found.where, found.count)
    told = {found.code for found in findings} | {"zero_area"}
    new = [Finding.from_core(found) for found in solid.tree.findings]
    inverted = any(found.code == "inside_out" for found in new)
    findings += [found for found in new if found.code not in told]
    return solid, "inside out" if inverted else "solid"


def _overlaps(solid: Solid) -> list[Finding]:
    """Return findings about bodies that are not in the solid, and faces that cross or overlap."""
    source = solid.to_mesh().source
    return [
        replace(found, where=_first_indices(source[list(found.where), 1]))
        for found in overlaps_of(solid)
    ]


def _proof(solid: Solid, findings: list[Finding]) -> Certificate:
    """Return the result of the exact check of a solid's mesh, with its coordinates as doubles.

    If faces cross in doubles but not on the lattice, add a finding to `findings`.
    """
    mesh = solid.to_mesh()
    proof = mesh.certificate
    told = any(found.code == "self_overlap" for found in findings)
    if proof.crossings and not told:
        crossing = np.unique(np.array(proof.crossings))
        places = mesh.source[crossing, 1]
        x, y, z = mesh.vertices[mesh.faces[crossing[0], 0]].tolist()
        message = (
            f"{_count_text(len(crossing), 'triangle')} cross or overlap others in {proof.precision}"
            f" precision; the first near ({x:.6g}, {y:.6g}, {z:.6g})"
        )
        findings.append(
            Finding("crossing", "warning", message, _first_indices(places), len(crossing))
        )
    return proof


def _count_text(count: int, one: str, more: str = "") -> str:
    return f"{count} {one if count == 1 else more or one + 's'}"


def _first_indices(indices: IndexArray) -> tuple[int, ...]:
    return tuple(indices[:_MAX_PLACES_NAMED].tolist())


def _between(vertices: FloatArray, ends: Sequence[int] | IndexArray) -> str:
    return f"from {_point(vertices[ends[0]])} to {_point(vertices[ends[1]])}"


def _first(mesh: Mesh, faces: IndexArray) -> str:
    corner = mesh.vertices[mesh.faces[faces[0], 0]]
    return f"; the first is triangle {int(faces[0])}, at {_point(corner)}"


def _point(point: FloatArray) -> str:
    return "({:.6g}, {:.6g}, {:.6g})".format(*point.tolist())
