"""Reduce an SVG drawing to plain groups of visible elements before svgelements reads it.

Nested views and symbols become groups with a transform, because svgelements does not fit them into
their viewports. It also draws symbols, masks and markers where they are declared.

# Source
SVG 2, sections 5 (structure), 7.11 (the initial view box) and 8.2 (fitting a view box).
"""

import math
import re
from xml.etree.ElementTree import Element

from ...mesh.interop import import_optional

#: Elements that are not drawn where they are declared, but whose content may be used elsewhere.
_DECLARED = frozenset({"symbol", "mask", "marker", "pattern", "clipPath"})

#: Elements that draw something other than shapes; a `switch` is one if none of its children fits.
NO_SHAPES = frozenset(
    {"text", "image", "foreignObject", "switch", "video", "audio", "canvas", "iframe"}
)

#: Elements that draw nothing, although their content may look like shapes.
_UNDRAWN = frozenset({"metadata", "glyph", "missing-glyph"})

#: Elements that a `switch` ignores.
_IGNORED_IN_SWITCH = frozenset({"title", "desc", "defs", "style", "script"})

#: The language that is chosen if a drawing has several.
_LANGUAGE = "en"

#: The attributes that must not be negative, by the name of the element.
_SIZES = {"rect": ("width", "height"), "circle": ("r",), "ellipse": ("rx", "ry")}

#: The largest number of elements that ``use`` elements draw, counted at each use.
_MAX_ELEMENTS_SHOWN = 1 << 17

#: The largest depth of ``use`` elements that are nested in each other.
_MAX_USE_DEPTH = 64

#: The attributes that reference the used element.
HREF = ("href", "{http://www.w3.org/1999/xlink}href")

#: A width and a height in user units, or None if they are not known.
_Size = tuple[float, float] | None


def name_of(element: Element) -> str:
    """Return the name of an XML element without its namespace."""
    return str(element.tag).rpartition("}")[2]


def make_plain(root: Element) -> None:
    """Reduce a drawing to groups, shapes, texts and uses, in the outermost element's user units.

    Raises
    ------
    ValueError
        If ``use`` elements contain themselves, or draw too many elements.
    """
    _remove_undrawn(root)
    size = _size_of_root(root)
    for parent in list(root.iter()):
        if name_of(parent) == "switch":
            _switch(parent)
    _check_uses(root)
    _flatten(root, size)
    for name in ("x", "y", "preserveAspectRatio", "viewBox", "width", "height"):
        root.attrib.pop(name, None)
    if size is not None:
        # Percentages refer to the width and the height.
        width, height = (repr(value) for value in size)
        root.attrib |= {"width": width, "height": height, "viewBox": f"0 0 {width} {height}"}


def _remove_undrawn(root: Element) -> None:
    """Remove elements that draw nothing, and shapes without their necessary attributes."""
    for parent in list(root.iter()):
        foreign = name_of(parent) == "foreignObject"
        parent[:] = [child for child in parent if not foreign and _is_drawn(child)]


def _is_drawn(element: Element) -> bool:
    name = name_of(element)
    sizes = [element.get(size, "") for size in _SIZES.get(name, ())]
    if name in _UNDRAWN or any(size.strip().startswith("-") for size in sizes):
        return False
    if name == "text":
        return any(text.strip() for text in element.itertext())
    return name != "path" or bool(element.get("d"))


def _switch(element: Element) -> None:
    """Make a ``switch`` element a group with its first child that fits, if any child does."""
    shown = [child for child in element if name_of(child) not in _IGNORED_IN_SWITCH]
    first = next(filter(_is_supported, shown), None)
    element[:] = [child for child in element if child is first or child not in shown]
    if first is not None or not shown:
        element.tag = _tag(element, "g")


def _is_supported(element: Element) -> bool:
    """Return true if a child of a ``switch`` needs no extension and has a suitable language."""
    if name_of(element) == "foreignObject" or element.get("requiredExtensions"):
        return False
    languages = element.get("systemLanguage")
    if languages is None:
        return True
    return any(one.strip().lower().split("-")[0] == _LANGUAGE for one in languages.split(","))


def _check_uses(root: Element) -> None:
    named = {element.attrib["id"]: element for element in root.iter() if element.get("id")}
    #: For each used id: the number of elements that it draws, and the depth of nested uses in it.
    known: dict[str, tuple[int, int]] = {}

    def shown(element: Element, outer: int) -> tuple[int, int]:
        if outer > _MAX_USE_DEPTH:
            raise ValueError(f"its <use> elements are nested deeper than {_MAX_USE_DEPTH} levels")
        count = depth = 0
        for inner in element.iter():
            target = _target(inner) if name_of(inner) == "use" else ""
            if target in named and target not in known:
                known[target] = shown(named[target], outer + 1)
            more, deeper = known.get(target, (0, -1))
            count, depth = count + 1 + more, max(depth, deeper + 1)
        return count, depth

    count, depth = shown(root, 0)
    if depth > _MAX_USE_DEPTH:
        raise ValueError(f"its <use> elements are nested deeper than {_MAX_USE_DEPTH} levels")
    if count > _MAX_ELEMENTS_SHOWN + sum(1 for _ in root.iter()):
        raise ValueError(f"its <use> elements repeat more than {_MAX_ELEMENTS_SHOWN} elements")


