"""Conversion between linear colours of glTF and sRGB colours of attributes and materials.

# Source
IEC 61966-2-1 (sRGB); glTF 2.0, sections 3.7.2.1 and 3.9.2.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

from ..._types import FloatArray

#: The end of the straight part of the curve, on the screen and in light, and its slope.
_DARK, _DARK_LIGHT, _SLOPE = 0.04045, 0.0031308, 12.92

#: Of the curve above.
_SHIFT, _POWER = 0.055, 2.4

#: Digits of a colour that reads back as it was: the curve and its inverse err by some 1e-15.
_DIGITS = 12

_BYTE, _WORD = 255, 65535


def to_light(colors: npt.ArrayLike) -> FloatArray:
    """Return linear colours of sRGB colours from 0 to 1; a fourth number, opacity, stays."""
    values = np.array(colors, dtype=np.float64)
    shown = values[..., :3]
    curve = ((shown + _SHIFT) / (1 + _SHIFT)) ** _POWER
    values[..., :3] = np.where(shown <= _DARK, shown / _SLOPE, curve)
    return values


def to_screen(colors: npt.ArrayLike) -> FloatArray:
    """Return sRGB colours of linear colours from 0 to 1."""
    values = np.array(colors, dtype=np.float64)
    light = np.clip(values[..., :3], 0, 1)
    curve = (1 + _SHIFT) * light ** (1 / _POWER) - _SHIFT
    values[..., :3] = np.where(light <= _DARK_LIGHT, light * _SLOPE, curve)
    return values


def color_of(light: npt.ArrayLike) -> tuple[float, ...]:
    """Return the sRGB colour of one linear colour, as it is read."""
    return tuple(round(value, _DIGITS) for value in to_screen(light).tolist())


def as_read(color: tuple[float, ...]) -> tuple[float, ...]:
    """Return the colour that is read back after this one was written."""
    return color_of(to_light(color))


def words_of(colors: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint16]:
    """Return sRGB bytes as linear 16-bit numbers, which keep all bytes distinct."""
    found: npt.NDArray[np.uint16] = np.rint(to_light(colors / _BYTE) * _WORD).astype(np.uint16)
    return found


def shown(light: npt.NDArray[Any], is_whole: bool) -> npt.NDArray[Any]:
    """Return linear colours of a file as sRGB: bytes if the file has integers, else floats."""
    colors = to_screen(light)
    if is_whole:
        return np.rint(np.clip(colors, 0, 1) * _BYTE).astype(np.uint8)
    return colors.astype(np.float32)
