"""A test whether faces are wide enough for chamfers or fillets along their edges."""

from collections.abc import Iterable, Sequence

import numpy as np

from ..._types import FloatArray, IndexArray
from ...bsp import Region
from ...errors import InvalidParameterError, invalid_parameter
from .plane_faces import FaceGraph

#: Edges count as parallel if the sine of their angle is below this.
_PARALLEL = 1e-7

#: The share of a face's area that rounding may change.
_SAME = 1e-6


def refuse_no_room(graph: FaceGraph, widths: FloatArray, apart: Iterable[int] = ()) -> None:
    """Raise an error if strips that chamfers or fillets remove along edges overlap on a face.

    Parameters
    ----------
    graph : FaceGraph
    widths : (e,) float64
        The width of the strip along each edge, on both of its faces; 0 for no strip.
    apart : iterable of int
        Faces that are not tested.

    Raises
    ------
    InvalidParameterError
        The message names a point, `where` the triangles of the face.
    """
    for face in np.setdiff1d(graph.sides[widths > 0], list(apart)).tolist():
        _refuse_no_room_on(graph, face, widths)


def has_room(graph: FaceGraph, face: int, widths: FloatArray) -> bool:
    """Return True if the strips along the edges of a face fit on it without overlap."""
    try:
        _refuse_no_room_on(graph, face, widths)
    except InvalidParameterError:
        return False
    return True


def _refuse_no_room_on(graph: FaceGraph, face: int, widths: FloatArray) -> None:
    loops, outer = _loops(graph, face), face_loops(graph, face)
    inner = [_inset(graph, face, loop, widths) for loop in loops]
    for loop, corners in zip(loops, inner, strict=True):
        _refuse_reversed(graph, face, loop, corners)
    _refuse_overlapping(graph, face, outer, inner, widths)


def face_loops(graph: FaceGraph, face: int) -> list[FloatArray]:
    """Return the corners of each boundary loop of a face, (n, 3); the face is on the left."""
    loops = _loops(graph, face)
    return [graph.vertices[_ends(graph, face, loop)[:, 0]] for loop in loops]


def no_room(graph: FaceGraph, place: FloatArray, faces: Iterable[int]) -> InvalidParameterError:
    """Return the error that the faces at a point are too small for a blend or an offset."""
    point = ", ".join(f"{value:.6g}" for value in place)
    triangles = np.flatnonzero(np.isin(graph.face, list(faces)))
    message = (
        f"The faces at ({point}) are too small for a blend or offset of this size. Choose a"
        " smaller size, or fewer edges."
    )
    return invalid_parameter(message, triangles[:8].tolist())


def _loops(graph: FaceGraph, face: int) -> list[IndexArray]:
    """Return the boundary loops of a face, as edge numbers; the face is on the left."""
    own = np.flatnonzero((graph.sides == face).any(axis=1)).tolist()
    begins = {edge: graph.ends[edge, int(graph.sides[edge, 0] != face)] for edge in own}
    stops = {edge: graph.ends[edge, int(graph.sides[edge, 0] == face)] for edge in own}
    leaving: dict[int, list[int]] = {}
    for edge in own:
        leaving.setdefault(int(begins[edge]), []).append(edge)
    loops = []
    while leaving:
        vertex = next(iter(leaving))
        loop = []
        while vertex in leaving:
            edge = leaving[vertex].pop()
            if not leaving[vertex]:
                del leaving[vertex]
            loop.append(edge)
            vertex = int(stops[edge])
        loops.append(np.array(loop))
    return loops


def _inset(graph: FaceGraph, face: int, loop: IndexArray, widths: FloatArray) -> FloatArray:
    """Return the start and end of each edge of a loop, moved inwards by its width, (n, 2, 3)."""
    inward = _inward(graph, face, loop)
    begins = graph.vertices[_ends(graph, face, loop)[:, 0]]
    corners = np.empty((len(loop), 2, 3))
    for k in range(len(loop)):
        one, other = inward[k - 1], inward[k]
        wide, wider = widths[loop[k - 1]], widths[loop[k]]
        cosine = float(one @ other)
        sine2 = 1 - cosine**2
        if sine2 < _PARALLEL**2:
            corners[k - 1, 1], corners[k, 0] = begins[k] + wide * one, begins[k] + wider * other
        else:
            across = ((wide - wider * cosine) * one + (wider - wide * cosine) * other) / sine2
            corners[k - 1, 1] = corners[k, 0] = begins[k] + across
    return corners


def _inward(graph: FaceGraph, face: int, loop: IndexArray) -> FloatArray:
    side = (graph.sides[loop, 0] != face).astype(np.int64)
    return np.asarray(graph.inward[loop, side])


def _ends(graph: FaceGraph, face: int, loop: IndexArray) -> IndexArray:
    ends = graph.ends[loop]
    is_left = graph.sides[loop, 0] == face
    return np.where(is_left[:, None], ends, ends[:, ::-1])


def _refuse_reversed(graph: FaceGraph, face: int, loop: IndexArray, corners: FloatArray) -> None:
    ends = graph.vertices[_ends(graph, face, loop)]
    along = ends[:, 1] - ends[:, 0]
    left = np.einsum("ij,ij->i", corners[:, 1] - corners[:, 0], along)
    gone = np.flatnonzero(left < -_PARALLEL * np.einsum("ij,ij->i", along, along))
    if len(gone):
        raise no_room(graph, ends[gone[0]].mean(axis=0), [face])


def _refuse_overlapping(
    graph: FaceGraph,
    face: int,
    outer: Sequence[FloatArray],
    inner: Sequence[FloatArray],
    widths: FloatArray,
) -> None:
    """Raise an error if the boundary of a face crosses itself after the strips are removed."""
    whole, left = (_flat(graph.normals[face], loops) for loops in (outer, inner))
    signed = sum(map(_area, left))
    if abs(Region(left).area - signed) > _SAME * sum(abs(_area(points)) for points in whole):
        edges = np.flatnonzero((graph.sides == face).any(axis=1) & (widths > 0))
        widest = edges[widths[edges].argmax()]
        raise no_room(graph, graph.vertices[graph.ends[widest]].mean(axis=0), [face])


def _flat(normal: FloatArray, loops: Sequence[FloatArray]) -> list[FloatArray]:
    """Project loops of a plane along a coordinate axis to (n, 2) points, keeping orientation.

    The axis is the one nearest to the plane's normal.
    """
    axis = int(np.abs(normal).argmax())
    plane = [(1, 2), (2, 0), (0, 1)][axis]
    flat = [corners.reshape(-1, 3)[:, plane] for corners in loops]
    return [points[:, ::-1] for points in flat] if normal[axis] < 0 else flat


def _area(points: FloatArray) -> float:
    x, y = (points - points[0]).T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2)
