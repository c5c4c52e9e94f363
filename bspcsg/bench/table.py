"""Tables of a benchmark record: targets, results, and the times of all engines."""

from typing import Any

from .cases import CASES
from .targets import MAIN_RIVAL, OURS, DoublingTarget, Faster, ratio
from .times import seconds_text

Row = dict[str, Any]

#: A median of fewer runs than this is printed with the number of runs.
_MIN_RUNS_FOR_MEDIAN = 5

#: The number of the worst results that are named.
_WORST = 12

#: The text for a missing figure.
_MISSING = "—"

_MET = {True: "yes", False: "no", None: _MISSING}


def lines_of(record: dict[str, Any], titles: bool) -> list[list[str]]:
    """Return the result table: a row of column names, and a row for each target of each case.

    Parameters
    ----------
    record : dict
        The record, as from `bspcsg.bench.record.read`.
    titles : bool
        True for the titles of cases instead of their names.
    """
    engines = _engines_of(record)
    lines = [["case", "to reach", "reached", "met", *engines, "memory", "answers"]]
    for row in record["cases"]:
        name = _title(row) if titles else row["case"]
        lines += _lines_of_row(row, name, engines)
    return lines


def detail_lines(record: dict[str, Any]) -> list[list[str]]:
    """Return a table of all figures: a row of column names, and a row for each item and engine."""
    head = ["case", "item", "engine", "first", "wall", "processor", "page faults", "peak"]
    found = [
        [row["case"], item["item"], name, *_figures(result)]
        for row in record["cases"]
        for item in row["items"]
        for name, result in item["engines"].items()
    ]
    return [head, *found]


def _figures(found: Row) -> list[str]:
    times = [_or_nothing(found.get(name)) for name in ("cold", "median", "cpu")]
    faults, peak = found.get("faults"), found.get("peak_mb")
    return [
        *times,
        _MISSING if faults is None else f"{faults:.0f}",
        f"{peak:.0f} MB" if peak else _MISSING,
    ]


def _or_nothing(seconds: float | None) -> str:
    return seconds_text(seconds) if seconds else _MISSING


def remarks(record: dict[str, Any]) -> list[str]:
    """Return sentences about the record: targets reached and missed, and items left out."""
    met = [
        (row["case"], target.reached(row["items"]).met)
        for row in record["cases"]
        if not row.get("small") and "left_out" not in row
        for target in CASES[row["case"]].targets
    ]
    said = [_counted(met)] if met else []
    dense = [
        row for row in record["cases"] if _doubling(row) and row["items"] and not row.get("small")
    ]
    said += _dense_cases_sentence(dense) if dense else []
    said += _worst_sentences(record["cases"])
    return said + [
        f"{row['case']}, {label}: left out, {reason}."
        for row in record["cases"]
        for label, reason in row.get("too_large", {}).items()
    ]


def _worst_sentences(rows: list[Row]) -> list[str]:
    """Return a sentence for each of the worst results of meshes from files."""
    items = [
        (found, row["case"], item)
        for row in rows
        for item in row["items"]
        if item.get("names") and (found := ratio(item, MAIN_RIVAL)) is not None
    ]
    worst = sorted(items, key=lambda each: each[0].value)[:_WORST]
    return [
        f"Worst: {found.text} {MAIN_RIVAL}, {case}, {item['item']} of {' and '.join(item['names'])}"
        f" ({item['triangles']} triangles), {_time(item['engines'][OURS])} against"
        f" {_time(item['engines'][MAIN_RIVAL])}."
        for found, case, item in worst
    ]


def _counted(met: list[tuple[str, bool | None]]) -> str:
    missed = list(dict.fromkeys(name for name, found in met if found is False))
    unknown = list(dict.fromkeys(name for name, found in met if found is None))
    said = f"Reached: {sum(found is True for _, found in met)} of {len(met)} targets."
    said += f" Missed: {', '.join(missed)}." if missed else ""
    return said + (f" No figure: {', '.join(unknown)}." if unknown else "")


def _dense_cases_sentence(rows: list[Row]) -> list[str]:
    """Return a sentence that names the dense cases that are too slow or grow too fast."""
    slow = [row["case"] for row in rows if _least_ratio(row) is False]
    grown = [row["case"] for row in rows if has_cliff(row)]
    return [
        f"Dense places: {len(rows)}. Slower than {MAIN_RIVAL}: {_named(slow)}."
        f" Cost grows more than allowed: {_named(grown)}."
    ]


def _named(names: list[str]) -> str:
    return f"{len(names)} ({', '.join(names)})" if names else "none"


def _least_ratio(row: Row) -> bool | None:
    """Return true if bspcsg is at least as fast as the main rival on each item, None if unknown."""
    return Faster(1).reached(row["items"]).met


