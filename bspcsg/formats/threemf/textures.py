"""Pictures in 3MF packages: their package parts, and the names of their materials.

3MF has no names for textures, so a material is named after the part with its picture. Texture
coordinates count from the picture's lower left corner, as in attributes.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from urllib.parse import quote, unquote
from xml.sax.saxutils import quoteattr

from ...attributes.material import Material

#: The type of the relationship between the model and a picture.
_TEXTURE = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dtexture"

#: The suffix of a picture's part by media type.
_SUFFIXES = {"image/png": "png", "image/jpeg": "jpeg"}

#: Characters that the name of a part must not contain, not even encoded.
_SLASHES = str.maketrans("/\\", "__")


@dataclass(frozen=True)
class PackedPicture:
    """A picture as a part of a package.

    Parameters
    ----------
    path : str
        The name of the part.
    media : str
        The media type, such as "image/png".
    data : bytes
    """

    path: str
    media: str
    data: bytes


class Resources:
    """The resource ids that a model has used, and its pictures.

    Parameters
    ----------
    first : int
        The first free id.
    """

    def __init__(self, first: int) -> None:
        self._next = first
        self._pictures: dict[tuple[str, bytes], PackedPicture] = {}
        self._textures: dict[str, int] = {}

    def free(self) -> int:
        """Return the next free resource id, and count it as used."""
        self._next += 1
        return self._next - 1

    @property
    def pictures(self) -> list[PackedPicture]:
        """All pictures that have been added."""
        return list(self._pictures.values())

    def picture(self, name: str, material: Material) -> PackedPicture:
        """Add the picture of a material; equal pictures with equal names share one part."""
        data, media = material.texture or b"", material.media or ""
        path = _path(len(self._pictures) + 1, name, media)
        return self._pictures.setdefault((name, data), PackedPicture(path, media, data))

    def texture(self, picture: PackedPicture) -> tuple[int, list[str]]:
        """Return the id of a picture's texture, and its XML, empty if it was returned before."""
        if picture.path in self._textures:
            return self._textures[picture.path], []
        number = self._textures[picture.path] = self.free()
        path = quoteattr(picture.path)
        return number, [f'<m:texture2d id="{number}" path={path} contenttype="{picture.media}"/>\n']


def _path(number: int, name: str, media: str) -> str:
    # Part names are not case-sensitive, so each picture has a folder of its own.
    return f"/3D/Textures/{number}/{quote(name, safe='')}.{_SUFFIXES[media]}"


def named_after(path: str) -> str:
    """Return the material name of a picture: the decoded file name of its part, without suffix."""
    last = path.rpartition("/")[2]
    return unquote(last.rpartition(".")[0] or last)


def fit_for_parts(names: list[str], others: list[str]) -> dict[str, str]:
    """Return for each name of a material with a picture a name that a package part may have.

    The names differ from each other and from `others`.
    """
    found: dict[str, str] = {}
    for name in names:
        rest = name.lstrip(".").translate(_SLASHES)
        fit = rest.rjust(len(name), "_")
        while fit != name and fit in {*names, *others, *found.values()}:
            fit += "_"
        found[name] = fit
    return found


def content_types(pictures: Iterable[PackedPicture]) -> str:
    """Return the XML of the content types of a package's pictures."""
    media = sorted({one.media for one in pictures})
    return "".join(f'<Default Extension="{_SUFFIXES[one]}" ContentType="{one}"/>' for one in media)


def relations(pictures: Iterable[PackedPicture]) -> Iterator[str]:
    """Yield the XML of the relationships between the model and its pictures."""
    for number, one in enumerate(pictures):
        yield f'<Relationship Id="rel{number}" Target="{one.path}" Type="{_TEXTURE}"/>\n'
