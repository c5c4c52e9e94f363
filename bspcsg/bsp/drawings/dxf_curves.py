"""Convert DXF entities to chains of corners in the plane of the drawing.

ezdxf turns arcs into Bézier curves, which are exact only to three ten-thousandths of the radius;
here arcs are divided into chords.
"""

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ..._types import FloatArray
from .dxf_layouts import ANY_LAYER, VIEWPORT
from .unread_content import UnreadContent

#: The kinds of entities that are outlines, and the kind that inserts a block of entities.
_CURVES = frozenset(["LINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE", "LWPOLYLINE", "POLYLINE"])
_BLOCK = "INSERT"

#: The largest number of entities of blocks, counted at each insertion. ezdxf inserts about ten
#: thousand in a second.
MAX_BLOCK_ENTITIES = 1 << 17

#: The largest depth of blocks that are nested in each other.
_MAX_BLOCK_DEPTH = 64

#: The largest number of chords of one arc.
_MAX_ARC_CHORDS = 1 << 20

#: The empty chain, for entities that are no outlines.
_EMPTY_CHAIN = np.zeros((0, 2))

#: The flag of vertices that are only control points of a spline, not corners.
_CONTROL_POINT_FLAG = 16


def chains_of(
    layout: Any, is_wanted: Callable[[str], bool], chord: float, lost: UnreadContent
) -> Iterator[FloatArray]:
    """Yield the corners of each outline, (n, 2); a closed outline ends with its first corner.

    Parameters
    ----------
    layout : ezdxf layout
        Insertions of blocks are replaced by the blocks' entities.
    is_wanted : callable
        Returns whether to read the layer of this name.
    chord : float
        The largest distance between a curve and its chords.
    lost : UnreadContent
        Collects entities that are no outlines.

    Raises
    ------
    ValueError
        If blocks contain themselves or too many entities, or a curve would have too many chords.
    """
    for entity, layer, is_placed in _entities(layout):
        if is_wanted(layer):
            chain = _EMPTY_CHAIN
            if is_placed and entity.dxftype() in _CURVES:
                chain = _chain(entity, chord)
            if len(chain) > 1:
                yield chain
            elif entity.dxftype() != VIEWPORT:
                lost.add(entity.dxftype())


def _entities(layout: Any) -> Iterator[tuple[Any, str, bool]]:
    """Yield the entities of a layout and of its inserted blocks, except the insertions themselves.

    Each entity comes with the name of its layer, and with False if it could not be transformed.
    """
    waiting: list[tuple[Iterator[tuple[Any, bool]], str]] = [
        (((entity, True) for entity in layout), ANY_LAYER)
    ]
    count = 0
    while waiting:
        entities, outer = waiting[-1]
        entity, is_placed = next(entities, (None, False))
        if entity is None:
            waiting.pop()
            continue
        count += len(waiting) > 1
        if count > MAX_BLOCK_ENTITIES:
            raise ValueError(f"its nested blocks contain more than {MAX_BLOCK_ENTITIES} entities")
        layer = entity.dxf.get("layer") or ANY_LAYER
        layer = outer if layer == ANY_LAYER else layer
        if entity.dxftype() == _BLOCK and is_placed:
            if len(waiting) > _MAX_BLOCK_DEPTH:
                raise ValueError(f"its blocks are nested deeper than {_MAX_BLOCK_DEPTH} levels")
            waiting.append((block_entities(entity), layer))
        else:
            yield entity, layer, is_placed


def block_entities(insert: Any, *, rows: bool = True) -> Iterator[tuple[Any, bool]]:
    """Yield the entities of one insertion of a block; an array of copies copy by copy.

    Each entity comes with True if it was transformed: ezdxf cannot transform all kinds.
    """
    if insert.block() is None:
        raise ValueError(f"an INSERT refers to the block “{insert.dxf.name}”, which is not defined")
    if insert.mcount > 1 and rows:
        yield from ((one, True) for one in insert.multi_insert())
        return
    unmoved: list[Any] = []
    placed = insert.virtual_entities(skipped_entity_callback=lambda one, _: unmoved.append(one))
    yield from ((one, True) for one in placed)
    yield from ((one, False) for one in unmoved)
    yield from ((one, False) for one in insert.attribs if not one.is_invisible)


def _chain(entity: Any, chord: float) -> FloatArray:
    kind = entity.dxftype()
    if kind == "LINE":
        return _flat([entity.dxf.start, entity.dxf.end])
    if kind == "ELLIPSE" and _is_full(entity):
        return _closed(_flat(_from_its_axis(entity).flattening(chord)))
    if kind == "SPLINE" and not len(entity.control_points) and not len(entity.fit_points):
        return _EMPTY_CHAIN
    if kind in ("ELLIPSE", "SPLINE"):
        return _flat(entity.flattening(chord))
    if kind == "LWPOLYLINE":
        return _polyline(entity, np.array(entity.get_points("xyb")), entity.closed, chord)
    if kind == "POLYLINE":
        return _old_polyline(entity, chord)
    return _arc(entity, chord)


