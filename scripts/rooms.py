"""Draws core/rooms.svg: the rooms of both languages and which uses which.

Rows are floors. An arrow that follows from others is left out; one that points up is red. Of
another checkout the picture goes to a file, and with --figures nothing is drawn, but counted.
"""

import argparse
from pathlib import Path

import networkx as nx

from house_figures import table
from import_graph import (
    ROOT,
    Floors,
    python_floors,
    python_graph,
    room_of,
    rust_floors,
    rust_graph,
)

PICTURE = ROOT / "core" / "rooms.svg"


def picture(root: Path = ROOT) -> str:
    """Return the rooms of both languages as SVG."""
    columns = (
        ("bspcsg", python_graph(root), python_floors(root)),
        ("core/src", rust_graph(root), rust_floors(root)),
    )
    height = 60 + _ROW * max(len(floors) for _, _, floors in columns)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="960" height="{height}"'
        ' font-family="sans-serif" font-size="12" text-anchor="middle">',
        f'<rect width="960" height="{height}" fill="#fff"/>',
    ]
    for left, width, column in zip((10, 740), (720, 210), columns, strict=True):
        parts += _column(*column, left, width)
    return "\n".join([*parts, "</svg>", ""])


#: Pixels from one floor to the next.
_ROW = 44


def _column(title: str, graph: nx.DiGraph, floors: Floors, left: int, width: int) -> list[str]:
    places = {
        room: (left + width * (2 * number + 1) / (2 * len(row)), 50 + _ROW * floor)
        for floor, row in enumerate(floors)
        for number, room in enumerate(row)
    }
    between = nx.DiGraph(
        (room_of(a), room_of(b)) for a, b in graph.edges if room_of(a) != room_of(b)
    )
    kept, up = _arrows(between.subgraph(places), floors)
    parts = [f'<text x="{left + width / 2}" y="22" font-size="15">{title}</text>']
    for a, b in sorted(kept.edges):
        (x1, y1), (x2, y2) = places[a], places[b]
        parts.append(f'<path d="M{x1:.0f} {y1 + 13:.0f}L{x2:.0f} {y2 - 13:.0f}" stroke="#9aa"/>')
    for a, b in sorted(up):
        (x1, y1), (x2, y2) = places[a], places[b]
        parts.append(f'<path d="M{x1:.0f} {y1:.0f}L{x2:.0f} {y2:.0f}" stroke="#c33"/>')
    for room, (x, y) in places.items():
        half = 4 * len(room) + 12
        parts.append(
            f'<rect x="{x - half:.0f}" y="{y - 13:.0f}" width="{2 * half}" height="26" rx="4"'
            f' fill="#eef3f8" stroke="#678"/><text x="{x:.0f}" y="{y + 4:.0f}">{room}</text>'
        )
    return parts


def _arrows(between: nx.DiGraph, floors: Floors) -> tuple[nx.DiGraph, list[tuple[str, str]]]:
    """Return the arrows down that follow from no others, and those that do not point down."""
    floor = {room: number for number, row in enumerate(floors) for room in row}
    up = [(a, b) for a, b in between.edges if floor[a] >= floor[b]]
    down = nx.DiGraph(edge for edge in between.edges if edge not in up)
    return nx.transitive_reduction(down), up


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--of", type=Path, default=ROOT, metavar="CHECKOUT", help="another one")
    parser.add_argument("--out", type=Path, default=PICTURE, help="by default core/rooms.svg")
    parser.add_argument("--figures", action="store_true", help="print sizes, shares and circles")
    options = parser.parse_args()
    if options.figures:
        print(table(options.of.resolve()), end="")
    else:
        options.out.write_text(picture(options.of.resolve()), encoding="utf-8")


if __name__ == "__main__":
    main()
