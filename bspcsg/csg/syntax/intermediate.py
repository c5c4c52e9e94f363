"""The `.csg` text that openscad made from a script, and the lines of both that an error names."""

import re
from dataclasses import dataclass

from ...errors import BspcsgError

#: The largest number of characters of a line that an error quotes.
_MAX_QUOTED_CHARACTERS = 100

_COMMENT = re.compile(r'"(?:[^"\\]|\\.)*"|//[^\n]*|/\*.*?\*/', re.DOTALL)
_OTHER_FILES = re.compile(r"^\s*(?:use|include)\s*<", re.MULTILINE)


@dataclass(frozen=True)
class Intermediate:
    """A `.csg` text and the `.scad` script from which it was made.

    Parameters
    ----------
    script : str
        The script's name.
    source : str
        The script's text.
    text : str
        The `.csg` text.
    """

    script: str
    source: str
    text: str

    @property
    def name(self) -> str:
        """The name of the `.csg` text in errors."""
        return f"{self.script}, as openscad's .csg"

    def explained(self, error: BspcsgError) -> BspcsgError:
        """Return an error whose message also quotes the line of the `.csg` text that it names.

        It adds the script's line if the node's name is on exactly one of its lines, and the script
        includes no other file.
        """
        place = re.match(rf"{re.escape(self.name)}:(\d+):(\d+): ", error.message)
        lines = self.text.splitlines()
        if place is None or int(place[1]) > len(lines):
            return error
        number, column = map(int, place.groups())
        line = lines[number - 1]
        message = (
            f"{error.message}\n  line {number} of the .csg: {line.strip()[:_MAX_QUOTED_CHARACTERS]}"
        )
        own = self._line_in_script(line[column - 1 :])
        if own is not None:
            message = f"{message}\n  from {self.script}:{own}"
        return type(error)(message, error.code, error.where)

    def _line_in_script(self, text: str) -> int | None:
        """Return the number of the script's only line that uses the node with which a text begins.

        None means that there is no such line or several, or that the script includes other files.
        """
        node = re.match(r"[A-Za-z_]\w*", text)
        if node is None or _OTHER_FILES.search(self.source):
            return None
        plain = _COMMENT.sub(lambda found: "\n" * found[0].count("\n"), self.source)
        word = re.compile(rf"\b{node[0]}\s*\(")
        found = [number for number, line in enumerate(plain.split("\n"), 1) if word.search(line)]
        return found[0] if len(found) == 1 else None
