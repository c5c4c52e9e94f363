"""What the evaluation of a solid took, stage by stage."""

from dataclasses import dataclass

from .._core import Tree


@dataclass(frozen=True)
class Stage:
    """A stage of an evaluation.

    Parameters
    ----------
    name : str
        "candidates" (faces that may meet), "contacts" (segments in which they do), "faces" (what
        is left, counted as elements of the result), "descent" (cells visited) or "uniting" (faces
        of an operand that overlaps itself).
    seconds : float
    count : int
        The number of things that the stage found, made or visited.
    """

    name: str
    seconds: float
    count: int


@dataclass(frozen=True)
class Profile:
    """The stages of an evaluation, in their order.

    Parameters
    ----------
    stages : tuple of Stage
    handed_on : str or None
        The reason for which the fastest way left the work to the descent, if it did.
    """

    stages: tuple[Stage, ...] = ()
    handed_on: str | None = None

    @classmethod
    def of(cls, tree: Tree) -> "Profile":
        """Return the profile of the evaluation that made a tree."""
        stages, handed_on = tree.profile()
        return cls(tuple(Stage(*stage) for stage in stages), handed_on)

    def lines(self) -> list[str]:
        """Return a line for each stage, and one for the reason."""
        lines = [f"{s.name}: {s.seconds:.4f} s, {s.count}" for s in self.stages]
        return (
            lines if self.handed_on is None else [*lines, f"to the descent, for {self.handed_on}"]
        )

    def __str__(self) -> str:
        """Return the lines as one text."""
        return "\n".join(self.lines())
