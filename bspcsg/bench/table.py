"""Tables of a record: what was to be reached, what was, and who took how long."""

from typing import Any

from .cases import CASES
from .targets import OURS, exponent

Row = dict[str, Any]

#: The columns of the table of rows.
COLUMNS = ("case", "to reach", "reached", "met", OURS, "others", "memory MB", "answers")


def rows_of(record: dict[str, Any]) -> list[list[str]]:
    """Return one line for each target of each case."""
    lines = []
    for row in record["cases"]:
        if "left_out" in row:
            lines.append([row["title"], "", "left out", "", "", row["left_out"], "", ""])
            continue
        described = [_times(row, OURS), _others(row), _memory(row), _answers(row)]
        for number, target in enumerate(CASES[row["case"]].targets):
            reached = target.reached(row["items"])
            met = {True: "yes", False: "no", None: "—"}[reached.met]
            head = [row["title"] if number == 0 else "", target.text, reached.text, met]
            lines.append([*head, *(described if number == 0 else [""] * len(described))])
    return lines


def markdown(record: dict[str, Any]) -> str:
    """Return the table as Markdown, with a line about the machine."""
    lines = [list(COLUMNS), ["---"] * len(COLUMNS), *rows_of(record)]
    drawn = "\n".join(f"| {' | '.join(line)} |" for line in lines)
    return f"{about(record)}\n\n{drawn}\n"


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
    texts = [_time(item["engines"].get(engine)) for item in row["items"]]
    if len(texts) == 1:
        return texts[0]
    known = [t for item in row["items"] if (t := item["engines"].get(engine, {}).get("median"))]
    if not known:
        return texts[0]
    power = exponent(row["items"], engine)
    grown = f", n^{power:.2f}" if power is not None and row["case"] == "sizes" else ""
    return f"{seconds_text(min(known))} … {seconds_text(max(known))}{grown}"


def _time(found: Row | None) -> str:
    if not found:
        return "—"
    if found["state"] == "stopped":
        steps = f" at step {found['steps_done']}" if "steps_done" in found else ""
        return f"> {seconds_text(found['stopped_after'])}{steps}"
    if found["state"] != "ok":
        return found["state"]
    fewer = "" if found["runs"] >= 5 else f" ({found['runs']})"
    return f"{seconds_text(found['median'])}{fewer}"


def seconds_text(seconds: float) -> str:
    """Return a time with three digits and a unit that suits it."""
    if seconds < 1e-3:
        return f"{seconds * 1e6:.3g} µs"
    return f"{seconds * 1e3:.3g} ms" if seconds < 1 else f"{seconds:.3g} s"


def _others(row: Row) -> str:
    names = dict.fromkeys(name for item in row["items"] for name in item["engines"])
    return ", ".join(f"{name} {_times(row, name)}" for name in names if name != OURS)


def _memory(row: Row) -> str:
    peaks = [f["peak_mb"] for item in row["items"] if (f := item["engines"].get(OURS, {})).get("peak_mb")]
    return f"{max(peaks):.0f}" if peaks and CASES[row["case"]].alone else ""


def _answers(row: Row) -> str:
    """Say whether all other answers are ours within rounding, and who differs if not."""
    words = {name for item in row["items"] for name in _differing(item)}
    compared = any("agrees" in found for item in row["items"] for found in _all_others(item))
    if not compared:
        return "not compared"
    return "agree" if not words else "; ".join(sorted(words))


def _differing(item: Row) -> list[str]:
    words = [
        f"{name} differs by {found['difference']:.1e}, allowed {found['bound']:.1e} ({item['item']})"
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
