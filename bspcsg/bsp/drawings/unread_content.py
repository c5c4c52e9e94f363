"""`UnreadContent`: counts of drawing content that was not read, reported by one warning."""

import os
import warnings
from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from ..._types import FloatArray
from ..sets.region import Region

#: The largest number of kinds in a message, and of characters of each kind's name.
_MAX_KINDS_NAMED, _MAX_KIND_CHARACTERS = 12, 40


class DrawingWarning(UserWarning):
    """A warning that a part of a drawing is not in its region, or that the region is empty."""


@dataclass
class UnreadContent:
    """The counts of the content of one drawing that is not in the region.

    Parameters
    ----------
    counts : Counter
        The number of omitted elements of each kind, by the kind's name in the file.
    outlines : int
        The number of outlines that were read.
    """

    counts: Counter[str] = field(default_factory=Counter)
    outlines: int = 0

    def add(self, kind: str, count: int = 1) -> None:
        """Add a number of omitted elements of one kind."""
        if count:
            self.counts[kind] += count

    def surrounding(self, loops: list[FloatArray]) -> list[FloatArray]:
        """Return the loops with at least three different corners; count the others as omitted."""
        found = [loop for loop in loops if len(np.unique(loop, axis=0)) >= 3]
        self.add("line that encloses no area", len(loops) - len(found))
        self.outlines += len(found)
        return found

    def warning_text(self, region: Region) -> str:
        """Return the warning's text on omitted content and an empty region; "" for neither."""
        kinds = self._kinds()
        lacking = f"left out: {kinds}. " if kinds else ""
        if not region.is_empty:
            return lacking.rstrip()
        reason = ""
        if self.outlines:
            reason = ": its outlines cancel each other out, or enclose no area"
        elif not kinds:
            reason = ": the drawing has no closed outline"
        return f"{lacking}{'The' if kinds else 'the'} region is empty{reason}."

    def _kinds(self) -> str:
        """Return the omitted kinds and their counts as text, shortened if there are many."""
        names = sorted(self.counts)
        kinds = [f"{_harmless(name)} ({self.counts[name]})" for name in names[:_MAX_KINDS_NAMED]]
        more = sum(self.counts[name] for name in names[_MAX_KINDS_NAMED:])
        return ", ".join([*kinds, *([f"others ({more})"] if more else [])])

    def warn(self, path: str | os.PathLike[str], region: Region) -> None:
        """Warn that content of a file is omitted or its region is empty, if this is so."""
        words = self.warning_text(region)
        if words:
            warnings.warn(f"{os.fspath(path)}: {words}", DrawingWarning, stacklevel=3)


def _harmless(name: str) -> str:
    letters = (
        c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in name[:_MAX_KIND_CHARACTERS]
    )
    return "".join(letters)
