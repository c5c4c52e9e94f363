"""Draw time against number of triangles as SVG with logarithmic axes."""

from dataclasses import dataclass
from html import escape
from math import ceil, floor, log10
from typing import Any

from .targets import OURS, exponent
from .times import seconds_text

#: The name of the case that is drawn.
_CASE = "sizes"

_WIDTH, _HEIGHT = 860, 520

#: The area between the axes, in pixels; the names of the lines are to the right of it.
_LEFT, _TOP, _RIGHT, _BOTTOM = 80, 60, 690, 450

_STYLE = (
    "text{font:13px system-ui,sans-serif;fill:#1a1c20}"
    ".title{font-size:16px;font-weight:600}.small{font-size:12px;fill:#5a606a}"
    ".grid{stroke:#e3e6ea;stroke-width:1}.line{fill:none;stroke-width:2}"
)

_OUR_COLOUR = "#c2410c"

#: The colours of the other engines, in the order of the record.
_COLOURS = ("#1d4ed8", "#15803d", "#7e22ce", "#0e7490", "#6b7280")

#: The least vertical distance of two names, in pixels.
_NAME_HEIGHT = 18


@dataclass(frozen=True)
class _Line:
    name: str
    colour: str
    points: list[tuple[float, float]]
    power: float | None


@dataclass(frozen=True)
class _Scale:
    """A logarithmic axis: its least and greatest power of ten, and their pixels."""

    least: int
    most: int
    start: float
    end: float

    @classmethod
    def around(cls, values: list[float], start: float, end: float) -> "_Scale":
        """Return the axis from the power of ten below all values to the power above them."""
        least = floor(log10(min(values)))
        return cls(least, max(ceil(log10(max(values))), least + 1), start, end)

    def at(self, value: float) -> float:
        """Return the pixel coordinate of a value."""
        part = (log10(value) - self.least) / (self.most - self.least)
        return self.start + part * (self.end - self.start)

    @property
    def powers(self) -> list[float]:
        """The powers of ten at which grid lines are drawn."""
        return [10.0**k for k in range(self.least, self.most + 1)]


def plot(record: dict[str, Any]) -> str:
    """Return the text of an SVG file with the times of the case `sizes`.

    Parameters
    ----------
    record : dict
        The record, as from `bspcsg.bench.record.read`. If it lacks the case, the drawing says so.
    """
    lines = _lines_of(record)
    if not lines:
        return _svg(
            [
                _text(
                    _LEFT,
                    _TOP,
                    f"The record has no times of the case {_CASE}; run bspcsg bench {_CASE}.",
                )
            ]
        )
    points = [point for line in lines for point in line.points]
    across = _Scale.around([size for size, _ in points], _LEFT, _RIGHT)
    upwards = _Scale.around([seconds for _, seconds in points], _BOTTOM, _TOP)
    body = [_text(_LEFT, 30, "Difference of two spheres, arrays to arrays", "title")]
    body += _grid(across, upwards)
    body += [_drawn(line, across, upwards) for line in lines]
    body += _names(lines, upwards)
    return _svg(body)


def _lines_of(record: dict[str, Any]) -> list[_Line]:
    items = [item for row in record["cases"] if row["case"] == _CASE for item in row["items"]]
    names = dict.fromkeys(name for item in items for name in item["engines"])
    colours = iter(_COLOURS)
    lines = []
    for name in names:
        points = [
            (float(item["triangles"]), seconds)
            for item in items
            if (seconds := item["engines"].get(name, {}).get("median"))
        ]
        if points:
            colour = _OUR_COLOUR if name == OURS else next(colours, _COLOURS[-1])
            lines.append(_Line(name, colour, points, exponent(items, name)))
    return lines


def _grid(across: _Scale, upwards: _Scale) -> list[str]:
    body = []
    for size in across.powers:
        x = across.at(size)
        body.append(f'<path class="grid" d="M{x:.1f},{_TOP}V{_BOTTOM}"/>')
        body.append(_text(x, _BOTTOM + 20, _count(size), "small", "middle"))
    for seconds in upwards.powers:
        y = upwards.at(seconds)
        body.append(f'<path class="grid" d="M{_LEFT},{y:.1f}H{_RIGHT}"/>')
        body.append(_text(_LEFT - 8, y + 4, seconds_text(seconds), "small", "end"))
    middle = (_LEFT + _RIGHT) / 2
    return [*body, _text(middle, _BOTTOM + 46, "triangles of both operands", "small", "middle")]


def _drawn(line: _Line, across: _Scale, upwards: _Scale) -> str:
    spots = [(across.at(size), upwards.at(seconds)) for size, seconds in line.points]
    path = "L".join(f"{x:.1f},{y:.1f}" for x, y in spots)
    dots = "".join(
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="{line.colour}"/>' for x, y in spots
    )
    return f'<path class="line" stroke="{line.colour}" d="M{path}"/>{dots}'


def _names(lines: list[_Line], upwards: _Scale) -> list[str]:
    """Return the text elements with each name at the end of its line, moved apart if too close."""
    body = []
    last = float("-inf")
    for line in sorted(lines, key=lambda line: upwards.at(line.points[-1][1])):
        last = max(upwards.at(line.points[-1][1]) + 4, last + _NAME_HEIGHT)
        power = "" if line.power is None else f"  ∝ n^{line.power:.2f}"
        name = f'<tspan fill="{line.colour}" font-weight="600">{escape(line.name)}</tspan>'
        body.append(f'<text x="{_RIGHT + 12}" y="{last:.1f}">{name}{power}</text>')
    return body


def _count(number: float) -> str:
    if number >= 1e6:
        return f"{number / 1e6:g} M"
    return f"{number / 1e3:g} k" if number >= 1e3 else f"{number:g}"


def _text(x: float, y: float, text: str, style: str = "", anchor: str = "start") -> str:
    kind = f' class="{style}"' if style else ""
    return f'<text x="{x:.1f}" y="{y:.1f}"{kind} text-anchor="{anchor}">{escape(text)}</text>'


def _svg(body: list[str]) -> str:
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_WIDTH}" height="{_HEIGHT}"'
        f' viewBox="0 0 {_WIDTH} {_HEIGHT}">'
    )
    ground = '<rect width="100%" height="100%" fill="#ffffff"/>'
    return "\n".join([head, f"<style>{_STYLE}</style>", ground, *body, "</svg>", ""])
