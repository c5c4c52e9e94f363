"""Tables in the terminal, drawn by rich without colours."""

from collections.abc import Iterable, Sequence


def table_text(
    columns: Sequence[str], rows: Iterable[Sequence[str]], right: Sequence[str] = ()
) -> str:
    """Return a table as lines of text.

    Parameters
    ----------
    columns : sequence of str
        The first may be of any length and is never cut.
    rows : iterable of sequence of str
    right : sequence of str
        Columns to align at the right.
    """
    from io import StringIO

    from rich import box
    from rich.console import Console
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for name in columns:
        table.add_column(name, justify="right" if name in right else "left", no_wrap=True)
    listed = [list(row) for row in rows]
    for row in listed:
        table.add_row(*row)
    # Wide enough for any entry: a table in a pipe or a log must not lose letters.
    texts = [list(columns), *listed]
    width = 80 + sum(max(len(row[k]) for row in texts) for k in range(len(columns)))
    drawn = StringIO()
    Console(file=drawn, width=width, highlight=False, markup=False).print(table)
    return "\n".join(line.rstrip() for line in drawn.getvalue().splitlines() if line.strip())
