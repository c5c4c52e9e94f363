"""Meshes that a file transforms or a unit scales; crossings that rounding causes are mended."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from .._core import Tree
from .._types import FloatArray
from ..errors import Finding, InvalidMeshError, LimitError, core_errors
from ..solid.mesh_transform import AttributedMesh, Mended
from ..solid.sewing import Sewn, sewn
from .raw import RawMesh, compacted, joined

#: A function that transforms points, (n, 3) float64.
PointMap: TypeAlias = Callable[[FloatArray], FloatArray]

SingleArray: TypeAlias = "np.ndarray[tuple[int, ...], np.dtype[np.float32]]"


@dataclass(frozen=True, eq=False)
class PlacedMesh:
    """A mesh of a file, and the transformation that the file applies to it.

    Parameters
    ----------
    mesh : RawMesh
        The vertices before the transformation, but the triangles and attributes after it.
    transform : callable
        The transformation: takes and returns points, (n, 3) float64.
    is_exact : bool
        True if `transform` rounds no coordinate.
    map : bytes
        A key of the transformation: meshes with equal keys are mended together.
    """

    mesh: RawMesh
    transform: PointMap
    is_exact: bool = True
    map: bytes = b""

    def in_place(self) -> RawMesh:
        """Return the mesh with its vertices transformed."""
        return replace(self.mesh, vertices=self.transform(self.mesh.vertices))


def is_exact(points: FloatArray | SingleArray, linear: FloatArray, shift: FloatArray) -> bool:
    """Say whether `linear @ point + shift` rounds no coordinate of any point.

    True is certain, False is not.

    Parameters
    ----------
    points : (n, 3) float64 or float32
    linear : (3, 3) float64
    shift : (3,) float64
    """
    if (np.count_nonzero(linear, axis=1) != 1).any():
        return False
    axes = np.argmax(linear != 0, axis=1)
    entries = linear[np.arange(3), axes]
    return _are_products_exact(points, entries) and all(
        _is_sum_exact(points[:, axis].astype(np.float64) * entry, offset)
        for axis, entry, offset in zip(axes.tolist(), entries, shift, strict=True)
        if offset != 0
    )


def _are_products_exact(points: FloatArray | SingleArray, entries: FloatArray) -> bool:
    if (np.abs(entries) == 1).all():
        return True
    # The product of two numbers of single precision is exact as a double.
    return _are_single(entries) and _are_single(points)


def _are_single(values: FloatArray | SingleArray) -> bool:
    return values.dtype == np.float32 or bool((values == values.astype(np.float32)).all())


def _is_sum_exact(values: FloatArray, offset: float) -> bool:
    total = values + offset
    # Total minus the larger summand is exact; if it equals the smaller one, the total is exact.
    return bool((total - values == offset).all() and (total - offset == values).all())


def placed_meshes(pieces: Sequence[PlacedMesh]) -> RawMesh:
    """Return transformed meshes as one mesh, in which each is an object with its name.

    If rounding makes surfaces cross that did not cross before, they are mended by changes as small
    as the rounding, within a mesh and among meshes with equal transformations. A mesh that rounding
    could open is first welded and split at T-junctions. Findings list triangles that still cross,
    and count dropped triangles.
    """
    meshes = [piece.in_place() for piece in pieces]
    whole = joined(meshes)
    is_rounded = not all(piece.is_exact for piece in pieces)
    pitch = _pitch_of(whole) if is_rounded else None
    if pitch is None:
        return whole
    together: dict[bytes, list[int]] = {}
    for number, piece in enumerate(pieces):
        if not piece.is_exact:
            together.setdefault(piece.map, []).append(number)
    crossing: dict[int, list[int]] = {}
    flat = 0
    for members in together.values():
        own = joined([pieces[number].mesh for number in members])
        found = _mended(own, pieces[members[0]].transform, pitch)
        if found is not None:
            _replace_with_mended(found, members, meshes, crossing)
            flat += _lost_triangle_count(own, found)
            whole = replace(whole, is_mended=True)
    return _with_findings(joined(meshes), meshes, crossing, flat) if whole.is_mended else whole


def rescaled(raw: RawMesh, unit: float, new_unit: float = 1.0) -> RawMesh:
    """Return a mesh, with its objects, whose coordinates are in another unit.

    If rounding makes surfaces cross that did not cross before, they are mended. Findings list
    triangles that still cross, and count dropped triangles.

    Parameters
    ----------
    raw : RawMesh
    unit, new_unit : float
        The lengths of both units; one of them is 1, so that each coordinate is rounded once.
    """
    if unit == new_unit:
        return raw

    def image(points: FloatArray) -> FloatArray:
        return points * unit / new_unit

    scaled = replace(raw, vertices=image(raw.vertices))
    is_rounded = new_unit != 1 or not is_exact(raw.vertices, np.eye(3) * unit, np.zeros(3))
    pitch = _pitch_of(scaled) if is_rounded else None
    if pitch is None:
        return scaled
    found = _mended(raw, image, pitch)
    return scaled if found is None else _with_mended(scaled, found)


def _with_mended(raw: RawMesh, found: Mended) -> RawMesh:
    ends = np.cumsum([0] + [count for _, count in raw.objects])
    counts = np.diff(np.searchsorted(found.origins, ends)).tolist()
    names = [name for name, _ in raw.objects]
    return replace(
        raw,
        vertices=found.mesh.vertices,
        faces=found.mesh.faces,
        attributes=found.mesh.attributes,
        objects=tuple(zip(names, counts, strict=True)),
        findings=(
            *raw.findings,
            *_crossing_finding(found.crossing.tolist()),
            *_flat_finding(_lost_triangle_count(raw, found)),
        ),
        is_mended=True,
    )


def _pitch_of(whole: RawMesh) -> int | None:
    """Return the lattice's pitch that suits a mesh's coordinates; None if there is none."""
    try:
        return AttributedMesh(whole.vertices, whole.faces).suited_pitch()
    except LimitError:
        return None


def _mended(raw: RawMesh, image: PointMap, pitch: int) -> Mended | None:
    """Return a transformed mesh, mended; None if transforming its vertices is enough."""
    mesh = AttributedMesh(raw.vertices, raw.faces, raw.attributes)
    divided = _sewn(mesh)
    if divided is not None:
        mesh = divided.mesh
    moved = replace(mesh, vertices=image(mesh.vertices))
    found = moved.mended(mesh.vertices, pitch)
    if divided is None:
        return found
    if found is None:
        return Mended(moved, divided.origins, np.zeros(0, dtype=np.int64))
    return replace(found, origins=divided.origins[found.origins])


def _sewn(mesh: AttributedMesh) -> Sewn | None:
    """Return a mesh welded and split at T-junctions; None if that is not needed or impossible."""
    try:
        with core_errors():
            tree = Tree.from_mesh(mesh.vertices, mesh.faces)
    except (InvalidMeshError, LimitError):
        # The conversion to a solid reports the reason.
        return None
    return sewn(mesh, tree)


def _replace_with_mended(
    found: Mended, members: list[int], meshes: list[RawMesh], crossing: dict[int, list[int]]
) -> None:
    """Replace some of `meshes` by their parts of a mesh into which they were joined and mended.

    `members` are the indices of these meshes, and `crossing` receives their triangles that still
    cross others.
    """
    end = 0
    for number in members:
        start, end = end, end + len(meshes[number].faces)
        rows = np.flatnonzero((found.origins >= start) & (found.origins < end))
        used, faces = compacted(found.mesh.faces[rows])
        attributes = found.mesh.attributes
        if meshes[number].attributes is not None and attributes is not None:
            attributes = replace(attributes.for_faces(rows), faces=faces).with_used_materials()
        else:
            attributes = None
        vertices = found.mesh.vertices[used]
        crossing[number] = np.flatnonzero(np.isin(rows, found.crossing)).tolist()
        meshes[number] = replace(
            meshes[number], vertices=vertices, faces=faces, attributes=attributes
        )


def _with_findings(
    whole: RawMesh, meshes: list[RawMesh], crossing: dict[int, list[int]], flat: int
) -> RawMesh:
    starts = np.cumsum([0] + [len(mesh.faces) for mesh in meshes]).tolist()
    places = sorted(starts[number] + row for number, rows in crossing.items() for row in rows)
    return replace(
        whole, is_mended=True, findings=(*_crossing_finding(places), *_flat_finding(flat))
    )


def _lost_triangle_count(raw: RawMesh, found: Mended) -> int:
    """Return the number of triangles of `raw` of which the mended mesh has no part."""
    return len(raw.faces) - len(np.unique(found.origins))


def _flat_finding(count: int) -> tuple[Finding, ...]:
    """Return the finding that `count` triangles were dropped, nothing if there are none."""
    if not count:
        return ()
    message = (
        f"{count} triangles were left out because they have no area or cancel a triangle that"
        " faces the opposite way: rounding the transformed meshes would open gaps there."
    )
    return (Finding("zero_area", "note", message, (), count),)


def _crossing_finding(places: list[int]) -> tuple[Finding, ...]:
    """Return the finding that the triangles `places` still cross others, nothing without any."""
    if not places:
        return ()
    return (Finding("crossing", "warning", _CROSSING, tuple(places), len(places)),)


_CROSSING = (
    "rounding the coordinates of the transformed meshes makes these triangles cross or"
    " overlap others, and no mending was possible"
)
