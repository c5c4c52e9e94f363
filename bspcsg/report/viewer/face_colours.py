"""The colour of each face of layers, for pictures, which have one colour for each face."""

import io
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ..._types import FloatArray, IndexArray
from ...errors import invalid_parameter
from .layer import Layer
from .paint import Colours, Labels, Paint

#: The colour of faces without a value on a scale.
_UNKNOWN = "#9aa2ab"

#: The names of paints that have the colours of the file itself.
OWN = ("material", "color")

#: The name that stands for one colour for each layer.
PART = "part"


def joined(layers: Sequence[Layer]) -> tuple[FloatArray, IndexArray]:
    """Return the vertices (n, 3) and faces (m, 3) of all layers, concatenated."""
    starts = np.cumsum([0, *(len(layer.vertices) for layer in layers)]).tolist()
    faces = [layer.faces + start for layer, start in zip(layers, starts, strict=False)]
    return np.concatenate([layer.vertices for layer in layers]), np.concatenate(faces)


def face_colours(layers: Sequence[Layer], name: str | None = None) -> FloatArray:
    """Return red, green and blue of all faces of all layers, (n, 3), from 0 to 1.

    Parameters
    ----------
    layers : sequence of Layer
    name : str, optional
        The name of a paint, or "part"; by default the materials or colours of the files. The faces
        of a layer without the paint have the colour of the layer.

    Raises
    ------
    InvalidParameterError
        If no layer has a paint of this name.
    """
    names = {paint.name for layer in layers for paint in layer.paints}
    if name is None:
        name = next((own for own in OWN if own in names), PART)
    if name != PART and name not in names:
        known = ", ".join(sorted({PART, *names}))
        raise invalid_parameter(
            f"there are no colours or attributes with the name {name!r}; known are {known}."
        )
    found = [_of_layer(layer, name) for layer in layers]
    return np.concatenate(found)


def are_textured(layers: Sequence[Layer]) -> bool:
    """Say whether a layer has textures; `face_colours` takes only one colour of them per face."""
    paints = [paint for layer in layers for paint in layer.paints]
    return any(
        isinstance(paint, Labels) and paint.uv is not None and any(paint.images)
        for paint in paints
        if paint.name in OWN
    )


def _of_layer(layer: Layer, name: str) -> FloatArray:
    paint = next((paint for paint in layer.paints if paint.name == name), None)
    if paint is None:
        return np.tile(_rgb([layer.colour]), (len(layer.faces), 1))
    return _of_paint(paint)


def _of_paint(paint: Paint) -> FloatArray:
    if isinstance(paint, Colours):
        values = paint.values[..., :3] / 255
        mean: FloatArray = values if values.ndim == 2 else values.mean(axis=1)
        return mean
    if isinstance(paint, Labels):
        plain = _rgb(paint.colours)[paint.numbers]
        return plain if paint.uv is None else plain * _textures(paint)
    values = paint.values if paint.values.ndim == 1 else paint.values.mean(axis=1)
    side = (paint.high - paint.low) or 1.0
    share = np.clip((np.where(np.isfinite(values), values, 0.0) - paint.low) / side, 0, 1)
    stops = _rgb(paint.stops)
    places = np.linspace(0, 1, len(stops))
    mixed = np.stack([np.interp(share, places, stops[:, k]) for k in range(3)], axis=1)
    shaded: FloatArray = np.where(np.isfinite(values)[:, None], mixed, _rgb([_UNKNOWN]))
    return shaded


def _textures(paint: Labels) -> FloatArray:
    """Return the texture's colour at the centroid of each face, (m, 3); white without texture."""
    found = np.ones((len(paint.numbers), 3))
    uv = np.zeros((len(found), 2)) if paint.uv is None else paint.uv.mean(axis=1)
    for label, data in enumerate(paint.images):
        chosen = np.flatnonzero(paint.numbers == label)
        pixels = None if data is None or not len(chosen) else _pixels(data)
        if pixels is not None:
            height, width, _ = pixels.shape
            column = np.floor(uv[chosen, 0] % 1 * width).astype(np.int64) % width
            row = np.floor((1 - uv[chosen, 1]) % 1 * height).astype(np.int64) % height
            found[chosen] = pixels[row, column] / 255
    return found


def _pixels(data: bytes) -> npt.NDArray[np.uint8] | None:
    """Return the pixels of a picture, (h, w, 3), or None if it cannot be read."""
    try:
        from PIL import Image

        with Image.open(io.BytesIO(data)) as image:
            return np.asarray(image.convert("RGB"))
    except (ImportError, OSError, ValueError):
        return None


def _rgb(colours: Sequence[str]) -> FloatArray:
    digits = [bytes.fromhex(colour[1:7]) for colour in colours]
    return np.array([list(one) for one in digits], dtype=np.float64).reshape(-1, 3) / 255
