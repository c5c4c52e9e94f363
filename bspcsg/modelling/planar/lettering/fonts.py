"""Search for the file of a font: bundled with the package, given by path, or of the system."""

import os
import re
import shutil
import subprocess
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import uharfbuzz

from ....errors import FormatError, InvalidParameterError
from ....formats.source import limited_content
from ....parameters import file_path, shown

#: The family of the font that comes with the package, and the files of its styles.
FAMILY = "Liberation Sans"
_FACES = {"regular": "LiberationSans-Regular.ttf", "bold": "LiberationSans-Bold.ttf"}

#: The largest number of characters in the name of a font.
_MAX_NAME_CHARACTERS = 200

#: Suffixes of font files.
_SUFFIXES = (".ttf", ".otf", ".ttc", ".otc")

#: The byte range of the flags in the table "head" of a font.
_HEAD_FLAGS = slice(16, 18)

#: The time limit of fontconfig, in seconds; its first run reads all fonts of the system.
_TIMEOUT = 120.0


class FontFile(NamedTuple):
    """A font file, and the font in it.

    Parameters
    ----------
    path : Path
        The font file.
    face : int
        The number of the font in the file, which may be a collection.
    """

    path: Path
    face: int = 0


def font_file(name: str | os.PathLike[str], *, paths: bool = True) -> FontFile:
    """Return the file of a font, given its name or path.

    Parameters
    ----------
    name : str or path
        ``"Family"`` or ``"Family:style=Style"`` in fontconfig's notation; empty for the font that
        comes with the package; or the path of a font file. A missing family is replaced by a family
        that fontconfig knows to have the same metrics.
    paths : bool
        True if `name` may be a path.

    Raises
    ------
    InvalidParameterError
        If there is no such font (code "unknown_font").
    FormatError
        If a path is not the name of a file.
    """
    text = file_path(name, "font").strip()
    if paths and (isinstance(name, os.PathLike) or text.lower().endswith(_SUFFIXES)):
        return FontFile(Path(text))
    own = _own_face(text)
    if own is not None:
        return own
    known = _fontconfig(text)
    if known is None:
        raise unknown_font(text)
    return known


def unknown_font(name: str) -> InvalidParameterError:
    """Return the error for a font name that is not found (code "unknown_font")."""
    message = (
        f"There is no font {shown(name)} on this machine. Give the path of a .ttf or .otf file, or"
        f' one of "{FAMILY}" and "{FAMILY}:style=Bold", which come with the package.'
    )
    return InvalidParameterError(message, "unknown_font")


def substitute_font(name: str) -> FontFile:
    """Return the bundled font to use in place of a missing font: bold if the name says bold."""
    _, style = _family_and_style(name)
    return _own_file("bold" if "bold" in style else "regular")


@lru_cache(maxsize=16)
def harfbuzz_font(file: FontFile) -> uharfbuzz.Font:
    """Return the HarfBuzz font of a file, with measures in design units.

    Raises
    ------
    FormatError
        If the file cannot be read or does not contain the font.
    """
    face = uharfbuzz.Face(limited_content(file.path), file.face)
    if face.glyph_count == 0:
        raise FormatError(
            f"{file.path}: the file is not a font that can be read, such as .ttf or .otf.",
            "malformed",
        )
    font = uharfbuzz.Font(face)
    font.scale = (face.upem, face.upem)
    return font


def wants_whole_pixels(file: FontFile) -> bool:
    """Return True if a font asks for an em of a whole number of pixels (bit 3 of its flags)."""
    head = harfbuzz_font(file).face.reference_table("head").data or b""
    # Byte 1 of the big-endian flags has the lower 8 bits.
    return len(head) >= _HEAD_FLAGS.stop and bool(head[_HEAD_FLAGS][1] & 8)


def _own_face(name: str) -> FontFile | None:
    family, style = _family_and_style(name)
    if family not in ("", FAMILY.lower()):
        return None
    return _own_file(style or "regular") if (style or "regular") in _FACES else None


def _own_file(style: str) -> FontFile:
    return FontFile(Path(__file__).parent / "faces" / _FACES[style])


def _family_and_style(name: str) -> tuple[str, str]:
    """Return the family and the style of a font name in fontconfig's notation, in lower case."""
    family, *properties = (part.strip().lower() for part in name.split(":"))
    pairs = [part.rpartition("=") for part in properties]
    # A property without "=" is a style, too.
    styles = [value.strip() for key, _, value in pairs if key.strip() in ("", "style")]
    return family, " ".join(styles)


@lru_cache(maxsize=64)
def _fontconfig(name: str) -> FontFile | None:
    """Return the system's font of a family, or of a family with equal metrics.

    None means that there is no such font, or that fontconfig is not installed.
    """
    told = _program_output("fc-match", "-f", "%{index}\n%{file}\n%{family}", "--", name)
    index, path, families = [*told.split("\n", 2), "", "", ""][:3]
    there = {family.strip().lower() for family in families.split(",")}
    family, style = _family_and_style(name)
    for like in (family, *([] if family in there else _equals(name))):
        own = _own_face(f"{like}:style={style}")
        if own is not None:
            return own
        if like in there:
            # Bits above the lower 16 number the instance of a variable font.
            return FontFile(Path(path), int(index or 0) & 0xFFFF)
    return None


def _equals(name: str) -> list[str]:
    """Return the families, in lower case, that fontconfig treats as equivalent to a font name.

    They are the families with strong binding ("s"), whose metrics equal the named family's.
    """
    lines = _program_output("fc-pattern", "-c", "--", name).splitlines()
    families = [line for line in lines if line.strip().startswith("family:")]
    return [found.lower() for line in families for found in re.findall(r'"([^"]*)"\(s\)', line)]


def _program_output(program: str, *arguments: str) -> str:
    """Return the output of a fontconfig program.

    It is empty if the program is not installed or fails, or for an unprintable or long font name.
    """
    path, name = shutil.which(program), arguments[-1]
    if path is None or not name.isprintable() or len(name) > _MAX_NAME_CHARACTERS:
        return ""
    try:
        done = subprocess.run(
            [path, *arguments], capture_output=True, text=True, timeout=_TIMEOUT, check=False
        )
    except (OSError, UnicodeError, subprocess.TimeoutExpired):
        return ""
    return done.stdout
