"""Meshes that files place or units scale: what rounding makes cross is mended."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from .._types import FloatArray
from ..errors import Finding, LimitError
from ..solid.moving import Mended, SaidMesh
from .raw import RawMesh, compacted, joined

SingleArray: TypeAlias = "np.ndarray[tuple[int, ...], np.dtype[np.float32]]"


@dataclass(frozen=True, eq=False)
class PlacedMesh:
    """A mesh in its place in a file.

    Parameters
    ----------
    mesh : RawMesh
    before : (n, 3) float64 or None
        The vertices before they were placed; None if placing them rounded none.
    map : bytes
        The map that placed them: what has one in common was placed as a whole.
    """

    mesh: RawMesh
    before: FloatArray | None = None
    map: bytes = b""


def is_exact(points: FloatArray | SingleArray, linear: FloatArray, shift: FloatArray) -> bool:
    """Say whether an affine map of points, row by row, rounds no coordinate; errs on no.

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
    # Two numbers of single precision have a product that doubles hold.
    return _are_single(entries) and _are_single(points)


def _are_single(values: FloatArray | SingleArray) -> bool:
    return values.dtype == np.float32 or bool((values == values.astype(np.float32)).all())


def _is_sum_exact(values: FloatArray, offset: float) -> bool:
    total = values + offset
    # The difference to the larger of the two is exact, and so is the sum if it is the other one.
    return bool((total - values == offset).all() and (total - offset == values).all())


def placed(pieces: Sequence[PlacedMesh]) -> RawMesh:
    """Return meshes in their places as one, each an object of its name.

    Where placing made surfaces cross that did not before, they are mended by changes of the width
    of the rounding: within a mesh, and among those that one map placed. A finding names what could
    not be mended.
    """
    meshes = [piece.mesh for piece in pieces]
    whole = joined(meshes)
    is_rounded = any(piece.before is not None for piece in pieces)
    pitch = _pitch_of(whole) if is_rounded else None
    if pitch is None:
        return whole
    together: dict[bytes, list[int]] = {}
    for number, piece in enumerate(pieces):
        if piece.before is not None:
            together.setdefault(piece.map, []).append(number)
    crossing: dict[int, list[int]] = {}
    for members in together.values():
        found = _mended([pieces[number] for number in members], pitch)
        if found is not None:
            _take(found, members, meshes, crossing)
            whole = replace(whole, is_mended=True)
    return _told(joined(meshes), meshes, crossing) if whole.is_mended else whole


def rescaled(raw: RawMesh, unit: float, new_unit: float = 1.0) -> RawMesh:
    """Return a mesh with its coordinates in another unit; its objects stay apart.

    Where rounding made surfaces cross that did not before, they are mended, and a finding names
    what could not be.

    Parameters
    ----------
    raw : RawMesh
    unit, new_unit : float
        The lengths of both units; one of them is 1, so that each coordinate is rounded once.
    """
    if unit == new_unit:
        return raw
    scaled = replace(raw, vertices=raw.vertices * unit / new_unit)
    is_rounded = new_unit != 1 or not is_exact(raw.vertices, np.eye(3) * unit, np.zeros(3))
    pitch = _pitch_of(scaled) if is_rounded else None
    if pitch is None:
        return scaled
    mesh = SaidMesh(scaled.vertices, scaled.faces, scaled.attributes)
    found = mesh.mended(raw.vertices, pitch)
    return scaled if found is None else _with_mended(scaled, found)


def _with_mended(raw: RawMesh, found: Mended) -> RawMesh:
    ends = np.cumsum([0] + [count for _, count in raw.objects])
    counts = np.diff(np.searchsorted(found.kept, ends)).tolist()
    names = [name for name, _ in raw.objects]
    return replace(
        raw,
        vertices=found.mesh.vertices,
        faces=found.mesh.faces,
        attributes=found.mesh.attributes,
        objects=tuple(zip(names, counts, strict=True)),
        findings=(*raw.findings, *_crossing(found.left.tolist())),
        is_mended=True,
    )


def _pitch_of(whole: RawMesh) -> int | None:
    """Return the pitch that suits a mesh, if one does."""
    try:
        return SaidMesh(whole.vertices, whole.faces).suited_pitch()
    except LimitError:
        return None


def _mended(pieces: Sequence[PlacedMesh], pitch: int) -> Mended | None:
    whole = joined([piece.mesh for piece in pieces])
    before = np.concatenate([piece.before for piece in pieces if piece.before is not None])
    return SaidMesh(whole.vertices, whole.faces, whole.attributes).mended(before, pitch)


def _take(
    found: Mended, members: list[int], meshes: list[RawMesh], crossing: dict[int, list[int]]
) -> None:
    """Put what was mended as a whole in the place of its pieces."""
    end = 0
    for number in members:
        start, end = end, end + len(meshes[number].faces)
        rows = np.flatnonzero((found.kept >= start) & (found.kept < end))
        used, faces = compacted(found.mesh.faces[rows])
        said = found.mesh.attributes
        if meshes[number].attributes is not None and said is not None:
            said = replace(said.taken(rows), faces=faces).with_used_materials()
        else:
            said = None
        vertices = found.mesh.vertices[used]
        crossing[number] = np.flatnonzero(np.isin(rows, found.left)).tolist()
        meshes[number] = replace(meshes[number], vertices=vertices, faces=faces, attributes=said)


def _told(whole: RawMesh, meshes: list[RawMesh], crossing: dict[int, list[int]]) -> RawMesh:
    starts = np.cumsum([0] + [len(mesh.faces) for mesh in meshes]).tolist()
    places = sorted(starts[number] + row for number, rows in crossing.items() for row in rows)
    return replace(whole, is_mended=True, findings=_crossing(places))


def _crossing(places: list[int]) -> tuple[Finding, ...]:
    """Return what is to be told of triangles that cross others still."""
    if not places:
        return ()
    return (Finding("crossing", "warning", _CROSSING, tuple(places), len(places)),)


_CROSSING = (
    "rounding meshes to where they are placed makes these triangles cross or overlap others, which"
    " could not be mended"
)
