"""Drawings of rectangles with known areas, in the forms of this package and of other programs."""

import io
import tempfile
from fractions import Fraction
from pathlib import Path
from typing import TypeAlias

import numpy as np
from ezdxf.filemanagement import new

from bspcsg import bsp

Rng: TypeAlias = np.random.Generator

#: The distance between the rectangles.
_APART = 64


def random_drawing(rng: Rng, suffix: str) -> tuple[bytes, Fraction]:
    """Return a random SVG or DXF file, and the area that it encloses."""
    width, height = rng.integers(1, 9, 2).tolist()
    if rng.random() < 0.5:
        return _own(suffix, width, height), Fraction(width * height)
    scales = rng.integers(1, 4, (int(rng.integers(1, 4)), 2)).tolist()
    area = Fraction(sum(width * height * x * y for x, y in scales))
    draw = _views if suffix == ".svg" else _blocks
    return draw(rng, width, height, scales), area


def _own(suffix: str, width: int, height: int) -> bytes:
    region = bsp.Region.rectangle(width, height)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"x{suffix}"
        (region.to_svg if suffix == ".svg" else region.to_dxf)(path)
        return path.read_bytes()


def _views(rng: Rng, width: int, height: int, scales: list[list[int]]) -> bytes:
    """Return an SVG with one rectangle drawn several times, in nested views or as a symbol."""
    shape = f'<rect width="{width}" height="{height}"/>'
    box = f'viewBox="0 0 {width} {height}" preserveAspectRatio="none"'
    body = f'<symbol id="s" {box}>{shape}</symbol>'
    for place, (x, y) in enumerate(scales):
        at = f'x="{_APART * place}" width="{width * x}" height="{height * y}"'
        kind = int(rng.integers(3))
        if kind == 0:
            body += f'<use href="#s" {at}/>'
        elif kind == 1:
            body += f"<svg {at} {box}>{shape}</svg>"
        else:
            move = f'transform="translate({_APART * place} 7) scale({x} {y})"'
            body += f"<g {move}><clipPath>{shape}</clipPath>{shape}</g>"
    return f'<svg xmlns="http://www.w3.org/2000/svg">{body}</svg>'.encode()


def _blocks(rng: Rng, width: int, height: int, scales: list[list[int]]) -> bytes:
    """Return a DXF with one rectangle drawn several times as a block, also in nested blocks."""
    document = new()
    content = document.blocks.new("inner")
    corners = [(0, 0), (width, 0), (width, height), (0, height)]
    if rng.random() < 0.5:
        content.add_lwpolyline(corners, close=True)
    else:
        for start, end in zip(corners, [*corners[1:], corners[0]], strict=True):
            content.add_line(start, end)
    document.blocks.new("outer").add_blockref("inner", (1, 2))
    for place, (x, y) in enumerate(scales):
        name = "outer" if rng.random() < 0.5 else "inner"
        attributes = {"xscale": x * rng.choice([-1, 1]), "yscale": y}
        document.modelspace().add_blockref(name, (_APART * place, 0), dxfattribs=attributes)
    text = io.StringIO()
    document.write(text)
    return text.getvalue().encode()
