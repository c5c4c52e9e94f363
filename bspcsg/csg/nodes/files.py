"""Shapes from files: import and surface."""

import os
from pathlib import Path

import numpy as np

from ...bsp import Region
from ...bsp.drawings.left_out import LeftOut
from ...formats.files import read
from ...formats.registry import FORMATS
from ...modelling.making.heights import (
    BRIGHTEST,
    height_map,
    heights_of,
    read_heights,
    read_picture,
)
from ...solid.solid import Solid
from ..making.drawings import dxf_region
from ..making.paper import svg_region
from ..syntax.arguments import Arguments
from ..syntax.tree import Node
from .registry import Evaluation, Geometry, node

#: Pixels per inch of drawings that do not say, and the fewest that count.
_DPI, _LEAST_DPI = 72.0, 0.001


@node("import")
def import_file(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Read a mesh (STL, OFF, OBJ, PLY, 3MF) or a drawing (DXF, SVG)."""
    del children
    arguments = run.arguments(owner, ("file",))
    path = _path(arguments, run)
    suffix = path.suffix.lower()
    if suffix == ".dxf":
        return _dxf(path, owner, arguments, run, arguments.number("scale", 1.0))
    if suffix == ".svg":
        return _svg(path, owner, arguments, run)
    if suffix not in FORMATS:
        known = ", ".join(sorted([*FORMATS, ".dxf", ".svg"]))
        message = f"“{suffix}” files are not supported; known are {known}."
        raise arguments.error(message, "unsupported")
    raw = read(path)
    if raw.is_empty_set:
        return Solid.empty()
    return run.closed_solid(owner, raw.vertices, raw.faces)


def drawing_of(owner: Node, arguments: Arguments, run: Evaluation) -> Region:
    """Return the DXF file that an extrusion names, as scripts of before 2013 have it."""
    # What an extrusion scales is its upper end.
    return _dxf(_path(arguments, run), owner, arguments, run, 1.0)


def _svg(path: Path, owner: Node, arguments: Arguments, run: Evaluation) -> Region:
    dpi = arguments.number("dpi", _DPI)
    if dpi < _LEAST_DPI:
        run.warn(owner, f"its dpi must be {_LEAST_DPI:g} or more; it is {_DPI:g} instead")
        dpi = _DPI
    for name in ("id", "layer"):
        if arguments.value(name) not in (None, ""):
            run.warn(owner, f"all of the drawing is read: its {name} does not count")
    lost = LeftOut()
    return _told(owner, run, lost, svg_region(path, dpi, arguments.flag("center"), lost))


def _dxf(path: Path, owner: Node, arguments: Arguments, run: Evaluation, scale: float) -> Region:
    origin = arguments.vector("origin", 2, (0.0, 0.0))
    layer = arguments.text("layer", "")
    lost = LeftOut()
    region = dxf_region(path, layer, np.array(origin), scale, arguments, lost)
    return _told(owner, run, lost, region)


def _told(owner: Node, run: Evaluation, lost: LeftOut, region: Region) -> Region:
    """Return the region of a drawing; the caller is told what it lacks."""
    words = lost.words(region)
    if words:
        name = run.arguments(owner, ("file",)).text("file")
        run.warn(owner, f"{name}: {words}")
    return region


@node("surface")
def surface(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Make the body below a table of heights: a text file of numbers, or a picture's brightness."""
    del children
    arguments = run.arguments(owner, ("file", "center", "convexity", "invert"))
    path = _path(arguments, run)
    is_picture = path.suffix.lower() == ".png"
    heights = read_picture(path) if is_picture else read_heights(path)
    if is_picture and arguments.flag("invert"):
        # One less the brightness that OpenSCAD counts from 0 to 255.
        heights = heights_of(BRIGHTEST / 255 - heights.table)
    arguments.limited(heights.table.size * 2, "this surface")
    return height_map(heights, centered=arguments.flag("center"))


def _path(arguments: Arguments, run: Evaluation) -> Path:
    name = arguments.text("file")
    path = run.folder / name
    # What lies elsewhere is refused first, so that nobody learns whether it is there.
    if name and "\0" not in name and not _is_allowed(path, run):
        message = (
            f"the file “{name}” lies outside the script's folder; --allow-path DIR (in Python,"
            " allow_paths) names further folders that may be read."
        )
        raise arguments.error(message, "forbidden_path")
    # Names that no file can have, for they are too long, are no files either.
    if not name or not os.path.isfile(path):
        message = f"there is no file “{name}”; names are relative to the script's folder."
        raise arguments.error(message, "missing_file")
    return path


def _is_allowed(path: Path, run: Evaluation) -> bool:
    """Say whether a file, links followed, lies where the script may read."""
    try:
        target = path.resolve()
        return any(target.is_relative_to(one) for one in (run.folder.resolve(), *run.allowed))
    except (OSError, RuntimeError):  # links that lead in a circle
        return False
