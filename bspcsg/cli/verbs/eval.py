"""The verb `eval`, which evaluates a set formula over files."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...errors import BspcsgError
from ..options.formula import File, Formula, FormulaError, evaluated, files_of, parse, subtracted
from ..options.patterns import matches
from ..options.shared import from_files, verb
from ..solid_verb import SolidVerb

if TYPE_CHECKING:
    from ...solid.solid import Solid

_HELP = """Write the set that a FORMULA over file names stands for.

\b
a | b, a + b   union             a & b   intersection
a - b          difference        a ^ b   what is inside exactly one
~a             what is outside   (a)     first this

~ binds tightest, then + and -, then &, then ^, then |, as in Python. Put names with blanks in
quotes, and blanks around + and -, which may be part of a name. A pattern such as hole*.stl means
the union of the files that it matches.
"""

_EPILOG = """\b
Example:
  bspcsg eval '(plate.stl - "hole 1.stl") | knob.stl' -o part.stl
"""


@verb("eval", help=_HELP, epilog=_EPILOG)
@click.argument("formula")
@from_files
def evaluate(formula: str, **given: Any) -> int:
    """Evaluate a formula and write the result; the help of the verb is in `_HELP`."""
    return _Evaluation(formula, **given).run()


class _Evaluation(SolidVerb):
    """The work of the verb `eval`: it evaluates a formula, reading each file once."""

    def __init__(self, formula: str, **settings: Any) -> None:
        self._text = formula
        try:
            self._formula: Formula = parse(formula)
        except FormulaError as error:
            raise click.UsageError(_with_caret(formula, error.message, error.column)) from None
        super().__init__("eval", **settings)
        self._cutters: list[Solid] = []

    def paths(self) -> Sequence[Path]:
        return [path for file in files_of(self._formula) for path in self._paths(file)]

    def cutters(self) -> "Sequence[Solid]":
        return self._cutters

    def combined(self) -> "Solid":
        solids = {file.name: self._loaded(file) for file in files_of(self._formula)}
        taken = subtracted(self._formula)
        self._cutters = [solid for name, solid in solids.items() if name in taken]
        self.lap("read")
        return evaluated(self._formula, lambda file: solids[file.name], _combined)

    def _paths(self, file: File) -> list[Path]:
        """Return the files that a name or a pattern in the formula means."""
        return matches(Path(file.name))

    def _loaded(self, file: File) -> "Solid":
        try:
            return _combined("union", [self.inputs.solid(path) for path in self._paths(file)])
        except BspcsgError as error:
            if error.code != "unreadable" or not any(sign in file.name for sign in "+-"):
                raise
            advice = (
                "Put blanks around + and - if they are operators and not part of the file name."
            )
            message = _with_caret(self._text, f"{error.message} {advice}", file.column)
            raise type(error)(message, error.code, error.where) from error


def _combined(name: str, solids: list["Solid"]) -> "Solid":
    from ...operations.setops import OPERATIONS

    if len(solids) == 1:
        return ~solids[0] if name == "complement" else solids[0]
    return OPERATIONS[name](*solids)


def _with_caret(formula: str, message: str, column: int) -> str:
    """Return a message, followed by the formula and a mark (^) under the column of an error."""
    if not formula.strip():
        return f"formula:{column + 1}: {message}"
    printed = "".join(" " if letter.isspace() else letter for letter in formula)
    return f"formula:{column + 1}: {message}\n  {printed}\n  {' ' * column}^"
