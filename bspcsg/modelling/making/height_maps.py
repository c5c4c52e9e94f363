"""Solids below tables of heights (height maps)."""

import io
import os
import warnings
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..._types import FloatArray, Scalar, Vector
from ...errors import FormatError, format_errors, invalid_parameter
from ...formats.source import limited_content
from ...geometry.arrays import doubles
from ...geometry.polygon import directed_edges
from ...mesh.interop import import_optional
from ...parameters import number, positive, refuse_many_corners, truth_value, two_values
from ...shapes.sweep import quad_triangles
from ...solid.ledger import counted
from ...solid.solid import Solid

#: The height of a white pixel.
BRIGHTEST = 100.0

#: The weights of red, green and blue in a pixel's brightness.
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


class Heights(NamedTuple):
    """A table of heights, and the height of the flat underside.

    Parameters
    ----------
    table : (m, n) float64
        The heights; shorter rows of a file are filled with zeros.
    floor : float
        The height of the underside. By default it is 0, or the least height minus 1 if that is
        lower; filled zeros do not count.
    """

    table: FloatArray
    floor: float


@counted
def surface(
    heights: Any,
    *,
    cell: Scalar | Vector = 1.0,
    floor: Scalar | None = None,
    center: bool = False,
) -> Solid:
    """Return the solid between a table of heights and a flat underside.

    Parameters
    ----------
    heights : (m, n) array_like of float, or path
        A table with columns along x and rows along y, at least two of each; a text file of such
        rows; or a PNG picture, whose black is height 0 and white 100, its last row at y = 0.
    cell : float or (2,) float
        The distance between columns and between rows, in model units.
    floor : float, optional
        The height of the flat underside, below all heights. By default it is 0, or the least height
        minus 1 if that is lower, as in OpenSCAD.
    center : bool
        True if the middle of the table is at x = y = 0, instead of its first corner.

    Raises
    ------
    InvalidParameterError
        If the table has another shape, a number is not finite, or the floor is not below all
        heights.
    FormatError
        If a file is not a table of heights or a PNG picture.
    LimitError
        If the solid would have too many corners.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.surface([[1, 1, 1], [1, 4, 1], [1, 1, 1]]).volume
    7.0
    """
    if isinstance(heights, (str, os.PathLike)):
        path = Path(heights)
        read = read_picture(path) if path.suffix.lower() == ".png" else read_heights(path)
    else:
        read = heights_of(_table(heights))
    refuse_many_corners(2 * read.table.size, "This surface")
    width, depth = (positive(entry, "cell") for entry in two_values(cell, "cell"))
    if floor is not None:
        base, least = number(floor, "floor"), float(read.table.min())
        if base >= least:
            raise invalid_parameter(
                f"floor must be below all heights, the smallest of which is {least:g}, but is"
                f" {base:g}."
            )
        read = Heights(read.table, base)
    body = height_map(read, centered=truth_value(center, "center"))
    return body if width == depth == 1 else body.scale((width, depth, 1.0))


def heights_of(table: FloatArray) -> Heights:
    """Return a table with OpenSCAD's default floor: 0, or the least height minus 1 if lower."""
    return Heights(table, min(float(table.min()) - 1, 0.0))


def _table(heights: Any) -> FloatArray:
    table = doubles(
        heights, invalid_parameter("heights must be a two-dimensional array of numbers.")
    )
    if table.ndim != 2 or min(table.shape) < 2:
        raise invalid_parameter(
            f"heights must have at least two rows and two columns, but has shape {table.shape}."
        )
    if not np.isfinite(table).all():
        raise invalid_parameter("heights has an entry that is not a finite number.")
    return table


def read_heights(path: Path) -> Heights:
    """Return the table of heights in a text file.

    Raises
    ------
    FormatError
        If the file cannot be read, an entry is not a finite number, or there are fewer than two
        rows or columns.
    """
    lines = limited_content(path).decode("utf-8", errors="replace").splitlines()
    rows = [_row(path, k, line) for k, line in enumerate(lines, 1) if _holds_numbers(line)]
    columns = max(map(len, rows), default=0)
    if len(rows) < 2 or columns < 2:
        raise FormatError(
            f"{path}: a surface needs at least two rows and two columns of numbers.", "syntax"
        )
    table = np.array([row + [0.0] * (columns - len(row)) for row in rows])
    return Heights(table, min(min(map(min, rows)) - 1, 0.0))


