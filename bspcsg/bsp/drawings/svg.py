"""Regions as SVG drawings: filled shapes in, one path out."""

import io
import math
import os
from collections.abc import Callable, Iterator
from typing import Any
from xml.etree import ElementTree
from xml.parsers import expat
from xml.sax.saxutils import quoteattr

import numpy as np

from ..._types import FloatArray, Scalar, WindingRule
from ...errors import FormatError, format_errors, invalid_parameter, words_of
from ...formats.atomic import write_file
from ...formats.source import limited_content
from ...mesh.interop import optional
from ...parameters import file_path, not_negative, of_kind, positive, shown, winding_rule
from ..sets.region import Region
from ..trees.facets import chosen_pitch
from .left_out import LeftOut
from .svg_tree import NO_SHAPES, make_plain, name_of


def load_svg(
    path: str | os.PathLike[str],
    *,
    tolerance: Scalar = 0.01,
    winding: WindingRule | None = None,
    pitch: int | None = None,
) -> Region:
    """Read the filled shapes of an SVG file as one region, their union.

    Parameters
    ----------
    path : path
    tolerance : float
        Largest distance between a curve and the chords that replace it, in user units.
    winding : {"positive", "nonzero", "even-odd"}, optional
        By default what each shape's ``fill-rule`` says.
    pitch : int, optional

    Returns
    -------
    Region
        In the user units of the outermost element (its size on paper and its view box do not
        matter), y upwards: the point (x, y) of the drawing becomes (x, -y). Strokes, text, images
        and what is not filled are left out; of a ``switch`` the first child that fits is drawn, in
        English if there is a choice; an open subpath counts as closed, as when it is filled.
        Clip paths and masks do not count; of style sheets only rules for a tag, a class or an id.

    Raises
    ------
    FormatError
        If the file cannot be read, is no well-formed SVG, or declares an entity.

    Warns
    -----
    DrawingWarning
        Names the kinds of what is left out, and says that the region is empty.
    """
    lost = LeftOut()
    chord = positive(tolerance, "tolerance")
    rule = None if winding is None else winding_rule(winding)
    found: list[tuple[list[FloatArray], WindingRule]] = []
    for shape in shown_shapes(path, make_plain, lost):
        loops: list[FloatArray] = []
        if _is_filled(shape):
            with format_errors(os.fspath(path), "SVG"):
                outlines = outlines_of(shape, _within(shape, chord))
                loops = [corners for corners, _ in outlines if len(corners) >= 3]
            found.append((loops, rule or _rule(shape)))
        if not loops and _keyword(shape, "stroke") not in ("", "none"):
            lost.add("stroke")
        lost.outlines += len(loops)
    points = [np.zeros((0, 2)), *(corners for loops, _ in found for corners in loops)]
    common = chosen_pitch(pitch, np.concatenate(points))
    shapes = (Region(loops, winding=kind, pitch=common) for loops, kind in found)
    region = Region.compose([Region(pitch=common), *shapes])
    lost.tell(path, region)
    return region


def shown_shapes(
    path: str | os.PathLike[str], prepare: Callable[[ElementTree.Element], None], lost: LeftOut
) -> list[Any]:
    """Return svgelements' shapes of a file, but for those that are not shown.

    Each has a transform to user units of its own: svgelements skews arcs in a wrong way.

    Parameters
    ----------
    path : path
    prepare : callable
        Changes the outermost element before it is looked at; takes off its view box.
    lost : LeftOut
        Gets what is shown, but is no shape.

    Raises
    ------
    FormatError
        As `load_svg` does.
    """
    data = _checked(path)
    elements = optional("svgelements", "svgelements")
    try:
        root = ElementTree.fromstring(data)
        if name_of(root) != "svg":
            raise ValueError("the outermost element is not svg")
        prepare(root)
        plain = io.BytesIO(ElementTree.tostring(root))
        drawing = elements.SVG.parse(plain, reify=False, ppi=96.0)
        # svgelements makes nothing of a drawing that is not displayed.
        found = [] if drawing is None else [one for one in drawing.elements() if _is_shown(one)]
        shapes = [shape for shape in found if isinstance(shape, elements.Shape)]
        for element in found:
            lost.add(*_no_shape(element))
    except Exception as error:  # what svgelements raises is of any kind
        message = f"{os.fspath(path)}: this is no valid SVG: {words_of(error)}."
        raise FormatError(message, "syntax") from error
    return shapes


