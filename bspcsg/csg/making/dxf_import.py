"""Import of DXF drawings as in OpenSCAD: arcs have the chords of OpenSCAD's circles."""

import math
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ..._types import FloatArray
from ...bsp import Region
from ...bsp.drawings.dxf import read_document
from ...bsp.drawings.dxf_curves import MAX_BLOCK_ENTITIES, block_entities
from ...bsp.drawings.dxf_layouts import ANY_LAYER, VIEWPORT, layout_with_content
from ...bsp.drawings.unread_content import UnreadContent
from ...errors import format_errors
from ..syntax.arguments import Arguments
from .tessellation import Fineness

#: The largest nesting depth of blocks; blocks at a greater depth are omitted.
_MAX_BLOCK_DEPTH = 16

#: The grid step of ends of lines, in drawing units; ends in neighbouring grid cells are one corner.
_GRID_STEP = 2.0**-10


def dxf_region(
    path: Path,
    layer: str,
    origin: FloatArray,
    scale: float,
    arguments: Arguments,
    lost: UnreadContent,
) -> Region:
    """Return the region inside the outlines of a DXF file, by the even-odd rule.

    Lines, LWPOLYLINE polylines, circles, arcs, ellipses and inserted blocks are read, as in
    OpenSCAD; open outlines are closed by a chord. If the model space is empty, the paper space is
    read.

    Parameters
    ----------
    path : Path
    layer : str
        The name of the layer to read; all layers if it is empty.
    origin : (2,) float64
        The point that becomes the origin, before scaling.
    scale : float
        The factor by which coordinates are then multiplied.
    arguments : Arguments
        The arguments of the node, which determine the number of chords of arcs.
    lost : LeftOut
        Collects the entities that are omitted.

    Raises
    ------
    FormatError
        If the file is not DXF, or the drawing would have too many corners; code ``"too_large"``.
    """
    document = read_document(path)
    with format_errors(str(path), "DXF"):
        entities = _entities(document, layer, lost)
        chains = [
            (np.array(chain, dtype=np.float64) - origin) * scale
            for chain in _limited(_flat(entities, lost), arguments, abs(scale), lost)
        ]
    proper = [chain for chain in chains if len(chain) > 1]
    return Region(lost.surrounding(_joined(proper)), winding="even-odd")


def _entities(document: Any, layer: str, lost: UnreadContent) -> Iterator[Any]:
    """Return the entities of a drawing on the named layer, or on all layers if it is empty."""

    def is_wanted(name: str) -> bool:
        return not layer or name == layer

    entities = layout_with_content(document, is_wanted, lost)
    return (one for one in entities if is_wanted(one.dxf.get("layer") or ANY_LAYER))


class _PointNumbering:
    """Numbering of points; points less than a grid step apart have the same number."""

    def __init__(self) -> None:
        self._numbers: dict[tuple[int, int], int] = {}

    def number(self, point: FloatArray) -> int:
        x, y = (math.floor(c / _GRID_STEP) for c in point.tolist())
        near = [(x + dx, y + dy) for dx in (0, -1, 1) for dy in (0, -1, 1)]
        known = next((cell for cell in near if cell in self._numbers), None)
        return self._numbers.setdefault((x, y) if known is None else known, len(self._numbers))


def _joined(chains: list[FloatArray]) -> list[FloatArray]:
    """Join chains, (n, 2) each, whose ends coincide; start with chains that have a free end."""
    places = _PointNumbering()
    ends = [(places.number(chain[0]), places.number(chain[-1])) for chain in chains]
    at: dict[int, list[int]] = {}
    for number, pair in enumerate(ends):
        for place in pair:
            at.setdefault(place, []).append(number)
    loose = [(k, pair.index(p)) for k, pair in enumerate(ends) for p in pair if len(at[p]) == 1]
    left = set(range(len(chains)))
    loops = []
    for number, end in [*loose, *((k, 0) for k in range(len(chains)))]:
        if number in left:
            loops.append(_joined_chain(number, end, chains, ends, at, left))
    return loops


