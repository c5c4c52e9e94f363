"""`Material`: the meaning of a name in the face attribute ``"material"``."""

from dataclasses import dataclass

from ..errors import InvalidMeshError
from .colours import AnyColor, color_of

#: The first bytes of the picture formats that mesh files may hold.
_MEDIA = {b"\x89PNG\r\n\x1a\n": "image/png", b"\xff\xd8\xff": "image/jpeg"}


@dataclass(frozen=True, init=False)
class Material:
    """A colour, and a picture that the attribute ``"uv"`` maps onto faces.

    Parameters
    ----------
    color : (4,) tuple of float
        Red, green, blue and opacity (by default 1), from 0 to 1, as on a screen. It may also be
        given as ``"orange"``, ``"#ff8800"`` or whole numbers up to 255 (see `attributes.colours`).
    texture : bytes, optional
        A PNG or JPEG file.
    """

    color: tuple[float, ...] = (1.0, 1.0, 1.0, 1.0)
    texture: bytes | None = None

    def __init__(
        self, color: AnyColor = (1.0, 1.0, 1.0, 1.0), texture: bytes | None = None
    ) -> None:
        object.__setattr__(self, "color", color_of(color))
        object.__setattr__(self, "texture", texture)
        is_picture = isinstance(texture, bytes) and self.media is not None
        if texture is not None and not is_picture:
            raise InvalidMeshError(
                "The texture of a material must be the contents of a PNG or JPEG file, as bytes.",
                "attributes",
            )

    @property
    def media(self) -> str | None:
        """The media type of the texture."""
        data = self.texture or b""
        return next((kind for start, kind in _MEDIA.items() if data.startswith(start)), None)
