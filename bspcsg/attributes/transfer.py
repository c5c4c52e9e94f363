"""The attributes of a result, taken from the source faces that contain its triangles.

Each triangle of a result lies in one face of one source. Values of faces are copied. At a corner
that equals a corner of the source's face, bit by bit, the value there is copied, too; elsewhere it
is interpolated between the three corners of the face, in lattice coordinates.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from .._types import BoolArray, FloatArray, IndexArray
from ..errors import InvalidMeshError
from .attributes import Attributes, Kind, Values, is_normal
from .barycentric import weights
from .colours import is_color, opaque
from .material import Material

#: The arrays of a source: its vertices in doubles, its vertices snapped to the lattice, its faces,
#: and the numbers of the faces in the input.
SourceArrays: TypeAlias = tuple[FloatArray, FloatArray, IndexArray, IndexArray]

#: A barycentric coordinate below minus this means that a corner was moved out of its source face.
_MAX_OUTSIDE = 0.125

#: The largest difference, relative to the largest value, of values at one vertex that count as
#: equal. Each is interpolated with an error of 2**-49, and positions are rounded to doubles.
_MAX_DIFFERENCE = 2.0**-40


@dataclass(frozen=True, eq=False)
class Surface:
    """The triangles of a result, and the source face that contains each.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int64
    source : (m, 2) int64
        The source's number (slot) and the face's number in it, for the face that contains each
        triangle.
    flips : (m,) bool
        True if a triangle is oriented opposite to its source face.
    """

    vertices: FloatArray
    faces: IndexArray
    source: IndexArray
    flips: BoolArray


@dataclass(frozen=True, eq=False)
class _NewCorners:
    """Corners of triangles that are not corners of the source faces that contain them.

    Parameters
    ----------
    triangles, corners : (j,) int64
        The triangle of each such corner, and the corner's number in it, from 0 to 2.
    faces : (j,) int64
        The number of the face that contains each corner.
    places : (j, 3) float64
        The barycentric coordinates of each corner in that face.
    """

    triangles: IndexArray
    corners: IndexArray
    faces: IndexArray
    places: FloatArray


@dataclass(frozen=True, eq=False)
class _SourceTriangles:
    """The triangles of a result that lie in one source, and the positions of their corners in it.

    Parameters
    ----------
    attributes : Attributes
        The attributes of the source.
    rows : (k,) int64
        The numbers of the triangles in the result.
    origins : (k,) int64
        The number of the source face that contains each triangle.
    corners : (k, 3) int64
        The corner of that face, 0 to 2, that equals each corner of the triangle, or -1.
    inner : _Inner
        The corners that equal no corner of their source face.
    flips : (k,) bool
        True if a triangle is oriented opposite to its source face.
    """

    attributes: Attributes
    rows: IndexArray
    origins: IndexArray
    corners: IndexArray
    inner: _NewCorners
    flips: BoolArray

    def values(self, name: str) -> Values:
        """Return the values of an attribute at the triangles' corners, (k, 3, …)."""
        given = self.attributes.at_corners(name, self.origins)
        width = math.prod(given.shape[2:])
        flat = given.reshape(len(self.rows), 3, width)
        found = np.take_along_axis(flat, np.maximum(self.corners, 0)[:, :, None], axis=1)
        if len(inner := self.inner.faces):
            ends = self.attributes.at_corners(name, inner).reshape(len(inner), 3, width)
            between = _interpolated(ends, self.inner.places)
            found[self.inner.triangles, self.inner.corners] = between
        return self._faced(name, found.reshape(given.shape))

    def of_faces(self, name: str) -> Values:
        """Return the values of a face attribute for each triangle, (k, …)."""
        return self._faced(name, self.attributes.face[name][self.origins])

    def _faced(self, name: str, values: Values) -> Values:
        if not is_normal(name, values) or not self.flips.any():
            return values
        turned = values.copy()
        turned[self.flips] *= -1
        return turned