def _joined_chain(
    number: int,
    end: int,
    chains: list[FloatArray],
    ends: list[tuple[int, int]],
    at: dict[int, list[int]],
    left: set[int],
) -> FloatArray:
    """Return the joined corners of consecutive chains, starting with chain `number` at `end`.

    Used chains are removed from `left`; the walk ends where no chain in `left` continues.
    """
    parts = []
    following: int | None = number
    while following is not None:
        left.discard(following)
        chain = chains[following] if end == 0 else chains[following][::-1]
        parts.append(chain)
        place = ends[following][1 - end]
        following = next((k for k in at[place] if k in left), None)
        if following is not None:
            end = ends[following].index(place)
            # The next chain begins with the same corner.
            parts[-1] = chain[:-1]
    return np.concatenate(parts)


def _flat(entities: Iterator[Any], lost: UnreadContent) -> Iterator[Any]:
    """Yield the entities of a drawing, with inserted blocks replaced by their entities."""
    waiting: list[Iterator[tuple[Any, bool]]] = [((entity, True) for entity in entities)]
    left = MAX_BLOCK_ENTITIES
    while waiting:
        entity, is_placed = next(waiting[-1], (None, False))
        left -= len(waiting) > 1
        if left < 0:
            raise ValueError(f"its nested blocks contain more than {MAX_BLOCK_ENTITIES} entities")
        if entity is None:
            waiting.pop()
        elif not is_placed or (entity.dxftype() == "INSERT" and len(waiting) > _MAX_BLOCK_DEPTH):
            lost.add(entity.dxftype())
        elif entity.dxftype() == "INSERT":
            # OpenSCAD does not repeat blocks in rows.
            lost.add("INSERT", entity.mcount - 1)
            waiting.append(block_entities(entity, rows=False))
        else:
            yield entity


def _limited(
    entities: Iterable[Any], arguments: Arguments, scale: float, lost: UnreadContent
) -> Iterator[Any]:
    """Yield the polylines of all entities; raise an error if they have too many corners.

    Record the entities that are not read in `lost`.
    """
    corners = 0
    for entity in entities:
        if entity.dxftype() not in _CURVES and entity.dxftype() != VIEWPORT:
            lost.add(entity.dxftype())
        for chain in _chains(entity, arguments, scale):
            corners = arguments.limited(corners + len(chain), "this drawing")
            yield chain


#: The types of DXF entities that OpenSCAD reads.
_CURVES = frozenset(["LINE", "LWPOLYLINE", "CIRCLE", "ARC", "ELLIPSE"])


def _chains(entity: Any, arguments: Arguments, scale: float) -> Iterator[Any]:
    kind = entity.dxftype()
    if kind == "LINE":
        yield [entity.dxf.start.vec2, entity.dxf.end.vec2]
    elif kind == "LWPOLYLINE":
        corners = [corner[:2] for corner in entity.get_points()]
        yield corners + corners[:1] if entity.closed else corners
    elif kind in ("CIRCLE", "ARC"):
        yield _arc(entity, arguments, scale)
    elif kind == "ELLIPSE":
        yield _ellipse(entity, arguments, scale)


def _arc(entity: Any, arguments: Arguments, scale: float) -> FloatArray:
    center, radius = np.array(entity.dxf.center.vec2), entity.dxf.radius
    full = entity.dxftype() == "CIRCLE"
    start = 0.0 if full else entity.dxf.start_angle
    stop = 360.0 if full else entity.dxf.end_angle
    sweep = stop - start if stop >= start else (stop - start) % 360
    count = math.ceil(_sides(radius * scale, arguments) * sweep / 360)
    angles = np.radians(start + sweep * np.arange(count + 1) / max(count, 1))
    points = center + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    return np.concatenate([points[:-1], points[:1]]) if full else points


def _sides(radius: float, arguments: Arguments) -> int:
    return arguments.sides(Fineness.of(arguments).fragments(radius), "an arc of this drawing")


def _ellipse(entity: Any, arguments: Arguments, scale: float) -> FloatArray:
    center, axis = np.array(entity.dxf.center.vec2), np.array(entity.dxf.major_axis.vec2)
    start, stop = entity.dxf.start_param, entity.dxf.end_param
    sweep = stop - start if stop >= start else (stop - start) % math.tau
    sides = _sides(float(np.hypot(*axis)) * scale, arguments)
    count = math.ceil(sides * sweep / math.tau - 1e-9)
    angles = start + sweep * np.arange(count + 1) / max(count, 1)
    other = np.array([-axis[1], axis[0]]) * entity.dxf.ratio
    points = center + np.outer(np.cos(angles), axis) + np.outer(np.sin(angles), other)
    closed = math.isclose(sweep, math.tau)
    return np.concatenate([points[:-1], points[:1]]) if closed else points