def _target(use: Element) -> str:
    """Return the id of the element that a ``use`` references; "" if it is in another file."""
    reference = next((use.get(key, "") for key in HREF if use.get(key)), "")
    return reference[1:] if reference[:1] == "#" else ""


def _flatten(root: Element, size: _Size) -> None:
    """Replace nested views, symbols and uses of symbols by groups with transforms."""
    symbols = {
        element.get("id"): dict(element.attrib)
        for element in root.iter()
        if name_of(element) == "symbol"
    }
    waiting = [(root, size)]
    while waiting:
        element, outer = waiting.pop()
        for place, child in enumerate(element):
            name, inner = name_of(child), outer
            if name == "svg":
                inner = _group(child, dict(child.attrib), outer)
            elif name == "use" and _target(child) in symbols:
                element[place] = _of_symbol(child, symbols[_target(child)], outer)
                continue
            elif name in _DECLARED:
                element[place] = _declaration(child)
            waiting.append((child, inner))


def _declaration(element: Element) -> Element:
    """Return a ``defs`` element around an element, which becomes a group."""
    around = Element(_tag(element, "defs"))
    element.tag = _tag(element, "g")
    for name in ("viewBox", "preserveAspectRatio"):
        element.attrib.pop(name, None)
    around.append(element)
    return around


def _of_symbol(use: Element, symbol: dict[str, str], outer: _Size) -> Element:
    """Return a group that draws a symbol as a ``use`` of it does."""
    around = Element(_tag(use, "g"), dict(use.attrib))
    view = symbol | {key: use.attrib[key] for key in ("width", "height") if key in use.attrib}
    _group(around, view | {key: use.get(key, "0") for key in ("x", "y")}, outer)
    references = {key: around.attrib.pop(key) for key in HREF if key in around.attrib}
    around.append(Element(use.tag, references))
    return around


def _tag(like: Element, name: str) -> str:
    return like.tag[: -len(name_of(like))] + name


def _group(element: Element, view: dict[str, str], outer: _Size) -> _Size:
    """Make an element a group with the transform of a view; return the view's own size or None."""
    wide, high = outer or (None, None)
    view = {key: value for key, value in view.items() if value.strip() != "auto"}
    x, y = (_length(view.get(key, "0"), whole) or 0.0 for key, whole in (("x", wide), ("y", high)))
    width = _length(view.get("width", "100%"), wide)
    height = _length(view.get("height", "100%"), high)
    box = _view_box(view)
    scales, inner = (1.0, 1.0), None if width is None or height is None else (width, height)
    left = top = 0.0
    if box is not None:
        left, top, inner = box[0], box[1], (box[2], box[3])
        if width is not None and height is not None:
            scales = (width / box[2], height / box[3])
            spare, scales = _view_fit(view.get("preserveAspectRatio", ""), scales, (width, height))
            x, y = x + spare[0], y + spare[1]
    moved = (x - left * scales[0], y - top * scales[1])
    own = element.get("transform", "")
    matrix = f"matrix({scales[0]!r} 0 0 {scales[1]!r} {moved[0]!r} {moved[1]!r})"
    for key in ("x", "y", "width", "height", "viewBox", "preserveAspectRatio"):
        element.attrib.pop(key, None)
    element.attrib["transform"] = f"{own} {matrix}".strip()
    element.tag = _tag(element, "g")
    return inner


def _view_fit(
    rule: str, scales: tuple[float, float], size: tuple[float, float]
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the offset and the scales (x, y) by ``preserveAspectRatio``, as ``xMidYMid meet``."""
    words = rule.split() or ["xMidYMid"]
    if words[0] == "none":
        return (0.0, 0.0), scales
    scale = max(scales) if words[-1] == "slice" else min(scales)
    share = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
    x, y = (share.get(words[0][k : k + 3], 0.5) for k in (1, 5))
    width, height = size
    spare = (width * (1 - scale / scales[0]) * x, height * (1 - scale / scales[1]) * y)
    return spare, (scale, scale)


def _size_of_root(root: Element) -> _Size:
    box = _view_box(dict(root.attrib))
    if box is not None:
        return box[2], box[3]
    width, height = (_length(root.get(key, ""), None) for key in ("width", "height"))
    return (width, height) if width and height and min(width, height) > 0 else None


def _view_box(view: dict[str, str]) -> tuple[float, float, float, float] | None:
    """Return left, top, width and height of a view box, or None if it is not valid."""
    words = [word for word in re.split(r"[\s,]+", view.get("viewBox", "")) if word]
    try:
        left, top, width, height = map(float, words)
    except ValueError:
        return None
    is_proper = all(map(math.isfinite, (left, top))) and all(
        0 < size < math.inf for size in (width, height)
    )
    return (left, top, width, height) if is_proper else None


def _length(text: str, whole: float | None) -> float | None:
    """Return a length in user units; None if it is no length, or relative to an unknown `whole`."""
    if not text or ("%" in text and whole is None):
        return None
    elements = import_optional("svgelements", "svgelements")
    try:
        value = elements.Length(text).value(ppi=96.0, relative_length=whole)
    except ValueError:
        return None
    is_known = isinstance(value, (int, float)) and math.isfinite(value)
    return float(value) if is_known else None
