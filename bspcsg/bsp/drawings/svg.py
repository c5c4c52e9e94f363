"""Regions as SVG drawings: `load_svg` reads filled shapes, `save_svg` writes one path."""

import io
import math
import os
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple
from xml.etree import ElementTree
from xml.parsers import expat
from xml.sax.saxutils import quoteattr

import numpy as np

from ..._types import FloatArray, Scalar, WindingRule
from ...errors import FormatError, format_errors, invalid_parameter, message_of
from ...formats.atomic import write_file
from ...formats.source import limited_content
from ...mesh.interop import import_optional
from ...parameters import file_path, instance_of, not_negative, positive, shown, winding_rule
from ..sets.region import Region
from ..trees.facets import chosen_pitch
from .svg_curves import Steps, chord_counts_within, outlines
from .svg_paths import Segments, path_segments, shape_segments
from .svg_tree import NO_SHAPES, make_plain, name_of
from .unread_content import UnreadContent


def load_svg(
    path: str | os.PathLike[str],
    *,
    tolerance: Scalar = 0.01,
    winding: WindingRule | None = None,
    pitch: int | None = None,
) -> Region:
    """Return the union of the filled shapes of an SVG file as a region.

    Parameters
    ----------
    path : path
    tolerance : float
        Largest distance between a curve and the chords that replace it, in user units.
    winding : {"positive", "nonzero", "even-odd"}, optional
        By default the ``fill-rule`` of each shape.
    pitch : int, optional

    Returns
    -------
    Region
        In the user units of the outermost element (its size on paper and view box are ignored),
        with y upwards: the point (x, y) of the drawing becomes (x, -y). Strokes, text, images and
        unfilled shapes are left out. Of a ``switch`` the first child that fits is drawn, in English
        if there is a choice. Open subpaths are closed. Clip paths and masks are ignored; in style
        sheets only rules for a tag, a class or an id are applied.

    Raises
    ------
    FormatError
        If the file cannot be read, is no well-formed SVG, or declares an entity.

    Warns
    -----
    DrawingWarning
        Names the kinds of skipped content, and reports an empty region.
    """
    lost = UnreadContent()
    chord = positive(tolerance, "tolerance")
    rule = None if winding is None else winding_rule(winding)
    shapes = visible_shapes(path, make_plain, lost)
    filled = [shape for shape in shapes if _is_filled(shape.element)]
    with format_errors(os.fspath(path), "SVG"):
        found_loops = iter(outlines_of(filled, chord_counts_within(_own_lengths(filled, chord))))
    found: list[tuple[list[FloatArray], WindingRule]] = []
    for shape in shapes:
        loops: list[FloatArray] = []
        if _is_filled(shape.element):
            loops = [corners for corners, _ in next(found_loops) if len(corners) >= 3]
            found.append((loops, rule or _rule(shape.element)))
        if not loops and _keyword(shape.element, "stroke") not in ("", "none"):
            lost.add("stroke")
        lost.outlines += len(loops)
    points = [np.zeros((0, 2)), *(corners for loops, _ in found for corners in loops)]
    common = chosen_pitch(pitch, np.concatenate(points))
    regions = (Region(loops, winding=kind, pitch=common) for loops, kind in found)
    region = Region.compose([Region(pitch=common), *regions])
    lost.warn(path, region)
    return region


class Shape(NamedTuple):
    """A visible shape of an SVG drawing.

    Parameters
    ----------
    element : object
        The svgelements shape. Its transform to user units is not applied, because svgelements skews
        arcs wrongly.
    path : Segments or None
        The segments of a path if its data are valid, read without svgelements; else None.
    """

    element: Any
    path: Segments | None


def visible_shapes(
    path: str | os.PathLike[str],
    prepare: Callable[[ElementTree.Element], None],
    lost: UnreadContent,
) -> list[Shape]:
    """Return the visible shapes of an SVG file, in drawing order.

    Parameters
    ----------
    path : path
    prepare : callable
        A function that changes the outermost element before it is read, for example to remove its
        view box.
    lost : UnreadContent
        Counts visible content that is no shape.

    Raises
    ------
    FormatError
        As `load_svg` does.
    """
    data = _checked_bytes(path)
    elements = import_optional("svgelements", "svgelements")
    try:
        root = ElementTree.fromstring(data)
        if name_of(root) != "svg":
            raise ValueError("its root element is not <svg>")
        prepare(root)
        paths = _segments_by_key(root)
        plain = io.BytesIO(ElementTree.tostring(root))
        drawing = elements.SVG.parse(plain, reify=False, ppi=96.0)
        # svgelements returns nothing for a drawing that is not displayed.
        found = [] if drawing is None else [one for one in drawing.elements() if _is_visible(one)]
        shapes = [
            # svgelements also gives shapes inside a path the path's data.
            Shape(
                shape,
                paths.get(shape.values.get("d")) if isinstance(shape, elements.Path) else None,
            )
            for shape in found
            if isinstance(shape, elements.Shape)
        ]
        for element in found:
            lost.add(*_no_shape(element))
    except Exception as error:  # svgelements raises errors of any type
        message = f"{os.fspath(path)}: the file is not a valid SVG drawing: {message_of(error)}."
        raise FormatError(message, "syntax") from error
    return shapes


def _segments_by_key(root: ElementTree.Element) -> dict[str, Segments]:
    """Replace the data of valid paths by keys, and return the paths' segments by key.

    svgelements takes ten times as long to read path data.

    svgelements takes ten times as long to read path data.
    """
    paths: dict[str, Segments] = {}
    for element in root.iter():
        segments = path_segments(element.get("d", "")) if name_of(element) == "path" else None
        if segments is not None:
            element.attrib["d"] = f"M{len(paths)},0"
            paths[element.attrib["d"]] = segments
    return paths


