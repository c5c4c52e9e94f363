"""`Material`: what a name in the face attribute ``"material"`` stands for."""

from dataclasses import dataclass

from ..errors import InvalidMeshError

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
        numbers = tuple(float(value) for value in self.color)
        color = (*numbers, 1.0) if len(numbers) == 3 else numbers
        if len(color) != 4 or not all(0 <= value <= 1 for value in color):
            message = f"A colour is three or four numbers from 0 to 1, not {self.color}."
            raise InvalidMeshError(message, "attributes")
        object.__setattr__(self, "color", color)
        if self.texture is not None and self.media is None:
            raise InvalidMeshError("A texture is a PNG or JPEG file, as bytes.", "attributes")

    @property
    def media(self) -> str | None:
        """The media type of the texture."""
        data = self.texture or b""
        return next((kind for start, kind in _MEDIA.items() if data.startswith(start)), None)
