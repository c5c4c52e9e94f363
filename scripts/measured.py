"""Write the tables of docs/measured.md from the table of the last release, docs/records/*.json.

    scripts/measured [--check]
    scripts/measured --release VERSION [--records FOLDER]

With --release the headline figures of the records that measuring scripts wrote to out/records
become docs/records/VERSION.json first; `scripts/bench -o out/records/bench.json` is such a script.
If a record is missing, the figures of the previous release stay, with their machine.
"""

import argparse
import json
import re
import sys
from collections.abc import Callable
from math import prod
from pathlib import Path
from typing import Any

from bspcsg.bench.table import has_cliff, lines_of
from bspcsg.bench.targets import MAIN_RIVAL, ratio
from recording import RECORDS, RELEASES, REPOSITORY, release

PAGE = REPOSITORY / "docs" / "measured.md"

Record = dict[str, Any]
Rows = list[list[str]]

#: The cases of `bspcsg bench` that are shown.
_CASES = (
    *["spheres-82k", "spheres-1310k", "spheres-1310k-one-core", "built-1310k"],
    *["large-pairs", "medium-pairs", "tiny-pairs", "overlap-pairs"],
    *["drilled-steps", "drilled-expression", "boxes-steps"],
    *["milled-cylinders", "milled-capsules", "capsules", "menger-4", "cubes", "coincident"],
    *["needles", "dome", "files-checked", "files-unchecked"],
)

#: The verdicts of campaigns that are shown.
_VERDICTS = ("agree", "same set, other topology", "within rounding", "oracle failed", "DISAGREE")

#: The comment above each table.
_MARK = "<!-- {} by scripts/measured -->\n"


def _bench(record: Record) -> Rows:
    cases = [row for row in record["cases"] if row["case"] in _CASES]
    head, *lines = lines_of({"cases": cases}, titles=True)
    engines = head[head.index("met") + 1 : head.index("memory")]
    rows = [["case", *(_named(record, name) for name in engines), f"times {MAIN_RIVAL}"]]
    for row, line in zip(cases, (line for line in lines if line[0]), strict=True):
        cell = dict(zip(head, line, strict=True))
        ours, *theirs = (cell[name] for name in engines)
        ours = ", ".join(filter(None, [ours, cell["memory"]]))
        rows.append([cell["case"], ours, *theirs, _ratio_text(row["items"])])
    return rows


def _named(record: Record, engine: str) -> str:
    return f"{engine} {record['versions'].get(engine, '')}".strip()


def _ratio_text(items: list[Record]) -> str:
    """Return how many times as long the main rival takes, as text: geometric mean and minimum."""
    ratios = [found.value for item in items if (found := ratio(item, MAIN_RIVAL))]
    if not ratios:
        return "—"
    mean = f"{prod(ratios) ** (1 / len(ratios)):.2g}"
    return mean if len(ratios) == 1 else f"{mean}, at least {min(ratios):.2g}"


def _dense(record: Record) -> Rows:
    rows = [row for row in record["cases"] if row["case"].startswith("dense-")]
    ratios = [[ratio(item, MAIN_RIVAL) for item in row["items"]] for row in rows]
    slower = sum(any(found and found.value < 1 for found in each) for each in ratios)
    grown = sum(map(has_cliff, rows))
    head = ["dense places", f"slower than {MAIN_RIVAL}", "cost grows faster than input and answer"]
    return [head, [str(len(rows)), str(slower), str(grown)]]


def _campaign(record: Record) -> Rows:
    rows = [
        [name, *(str(counts.get(verdict, 0)) for verdict in _VERDICTS)]
        for name, counts in record["operations"].items()
    ]
    return [["operation", *_VERDICTS], *rows]


def _rays(record: Record) -> Rows:
    rows = [
        [
            f"{row['case']}: {row['question']}",
            *(f"{row[f'{engine}_rays_per_s'] / 1e6:.2f}" for engine in ("bspcsg", "embreex")),
        ]
        for row in record["questions"]
        if row["case"].startswith("camera")
    ]
    return [["million rays a second", "bspcsg", "embree"], *rows]


def _instructions(record: Record) -> Rows:
    counts = record["counts"]
    return [[*counts], [f"{count / 1e6:.3g}" for count in counts.values()]]


#: The tables of a release: for each the name of its record, and the function that makes its rows.
_TABLES: dict[str, tuple[str, Callable[[Record], Rows]]] = {
    "times": ("bench", _bench),
    "dense places": ("bench", _dense),
    "rays": ("bench_rays", _rays),
    "instructions": ("instructions", _instructions),
    "campaign": ("campaign", _campaign),
}


def condensed(records: Path, before: Record) -> Record:
    """Return the table of a release from records in a folder; missing ones are as in `before`."""
    found = dict(before)
    for name, (source, rows) in _TABLES.items():
        path = records / f"{source}.json"
        if path.is_file():
            record = json.loads(path.read_text("utf-8"))
            found[name] = {"machine": _place(record), "rows": rows(record)}
    peers = records / "peers.json"
    if peers.is_file():
        record = json.loads(peers.read_text("utf-8"))
        found["peers"] = {**record, "machine": _place(record)}
    return found


def _place(record: Record) -> str:
    machine = record["machine"]
    when = machine.get("date") or record["date"].partition("T")[0]
    words = [when, machine["processor"], f"{machine['cores']} cores", f"{machine['memory_gb']} GB"]
    return ", ".join([*words, machine["system"]])


def written(table: Record) -> str:
    """Return the table of a release as JSON text, with one row a line."""
    text = json.dumps(table, indent=1, ensure_ascii=False)
    return re.sub(r"\n {4,}|\n {3}(?=[\]}])", " ", text) + "\n"


def page(text: str, table: Record) -> str:
    """Return the text of a page with its tables replaced."""
    for name in _TABLES:
        before, mark, rest = text.partition(_MARK.format(name))
        if not mark:
            raise SystemExit(f"measured: {PAGE.name} needs the line {_MARK.format(name).strip()}")
        after = rest.splitlines(keepends=True)
        while after and after[0].startswith(("|", "\n")):
            del after[0]
        text = "\n".join([before + mark, _as_markdown(table[name]["rows"]), "".join(after)])
    return f"{text.rstrip()}\n"


def _as_markdown(rows: Rows) -> str:
    head, *body = ([cell.replace("|", "\\|") for cell in row] for row in rows)
    lines = [head, ["---"] * len(head), *body]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing; fail if outdated")
    parser.add_argument("--release", metavar="VERSION", help="make the table of a release, as 1.1")
    parser.add_argument("--records", type=Path, default=RECORDS, help="by default out/records")
    options = parser.parse_args(arguments)
    if options.release:
        table = condensed(options.records, release())
        (RELEASES / f"{options.release}.json").write_text(written(table), encoding="utf-8")
    text = PAGE.read_text(encoding="utf-8")
    fresh = page(text, release())
    if options.check:
        print("the tables are up to date" if fresh == text else "outdated; run scripts/measured")
        return int(fresh != text)
    PAGE.write_text(fresh, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
