"""Tables of a record: what was to be reached, what was, and who took how long."""

from typing import Any

from .cases import CASES
from .record import seconds_text
from .targets import OURS

Row = dict[str, Any]

#: Runs whose median needs no remark.
_ENOUGH = 5

#: The sign in place of a figure that there is none of.
_NOTHING = "—"

_MET = {True: "yes", False: "no", None: _NOTHING}


def lines_of(record: dict[str, Any], titles: bool) -> list[list[str]]:
    """Return the table: a line of columns' names, and one for each target of each case.

    Parameters
    ----------
    record : dict
        As `bspcsg.bench.record.read` returns it.
    titles : bool
        True if cases stand with their titles, instead of their names.
    """
    engines = _engines_of(record)
    lines = [["case", "to reach", "reached", "met", *engines, "memory", "answers"]]
    for row in record["cases"]:
        name = _title(row) if titles else row["case"]
        lines += _lines_of_row(row, name, engines)
    return lines


def _engines_of(record: dict[str, Any]) -> list[str]:
    """Return all engines that took part, ours first."""
    engines = (name for row in record["cases"] for i in row["items"] for name in i["engines"])
    return list(dict.fromkeys([OURS, *engines]))


def _title(row: Row) -> str:
    sizes = ", ".join(item["item"] for item in row["items"])
    return f"{row['title']} (small: {sizes})" if row.get("small") else str(row["title"])


def _lines_of_row(row: Row, name: str, engines: list[str]) -> list[list[str]]:
    """Return one line for each target; what is the same for all stands in the first."""
    if "left_out" in row:
        return [[name, "", "left out", "", *[""] * len(engines), "", row["left_out"]]]
    described = [*(_times(row, engine) for engine in engines), _memory(row), _answers(row)]
    lines = []
    for target in CASES[row["case"]].targets:
        reached = target.reached(row["items"])
        # Targets are meant for the full size.
        met = None if row.get("small") else reached.met
        head = [name, target.text, reached.text, _MET[met]]
        lines.append([*head, *described])
        name, described = "", [""] * len(described)
    return lines


def markdown(record: dict[str, Any]) -> str:
    """Return the table as Markdown, with a line about the machine."""
    head, *lines = lines_of(record, titles=True)
    drawn = [f"| {' | '.join(line)} |" for line in [head, ["---"] * len(head), *lines]]
    return "\n".join([about(record), "", *drawn, ""])


def counter_lines(record: dict[str, Any]) -> list[list[str]]:
    """Return a table of our counters: a line of columns' names, and one for each item."""
    counted = [
        (row["case"], item["item"], found)
        for row in record["cases"]
        for item in row["items"]
        if (found := item["engines"].get(OURS, {}).get("counters"))
    ]
    names = list(dict.fromkeys(name for _, _, found in counted for name in found))
    lines = [[case, item, *(str(found.get(n, "")) for n in names)] for case, item, found in counted]
    return [["case", "item", *names], *lines]


def about(record: dict[str, Any]) -> str:
    """Return a sentence about machine and versions."""
    machine = record["machine"]
    versions = ", ".join(f"{name} {found}" for name, found in record["versions"].items())
    return (
        f"{machine['processor']}, {machine['cores']} cores, {machine['memory_gb']} GB,"
        f" {machine['system']}; {versions}. Medians of {record['runs']} runs in alternation in one"
        " process, fewer where the number stands in brackets."
    )


def _times(row: Row, engine: str) -> str:
    """Return the median of an engine, or from the least to the greatest of several items."""
    found = [item["engines"].get(engine) for item in row["items"]]
    known = [result["median"] for result in found if result and result["median"]]
    if len(found) == 1 or not known:
        return _time(found[0])
    missing = f", {len(found) - len(known)} missing" if len(known) < len(found) else ""
    return f"{seconds_text(min(known))} … {seconds_text(max(known))}{missing}"


def _time(found: Row | None) -> str:
    if not found:
        return _NOTHING
    if found["state"] == "stopped":
        steps = f" at step {found['steps_done']}" if "steps_done" in found else ""
        return f"> {seconds_text(found['stopped_after'])}{steps}"
    if found["state"] != "ok":
        return str(found["state"])
    fewer = "" if found["runs"] >= _ENOUGH else f" ({found['runs']})"
    return f"{seconds_text(found['median'])}{fewer}"


def _memory(row: Row) -> str:
    """Return the peak of our process where it did nothing else."""
    peaks = [item["engines"].get(OURS, {}).get("peak_mb") for item in row["items"]]
    known = [peak for peak in peaks if peak]
    return f"{max(known):.0f} MB" if known and CASES[row["case"]].alone else ""


def _answers(row: Row) -> str:
    """Say whether all other answers are ours within rounding, and who differs if not."""
    words = {name for item in row["items"] for name in _differing(item)}
    compared = any("agrees" in found for item in row["items"] for found in _all_others(item))
    if not compared:
        return "not compared"
    return "agree" if not words else "; ".join(sorted(words))


def _differing(item: Row) -> list[str]:
    words = [
        f"{name} differs by {found['difference']:.1e}, {found['bound']:.1e} allowed"
        for name, found in item["engines"].items()
        if found.get("agrees") is False
    ]
    if item.get("at_once", {}).get("agrees") is False:
        words.append(f"manifold3d at once differs by {item['at_once']['difference']:.1e}")
    ours = item["engines"].get(OURS, {})
    if ours.get("facts", {}).get("open_edges"):
        words.append(f"{OURS}: open edges ({item['item']})")
    return words


def _all_others(item: Row) -> list[Row]:
    return [*(f for name, f in item["engines"].items() if name != OURS), item.get("at_once", {})]