def _doubling(row: Row) -> DoublingTarget | None:
    found = (goal for goal in CASES[row["case"]].targets if isinstance(goal, DoublingTarget))
    return next(found, None)


def has_cliff(row: Row) -> bool:
    """Return true if a full-size row has a target for the growth of our cost, and misses it."""
    target = _doubling(row)
    return bool(target and not row.get("small") and target.reached(row["items"]).met is False)


def _engines_of(record: dict[str, Any]) -> list[str]:
    """Return the names of all engines in the record, ours first."""
    engines = (name for row in record["cases"] for i in row["items"] for name in i["engines"])
    return list(dict.fromkeys([OURS, *engines]))


def _title(row: Row) -> str:
    sizes = ", ".join(item["item"] for item in row["items"])
    return f"{row['title']} (small: {sizes})" if row.get("small") else str(row["title"])


def _lines_of_row(row: Row, name: str, engines: list[str]) -> list[list[str]]:
    """Return one row for each target of a case; only the first has the columns of the case."""
    if "left_out" in row:
        return [[name, "", "left out", "", *[""] * len(engines), "", row["left_out"]]]
    described = [*(_times(row, engine) for engine in engines), _memory(row), _answers(row)]
    lines = []
    for target in CASES[row["case"]].targets:
        reached = target.reached(row["items"])
        # Targets do not apply to small items.
        met = None if row.get("small") else reached.met
        head = [name, target.text, reached.text, _MET[met]]
        lines.append([*head, *described])
        name, described = "", [""] * len(described)
    return lines


def markdown(record: dict[str, Any]) -> str:
    """Return the result table as Markdown, with the machine, the versions and remarks."""
    head, *lines = lines_of(record, titles=True)
    drawn = [f"| {' | '.join(line)} |" for line in [head, ["---"] * len(head), *lines]]
    said = [line for remark in remarks(record) for line in ("", remark)]
    return "\n".join([about(record), "", *drawn, *said, ""])


def counter_lines(record: dict[str, Any]) -> list[list[str]]:
    """Return a table of our engine's counters: a row of column names, and a row for each item."""
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
    """Return a sentence about the machine and the versions of a record."""
    machine = record["machine"]
    versions = ", ".join(f"{name} {found}" for name, found in record["versions"].items())
    return (
        f"{machine['processor']}, {machine['cores']} cores, {machine['memory_gb']} GB,"
        f" {machine['system']}; {versions}. Medians of {record['runs']} runs in alternation in one"
        " process, after one that warms up, wall / processor time; fewer where the number stands in"
        " brackets."
    )


def _times(row: Row, engine: str) -> str:
    """Return the median time of an engine as text, or the range of medians of several items."""
    found = [item["engines"].get(engine) for item in row["items"]]
    known = [result for result in found if result and result["median"]]
    if len(found) < 2 or not known:
        return _time(found[0] if found else None)
    missing = f", {len(found) - len(known)} missing" if len(known) < len(found) else ""
    both = [_range([result[name] for result in known]) for name in ("median", "cpu")]
    return f"{' / '.join(both)}{missing}"


def _range(times: list[float]) -> str:
    return f"{seconds_text(min(times))} … {seconds_text(max(times))}"


def _time(found: Row | None) -> str:
    if not found:
        return _MISSING
    if found["state"] == "stopped":
        steps = f" at step {found['steps_done']}" if "steps_done" in found else ""
        return f"> {seconds_text(found['stopped_after'])}{steps}"
    if found["state"] != "ok":
        return str(found["state"])
    fewer = "" if found["runs"] >= _MIN_RUNS_FOR_MEDIAN else f" ({found['runs']})"
    return f"{seconds_text(found['median'])} / {seconds_text(found['cpu'])}{fewer}"


def _memory(row: Row) -> str:
    """Return the peak memory of our process as text, if the case runs each engine alone."""
    peaks = [item["engines"].get(OURS, {}).get("peak_mb") for item in row["items"]]
    known = [peak for peak in peaks if peak]
    return f"{max(known):.0f} MB" if known and CASES[row["case"]].alone else ""


def _answers(row: Row) -> str:
    """Return "agree" if all results equal ours within rounding, "not compared", or which differ."""
    words = {name for item in row["items"] for name in _differing(item)}
    compared = any("agrees" in found for item in row["items"] for found in _all_answers(item))
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
    if ours.get("proof", {}).get("agrees") is False:
        words.append(f"{OURS}: {ours['proof']['text']} ({item['item']})")
    if ours.get("facts", {}).get("open_edges"):
        words.append(f"{OURS}: open edges ({item['item']})")
    return words


def _all_answers(item: Row) -> list[Row]:
    """Return the results and checks of an item, dicts that may have the key "agrees"."""
    proof = item["engines"].get(OURS, {}).get("proof", {})
    return [*item["engines"].values(), item.get("at_once", {}), proof]
