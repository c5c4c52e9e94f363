"""Tables as text for the terminal, drawn by the package rich without colours."""

from collections.abc import Iterable, Sequence

from ...errors import without_control_characters
from . import terminal

#: The character of a table's horizontal lines on a terminal, and in a pipe or a file.
_RULE, _PLAIN_RULE = "─", "-"

#: The number of characters that a table's column takes besides its text.
_MARGIN = 3


def table_text(
    columns: Sequence[str], rows: Iterable[Sequence[str]], right: Sequence[str] = ()
) -> str:
    """Return a table as text that fits the terminal; in a pipe, the width is not limited.

    Words are not broken: if the terminal is too narrow for the longest word of each column, each
    row becomes several lines of a name and a value.

    Parameters
    ----------
    columns : sequence of str
    rows : iterable of sequence of str
    right : sequence of str
        Names of the columns to align at the right.
    """
    from rich.cells import cell_len

    columns, *listed = [
        [without_control_characters(entry) for entry in row] for row in (columns, *rows)
    ]
    entries = list(zip(columns, *listed, strict=True))
    width = terminal.output_width()
    # In a pipe or a file, no text of the table may be cut off.
    widths = [max(map(cell_len, column)) for column in entries]
    if width is None:
        whole = sum(widths) + _MARGIN * len(columns)
        return _drawn(columns, listed, right, widths, whole).replace(_RULE, _PLAIN_RULE)
    least = [max(_longest_word(entry) for entry in column) for column in entries]
    if sum(least) + _MARGIN * len(columns) > width:
        return "\n\n".join(_stacked(columns, row) for row in listed)
    return _drawn(columns, listed, right, least, width)


def _longest_word(text: str) -> int:
    from rich.cells import cell_len

    # Do not split at no-break spaces, which keep the digits of a number together.
    return max(map(cell_len, text.split(" ")))


def _stacked(columns: Sequence[str], row: Sequence[str]) -> str:
    named = max(map(len, columns))
    pairs = zip(columns, row, strict=True)
    return "\n".join(f"{name:{named}}  {value}".strip() for name, value in pairs if value)


def _drawn(
    columns: Sequence[str],
    rows: Sequence[Sequence[str]],
    right: Sequence[str],
    least: Sequence[int],
    width: int,
) -> str:
    from io import StringIO

    from rich import box
    from rich.console import Console
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for name, narrowest in zip(columns, least, strict=True):
        if name in right:
            table.add_column(name, justify="right", min_width=narrowest)
        else:
            table.add_column(name, min_width=narrowest)
    for row in rows:
        table.add_row(*row)
    drawn = StringIO()
    # A word between colons is a name, not the name of an emoji.
    console = Console(file=drawn, width=width, highlight=False, markup=False, emoji=False)
    console.print(table)
    return "\n".join(line.rstrip() for line in drawn.getvalue().splitlines() if line.strip())
