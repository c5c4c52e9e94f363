"""Colours as numbers, and how light changes them."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ..._types import FloatArray
from ...errors import invalid_parameter
from ...geometry.arrays import axes_of, doubles
from ...parameters import shown

#: Red, green, blue (and cover) from 0 to 255.
ColourArray = npt.NDArray[np.uint8]

#: The colour of facets when none is given.
DEFAULT = "#9db9d6"

_NAMES = {"white": "#ffffff", "black": "#000000"}

#: The direction that the light comes from: the right, above, and away from the viewer.
_LIGHT = np.array([-0.25, 0.45, -0.85])
_LIGHT /= np.linalg.norm(_LIGHT)
_AMBIENT = 0.35


def colour(value: Any, name: str = "colour") -> ColourArray:
    """Return (3,) uint8 of "#rgb", "#rrggbb", "white", "black", or three numbers from 0 to 1."""
    if isinstance(value, str):
        digits = _NAMES.get(value, value).removeprefix("#")
        wide = "".join(2 * digit for digit in digits) if len(digits) == 3 else digits
        try:
            return np.frombuffer(bytes.fromhex(wide), dtype=np.uint8).reshape(3).copy()
        except ValueError as error:
            message = (
                f"The {name} must be like '#3070b0' or three numbers from 0 to 1: {shown(value)}."
            )
            raise invalid_parameter(message) from error
    single: ColourArray = colours(
        np.asarray(value)[None] if axes_of(value) == 1 else value, 1, name
    )[0]
    return single


def colours(values: Any, count: int, name: str = "colours") -> ColourArray:
    """Return (count, 3) uint8 of one colour for all, or of (count, 3) numbers from 0 to 1."""
    is_row = axes_of(values) == 1 and len(values) > 0
    if is_row and isinstance(values[0], str):
        return _each(values, count, name)
    if isinstance(values, str) or (is_row and len(values) == 3):
        return np.tile(colour(values, name), (count, 1))
    given = doubles(values, invalid_parameter(f"The {name} must be numbers from 0 to 1."))
    if given.shape != (count, 3):
        raise invalid_parameter(f"The {name} must have shape ({count}, 3), not {given.shape}.")
    if not ((given >= 0) & (given <= 1)).all():
        raise invalid_parameter(f"The {name} must be numbers from 0 to 1.")
    return np.round(given * 255).astype(np.uint8)


def _each(values: Any, count: int, name: str) -> ColourArray:
    if len(values) != count:
        raise invalid_parameter(f"There must be {count} {name}, not {len(values)}.")
    return np.stack([colour(value, name) for value in values])


def lit(base: ColourArray, normals: FloatArray, axes: FloatArray) -> ColourArray:
    """Return colours of facets by Lambert's law, with light over the viewer's left shoulder.

    Parameters
    ----------
    base : (k, 3) uint8
    normals : (k, 3) float64
        Unit normals towards the viewer.
    axes : (3, 3) float64
        Of the camera.
    """
    cosine = np.clip(normals @ (_LIGHT @ axes), 0, 1)
    strength = _AMBIENT + (1 - _AMBIENT) * cosine
    shaded: ColourArray = np.round(base * strength[:, None]).astype(np.uint8)
    return shaded


def hexadecimal(value: ColourArray) -> str:
    """Return "#rrggbb"."""
    return "#" + bytes(value[:3].tolist()).hex()
