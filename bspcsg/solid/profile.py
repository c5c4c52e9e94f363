"""`Profile`: the time and the counts of each stage of the evaluation of a solid."""

from collections.abc import Mapping
from dataclasses import dataclass

from .._core import Tree

#: What each stage of an evaluation counts. "candidates": faces that may meet; "contacts": segments
#: in which faces meet; "faces": whole and cut faces of the result; "descent": cells visited;
#: "uniting": faces of an operand that overlaps itself.
COUNTED = {
    "candidates": "faces",
    "contacts": "segments",
    "faces": "elements",
    "own pairs": "pairs of faces",
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
        The number of faces, pairs, segments or cells that the stage found, made or visited.
    """

    name: str
    seconds: float
    count: int


@dataclass(frozen=True)
class KernelCount:
    """How often a kernel, a procedure for set operations, was asked in an evaluation.

    Parameters
    ----------
    name : str
        "arrangement", which is asked once about all faces, or "orthogonal", "general" or "trees",
        which are asked about cells of the descent.
    asked, took : int
        The number of requests, and of those that the kernel carried out.
    refused : dict of str to int
        The number of requests that the kernel refused, by the reason.
    """

    name: str
    asked: int
    took: int
    refused: Mapping[str, int]

    def __str__(self) -> str:
        """Return the counts as a line of text."""
        reasons = ", ".join(f"{reason} ({count})" for reason, count in self.refused.items())
        refused = f", refused {self.asked - self.took}: {reasons}" if reasons else ""
        return f"{self.name}: asked {self.asked}, took {self.took}{refused}"


@dataclass(frozen=True)
class Profile:
    """The stages of the evaluation of a solid, in order.

    Parameters
    ----------
    stages : tuple of Stage
    handed_on : str or None
        The reason why the fast path left the evaluation to the descent through space, if it did.
    kernels : tuple of KernelCount
        How often each kernel was asked, and why it refused.
    """

    stages: tuple[Stage, ...] = ()
    handed_on: str | None = None
    kernels: tuple[KernelCount, ...] = ()

    @classmethod
    def of(cls, tree: Tree) -> "Profile":
        """Return the profile of the evaluation that made a tree."""
        stages, handed_on = tree.profile()
        kernels = (
            KernelCount(name, asked, took, dict(refused))
            for name, asked, took, refused in tree.kernels()
        )
        return cls(tuple(Stage(*stage) for stage in stages), handed_on, tuple(kernels))

    def lines(self) -> list[str]:
        """Return a line for each stage and each kernel that was asked about cells.

        The last line, if there is one, is the reason against the fast path.
        """
        lines = [f"{s.name}: {s.seconds:.4f} s, {s.count} {COUNTED[s.name]}" for s in self.stages]
        lines += [str(kernel) for kernel in self.kernels[1:] if kernel.asked]
        if self.handed_on is None:
            return lines
        return [*lines, f"left to the descent: {self.handed_on}"]

    def __str__(self) -> str:
        """Return the stages as text, one line for each."""
        return "\n".join(self.lines())
