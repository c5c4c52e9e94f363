"""MTL, the companion file with an OBJ file's materials; their pictures are companion files, too."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..attributes.material import Material
from ..errors import InvalidMeshError
from .source import Source, as_text

#: The colour of a material whose colour is not given.
_PLAIN = (0.8, 0.8, 0.8)

#: Keywords of statements that a name follows.
_NAMING = frozenset({b"newmtl", b"map_Kd"})

#: The largest number of words in the name of a file: file systems allow 255 bytes.
_MAX_NAME_WORDS = 128


@dataclass
class Libraries:
    """The content of the material libraries (MTL files) that an OBJ file names.

    Parameters
    ----------
    materials : dict of str to Material
    missing : list of str
        The names of files that do not exist.
    dropped : set of str
        Kinds of data that `Material` cannot store.
    """

    materials: dict[str, Material] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)
    dropped: set[str] = field(default_factory=set)


def name_of(words: Sequence[bytes]) -> str:
    """Return words of a statement as one name, joined by spaces."""
    return as_text(b" ".join(words))


def materials_in(source: Source, libraries: Sequence[Sequence[bytes]]) -> Libraries:
    """Return the content of the material libraries that statements of an OBJ name.

    The words of a statement are the name of one file if that file exists, else one name each.
    """
    found = Libraries()
    for words in libraries:
        whole = name_of(words)
        names = [whole] if source.beside(whole) is not None else [name_of([word]) for word in words]
        for name in names:
            data = source.beside(name)
            if data is None:
                found.missing.append(name)
                continue
            for material, statements in _sections(Source(name, data)):
                found.materials.setdefault(material, _material(source, statements, found))
    return found


def _sections(library: Source) -> list[tuple[str, dict[bytes, list[bytes]]]]:
    """Return each material's name and its statements, as lists of words by keyword."""
    found: list[tuple[str, dict[bytes, list[bytes]]]] = []
    for _, words in library.text_lines(b"#", _NAMING):
        if words[0] == b"newmtl":
            found.append((name_of(words[1:]), {}))
        elif found:
            found[-1][1][words[0]] = words[1:]
    return found


def _material(
    source: Source, statements: Mapping[bytes, list[bytes]], found: Libraries
) -> Material:
    """Return the material of some statements; an invalid colour or picture is left out."""
    color = _color(statements.get(b"Kd"))
    if color is None:
        found.dropped.add("colours of materials that are not three numbers")
    full = (*(color or _PLAIN), _opacity(statements))
    texture = _picture(source, statements.get(b"map_Kd", []), found)
    try:
        return Material(full, texture)
    except InvalidMeshError:
        found.dropped.add("pictures that are neither PNG nor JPEG")
        return Material(full)


def _color(words: Sequence[bytes] | None) -> tuple[float, ...] | None:
    """Return red, green and blue, given as three numbers or one grey; None for invalid words.

    Without words the colour is `_PLAIN`.
    """
    if words is None:
        return _PLAIN
    numbers = [_number(word) for word in words]
    if len(numbers) not in (1, 3) or any(map(math.isnan, numbers)):
        return None
    return tuple(numbers * 3)[:3]


def _opacity(statements: Mapping[bytes, list[bytes]]) -> float:
    """Return the opacity that a statement `d` or `Tr` gives, 1 if there is no valid number."""
    if b"d" in statements:
        told = _number(statements[b"d"][-1]) if statements[b"d"] else math.nan
    else:
        told = 1 - _number(statements[b"Tr"][-1]) if statements.get(b"Tr") else math.nan
    return 1.0 if math.isnan(told) else told


def _number(word: bytes) -> float:
    """Return a number clamped to the range from 0 to 1; NaN if the word is no number."""
    try:
        return float(np.clip(float(word), 0, 1))
    except ValueError:
        return math.nan


def _picture(source: Source, words: Sequence[bytes], found: Libraries) -> bytes | None:
    """Return the content of the picture file whose name ends a statement; None if there is none.

    The name may have several words.
    """
    for start in range(max(0, len(words) - _MAX_NAME_WORDS), len(words)):
        data = source.beside(name_of(words[start:]))
        if data is not None:
            return data
    if words:
        # Numbers after an option may belong to the option or to the name.
        has_options = words[0].startswith(b"-")
        found.missing.append(name_of(words[-1:] if has_options else words))
    return None


def library_and_companions(
    materials: Mapping[str, Material], stem: str
) -> tuple[str, dict[str, bytes]]:
    """Return the name of the MTL file for an OBJ file called `stem`, and all companion files.

    The companion files are a dictionary of name to content.
    """
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