def _no_shape(element: Any) -> tuple[str, int]:
    """Return what an element without a shape is called, and 1 if it shows something."""
    name = str(element.values.get("tag"))
    if name == "use":
        return "use of what is not there", int(not len(element))
    return name, int(name in NO_SHAPES)


def save_svg(
    region: Region, path: str | os.PathLike[str], *, fill: str = "#9db8d9", margin: Scalar = 0.05
) -> None:
    """Write a region as an SVG file with one path, y upwards on the page.

    Coordinates are written so that reading them gives the same doubles again.

    Parameters
    ----------
    region : Region
        Bounded.
    path : path
    fill : str
        Colour of the inside; the outline is black.
    margin : float
        Space around the region, as a part of its size; at least 0.

    Raises
    ------
    UnboundedError
        If the region reaches to infinity.
    FormatError
        If the file cannot be written.
    """
    write_file(path, [svg_data(region, fill=fill, margin=margin)])


def svg_data(region: Region, *, fill: str = "#9db8d9", margin: Scalar = 0.05) -> bytes:
    """Return what `save_svg` writes."""
    bounds = of_kind(Region, region, "region").bounds
    low, high = (np.zeros(2), np.ones(2)) if bounds is None else bounds
    space = float((high - low).max()) * not_negative(margin, "margin")
    if not isinstance(fill, str):
        raise invalid_parameter(f"fill must be a colour, not {shown(fill)}.")
    width, height = (high - low + 2 * space).tolist()
    if not math.isfinite(max(width, height)):
        message = f"With a margin of {shown(margin)} the page is beyond all doubles; give less."
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


def _checked(path: str | os.PathLike[str]) -> bytes:
    """Return the file's bytes if they are XML without entities; a document type is not read."""
    name = file_path(path)
    data = limited_content(name)
    parser = expat.ParserCreate()

    def refuse(*_: object) -> None:
        raise FormatError(f"{name}: entities are not allowed here.", "syntax")

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
        message = f"{name}:1: the XML cannot be decoded: {words_of(error)}."
        raise FormatError(message, "syntax", [1]) from error
    return data


def _is_shown(shape: Any) -> bool:
    is_visible = _keyword(shape, "visibility") not in ("hidden", "collapse")
    return is_visible and _keyword(shape, "display") != "none"


def _is_filled(shape: Any) -> bool:
    if _keyword(shape, "fill") == "none":
        return False
    # What says nothing of its fill is black.
    return shape.values.get("fill") is None or shape.fill.value is not None


def _rule(shape: Any) -> WindingRule:
    return "even-odd" if _keyword(shape, "fill-rule") == "evenodd" else "nonzero"


def _keyword(shape: Any, name: str) -> str:
    """Return a property as CSS takes it: without blanks, case and importance."""
    return str(shape.values.get(name) or "").partition("!")[0].strip().lower()


