"""Draws core/rooms.svg: the rooms of both languages and which uses which.

Rows are floors. An arrow that follows from others is left out.
"""

import networkx as nx

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


def picture() -> str:
    """Return the rooms of both languages as SVG."""
    columns = (
        ("bspcsg", python_graph(), python_floors()),
        ("core/src", rust_graph(), rust_floors()),
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
    kept = nx.transitive_reduction(between.subgraph(places))
    parts = [f'<text x="{left + width / 2}" y="22" font-size="15">{title}</text>']
    for a, b in sorted(kept.edges):
        (x1, y1), (x2, y2) = places[a], places[b]
        parts.append(f'<path d="M{x1:.0f} {y1 + 13:.0f}L{x2:.0f} {y2 - 13:.0f}" stroke="#9aa"/>')
    for room, (x, y) in places.items():
        half = 4 * len(room) + 12
        parts.append(
            f'<rect x="{x - half:.0f}" y="{y - 13:.0f}" width="{2 * half}" height="26" rx="4"'
            f' fill="#eef3f8" stroke="#678"/><text x="{x:.0f}" y="{y + 4:.0f}">{room}</text>'
        )
    return parts


if __name__ == "__main__":
    PICTURE.write_text(picture(), encoding="utf-8")
