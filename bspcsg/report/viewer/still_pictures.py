"""Small pictures of layers, drawn by the painter's algorithm, as data URLs."""

import base64
import io
from collections.abc import Sequence
from urllib.parse import quote

import numpy as np

from ...bsp import Camera, Picture
from ...bsp.painting.camera import View
from ...bsp.painting.picture import picture
from .face_colours import face_colours, joined
from .layer import DIFFERENCE, Layer, drawn_points

#: Meshes with more triangles than this are simplified first, to this number of grid cells along the
#: longest side: the triangles would be smaller than a pixel.
_MAX_TRIANGLES_DRAWN, _CELLS_PER_SIDE = 6_000, 96

#: The largest number of triangles of a picture 320 pixels wide that shows edges; more edges would
#: blacken it.
_MAX_TRIANGLES_WITH_EDGES = 1_500

#: The largest number of characters of a picture that is stored as SVG, not as pixels, and the
#: smallest number of characters of one polygon in SVG.
_MAX_PREFERRED_SVG_CHARACTERS, _MIN_POLYGON_CHARACTERS = 5_000, 40

#: The largest number of characters of an SVG picture if no picture of pixels can be made; a longer
#: one is omitted.
_MAX_SVG_CHARACTERS = 150_000

#: The quality of WebP pictures, from 0 to 100, and the effort of compression, from 0 to 6.
_QUALITY, _EFFORT = 66, 3


def camera_for(layers: Sequence[Layer], size: tuple[int, int], view: View = "iso") -> Camera:
    """Return a camera with all layers in its picture, by default from front, right and above."""
    return Camera.named(view, drawn_points(layers), size[0] / size[1])


def still_picture(
    layers: Sequence[Layer],
    camera: Camera | None = None,
    size: tuple[int, int] = (320, 240),
    edges: bool = True,
) -> str:
    """Return a picture of layers, all opaque, as a data URL; an empty string if it is too large.

    Parameters
    ----------
    layers : sequence of Layer
    camera : Camera, optional
        By default one with all layers in its picture.
    size : (int, int)
        Width and height in pixels.
    edges : bool
        True to draw the feature edges, unless there are too many.
    """
    if not any(len(layer.faces) for layer in layers):
        return ""
    painted = _painted(layers, camera or camera_for(layers, size), size, edges)
    least = len(painted.painting.source) * _MIN_POLYGON_CHARACTERS
    # Test the lower bound first, to avoid making a long SVG in vain.
    if least <= _MAX_PREFERRED_SVG_CHARACTERS and len(painted.svg) <= _MAX_PREFERRED_SVG_CHARACTERS:
        return _vector(painted.svg)
    pixels = _pixels(painted)
    if pixels:
        return pixels
    return _vector(painted.svg) if len(painted.svg) <= _MAX_SVG_CHARACTERS else ""


def rough_picture(layer: Layer, size: tuple[int, int], most: int, view: View = "iso") -> Picture:
    """Return a picture of a layer; a layer of more than `most` triangles is simplified.

    Parameters
    ----------
    layer : Layer
    size : (int, int)
        Width and height in pixels.
    most : int
    view : str
        The name of the point of view.
    """
    shape, cells = layer, _CELLS_PER_SIDE
    while len(shape.faces) > most and cells > 1:
        cells = cells * 2 // 3
        shape = layer.simplified(cells)
    return _painted([shape], camera_for([layer], size, view), size, edges=shape is layer)


def rings(
    places: Sequence[Sequence[float]], camera: Camera, size: tuple[int, int] = (320, 240)
) -> str:
    """Return a data URL of an SVG with a red ring around each point, as the camera projects it."""
    width, height = size
    flat = camera.flatten(camera.place(np.array(places))) * (height / 2)
    circles = "".join(
        f"<circle cx='{width / 2 + x:.1f}' cy='{height / 2 - y:.1f}' r='9'/>"
        for x, y in flat.tolist()
    )
    return _vector(
        f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {height}' fill='none'"
        f" stroke='{DIFFERENCE}' stroke-width='2'>{circles}</svg>"
    )


def _painted(
    layers: Sequence[Layer], camera: Camera, size: tuple[int, int], edges: bool
) -> Picture:
    count = sum(len(layer.faces) for layer in layers)
    whole = count <= _MAX_TRIANGLES_DRAWN
    meshes = list(layers) if whole else [layer.simplified(_CELLS_PER_SIDE) for layer in layers]
    colours = face_colours(meshes)
    return picture(
        joined(meshes),
        camera=camera,
        size=size,
        edges="feature" if edges and count <= _MAX_TRIANGLES_WITH_EDGES * size[0] / 320 else "none",
        colors=colours if len(colours) else None,
        background=None,
        line_width=1.0,
    )


def _vector(svg: str) -> str:
    return "data:image/svg+xml," + quote(svg.strip(), safe=" /:=,;'()-.")


def _pixels(painted: Picture) -> str:
    """Return a picture as a data URL of WebP; an empty string without Pillow."""
    try:
        from PIL import Image
    except ImportError:
        return ""
    buffer = io.BytesIO()
    with Image.open(io.BytesIO(painted.png)) as image:
        image.save(buffer, "WEBP", quality=_QUALITY, method=_EFFORT)
    return "data:image/webp;base64," + base64.b64encode(buffer.getvalue()).decode("ascii")
