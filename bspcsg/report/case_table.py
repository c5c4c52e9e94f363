"""The table of all cases on the page of a campaign: its columns and cells."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from ..campaign.record import CaseRecord
from .formatting import NO_NUMBER, milliseconds, number, tone, whole
from .merging import rank


class Column(NamedTuple):
    """One column of the table of cases.

    Parameters
    ----------
    name : str
    title : str
    kind : {"text", "number"}
    shown : callable
        Returns the text of a case's cell.
    """

    name: str
    title: str
    kind: str
    shown: Callable[[CaseRecord], str]


class Row(NamedTuple):
    """One row of the table of cases; `card` is the id of the case's card in the page, or empty."""

    tone: str
    rank: int
    card: str
    cells: list[str]


def _triangles_in(case: CaseRecord) -> str:
    counts = [operand["triangles"] for operand in case["operands"]]
    known = [count for count in counts if count is not None]
    return whole(sum(known)) if known else NO_NUMBER


def _triangles_out(case: CaseRecord) -> str:
    return whole(facts["triangles"]) if (facts := case["ours"]) else NO_NUMBER


def _volume(case: CaseRecord) -> str:
    return number(facts["volume"]) if (facts := case["ours"]) else NO_NUMBER


def _euler(case: CaseRecord) -> str:
    return whole(facts["euler_number"]) if (facts := case["ours"]) else NO_NUMBER


def _parts(case: CaseRecord) -> str:
    return whole(facts["components"]) if (facts := case["ours"]) else NO_NUMBER


def _difference(case: CaseRecord) -> str:
    return number(found["volume"], 3) if (found := case["set_difference"]) else NO_NUMBER


def _thickness(case: CaseRecord) -> str:
    return number(found["thickness"], 3) if (found := case["set_difference"]) else NO_NUMBER


def _distance(case: CaseRecord) -> str:
    found = case["hausdorff"]
    return number(max(found["forward"], found["backward"]), 3) if found else NO_NUMBER


def _oracle_time(case: CaseRecord) -> str:
    return milliseconds(case["oracles"][0]["seconds"] if case["oracles"] else None)


def _memory(case: CaseRecord) -> str:
    return NO_NUMBER if case["memory_mb"] is None else whole(round(case["memory_mb"]))


COLUMNS = (
    Column("verdict", "verdict", "text", lambda case: case["verdict"]),
    Column("case", "case", "text", lambda case: case["case"]),
    Column("operation", "operation", "text", lambda case: case["operation"]),
    Column("triangles_in", "triangles in", "number", _triangles_in),
    Column("triangles_out", "out", "number", _triangles_out),
    Column("volume", "volume", "number", _volume),
    Column("difference", "set difference", "number", _difference),
    Column("thickness", "its thickness", "number", _thickness),
    Column("hausdorff", "Hausdorff", "number", _distance),
    Column("euler", "Euler", "number", _euler),
    Column("parts", "surfaces", "number", _parts),
    Column("ours", "bspcsg ms", "number", lambda case: milliseconds(case["seconds"]["ours"])),
    Column("oracle", "oracle ms", "number", _oracle_time),
    Column("memory", "MB", "number", _memory),
)


def table(cases: Sequence[CaseRecord], cards: dict[str, str]) -> tuple[list[Column], list[Row]]:
    """Return the columns that are not empty, and a row for each case.

    Parameters
    ----------
    cases : sequence of CaseRecord
    cards : dict of str to str
        The ids of cards in the page, by the keys of their cases.
    """
    rows = [[column.shown(case) for column in COLUMNS] for case in cases]
    used = [k for k in range(len(COLUMNS)) if k < 3 or any(row[k] != NO_NUMBER for row in rows)]
    return [COLUMNS[k] for k in used], [
        Row(
            tone(case["verdict"]),
            rank(case),
            cards.get(case["key"], ""),
            [row[k] for k in used],
        )
        for case, row in zip(cases, rows, strict=True)
    ]
