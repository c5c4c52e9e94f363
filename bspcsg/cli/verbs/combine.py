"""The verbs `union`, `difference`, `intersection` and `xor`, which combine files."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..options.patterns import files_argument
from ..options.shared import from_files, verb
from ..solid_verb import SolidVerb

if TYPE_CHECKING:
    from ...solid.solid import Solid
    from ...verify.check import CheckReport

_HELP = {
    "union": "Write what is inside at least one of the files.",
    "difference": "Write what is inside the first file and none of the others. Also called cut.",
    "intersection": "Write what is inside all of the files.",
    "xor": "Write what is inside an odd number of the files.",
}

_EXAMPLES = {
    "union": "bspcsg union body.stl lid.stl -o closed.stl",
    "difference": "bspcsg difference plate.stl hole1.obj hole2.obj -o plate.ply",
    "intersection": "bspcsg intersection a.off b.off -o common.off --json",
    "xor": "bspcsg xor old.stl new.stl -o changed.ply",
}


def _verb(op: str) -> click.Command:
    """Return the command of a set operation."""

    @files_argument("A B [C ...]")
    @from_files
    def run(**given: Any) -> int:
        return _Named(op, **given).run()

    epilog = f"\b\nExample:\n  {_EXAMPLES[op]}"
    return verb(op, help=_HELP[op], epilog=epilog)(run)


class _Named(SolidVerb):
    """A named set operation on two or more files."""

    def __init__(self, op: str, files: tuple[Path, ...], **settings: Any) -> None:
        if len(files) < 2:
            context = click.get_current_context()
            raise click.UsageError(f"{op} needs at least two files.", context)
        super().__init__(op, **settings)
        self._files = files
        self._solids: list[Solid] = []

    def paths(self) -> Sequence[Path]:
        return self._files

    def combined(self) -> "Solid":
        from ...operations.setops import OPERATIONS

        self._solids = [self.inputs.solid(path) for path in self._files]
        self.lap("read")
        return OPERATIONS[self.op](*self._solids)

    def cutters(self) -> "Sequence[Solid]":
        return self._solids[1:] if self.op == "difference" else ()

    def compared(self, result: "Solid") -> "CheckReport | None":
        from ...verify.check import check_result

        depth = self.settings["check"]
        return check_result(result, self.op, self._solids, depth)  # type: ignore[arg-type]


union = _verb("union")
difference = _verb("difference")
intersection = _verb("intersection")
xor = _verb("xor")