def patches_of(sources: Sequence[Attributes | None]) -> list[npt.NDArray[np.uint32] | None]:
    """Return the patch number of each face, an (m,) array or None for each source.

    A patch consists of all faces, also of different sources, with equal attributes.
    """
    known: dict[bytes, int] = {}
    found: list[npt.NDArray[np.uint32] | None] = []
    patches = [None if one is None else one.patches for one in sources]
    next_number = sum(len(values) for one in patches if one is not None for values in one[1:])
    for one in patches:
        if one is None:
            found.append(None)
            continue
        numbers, values = one
        lone = len(numbers) and max(int(numbers.max()) + 1 - len(values), 0)
        shared = [known.setdefault(value, len(known)) for value in values]
        table = np.array([*shared, *range(next_number, next_number + lone)], dtype=np.uint32)
        found.append(table[numbers])
        next_number += lone
    return found


def inherited_attributes(
    surface: Surface,
    sources: Sequence[Attributes | None],
    arrays_of: Callable[[int], SourceArrays | None],
) -> Attributes:
    """Return the attributes of a result, copied or interpolated from its sources.

    Parameters
    ----------
    surface : Surface
    sources : sequence of Attributes or None
        The attributes of the source in each slot.
    arrays_of : callable
        Returns the core's arrays of the source in a slot.

    Raises
    ------
    InvalidMeshError
        If a name has values of different shapes in two sources; code ``"attributes"``.
    """
    rows_of = dict(_triangles_by_source(surface.source))
    sources_of_triangles = []
    for slot, attributes in enumerate(sources):
        if attributes is not None:
            rows = rows_of.get(slot, _NO_ROWS)
            known = arrays_of(slot) if len(rows) else None
            sources_of_triangles.append(
                _triangles_of(surface, rows, attributes, known or _NO_ARRAYS)
            )
    materials: dict[str, Material] = {}
    sources_of_triangles = [
        replace(lot, attributes=lot.attributes.among(materials)) for lot in sources_of_triangles
    ]
    found: dict[Kind, dict[str, Values]] = {"vertex": {}, "corner": {}, "face": {}}
    for name in dict.fromkeys(
        name for lot in sources_of_triangles for name in lot.attributes.names
    ):
        kind, values = _joined(
            name, [lot for lot in sources_of_triangles if name in lot.attributes.names], surface
        )
        values.flags.writeable = False
        found[kind][name] = values
    return Attributes(surface.faces, **found, materials=materials)


#: The arrays of a source that contains no triangle of the result.
_NO_ROWS: IndexArray = np.zeros(0, dtype=np.int64)
_NO_ARRAYS: SourceArrays = (
    np.zeros((0, 3)),
    np.zeros((0, 3)),
    np.zeros((0, 3), dtype=np.int64),
    _NO_ROWS,
)


def _triangles_by_source(source: IndexArray) -> Iterator[tuple[int, IndexArray]]:
    """Yield the index of each source and the ascending numbers of the triangles in it."""
    order = np.argsort(source[:, 0], kind="stable")
    slots, starts = np.unique(source[order, 0], return_index=True)
    yield from zip(slots.tolist(), np.split(order, starts[1:]), strict=False)


def _triangles_of(
    surface: Surface, rows: IndexArray, attributes: Attributes, known: SourceArrays
) -> _SourceTriangles:
    doubles, lattice, faces, numbers = known
    origins = surface.source[rows, 1]
    triangles = faces[np.searchsorted(numbers, origins)]
    points = surface.vertices[surface.faces[rows]]
    corners = _matching_corners(points, doubles[triangles])
    corners = np.where(corners < 0, _matching_corners(points, lattice[triangles]), corners)
    at, corner = np.nonzero(corners < 0)
    places = weights(points[at, corner], lattice[triangles[at]])
    inner = _NewCorners(at, corner, origins[at], places)
    inner = _with_positions_inside(inner, surface.faces[rows], corners, origins)
    return _SourceTriangles(attributes, rows, origins, corners, inner, surface.flips[rows])


