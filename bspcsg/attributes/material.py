"""`Material`: what a name in the face attribute ``"material"`` stands for."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from ..errors import InvalidMeshError
from ..geometry.arrays import doubles
from ..parameters import shown

#: Beginnings of the pictures that files of meshes may hold.
_MEDIA = {b"\x89PNG\r\n\x1a\n": "image/png", b"\xff\xd8\xff": "image/jpeg"}


@dataclass(frozen=True)
class Material:
    """A colour, and a picture laid over faces by the attribute ``"uv"``.

    Parameters
    ----------
    color : (4,) or (3,) tuple of float
        Red, green, blue and opacity (by default 1), 0 to 1, as a screen shows them.
    texture : bytes, optional
        A PNG or JPEG file.
    """

    color: tuple[float, ...] = (1.0, 1.0, 1.0, 1.0)
    texture: bytes | None = None

    def __post_init__(self) -> None:
        """Take three numbers for an opaque colour; refuse what is none."""
        object.__setattr__(self, "color", color_of(self.color))
        is_picture = isinstance(self.texture, bytes) and self.media is not None
        if self.texture is not None and not is_picture:
            raise InvalidMeshError("A texture is a PNG or JPEG file, as bytes.", "attributes")

    @property
    def media(self) -> str | None:
        """The media type of the texture."""
        data = self.texture or b""
        return next((kind for start, kind in _MEDIA.items() if data.startswith(start)), None)


def color_of(given: Any) -> tuple[float, ...]:
    """Return red, green, blue and opacity, from 0 to 1; of three numbers the opaque colour."""
    message = f"A colour is three or four numbers from 0 to 1, not {shown(given)}."
    refusal = InvalidMeshError(message, "attributes")
    row = doubles(tuple(given) if isinstance(given, Iterable) else given, refusal)
    if row.shape not in ((3,), (4,)) or not ((row >= 0) & (row <= 1)).all():
        raise refusal
    numbers: list[float] = row.tolist()
    return (*numbers, 1.0) if len(numbers) == 3 else tuple(numbers)
