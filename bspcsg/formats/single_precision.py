"""Rounding of a mesh to single precision, the precision of binary STL and GLB."""

import numpy as np

from .._core import mesh_in_single
from .._types import BoolArray, FloatArray, IndexArray
from ..attributes.attributes import made
from ..errors import Finding, core_errors
from ..mesh.certificate import Certificate, certify
from ..mesh.mesh import Mesh
from ..mesh.weld import distinct_count
from ..solid.solid import solid_of_mesh
from .blocks import blocks
from .raw import RawMesh, compacted
from .triangles import are_flat, are_turned

#: The largest number of triangles that a finding names.
_MAX_TRIANGLES_NAMED = 8


def losses(mesh: Mesh | RawMesh, format_name: str) -> tuple[Finding, ...]:
    """Return findings about what rounding to single precision changes in a mesh.

    Vertices that merge, triangles that lose their area and triangles that turn over are counted
    exactly. A triangle turns over if its normals before and after are more than a right angle
    apart. A triangle that had no area before is not counted.

    Parameters
    ----------
    mesh : Mesh or RawMesh
    format_name : str
        The name of the format in the message.

    Raises
    ------
    OverflowError
        If a coordinate is beyond single precision.
    """
    with np.errstate(over="ignore"):
        rounded = mesh.vertices.astype(np.float32).astype(np.float64)
    if not np.isfinite(rounded).all():
        raise OverflowError
    shift = float(np.abs(rounded - mesh.vertices).max(initial=0.0))
    if shift == 0:
        return ()
    moved = (rounded != mesh.vertices).any(axis=1)
    message = (
        f"{format_name} stores coordinates in single precision, which changed them by up to"
        f" {shift:.2g}. PLY, OBJ, OFF, 3MF and ASCII STL keep every digit."
    )
    return (
        Finding("single_precision", "note", message, (), 1),
        *_merged(mesh.vertices, rounded, moved),
        *_changed(mesh, rounded, moved),
    )


def in_single_precision(mesh: Mesh) -> tuple[Mesh, tuple[Finding, ...]]:
    """Return a solid's mesh in single precision, with crossings mended where possible.

    Rounding moves every corner, so close surfaces may cross and thin triangles may lose their area.
    Both are mended by changes as small as the rounding. If no triangle would remain, surfaces are
    first moved outwards by one spacing of single precision.

    Parameters
    ----------
    mesh : Mesh
        Closed: the triangles at each edge share the indices of its vertices.

    Returns
    -------
    mesh : Mesh
        The given mesh if nothing had to be changed, or if no triangle would remain.
    findings : tuple of Finding
        The number of triangles changed or moved, and the places where surfaces still cross.

    Raises
    ------
    OverflowError
        If a coordinate is beyond single precision.
    """
    with np.errstate(over="ignore"):
        if not np.isfinite(mesh.vertices.astype(np.float32)).all():
            raise OverflowError
    result, mended, crossing = _mended(mesh)
    changed = _mending(mended)
    if len(mesh.faces) and not len(result.faces):
        result, changed, crossing = _thickened_and_rounded(mesh)
    left = tuple(finding for finding in (changed, _crossing(crossing)) if finding.count)
    return (result if changed.count else mesh), left


def _thickened_and_rounded(mesh: Mesh) -> tuple[Mesh, Finding, IndexArray]:
    """Thicken a mesh that rounding would erase; return it rounded, a finding, and crossings.

    Crossings are the numbers of triangles that still cross others.
    """
    spacing = _spacing(mesh.vertices)
    result, _, crossing = _mended(_thickened(mesh, spacing))
    if len(result.faces):
        return result, _thickening(len(result.faces), spacing), crossing
    rounded = mesh.vertices.astype(np.float32).astype(np.float64)
    return mesh, _mending(0), _faulty_triangles(certify(rounded, mesh.faces))


def _mended(mesh: Mesh) -> tuple[Mesh, int, IndexArray]:
    """Round a mesh to single precision and mend it, several times if necessary.

    Return the mesh, the count of mended triangles, and the numbers of those that still cross.
    """
    result, mended, crossing = _rounded(mesh)
    for _ in range(_MAX_ROUNDS):
        if not len(crossing) or not len(result.faces):
            break
        mended += len(crossing)
        result, more, _ = _rounded(_united(result))
        # The lattice on which surfaces are united does not contain all numbers of single precision.
        # Faces that stay unchanged there may cross, so all are checked.
        crossing = _faulty_triangles(result.certificate)
        mended += more
    return result, mended, crossing


#: The largest number of rounds; each unites surfaces that cross after rounding, and rounds the
#: result. One is nearly always enough: surfaces nearer to each other than the rounding coincide
#: after it, and are united.
_MAX_ROUNDS = 4


def _rounded(mesh: Mesh) -> tuple[Mesh, int, IndexArray]:
    """Round a mesh to single precision and mend it, once.

    Return the mesh, the count of mended triangles, and the numbers of those that still cross.
    """
    with core_errors():
        found = mesh_in_single(mesh.vertices, mesh.faces)
    kept = found["kept"]
    used, faces = compacted(found["triangles"])
    carried = mesh.carried and made(mesh.attributes.onto(faces, kept))
    result = Mesh(found["vertices"][used], faces, mesh.source[kept], carried)
    faulty = np.searchsorted(kept, _in_either(found["crossings"], found["flat"]))
    return result, found["mended"], faulty