def _flat(points: Any) -> FloatArray:
    return np.array([(point[0], point[1]) for point in points], dtype=np.float64).reshape(-1, 2)


def _closed(points: FloatArray) -> FloatArray:
    return np.concatenate([points[:-1], points[:1]])


def _is_full(ellipse: Any) -> bool:
    turn = ellipse.dxf.end_param - ellipse.dxf.start_param
    return math.isclose(abs(turn), math.tau, rel_tol=1e-9)


def _from_its_axis(ellipse: Any) -> Any:
    """Return a full ellipse that starts on its axis; ezdxf treats one that does not as a point."""
    full = ellipse.copy()
    full.dxf.start_param, full.dxf.end_param = 0.0, math.tau
    return full


def _arc(entity: Any, chord: float) -> FloatArray:
    start, turn = 0.0, math.tau
    if entity.dxftype() == "ARC":
        start = math.radians(entity.dxf.start_angle)
        turn = math.radians((entity.dxf.end_angle - entity.dxf.start_angle) % 360.0) or math.tau
    center, radius = entity.dxf.center, abs(entity.dxf.radius)
    count = _chords(radius, turn, chord)
    if turn == math.tau:
        # With corners at the ends of both axes, the polygon is exactly as wide and as high as the
        # circle.
        count = -(-count // 4) * 4
    angles = start + turn * np.arange(count + 1) / count
    points = np.column_stack([np.cos(angles), np.sin(angles)]) * radius + (center.x, center.y)
    return _on_plane(entity, _closed(points) if turn == math.tau else points, center.z)


def _chords(radius: float, turn: float, chord: float) -> int:
    """Return the number of chords of an arc within a distance `chord` of it, 4 or more a circle."""
    half = 2 * math.asin(math.sqrt(min(chord / (2 * radius), 1.0))) if radius else math.pi
    count = math.ceil(abs(turn) / min(2 * half, math.pi / 2))
    if count > _MAX_ARC_CHORDS:
        raise ValueError(
            f"an arc would be divided into {count} chords, more than {_MAX_ARC_CHORDS}; choose a"
            " larger tolerance"
        )
    return max(count, 1)


def _polyline(entity: Any, rows: FloatArray, is_closed: bool, chord: float) -> FloatArray:
    """Return the corners of a polyline, given rows (x, y, bulge) for its vertices."""
    points = rows.reshape(-1, 3)[:, 0] + 1j * rows.reshape(-1, 3)[:, 1]
    ends = np.roll(points, -1) if is_closed else points[1:]
    pieces = [
        _bulged(start, end, float(bulge), chord)
        for start, end, bulge in zip(points, ends, rows.reshape(-1, 3)[:, 2], strict=False)
    ]
    last = points[:1] if is_closed else points[-1:]
    whole = np.concatenate([*pieces, last])
    elevation = float(np.ravel(entity.dxf.get("elevation", 0.0))[-1])
    return _on_plane(entity, np.column_stack([whole.real, whole.imag]), elevation)


def _bulged(start: complex, end: complex, bulge: float, chord: float) -> Any:
    """Return the corners of an arc without its end; the bulge is the tangent of angle / 4.

    Points are computed from half of their angle, which avoids cancellation in nearly straight arcs.
    """
    turn = 4 * math.atan(bulge)
    if turn == 0 or start == end:
        return np.array([start])
    radius = abs(end - start) / abs(2 * math.sin(turn / 2))
    count = _chords(radius, turn, chord)
    angles = turn * np.arange(count) / count
    turned = np.exp(0.5j * (angles - turn))
    return start + (end - start) * np.sin(angles / 2) / math.sin(turn / 2) * turned


def _old_polyline(entity: Any, chord: float) -> FloatArray:
    if entity.is_3d_polyline:
        points = _flat(entity.points())
        return np.concatenate([points, points[:1]]) if entity.is_closed else points
    if not entity.is_2d_polyline:
        # A mesh.
        return _EMPTY_CHAIN
    rows = [
        (vertex.dxf.location.x, vertex.dxf.location.y, vertex.dxf.get("bulge", 0.0))
        for vertex in entity.vertices
        if not vertex.dxf.flags & _CONTROL_POINT_FLAG
    ]
    return _polyline(entity, np.array(rows), entity.is_closed, chord)


def _on_plane(entity: Any, points: FloatArray, elevation: float) -> FloatArray:
    """Return points in an entity's own plane as drawing coordinates, without z."""
    system = entity.ocs()
    if not system.transform:
        return points
    return _flat(system.points_to_wcs((x, y, elevation) for x, y in points.tolist()))
