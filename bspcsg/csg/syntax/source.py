"""The text of a script, with the places that errors about it name."""

from bisect import bisect_right
from dataclasses import dataclass, field
from pathlib import Path

from ...errors import FormatError
from .tree import Place


@dataclass(frozen=True)
class Script:
    """A text that a parser reads.

    Parameters
    ----------
    text : str
    name : str
        Its name in errors: the path as the caller gave it.
    folder : Path, optional
        The folder of the files that it imports; the current folder by default.
    """

    text: str
    name: str = "<csg>"
    folder: Path = field(default_factory=Path)

    def places(self) -> "Places":
        """Return the index of this text's lines."""
        return Places(self.text)

    def error(self, place: Place, message: str, code: str = "syntax") -> FormatError:
        """Return the error for a place: `where` holds line and column, both from 1."""
        return error_at(self.name, place, message, code)


class Places:
    """Lines and columns of offsets in a text.

    Parameters
    ----------
    text : str
    """

    def __init__(self, text: str) -> None:
        self._starts = [0]
        position = text.find("\n")
        while position >= 0:
            self._starts.append(position + 1)
            position = text.find("\n", position + 1)

    def at(self, offset: int) -> Place:
        """Return the place of a character, counted from 0."""
        line = bisect_right(self._starts, offset)
        return Place(line, offset - self._starts[line - 1] + 1)


def error_at(name: str, place: Place, message: str, code: str) -> FormatError:
    """Return the error for a place of a named script."""
    return FormatError(f"{name}:{place.line}:{place.column}: {message}", code, list(place))
