"""`Material`: a colour and a texture, which the face attribute ``"material"`` names."""

from dataclasses import dataclass

from ..errors import InvalidMeshError
from .colours import AnyColor, color_of

#: The media types of the picture formats in mesh files, by the first bytes of a file.
_MEDIA = {b"\x89PNG\r\n\x1a\n": "image/png", b"\xff\xd8\xff": "image/jpeg"}


@dataclass(frozen=True, init=False)
class Material:
    """A colour, and optionally a picture that the attribute ``"uv"`` maps onto faces.

    Parameters
    ----------
    color : (4,) tuple of float
        Red, green, blue and opacity (by default 1), from 0 to 1, as on a screen. It may also be
        given as ``"orange"``, ``"#ff8800"`` or whole numbers up to 255 (see `attributes.colours`).
    texture : bytes, optional
        The contents of a PNG or JPEG file.
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
        """The media type of the texture, such as ``"image/png"``; None without a texture."""
        data = self.texture or b""
        return next((kind for start, kind in _MEDIA.items() if data.startswith(start)), None)
