"""Colours of facets as bytes, and their shading by light."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ..._types import FloatArray
from ...attributes.colours import as_bytes, colors_of, is_opaque, one_color
from ...errors import invalid_parameter

#: Red, green, blue (and opacity) from 0 to 255.
ColourArray = npt.NDArray[np.uint8]

#: The colour of facets when none is given.
DEFAULT = "#9db9d6"

#: The direction towards the light in camera coordinates: right, up, and away from the viewer.
_LIGHT = np.array([-0.25, 0.45, -0.85])
_LIGHT /= np.linalg.norm(_LIGHT)
_AMBIENT = 0.35


def colour(value: Any, name: str = "colour") -> ColourArray:
    """Return an opaque colour, in any form that `attributes.colours` reads, as (3,) uint8."""
    return _opaque(one_color(value, name), name)


def colours(values: Any, count: int, name: str = "colours") -> ColourArray:
    """Return one colour for all, or one for each, as (count, 3) uint8."""
    given = _opaque(colors_of(values, name), name)
    if given.ndim == 1:
        return np.tile(given, (count, 1))
    if given.shape != (count, 3):
        message = (
            f"{name} must be one colour or {count} colours in an array of shape ({count}, 3), not"
            f" {given.shape}."
        )
        raise invalid_parameter(message)
    return given


def _opaque(given: Any, name: str) -> ColourArray:
    """Return colours as bytes without their opacity, or raise an error if it is not 1."""
    if not is_opaque(given):
        raise invalid_parameter(
            f"The {name} must be opaque, because pictures cannot show transparent faces; set the"
            " opacity to 1 or leave it out."
        )
    return as_bytes(given[..., :3])


def shaded_colours(base: ColourArray, normals: FloatArray, axes: FloatArray) -> ColourArray:
    """Return facet colours shaded by Lambert's law, with light from above the viewer's left.

    Parameters
    ----------
    base : (k, 3) uint8
    normals : (k, 3) float64
        Unit normals towards the viewer.
    axes : (3, 3) float64
        The unit vectors right, up, and away from the viewer, as rows.
    """
    cosine = np.clip(normals @ (_LIGHT @ axes), 0, 1)
    strength = _AMBIENT + (1 - _AMBIENT) * cosine
    shaded: ColourArray = np.round(base * strength[:, None]).astype(np.uint8)
    return shaded