def outlines_of(shape: Any, steps: Callable[[Any], int]) -> Iterator[tuple[FloatArray, bool]]:
    """Yield the corners of each subpath of a shape, y upwards, and whether it is closed.

    Parameters
    ----------
    shape : object
        One of `shown_shapes`.
    steps : callable
        Says of an arc or a curve of svgelements how many chords replace it.
    """
    elements = optional("svgelements", "svgelements")
    matrix = shape.transform
    linear = np.array([(matrix.a, matrix.c), (matrix.b, matrix.d)], dtype=np.float64)
    for subpath in elements.Path(shape).as_subpaths():
        segments = list(subpath)
        points = [point for segment in segments for point in _points_of(elements, segment, steps)]
        local = np.array([(p.real, p.imag) for p in points]).reshape(-1, 2)
        with np.errstate(invalid="ignore"):  # what is not finite is refused with the outline
            corners = (local @ linear.T + (matrix.e, matrix.f)) * (1, -1) + 0.0
        different = np.any(corners != np.roll(corners, 1, axis=0), axis=1)
        yield corners[different], any(isinstance(one, elements.Close) for one in segments)


def _points_of(elements: Any, segment: Any, steps: Callable[[Any], int]) -> list[complex]:
    """Return the end of a segment, after points between for a curve."""
    if segment.end is None:
        return []
    if isinstance(segment, (elements.Move, elements.Line, elements.Close)):
        return [_complex(segment.end)]
    count = steps(segment)
    inner = curve_of(segment)(np.arange(1, count) / count)
    return [*inner.tolist(), _complex(segment.end)]


def curve_of(segment: Any) -> Callable[[FloatArray], Any]:
    """Return what gives the points of an arc or a curve, as complex numbers, by its parameters."""
    elements = optional("svgelements", "svgelements")
    if isinstance(segment, elements.Arc) and segment.sweep:
        ends = (segment.start, segment.center, segment.prx, segment.pry)
        start, center, across, along = map(_complex, ends)
        if across != center and along != center:
            return _arc_of(
                start - center, center, across - center, abs(along - center), float(segment.sweep)
            )

    def curve(parameters: FloatArray) -> Any:
        points = np.asarray(segment.npoint(parameters), dtype=np.float64).reshape(-1, 2)
        return points[:, 0] + 1j * points[:, 1]

    return curve


def _arc_of(
    first: complex, center: complex, wide: complex, height: float, sweep: float
) -> Callable[[FloatArray], Any]:
    """Return the points of an arc by its parameters.

    svgelements measures the arc again at each call, which takes ten times as long as the points.

    Parameters
    ----------
    first, wide : complex
        Its beginning and the end of its first axis, seen from its center.
    center : complex
    height : float
        Half of its other axis.
    sweep : float
        How far it goes.
    """
    width = abs(wide)
    high = 1j * height * wide / width
    begins = first / wide
    start = math.atan2(begins.imag * width / height, begins.real)

    def curve(parameters: FloatArray) -> Any:
        angles = start + sweep * parameters
        return center + wide * np.cos(angles) + high * np.sin(angles)

    return curve


def _complex(point: Any) -> complex:
    return complex(float(point.x), float(point.y))


def _within(shape: Any, chord: float) -> Callable[[Any], int]:
    """Return how many chords stay within a tolerance, which is given in user units."""
    matrix = shape.transform
    linear = np.array([(matrix.a, matrix.c), (matrix.b, matrix.d)], dtype=np.float64)
    stretch = float(np.linalg.norm(linear, 2))
    return lambda segment: _steps(segment, chord / stretch if stretch else chord)


def _steps(segment: Any, chord: float) -> int:
    """Return how many chords stay within the tolerance, tried at points between."""
    curve, steps = curve_of(segment), 2
    while steps < 1 << 12:
        points = curve(np.arange(4 * steps + 1) / (4 * steps))
        inner = points[:-1].reshape(-1, 4)[:, 1:]
        if _distance(inner, points[:-4:4, None], points[4::4, None]) <= chord:
            break
        steps *= 2
    return steps


def _distance(points: Any, start: Any, end: Any) -> float:
    """Return the largest distance of points from the chords below them."""
    offset, along = points - start, end - start
    length = np.abs(along)
    with np.errstate(invalid="ignore", divide="ignore"):
        height = np.abs((offset * np.conj(along)).imag) / length
    return float(np.where(length > 0, height, np.abs(offset)).max())
