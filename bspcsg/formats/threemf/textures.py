"""Pictures in packages of 3MF: the parts they are in, and what materials are called by them.

3MF has no names for textures, so the name of a part is that of the material. Coordinates count from
the lower left corner of the picture, as those of attributes do.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from urllib.parse import quote, unquote

from ...attributes.material import Material

#: What pictures are related to the model by.
_TEXTURE = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dtexture"

#: Suffixes of parts by media types.
_SUFFIXES = {"image/png": "png", "image/jpeg": "jpeg"}

#: What names of parts must not have, not even encoded. Nor may they begin with a dot.
_SLASHES = str.maketrans("/\\", "__")


@dataclass(frozen=True)
class Picture:
    """A picture as a part of a package.

    Parameters
    ----------
    path : str
        The part.
    media : str
        Its media type.
    data : bytes
    """

    path: str
    media: str
    data: bytes


def pictures_of(materials: Mapping[str, Material]) -> dict[str, Picture]:
    """Return the pictures of those materials that have one, by names."""
    textured = {name: one for name, one in materials.items() if one.texture is not None}
    return {
        name: Picture(_path(number, name, one.media or ""), one.media or "", one.texture or b"")
        for number, (name, one) in enumerate(textured.items(), 1)
    }


def _path(number: int, name: str, media: str) -> str:
    # Parts whose names differ by case alone are the same, so each has a folder.
    return f"/3D/Textures/{number}/{quote(name, safe='')}.{_SUFFIXES[media]}"


def named_after(path: str) -> str:
    """Return the name of the material whose picture is a part."""
    last = path.rpartition("/")[2]
    return unquote(last.rpartition(".")[0] or last)


def fit_for_parts(names: list[str]) -> dict[str, str]:
    """Return what materials with pictures are called in files, by their names."""
    found: dict[str, str] = {}
    for name in names:
        rest = name.lstrip(".").translate(_SLASHES)
        fit = rest.rjust(len(name), "_")
        while fit != name and fit in {*names, *found.values()}:
            fit += "_"
        found[name] = fit
    return found


def content_types(pictures: Mapping[str, Picture]) -> str:
    """Return what the types of a package say about its pictures."""
    media = sorted({one.media for one in pictures.values()})
    return "".join(f'<Default Extension="{_SUFFIXES[one]}" ContentType="{one}"/>' for one in media)


def relations(pictures: Mapping[str, Picture]) -> Iterator[str]:
    """Yield what relates the model to its pictures."""
    for number, one in enumerate(pictures.values()):
        yield f'<Relationship Id="rel{number}" Target="{one.path}" Type="{_TEXTURE}"/>\n'