def _faulty_triangles(proof: Certificate) -> IndexArray:
    """Return the numbers of the triangles that cross others or have no area, ascending."""
    return _in_either(np.array(proof.crossings), np.array(proof.flat))


def _in_either(first: IndexArray, second: IndexArray) -> IndexArray:
    """Return the numbers that are in at least one of two lists, ascending."""
    # Not numpy.unique: it imports numpy.ma, a tenth of the time of a small boolean operation.
    return np.array(sorted({*first.ravel().tolist(), *second.tolist()}), dtype=np.int64)


def _united(mesh: Mesh) -> Mesh:
    """Return the mesh of the solid that a mesh encloses: crossing triangles are cut exactly."""
    result = solid_of_mesh(mesh).normalized().to_mesh()
    origins = mesh.source[result.source[:, 1]]
    return Mesh(result.vertices, result.faces, origins, result.carried)


def _spacing(vertices: FloatArray) -> float:
    """Return the distance between adjacent float32 numbers at the largest coordinate."""
    return float(np.spacing(np.float32(np.abs(vertices).max())))


def _thickened(mesh: Mesh, spacing: float) -> Mesh:
    """Move each vertex of a mesh outwards by `spacing`, along the gradient of the volume.

    Opposite sides move two spacings apart along an axis, and rounding brings them at most one
    spacing closer.
    """
    first, second, third = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    edges = np.stack([second - first, third - first])
    # Scale the edges, since their squared lengths may underflow.
    edges /= np.abs(edges).max()
    areas = np.cross(edges[0], edges[1])
    gained = np.zeros_like(mesh.vertices)
    for corners in mesh.faces.T:
        np.add.at(gained, corners, areas)
    longest = np.abs(gained).max(axis=1, keepdims=True)
    ways = np.divide(gained, longest, np.zeros_like(gained), where=longest > 0)
    most = float(np.finfo(np.float32).max)
    moved = np.clip(mesh.vertices + spacing * ways, -most, most)
    return Mesh(moved, mesh.faces, mesh.source, mesh.carried)


def _mending(count: int) -> Finding:
    message = (
        "rounding to single precision makes surfaces cross or triangles lose their area; to"
        f" repair this, {count} triangles were moved within the rounding error or left out."
    )
    return Finding("mended_in_single", "note", message, (), count)


def _thickening(count: int, spacing: float) -> Finding:
    message = (
        "the whole mesh is so thin that it would vanish in single precision, so the surfaces"
        f" of {count} triangles were moved outwards by {spacing:.2g}{_REMEDY}"
    )
    return Finding("thickened_in_single", "warning", message, (), count)


def _crossing(where: IndexArray) -> Finding:
    message = (
        f"after rounding to single precision, {len(where)} triangles cross or overlap"
        f" others{_REMEDY}"
    )
    named = tuple(where[:_MAX_TRIANGLES_NAMED].tolist())
    return Finding("crossing_in_single", "warning", message, named, len(where))


def _merged(vertices: FloatArray, rounded: FloatArray, moved: BoolArray) -> tuple[Finding, ...]:
    near = _beside_moved(rounded, moved)
    lost = distinct_count(vertices[near]) - distinct_count(rounded[near])
    if not lost:
        return ()
    message = f"rounding to single precision merges {lost} vertices with others{_REMEDY}"
    return (Finding("merged_by_rounding", "warning", message, (), lost),)


def _beside_moved(rounded: FloatArray, moved: BoolArray) -> BoolArray:
    """Say for each vertex whether its x equals that of a moved vertex; others cannot merge."""
    x = rounded[:, 0]
    taken = np.sort(x[moved])
    place = np.minimum(np.searchsorted(taken, x), len(taken) - 1)
    beside: BoolArray = taken[place] == x
    return beside


_REMEDY = "; write PLY, OBJ, OFF or 3MF to keep the mesh as it is."


def _changed(mesh: Mesh | RawMesh, rounded: FloatArray, moved: BoolArray) -> tuple[Finding, ...]:
    """Return findings about triangles that rounding turns over or deprives of their area."""
    flat, turned = _flat_and_turned(mesh.vertices, rounded, mesh.faces, moved)
    told = (
        ("flattened_by_rounding", "removes the area of", flat),
        ("turned_by_rounding", "turns over", turned),
    )
    return tuple(
        Finding(
            code,
            "warning",
            f"rounding to single precision {verb} {len(where)} triangles{_REMEDY}",
            tuple(where[:_MAX_TRIANGLES_NAMED].tolist()),
            len(where),
        )
        for code, verb, where in told
        if len(where)
    )


def _flat_and_turned(
    vertices: FloatArray, rounded: FloatArray, faces: IndexArray, moved: BoolArray
) -> tuple[IndexArray, IndexArray]:
    """Return the numbers of triangles that lose their area, and of triangles that turn over."""
    numbers = np.flatnonzero(moved[faces].any(axis=1))
    flat, turned = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    for block in blocks(len(numbers)):
        some = numbers[block]
        before, after = vertices[faces[some]], rounded[faces[some]]
        is_flat = are_flat(after)
        lost = np.flatnonzero(is_flat)
        flat.append(some[lost[~are_flat(before[lost])]])
        kept = np.flatnonzero(~is_flat)
        turned.append(some[kept[are_turned(before[kept], after[kept])]])
    return np.concatenate(flat), np.concatenate(turned)
