"""Paints, ways to colour the faces of a layer: by labels, on a scale, or with explicit colours."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ..._types import FloatArray, IndexArray

#: The elements of a mesh that have a value each.
PaintedElements: TypeAlias = Literal["face", "corner"]

#: Colours of labels in order; after the last colour, the first one is used again.
PALETTE = (
    "#6f9bd1", "#e0a458", "#7fb285", "#a98bc9", "#c98b8b", "#79b7bd", "#b8a46a", "#8d99ae",
    "#d48fb0", "#94b35c",
)  # fmt: skip

#: Colours from thin (red) to thick (blue), which colour-blind people can distinguish, too.
THICKNESS = ("#b2182b", "#ef8a62", "#f3d9c5", "#cfe0ec", "#67a9cf", "#2166ac")

#: Colours from the distance 0 (grey) to the largest distance (dark red).
DISTANCE = ("#dfe4ea", "#fdd49e", "#fc8d59", "#d7301f", "#7f0000")

#: Values above this multiple of the median have the last colour of a scale, so that smaller values
#: can be distinguished.
_CAP = 3.0


@dataclass(frozen=True, eq=False)
class Labels:
    """A paint with one label for each face, such as the name of a material.

    Parameters
    ----------
    name : str
    numbers : (m,) int64
        The number of the label of each face.
    labels, colours : sequence of str
        Text and colour of each label, as ``"#rrggbb"``, or ``"#rrggbbaa"`` with an opacity.
    uv : (m, 3, 2) float64, optional
        Texture coordinates of each face's corners in the picture of its label, from the lower left.
    images : sequence of bytes or None
        The PNG or JPEG file of each label, None for a label without a picture.
    """

    name: str
    numbers: IndexArray
    labels: Sequence[str]
    colours: Sequence[str]
    uv: FloatArray | None = None
    images: Sequence[bytes | None] = ()

    def for_faces(self, faces: IndexArray) -> "Labels":
        """Return the paint for the given faces only, in the given order."""
        uv = None if self.uv is None else self.uv[faces]
        return replace(self, numbers=self.numbers[faces], uv=uv)


@dataclass(frozen=True, eq=False)
class Scale:
    """A paint with one number for each face or corner, shown on a scale of colours.

    Parameters
    ----------
    name : str
    values : (m,) or (m, 3) float64
        NaN for unknown values.
    stops : sequence of str
        Colours from the lowest to the highest value, evenly spaced.
    """

    name: str
    values: FloatArray
    stops: Sequence[str]

    @property
    def at(self) -> PaintedElements:
        """The elements of the mesh that have a number: faces or corners."""
        return "face" if self.values.ndim == 1 else "corner"

    @property
    def low(self) -> float:
        """The value that has the first colour: the smallest known one."""
        return float(self._known.min()) if len(self._known) else 0.0

    @property
    def high(self) -> float:
        """The value that has the last colour: the largest known one, or three times the median."""
        if not len(self._known):
            return 0.0
        largest, typical = float(self._known.max()), float(np.median(self._known))
        return min(largest, _CAP * typical) if typical > 0 else largest

    @property
    def is_capped(self) -> bool:
        """True if a value is larger than `high`."""
        return bool(len(self._known)) and float(self._known.max()) > self.high

    @property
    def _known(self) -> FloatArray:
        return self.values[np.isfinite(self.values)]

    def steps(self, most: int) -> npt.NDArray[np.uint16]:
        """Return the values, from `low` to `high`, as integers from 1 to `most`, 0 for NaN."""
        low, side = self.low, self.high - self.low
        known = np.isfinite(self.values)
        share = (np.where(known, self.values, low) - low) / (side or 1.0)
        numbers = 1 + np.rint(np.clip(share, 0, 1) * (most - 1))
        return np.where(known, numbers, 0).astype(np.uint16)

    def for_faces(self, faces: IndexArray) -> "Scale":
        """Return the paint for the given faces only, in the given order."""
        return replace(self, values=self.values[faces])


@dataclass(frozen=True, eq=False)
class Colours:
    """A paint with one colour for each face or corner.

    Parameters
    ----------
    name : str
    values : (m, 4) or (m, 3, 4) uint8
        Red, green, blue and opacity, in sRGB.
    """

    name: str
    values: npt.NDArray[np.uint8]

    @property
    def at(self) -> PaintedElements:
        """The elements of the mesh that have a colour: faces or corners."""
        return "face" if self.values.ndim == 2 else "corner"

    def for_faces(self, faces: IndexArray) -> "Colours":
        """Return the paint for the given faces only, in the given order."""
        return replace(self, values=self.values[faces])


Paint: TypeAlias = Labels | Scale | Colours
