"""The text of a script, and the lines and columns that errors name."""

from bisect import bisect_right
from dataclasses import dataclass, field
from pathlib import Path

from ...errors import FormatError
from .tree import Place


@dataclass(frozen=True)
class Script:
    """The text of a script, with its name and folder.

    Parameters
    ----------
    text : str
        The text of the script.
    name : str
        The name in errors: the path as the caller gave it.
    folder : Path, optional
        The folder of the files that the script imports; by default the current folder.
    """

    text: str
    name: str = "<csg>"
    folder: Path = field(default_factory=Path)

    def places(self) -> "LineIndex":
        """Return the converter of offsets in this text to lines and columns."""
        return LineIndex(self.text)

    def error(self, place: Place, message: str, code: str = "syntax") -> FormatError:
        """Return an error at a line and column, both from 1, which `where` contains."""
        return error_at(self.name, place, message, code)


class LineIndex:
    """A converter of offsets in a text to lines and columns.

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
        """Return the line and column, both from 1, of the character at an offset, from 0."""
        line = bisect_right(self._starts, offset)
        return Place(line, offset - self._starts[line - 1] + 1)


def error_at(name: str, place: Place, message: str, code: str) -> FormatError:
    """Return an error whose message begins with the script's name, line and column."""
    return FormatError(f"{name}:{place.line}:{place.column}: {message}", code, list(place))
