"""Small pictures of layers by the painter's algorithm, as addresses that hold the picture."""

import base64
import io
from collections.abc import Sequence
from urllib.parse import quote

import numpy as np

from ..bsp import Camera, Picture, picture
from .layer import Layer, bounds_of

#: Triangles above which a mesh is simplified first: more are smaller than a pixel.
_MOST_TRIANGLES = 12_000

#: Characters up to which a picture stays SVG, which is sharp at every size.
_FEW_CHARACTERS = 5_000

#: Characters of SVG above which there is no picture if none of pixels can be made.
_MOST_CHARACTERS = 150_000

#: Of WebP, from 0 to 100.
_QUALITY = 68


def camera_for(layers: Sequence[Layer], size: tuple[int, int]) -> Camera:
    """Return a camera that sees all layers, from the right front top."""
    low, high = bounds_of(layers)
    corners = np.array([[low, high][k >> a & 1][a] for k in range(8) for a in range(3)])
    return Camera.named("iso", corners.reshape(8, 3), size[0] / size[1])


def still(
    layers: Sequence[Layer], camera: Camera | None = None, size: tuple[int, int] = (320, 240)
) -> str:
    """Return a picture of opaque layers as the address of an image, or nothing if it is too large.

    Parameters
    ----------
    layers : sequence of Layer
    camera : Camera, optional
        By default one that sees all of them.
    size : (int, int)
        Width and height in pixels.
    """
    shown = [layer for layer in layers if len(layer.faces)]
    if not shown:
        return ""
    painted = _painted(shown, camera or camera_for(shown, size), size)
    if len(painted.svg) <= _FEW_CHARACTERS:
        return _vector(painted.svg)
    pixels = _pixels(painted)
    if pixels:
        return pixels
    return _vector(painted.svg) if len(painted.svg) <= _MOST_CHARACTERS else ""


def _painted(layers: Sequence[Layer], camera: Camera, size: tuple[int, int]) -> Picture:
    whole = sum(len(layer.faces) for layer in layers) <= _MOST_TRIANGLES
    meshes = list(layers) if whole else [layer.simplified() for layer in layers]
    starts = np.cumsum([0, *(len(layer.vertices) for layer in meshes)])
    vertices = np.concatenate([layer.vertices for layer in meshes])
    pairs = list(zip(meshes, starts, strict=False))
    faces = np.concatenate([layer.faces + start for layer, start in pairs])
    colours = [layer.colour for layer in meshes for _ in range(len(layer.faces))]
    return picture(
        (vertices, faces),
        camera=camera,
        size=size,
        # Bends of a simplified mesh are not those of the shape.
        edges="feature" if whole else "none",
        colors=colours or None,
        background=None,
        line_width=1.0,
    )


def _vector(svg: str) -> str:
    return "data:image/svg+xml," + quote(svg.strip(), safe=" /:=,;'()-.")


def _pixels(painted: Picture) -> str:
    """Return the picture as WebP, or nothing if Pillow is not there."""
    try:
        from PIL import Image
    except ImportError:
        return ""
    buffer = io.BytesIO()
    with Image.open(io.BytesIO(painted.png)) as image:
        image.save(buffer, "WEBP", quality=_QUALITY, method=6)
    return "data:image/webp;base64," + base64.b64encode(buffer.getvalue()).decode("ascii")
