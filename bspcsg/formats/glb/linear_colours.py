"""Conversion between glTF's linear colours and the sRGB colours of attributes and materials.

# Source
IEC 61966-2-1 (sRGB); glTF 2.0, sections 3.7.2.1 and 3.9.2.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

from ..._types import FloatArray

#: The end of the sRGB curve's straight part, as an sRGB and as a linear value, and its slope.
_DARK, _DARK_LIGHT, _SLOPE = 0.04045, 0.0031308, 12.92

#: The constants of the sRGB curve's power part.
_SHIFT, _POWER = 0.055, 2.4

#: Decimals to which a colour that is read is rounded, as the conversions err by about 1e-15.
_DIGITS = 12

_BYTE, _WORD = 255, 65535


def to_linear(colors: npt.ArrayLike) -> FloatArray:
    """Convert sRGB colours from 0 to 1 to linear colours; a fourth number, opacity, stays."""
    values = np.array(colors, dtype=np.float64)
    shown = values[..., :3]
    curve = ((shown + _SHIFT) / (1 + _SHIFT)) ** _POWER
    values[..., :3] = np.where(shown <= _DARK, shown / _SLOPE, curve)
    return values


def to_srgb(colors: npt.ArrayLike) -> FloatArray:
    """Convert linear colours from 0 to 1 to sRGB colours; a fourth number, opacity, stays."""
    values = np.array(colors, dtype=np.float64)
    light = np.clip(values[..., :3], 0, 1)
    curve = (1 + _SHIFT) * light ** (1 / _POWER) - _SHIFT
    values[..., :3] = np.where(light <= _DARK_LIGHT, light * _SLOPE, curve)
    return values


def color_of(light: npt.ArrayLike) -> tuple[float, ...]:
    """Convert one linear colour of a file to sRGB, rounded to `_DIGITS` decimals."""
    return tuple(round(value, _DIGITS) for value in to_srgb(light).tolist())


def as_read(color: tuple[float, ...]) -> tuple[float, ...]:
    """Return the sRGB colour that is read from a GLB file into which `color` was written."""
    return color_of(to_linear(color))


def linear_words(colors: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint16]:
    """Convert sRGB bytes to linear 16-bit integers, which are distinct for distinct bytes."""
    found: npt.NDArray[np.uint16] = np.rint(to_linear(colors / _BYTE) * _WORD).astype(np.uint16)
    return found


def srgb_colours(light: npt.NDArray[Any], is_whole: bool) -> npt.NDArray[Any]:
    """Convert linear colours of a file to sRGB: uint8 if the file has integers, else float32."""
    colors = to_srgb(light)
    if is_whole:
        return np.rint(np.clip(colors, 0, 1) * _BYTE).astype(np.uint8)
    return colors.astype(np.float32)
