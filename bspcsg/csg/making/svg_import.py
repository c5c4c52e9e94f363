"""Import of SVG drawings as in OpenSCAD: in millimetres on the page, with y upwards."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from ..._types import FloatArray, IndexArray
from ...bsp import Region
from ...bsp.drawings.svg import Shape, outlines_of, visible_shapes
from ...bsp.drawings.svg_curves import Cubics, Curves, Steps
from ...bsp.drawings.svg_tree import HREF, name_of
from ...bsp.drawings.unread_content import UnreadContent
from ...errors import format_errors
from ...mesh.interop import import_optional
from ...modelling.planar.offsetting import stroke_area

_MILLIMETRES = {"mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72, "pc": 25.4 / 6}
_LENGTH = re.compile(r"\s*([0-9.]+(?:[eE][+-]?\d+)?)\s*([a-zA-Z%]*)\s*")

#: The number of chords of a Bézier curve, and of a quarter of a circle or an ellipse.
_CURVE_STEPS, _QUARTER_STEPS = 20, 10

#: The number of chords per half turn of any other arc; each arc gets four additional chords.
_TURN_STEPS = 10

#: The tolerance for rounding errors when a number of chords is rounded down.
_ROUNDING = 1e-6

#: The smallest width of a line in user units. A thinner line is drawn one unit wide.
_MIN_LINE_WIDTH = 0.01

#: A subpath is closed if the distance of its ends, in user units, is at most this.
_CLOSED = 0.1


@dataclass(frozen=True)
class _PageTransform:
    """The map from user units to millimetres from the lower left corner of the page."""

    scale: float
    x: float
    y: float


def svg_region(path: Path, dpi: float, centered: bool, lost: UnreadContent) -> Region:
    """Return the region of the shapes in an SVG file, as OpenSCAD imports them.

    Closed paths are filled, whatever their fill; open paths get the width of their stroke. Curves
    have the number of chords that OpenSCAD uses, which does not depend on their size. The view box
    is fitted into width and height, as in browsers; without a view box, user units are millimetres.
    Style sheets and ``use`` elements are ignored. Hidden shapes are omitted; OpenSCAD 2021.01 draws
    them.

    Parameters
    ----------
    path : Path
    dpi : float
        Pixels per inch, for lengths without a unit.
    centered : bool
        True if the middle of the drawing is at the origin, rather than the lower left corner of the
        page.
    lost : LeftOut
        Collects the shapes that are omitted.
    """
    region = _drawn(path, lost)
    page = _page(path, dpi)
    placed = region.scale(page.scale).translate(page.x, page.y)
    bounds = placed.bounds
    if centered and bounds is not None:
        return placed.translate(*(-bounds.mean(axis=0)).tolist())
    return placed


def _drawn(path: Path, lost: UnreadContent) -> Region:
    region = Region()
    shapes = visible_shapes(path, _prepare, lost)
    with format_errors(str(path), "SVG"):
        found = outlines_of(shapes, _steps_of(shapes))
    for shape, outlines in zip(shapes, found, strict=True):
        closed = [
            corners for corners, is_closed in outlines if is_closed or _returns_to_start(corners)
        ]
        loops = [corners for corners in closed if len(corners) >= 3]
        lost.outlines += len(loops)
        region = region | Region(loops, winding="even-odd")
        for corners, is_closed in outlines:
            if not is_closed and not _returns_to_start(corners) and len(corners) >= 2:
                region = region | _stroke(shape.element, corners)
    return region


def _prepare(root: ElementTree.Element) -> None:
    """Remove from an SVG tree what OpenSCAD ignores, and the view box, which is read separately."""
    for parent in list(root.iter()):
        parent[:] = [child for child in parent if name_of(child) != "style"]
        if name_of(parent) == "switch":
            # OpenSCAD draws all children of a switch element.
            parent.tag = parent.tag.removesuffix("switch") + "g"
        if name_of(parent) == "use":
            # Without a reference it draws nothing, and is reported as omitted.
            parent.attrib = {key: parent.attrib[key] for key in parent.attrib if key not in HREF}
    for name in ("viewBox", "width", "height", "x", "y", "preserveAspectRatio"):
        root.attrib.pop(name, None)


def _steps_of(shapes: Sequence[Shape]) -> Steps:
    """Return a function from curves to the numbers of chords that OpenSCAD gives them."""
    elements = import_optional("svgelements", "svgelements")
    round_ones = (elements.Circle, elements.Ellipse)
    is_round = np.array([isinstance(shape.element, round_ones) for shape in shapes], dtype=bool)

    def steps(curves: Curves) -> IndexArray:
        if isinstance(curves, Cubics):
            return np.full(len(curves.owner), _CURVE_STEPS)
        turns = np.nan_to_num(np.abs(curves.sweep) * _TURN_STEPS / np.pi)
        counts = np.floor(turns + _ROUNDING).astype(np.int64) + 4
        return np.where(is_round[curves.owner], _QUARTER_STEPS, counts)

    return steps


def _returns_to_start(corners: FloatArray) -> bool:
    """Return True if a subpath without a closing command ends at its first point."""
    return len(corners) > 2 and bool(np.hypot(*(corners[0] - corners[-1])) <= _CLOSED)


def _stroke(shape: Any, corners: FloatArray) -> Region:
    width = float(shape.implicit_stroke_width or 0.0)
    width = width if width >= _MIN_LINE_WIDTH else 1.0
    cap = shape.values.get("stroke-linecap")
    join = str(shape.values.get("stroke-linejoin"))
    return stroke_area(corners, width, cap if cap in ("butt", "round") else "square", join)


def _page(path: Path, dpi: float) -> _PageTransform:
    # `visible_shapes` has refused files that declare an entity.
    _, root = next(iter(ElementTree.iterparse(path, events=("start",))))
    width, height = (_length(root.get(name, ""), dpi) for name in ("width", "height"))
    with format_errors(str(path), "SVG"):
        words = re.split(r"[\s,]+", root.get("viewBox", "").strip())
        box = [float(word) for word in words if word]
    if len(box) != 4 or min(box[2:]) <= 0:
        return _PageTransform(1.0, 0.0, height or 0.0)
    left, top, wide, high = box
    width = width or (height / high * wide if height else wide * 25.4 / dpi)
    height = height or high * width / wide
    scale = min(width / wide, height / high)
    x = (width - wide * scale) / 2 - left * scale
    return _PageTransform(scale, x, height - (height - high * scale) / 2 + top * scale)


def _length(text: str, dpi: float) -> float | None:
    """Return an SVG length in millimetres; None if it is missing or a percentage."""
    match = _LENGTH.fullmatch(text)
    if match is None or match.group(2) == "%":
        return None
    return float(match.group(1)) * _MILLIMETRES.get(match.group(2), 25.4 / dpi)