def _matching_corners(points: FloatArray, corners: FloatArray) -> IndexArray:
    """Return the corner of a face, 0 to 2, that equals each corner of a triangle, or -1; (k, 3)."""
    same = (points[:, :, None] == corners[:, None]).all(axis=3)
    return np.where(same.any(axis=2), same.argmax(axis=2), -1)


def _with_positions_inside(
    inner: _NewCorners, vertices: IndexArray, corners: IndexArray, origins: IndexArray
) -> _NewCorners:
    """Replace positions outside their source faces.

    Such a corner gets the position of another triangle's corner at the same vertex, or else a
    nearby position in its face. It arises where edges were swapped because rounding would flip a
    triangle.
    """
    with np.errstate(invalid="ignore"):
        outside = np.flatnonzero(~(inner.places.min(axis=1, initial=1) >= -_MAX_OUTSIDE))
    if len(outside) == 0:
        return inner
    faces, places = inner.faces.copy(), inner.places.copy()
    number = np.full(vertices.shape, -1)
    number[inner.triangles, inner.corners] = np.arange(len(faces))
    lost = set(outside.tolist())
    for k in outside.tolist():
        here = np.argwhere(vertices == vertices[inner.triangles[k], inner.corners[k]]).tolist()
        found = [(t, c) for t, c in here if number[t, c] not in lost]
        if found:
            triangle, corner = found[0]
            at = number[triangle, corner]
            faces[k] = origins[triangle]
            places[k] = np.eye(3)[corners[triangle, corner]] if at < 0 else inner.places[at]
        else:
            place = np.clip(np.nan_to_num(inner.places[k], nan=1 / 3), 0, 1)
            places[k] = place / place.sum()
    return _NewCorners(inner.triangles, inner.corners, faces, places)


def _interpolated(values: Values, places: FloatArray) -> Values:
    """Interpolate between the values at three corners, (k, 3, w), with (k, 3) weights, to (k, w).

    A value that is equal at all three corners stays exact. Whole numbers are rounded; for truth
    values and text, the value of the corner with the largest weight is taken.
    """
    rows = np.arange(len(values))
    nearest: Values = values[rows, places.argmax(axis=1)]
    if values.dtype.kind not in "iuf":
        return nearest
    wide = values.astype(np.float64)
    second, third = places[:, 1, None], places[:, 2, None]
    with np.errstate(invalid="ignore", over="ignore"):
        made = wide[:, 0] + second * (wide[:, 1] - wide[:, 0]) + third * (wide[:, 2] - wide[:, 0])
    if values.dtype.kind in "iu":
        made = np.clip(np.rint(made), wide.min(axis=1), wide.max(axis=1))
    is_same = (values == values[:, :1]).all(axis=1)
    found: Values = np.where(is_same, values[:, 0], made.astype(values.dtype))
    return found


def _joined(
    name: str, sources_of_triangles: list[_SourceTriangles], surface: Surface
) -> tuple[Kind, Values]:
    """Return the values of an attribute in the result, and the kind of elements they belong to."""
    kinds = {lot.attributes.kind_of(name) for lot in sources_of_triangles}
    if kinds == {"face"}:
        parts = [lot.of_faces(name) for lot in sources_of_triangles]
        return "face", _values_of_all_triangles(
            name, sources_of_triangles, parts, (len(surface.faces),), 1
        )
    parts = [lot.values(name) for lot in sources_of_triangles]
    values = _values_of_all_triangles(name, sources_of_triangles, parts, (len(surface.faces), 3), 2)
    if kinds == {"vertex"}:
        common = _of_vertices(name, values, sources_of_triangles, surface)
        if common is not None:
            return "vertex", common
    return "corner", values


def _values_of_all_triangles(
    name: str,
    sources_of_triangles: list[_SourceTriangles],
    parts: list[Values],
    shape: tuple[int, ...],
    depth: int,
) -> Values:
    """Return the values of an attribute for all triangles of a result.

    Triangles from sources without the attribute get the default value.
    """
    parts = uniform_colors(name, parts, depth)
    kind = common_type(name, parts, depth)
    blank = default_of(name, parts[0].astype(kind, copy=False), depth)
    filled = np.full(shape + parts[0].shape[depth:], blank, dtype=kind)
    for lot, part in zip(sources_of_triangles, parts, strict=True):
        filled[lot.rows] = part
    return filled


