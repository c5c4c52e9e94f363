"""`Profile`: the time and the counts of each stage of the evaluation of a solid."""

from dataclasses import dataclass

from .._core import Tree

#: What each stage of an evaluation counts. "candidates": faces that may meet; "contacts": segments
#: in which faces meet; "faces": whole and cut faces of the result; "descent": cells visited;
#: "uniting": faces of an operand that overlaps itself.
COUNTED = {
    "candidates": "faces",
    "contacts": "segments",
    "faces": "elements",
    "descent": "cells",
    "uniting": "faces",
}


@dataclass(frozen=True)
class Stage:
    """One stage of an evaluation.

    Parameters
    ----------
    name : str
        A key of `COUNTED`, whose value there says what `count` counts.
    seconds : float
    count : int
        The number of faces, segments or cells that the stage found, made or visited.
    """

    name: str
    seconds: float
    count: int


@dataclass(frozen=True)
class Profile:
    """The stages of the evaluation of a solid, in order.

    Parameters
    ----------
    stages : tuple of Stage
    handed_on : str or None
        The reason why the fast path left the evaluation to the descent through space, if it did.
    """

    stages: tuple[Stage, ...] = ()
    handed_on: str | None = None

    @classmethod
    def of(cls, tree: Tree) -> "Profile":
        """Return the profile of the evaluation that made a tree."""
        stages, handed_on = tree.profile()
        return cls(tuple(Stage(*stage) for stage in stages), handed_on)

    def lines(self) -> list[str]:
        """Return a line for each stage; last, if there is one, the reason against the fast path."""
        lines = [f"{s.name}: {s.seconds:.4f} s, {s.count} {COUNTED[s.name]}" for s in self.stages]
        if self.handed_on is None:
            return lines
        return [*lines, f"left to the descent: {self.handed_on}"]

    def __str__(self) -> str:
        """Return the stages as text, one line for each."""
        return "\n".join(self.lines())
