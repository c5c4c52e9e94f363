"""MTL: the materials of an OBJ, in a file beside it; pictures lie there, too."""

from collections.abc import Mapping

from ..attributes.material import Material
from ..errors import InvalidMeshError
from .source import Source

#: The colour of materials that say none.
_PLAIN = (0.8, 0.8, 0.8, 1.0)


def materials_in(source: Source, libraries: list[str]) -> tuple[dict[str, Material], list[str]]:
    """Return the materials of the libraries that an OBJ names, and the files that are not there."""
    found: dict[str, Material] = {}
    missing = []
    for library in libraries:
        data = source.beside(library)
        if data is None:
            missing.append(library)
            continue
        for name, words in _sections(data):
            picture = words.get("map_Kd", [])
            texture = source.beside(picture[-1]) if picture else None
            if picture and texture is None:
                missing.append(picture[-1])
            found.setdefault(name, _material(words, texture))
    return found, missing


def _sections(data: bytes) -> list[tuple[str, dict[str, list[str]]]]:
    """Return the statements of each material, the words by the first of each."""
    found: list[tuple[str, dict[str, list[str]]]] = []
    for line in data.decode("utf-8", "replace").splitlines():
        words = line.partition("#")[0].split()
        if words[:1] == ["newmtl"]:
            found.append((" ".join(words[1:]), {}))
        elif words and found:
            found[-1][1][words[0]] = words[1:]
    return found


def _material(words: Mapping[str, list[str]], texture: bytes | None) -> Material:
    """Return a material; numbers that are none leave it plain."""
    try:
        red, green, blue = map(float, words.get("Kd", _PLAIN[:3]))
        opacity = float(words["d"][0]) if "d" in words else 1 - float(words.get("Tr", ["0"])[0])
        return Material((red, green, blue, opacity), texture)
    except (ValueError, IndexError, InvalidMeshError):
        return Material(_PLAIN)


def written(materials: Mapping[str, Material], stem: str) -> tuple[str, dict[str, bytes]]:
    """Return the name of the library of an OBJ, and all files that go beside it."""
    library = f"{stem}.mtl"
    lines, files = [], {}
    for number, (name, material) in enumerate(materials.items()):
        *color, opacity = material.color
        lines += [f"newmtl {name}", "Kd {!r} {!r} {!r}".format(*color), f"d {opacity!r}"]
        if material.texture is not None:
            ending = "png" if material.media == "image/png" else "jpg"
            picture = f"{stem}-{number}.{ending}"
            files[picture] = material.texture
            lines.append(f"map_Kd {picture}")
    return library, {library: "".join(f"{line}\n" for line in lines).encode(), **files}