def uniform_colors(name: str, parts: Sequence[Values], depth: int) -> list[Values]:
    """Return the colours of several meshes in one type and width; return other values unchanged.

    Whole numbers of one type are unchanged; mixed types become floats from 0 to 1. If colours of
    one mesh have four numbers, full opacity is added to colours of three.

    Parameters
    ----------
    name, parts, depth
        As for `common_type`.
    """
    if not all(is_color(name, part, depth) for part in parts):
        return list(parts)
    floats = [part.dtype for part in parts if part.dtype.kind == "f"]
    found = list(parts)
    if floats or len({part.dtype for part in parts}) > 1:
        kind = np.result_type(*(floats or [np.dtype(np.float64)]))
        found = [
            part / kind.type(np.iinfo(part.dtype).max) if part.dtype.kind == "u" else part
            for part in parts
        ]
    width = max(part.shape[depth] for part in parts)
    return [opaque(part) if part.shape[depth] < width else part for part in found]


def common_type(name: str, parts: Sequence[Values], depth: int) -> np.dtype[Any]:
    """Return the common numpy type of an attribute's values in several meshes.

    Parameters
    ----------
    name : str
    parts : sequence of arrays
    depth : int
        The number of array axes that index the vertex, corner or face: 1 or 2.

    Raises
    ------
    InvalidMeshError
        If the values have different shapes, or are text in one mesh and numbers in another.
    """
    shapes = sorted({part.shape[depth:] for part in parts})
    if len(shapes) > 1:
        told = " and ".join(map(str, shapes))
        message = (
            f"Attributes: “{name}” has values of shapes {told} in different operands; rename"
            " one attribute, or give both the same shape."
        )
        raise InvalidMeshError(message, "attributes")
    if len({part.dtype.kind == "U" for part in parts}) > 1:
        raise InvalidMeshError(
            f"Attributes: “{name}” is text in one operand and numbers in another; rename one"
            " attribute, or give both the same type.",
            "attributes",
        )
    return np.result_type(*(part.dtype for part in parts))


def default_of(name: str, values: Values, depth: int) -> Any:
    """Return the value for elements without an attribute: NaN, 0, False or empty text.

    For colours in whole numbers it is opaque white, which pictures also use for NaN.
    """
    kind = values.dtype
    if kind.kind == "u" and is_color(name, values, depth):
        return np.iinfo(kind).max
    return np.nan if kind.kind == "f" else np.zeros((), kind)[()]


def _of_vertices(
    name: str, values: Values, sources_of_triangles: list[_SourceTriangles], surface: Surface
) -> Values | None:
    """Return one value per vertex if all corners at each vertex have equal values, else None."""
    count = len(surface.vertices)
    flat = values.reshape(3 * len(surface.faces), math.prod(values.shape[2:]))
    vertices = surface.faces.ravel()
    # Write copied values last, so that they replace interpolated ones.
    is_given = np.zeros(len(surface.faces) * 3, dtype=bool).reshape(-1, 3)
    for lot in sources_of_triangles:
        is_given[lot.rows] = lot.corners >= 0
    order = np.argsort(is_given.ravel(), kind="stable")
    common = np.full((count, flat.shape[1]), default_of(name, values, 2), dtype=values.dtype)
    common[vertices[order]] = flat[order]
    if not _are_nearly_equal(common[vertices], flat):
        return None
    whole: Values = common.reshape(count, *values.shape[2:])
    return whole


def _are_nearly_equal(one: Values, other: Values) -> bool:
    same = one == other
    if one.dtype.kind == "f":
        largest = np.nanmax(np.abs(one), initial=0, where=np.isfinite(one))
        with np.errstate(invalid="ignore"):
            same |= np.abs(one - other) <= _MAX_DIFFERENCE * largest
        same |= np.isnan(one) & np.isnan(other)
    return bool(same.all())
