"""Evaluation of the nodes that read files: import and surface."""

import os
from pathlib import Path

import numpy as np

from ...bsp import Region
from ...bsp.drawings.unread_content import UnreadContent
from ...formats.files import read
from ...formats.registry import FORMATS
from ...modelling.making.height_maps import (
    BRIGHTEST,
    height_map,
    heights_of,
    read_heights,
    read_picture,
)
from ...solid.solid import Solid
from ..making.dxf_import import dxf_region
from ..making.svg_import import svg_region
from ..syntax.arguments import Arguments
from ..syntax.tree import Node, Value
from .registry import Evaluation, Geometry, node
from .signature import Signature

#: The default and the smallest accepted number of pixels per inch of a drawing.
_DEFAULT_DPI, _MIN_DPI = 72.0, 0.001

#: Arguments that only some types of files use, with the default values that OpenSCAD writes.
_DEFAULT_ARGUMENTS: dict[str, Value] = {
    "id": "", "layer": "", "origin": (0.0, 0.0), "scale": 1.0, "dpi": _DEFAULT_DPI,
}  # fmt: skip


_IMPORT = Signature(
    ("file", "layer", "convexity", "origin", "scale"), ("center", "dpi", "id", "timestamp")
)


@node("import", takes=_IMPORT)
def import_file(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Read a mesh (STL, OFF, OBJ, PLY, 3MF) or a drawing (DXF, SVG)."""
    del children
    arguments = run.arguments(owner)
    path = _path(arguments, run)
    suffix = path.suffix.lower()
    if suffix == ".dxf":
        _tell_of_unused(owner, arguments, run, ("layer", "origin", "scale"))
        drawing = _dxf(path, owner, arguments, run, arguments.number("scale", 1.0))
        bounds = drawing.bounds if arguments.flag("center") else None
        return drawing if bounds is None else drawing.translate(*(-bounds.mean(axis=0)).tolist())
    if suffix == ".svg":
        _tell_of_unused(owner, arguments, run, ("dpi",))
        return _svg(path, owner, arguments, run)
    if suffix not in FORMATS:
        known = ", ".join(sorted([*FORMATS, ".dxf", ".svg"]))
        message = f"“{suffix}” files are not supported; known are {known}."
        raise arguments.error(message, "unsupported")
    _tell_of_unused(owner, arguments, run, ())
    raw = read(path)
    if raw.is_empty_set:
        return Solid.empty()
    vertices = raw.vertices
    if arguments.flag("center") and len(raw.faces):
        there = vertices[np.unique(raw.faces)]
        vertices = vertices - (there.min(axis=0) + there.max(axis=0)) / 2
    return run.closed_solid(owner, vertices, raw.faces)


def _tell_of_unused(
    owner: Node, arguments: Arguments, run: Evaluation, used: tuple[str, ...]
) -> None:
    """Warn of arguments that a file of this type ignores, unless they have default values."""
    for name, nothing in _DEFAULT_ARGUMENTS.items():
        if name not in used and arguments.value(name) not in (None, nothing):
            run.warn(
                owner, f"its {name} is ignored for this file format, whose files are read whole"
            )


def drawing_of(owner: Node, arguments: Arguments, run: Evaluation) -> Region:
    """Return the DXF drawing that an extrusion names, as in scripts from before 2013."""
    # The argument `scale` of an extrusion scales its upper end, not the drawing.
    return _dxf(_path(arguments, run), owner, arguments, run, 1.0)


def _svg(path: Path, owner: Node, arguments: Arguments, run: Evaluation) -> Region:
    dpi = arguments.number("dpi", _DEFAULT_DPI)
    if dpi < _MIN_DPI:
        run.warn(
            owner,
            f"its dpi must be at least {_MIN_DPI:g}, not {dpi:g}; {_DEFAULT_DPI:g} is used instead",
        )
        dpi = _DEFAULT_DPI
    lost = UnreadContent()
    region = svg_region(path, dpi, arguments.flag("center"), lost)
    return _with_warning(owner, run, arguments.text("file"), lost, region)


def _dxf(path: Path, owner: Node, arguments: Arguments, run: Evaluation, scale: float) -> Region:
    origin = arguments.vector("origin", 2, (0.0, 0.0))
    layer = arguments.text("layer", "")
    lost = UnreadContent()
    region = dxf_region(path, layer, np.array(origin), scale, arguments, lost)
    return _with_warning(owner, run, arguments.text("file"), lost, region)


def _with_warning(
    owner: Node, run: Evaluation, name: str, lost: UnreadContent, region: Region
) -> Region:
    """Return the region of a drawing unchanged, and warn of its omitted entities."""
    words = lost.warning_text(region)
    if words:
        run.warn(owner, f"{name}: {words}")
    return region


@node("surface", takes=Signature(("file", "center", "convexity", "invert"), ("timestamp",)))
def surface(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Make the solid below a table of heights, from a text file or the brightness of a picture."""
    del children
    arguments = run.arguments(owner)
    path = _path(arguments, run)
    is_picture = path.suffix.lower() == ".png"
    heights = read_picture(path) if is_picture else read_heights(path)
    if is_picture and arguments.flag("invert"):
        # OpenSCAD subtracts the brightness, which it counts from 0 to 255, from 1.
        heights = heights_of(BRIGHTEST / 255 - heights.table)
    arguments.limited(heights.table.size * 2, "this surface")
    return height_map(heights, centered=arguments.flag("center"))


def _path(arguments: Arguments, run: Evaluation) -> Path:
    name = arguments.text("file")
    path = run.folder / name
    # Refuse forbidden files first, so that the error does not reveal whether they exist.
    if name and "\0" not in name and not _is_allowed(path, run):
        message = (
            f"the file “{name}” lies outside the script's folder and is not read; allow its"
            " folder with --allow-path DIR, or allow_paths in Python."
        )
        raise arguments.error(message, "forbidden_path")
    # A name that is too long for any file counts as a missing file.
    if not name or not os.path.isfile(path):
        message = (
            f"the file “{name}” does not exist; file names are relative to the script's folder."
        )
        raise arguments.error(message, "missing_file")
    return path


def _is_allowed(path: Path, run: Evaluation) -> bool:
    """Return True if a file is in an allowed folder after links are resolved."""
    try:
        target = path.resolve()
        return any(target.is_relative_to(one) for one in (run.folder.resolve(), *run.allowed))
    except (OSError, RuntimeError):  # links that lead in a circle
        return False
