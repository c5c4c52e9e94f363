"""The profile of the evaluation of a solid, stage by stage."""

from dataclasses import dataclass

from .._core import Tree

#: The stages, and what each counts: faces that may meet, segments in which they do, whole and cut
#: faces of the result, cells visited, faces of an operand that overlaps itself.
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
        A key of `COUNTED`, which has the meaning of `count`.
    seconds : float
    count : int
        The number of things that the stage found, made or visited.
    """

    name: str
    seconds: float
    count: int


@dataclass(frozen=True)
class Profile:
    """The stages of an evaluation, in order.

    Parameters
    ----------
    stages : tuple of Stage
    handed_on : str or None
        The reason why the fast path handed the work to the descent, if it did.
    """

    stages: tuple[Stage, ...] = ()
    handed_on: str | None = None

    @classmethod
    def of(cls, tree: Tree) -> "Profile":
        """Return the profile of the evaluation that made a tree."""
        stages, handed_on = tree.profile()
        return cls(tuple(Stage(*stage) for stage in stages), handed_on)

    def lines(self) -> list[str]:
        """Return a line for each stage, and one for the reason if there is one."""
        lines = [f"{s.name}: {s.seconds:.4f} s, {s.count} {COUNTED[s.name]}" for s in self.stages]
        if self.handed_on is None:
            return lines
        return [*lines, f"left to the descent: {self.handed_on}"]

    def __str__(self) -> str:
        """Return the lines as one text."""
        return "\n".join(self.lines())