def read_picture(path: Path) -> Heights:
    """Return a PNG picture's brightness as heights, bottom row first, from black 0 to white 100.

    The brightness of a colour is its luminance (ITU-R BT.709), as in OpenSCAD; opacity is ignored.

    Raises
    ------
    FormatError
        If the file is no PNG picture, or has fewer than two rows or columns.
    LimitError
        If it has too many pixels.
    MissingPartError
        If Pillow is not installed.
    """
    pillow = import_optional("PIL.Image", "pillow")
    with format_errors(str(path), "PNG"), warnings.catch_warnings():
        # Pictures that are too large are refused below.
        warnings.simplefilter("ignore", pillow.DecompressionBombWarning)
        picture = pillow.open(io.BytesIO(limited_content(path)), formats=["PNG"])
        refuse_many_corners(2 * picture.width * picture.height, "This surface")
        colours = _colours(picture)
    if min(colours.shape[:2]) < 2:
        raise FormatError(
            f"{path}: a surface needs at least two rows and two columns of pixels.", "syntax"
        )
    return heights_of((colours[::-1] @ _LUMINANCE) * (BRIGHTEST / 255))


def _colours(picture: Any) -> FloatArray:
    """Return red, green and blue of each pixel, (rows, columns, 3) float64 from 0 to 255."""
    if not picture.mode.startswith("I"):
        return np.asarray(picture.convert("RGB"), dtype=np.float64)
    # Of 16-bit values, use the upper 8 bits.
    upper = np.asarray(picture).astype(np.int64) >> 8
    return np.repeat(upper[:, :, None].astype(np.float64), 3, axis=2)


def _holds_numbers(line: str) -> bool:
    return bool(line.strip()) and not line.lstrip().startswith("#")


def _row(path: Path, number: int, line: str) -> list[float]:
    try:
        row = [float(word) for word in line.split()]
    except ValueError:
        # Do not quote the content, which may be confidential.
        raise FormatError(
            f"{path}:{number}: this line has an entry that is not a number.", "syntax", [number]
        ) from None
    if not np.isfinite(row).all():
        raise FormatError(
            f"{path}:{number}: this line has a height that is not a finite number.",
            "non_finite",
            [number],
        )
    return row


def height_map(heights: Heights, *, centered: bool) -> Solid:
    """Return the solid between a table of heights and its floor.

    Columns run along x and rows along y, one unit apart. The centre of each square of four table
    entries has their mean height.
    """
    rows, columns = heights.table.shape
    shift = -(np.array([columns, rows]) - 1) / 2 if centered else np.zeros(2)
    y, x = np.indices((rows, columns))
    corners = np.column_stack([x.ravel(), y.ravel(), heights.table.ravel()])
    middles = _middles(heights.table)
    rim = _rim(rows, columns)
    below = corners[rim] * (1, 1, 0) + (0, 0, heights.floor)
    vertices = np.concatenate([corners, middles, below]) + (*shift, 0)
    ids = np.arange(rows * columns).reshape(rows, columns)
    a, b, d, c = (part.ravel() for part in (ids[:-1, :-1], ids[:-1, 1:], ids[1:, :-1], ids[1:, 1:]))
    tips = len(corners) + np.arange(len(middles))
    top = [np.column_stack([s, e, tips]) for s, e in ((a, b), (b, c), (c, d), (d, a))]
    start, end = directed_edges([corners[rim]]).T
    low = len(corners) + len(middles)
    sides = quad_triangles(low + start, low + end, rim[start], rim[end])
    fan = np.arange(1, len(rim) - 1)
    bottom = np.column_stack([np.zeros_like(fan), fan + 1, fan]) + low
    return Solid(vertices, np.concatenate([*top, sides, bottom]))


def _middles(heights: FloatArray) -> FloatArray:
    z = (heights[:-1, :-1] + heights[:-1, 1:] + heights[1:, :-1] + heights[1:, 1:]) / 4
    y, x = np.indices(z.shape)
    return np.column_stack([x.ravel() + 0.5, y.ravel() + 0.5, z.ravel()])


def _rim(rows: int, columns: int) -> np.ndarray:
    """Return the numbers of the entries at the table's border, counter-clockwise from the first."""
    ids = np.arange(rows * columns).reshape(rows, columns)
    sides = (ids[0, :-1], ids[:-1, -1], ids[-1, :0:-1], ids[:0:-1, 0])
    return np.concatenate(sides)