def _no_shape(element: Any) -> tuple[str, int]:
    """Return an element's name, and 1 if it is visible content without a shape, else 0."""
    name = str(element.values.get("tag"))
    if name == "use":
        return "use of a missing element", int(not len(element))
    return name, int(name in NO_SHAPES)


def save_svg(
    region: Region, path: str | os.PathLike[str], *, fill: str = "#9db8d9", margin: Scalar = 0.05
) -> None:
    """Write a region as an SVG file with one path; y points up on the page.

    Reading the file gives the same doubles as coordinates.

    Parameters
    ----------
    region : Region
        A bounded region.
    path : path
    fill : str
        The colour of the inside; the outline is black.
    margin : float
        The empty margin around the region, as a fraction of its larger extent; at least 0.

    Raises
    ------
    UnboundedError
        If the region reaches to infinity.
    FormatError
        If the file cannot be written.
    """
    write_file(path, [svg_data(region, fill=fill, margin=margin)])


def svg_data(region: Region, *, fill: str = "#9db8d9", margin: Scalar = 0.05) -> bytes:
    """Return the bytes of the SVG file that `save_svg` writes for a region."""
    bounds = instance_of(Region, region, "region").bounds
    low, high = (np.zeros(2), np.ones(2)) if bounds is None else bounds
    space = float((high - low).max()) * not_negative(margin, "margin")
    if not isinstance(fill, str):
        raise invalid_parameter(
            f"fill must be an SVG colour as text, such as 'orange', not {shown(fill)}."
        )
    width, height = (high - low + 2 * space).tolist()
    if not math.isfinite(max(width, height)):
        message = (
            f"The margin {shown(margin)} makes the drawing larger than doubles can represent;"
            " choose a smaller margin."
        )
        raise invalid_parameter(message)
    x, y = float(low[0]) - space, -float(high[1]) - space
    outlines = " ".join(_path_of(points) for points in region.to_polygons())
    return (
        '<svg xmlns="http://www.w3.org/2000/svg"'
        f' viewBox="{x!r} {y!r} {width!r} {height!r}">\n'
        f'<path fill-rule="nonzero" fill={quoteattr(fill)} stroke="black"'
        f' stroke-width="{max(width, height) / 400!r}" d="{outlines}"/>\n</svg>\n'
    ).encode()


def _path_of(points: FloatArray) -> str:
    corners = (f"{x!r},{-y + 0.0!r}" for x, y in points.tolist())
    return f"M{' L'.join(corners)} Z"


def _checked_bytes(path: str | os.PathLike[str]) -> bytes:
    """Return the bytes of a file, or raise an error if it is not XML or declares entities."""
    name = file_path(path)
    data = limited_content(name)
    parser = expat.ParserCreate()

    def refuse(*_: object) -> None:
        raise FormatError(
            f"{name}: the SVG declares XML entities, which are not supported; save it without"
            " them.",
            "syntax",
        )

    parser.EntityDeclHandler = refuse
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code)
        raise FormatError(
            f"{name}:{error.lineno}: the XML is not well-formed: {reason}.",
            "syntax",
            [error.lineno],
        ) from None
    except (LookupError, ValueError) as error:
        message = f"{name}:1: the XML cannot be decoded: {message_of(error)}."
        raise FormatError(message, "syntax", [1]) from error
    return data


def _is_visible(shape: Any) -> bool:
    is_visible = _keyword(shape, "visibility") not in ("hidden", "collapse")
    return is_visible and _keyword(shape, "display") != "none"


def _is_filled(shape: Any) -> bool:
    if _keyword(shape, "fill") == "none":
        return False
    # A shape without a fill property is black.
    return shape.values.get("fill") is None or shape.fill.value is not None


def _rule(shape: Any) -> WindingRule:
    return "even-odd" if _keyword(shape, "fill-rule") == "evenodd" else "nonzero"


def _keyword(shape: Any, name: str) -> str:
    """Return a CSS property in lower case, without blanks and "!important"; "" if it is not set."""
    return str(shape.values.get(name) or "").partition("!")[0].strip().lower()


def outlines_of(shapes: Sequence[Shape], steps: Steps) -> list[list[tuple[FloatArray, bool]]]:
    """Return for each shape its subpaths: the corners, (n, 2), y upwards, and whether it is closed.

    Parameters
    ----------
    shapes : sequence of Shape
    steps : callable
        A function that returns the number of chords of each curve.
    """
    segments = [shape.path or shape_segments(shape.element) for shape in shapes]
    return outlines(segments, _matrices(shapes), steps)


def _matrices(shapes: Sequence[Shape]) -> FloatArray:
    found = [shape.element.transform for shape in shapes]
    rows = [(one.a, one.b, one.c, one.d, one.e, one.f) for one in found]
    return np.array(rows, dtype=np.float64).reshape(-1, 6)


def _own_lengths(shapes: Sequence[Shape], length: float) -> FloatArray:
    """Return for each shape a length in its own coordinates, at most `length` in user units."""
    a, b, c, d = _matrices(shapes)[:, :4].T
    # The longer half axis of the ellipse to which the matrix maps the unit circle.
    with np.errstate(all="ignore"):
        stretch = (np.hypot(a + d, b - c) + np.hypot(a - d, b + c)) / 2
    return length / np.where(stretch > 0, stretch, 1.0)
