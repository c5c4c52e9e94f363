"""Read the segments of SVG's shapes, in the shapes' own coordinates.

# Source
SVG 1.1, 8.3 (path data).
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from ...mesh.interop import import_optional

_BLANKS = " ,\t\n\r\f"
_FLOAT = r"(?>[-+]?[0-9]*\.?[0-9]+(?:[eE][-+]?[0-9]+)?)"
_NUMBER = re.compile(_FLOAT)
_COMMAND = re.compile("([MmZzLlHhVvCcSsQqTtAa])")
_WORD = re.compile(f"{_COMMAND.pattern}|{_FLOAT}")

#: The numbers and flags of an arc; flags need no separators.
_ARC = re.compile(
    rf"[{_BLANKS}]*".join(["", *[f"({_FLOAT})"] * 3, *["([01])"] * 2, *[f"({_FLOAT})"] * 2, ""])
)

#: The number of numbers that a segment of each command takes.
_NUMBERS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}


@dataclass
class Segments:
    """The segments of a shape: lines, cubic curves and arcs; points are complex, y downwards.

    Parameters
    ----------
    ends : list of complex
        The end point of each segment; the first segment of a subpath is a move.
    firsts : list of int
        The index of the first segment of each subpath.
    closed : list of bool
        Whether each subpath is closed.
    cubics : list of tuple
        Cubic curves: the index of the segment, and its four control points.
    chords : list of tuple
        Arcs by their ends: the index of the segment, start, end, two radii, rotation in degrees,
        whether the arc is larger than a half, and whether its angle increases.
    turns : list of tuple
        Arcs by their centres: the index of the segment, the centre, the two half axes, the angle at
        which the arc begins, and the signed angle that it covers, in radians.
    """

    ends: list[complex] = field(default_factory=list)
    firsts: list[int] = field(default_factory=list)
    closed: list[bool] = field(default_factory=list)
    cubics: list[tuple[int, complex, complex, complex, complex]] = field(default_factory=list)
    chords: list[tuple[int, complex, complex, float, float, float, bool, bool]] = field(
        default_factory=list
    )
    turns: list[tuple[int, complex, complex, complex, float, float]] = field(default_factory=list)

    def move(self, to: complex) -> None:
        """Begin a subpath at a point."""
        self.firsts.append(len(self.ends))
        self.closed.append(False)
        self.ends.append(to)

    def line(self, to: complex) -> None:
        """Add a straight segment to a point."""
        self.ends.append(to)

    def close(self) -> None:
        """Add a straight segment to the start of the subpath, which is then closed."""
        self.ends.append(self.ends[self.firsts[-1]])
        self.closed[-1] = True

    def cubic(self, a: complex, b: complex, c: complex, d: complex) -> None:
        """Add a cubic Bézier curve from a to d, with control points b and c."""
        self.cubics.append((len(self.ends), a, b, c, d))
        self.ends.append(d)

    def quadratic(self, a: complex, b: complex, c: complex) -> None:
        """Add a quadratic Bézier curve from a to c, with control point b, as a cubic one."""
        self.cubic(a, a + (b - a) * (2 / 3), c + (b - c) * (2 / 3), c)


def path_segments(data: str) -> Segments | None:
    """Return the segments of the data of an SVG path, or None if the data are invalid."""
    if _WORD.sub("", data).strip(_BLANKS):
        return None
    before, *parts = _COMMAND.split(data)
    if before.strip(_BLANKS) or not parts or parts[0] not in "Mm":
        return None
    pen = _Pen()
    for command, text in zip(parts[::2], parts[1::2], strict=True):
        numbers = _numbers(command.upper(), text)
        if numbers is None:
            return None
        pen.draw(command, numbers)
    return pen.drawn


def _numbers(command: str, text: str) -> list[float] | None:
    """Return the numbers of a path command; None if their count is wrong or one is not finite."""
    if command == "Z":
        return None if text.strip(_BLANKS) else []
    if command == "A":
        arcs = _ARC.findall(text)
        words = [word for arc in arcs for word in arc]
        if _ARC.sub("", text).strip(_BLANKS):
            return None
    else:
        words = _NUMBER.findall(text)
    numbers = list(map(float, words))
    is_right = (
        numbers and len(numbers) % _NUMBERS[command] == 0 and all(map(math.isfinite, numbers))
    )
    return numbers if is_right else None


class _Pen:
    """Converts the commands of path data to segments, one after another."""

    def __init__(self) -> None:
        self.drawn = Segments()
        self._here = 0j
        self._begin = 0j
        #: The last control point of a curve, and the command ("S" or "T") that would mirror it.
        self._control = 0j
        self._smooth = ""

    def draw(self, command: str, numbers: list[float]) -> None:
        """Add the segments of a command with its numbers."""
        kind = command.upper()
        step = _NUMBERS[kind]
        for place in range(0, len(numbers) or 1, step or 1):
            origin = self._here if command.islower() else 0j
            self._segment(kind, numbers[place : place + step], origin)
            kind = "L" if kind == "M" else kind

    def _segment(self, kind: str, numbers: list[float], origin: complex) -> None:
        drawn = self.drawn
        if kind == "M":
            self._here = self._begin = origin + complex(*numbers)
            drawn.move(self._here)
        else:
            if drawn.closed[-1]:
                drawn.move(self._here)
            if kind == "Z":
                drawn.close()
                self._here = self._begin
            elif kind == "A":
                self._arc(numbers, origin)
            elif kind in "LHV":
                self._line(kind, numbers, origin)
            else:
                self._curve(kind, numbers, origin)
                return
        self._smooth = ""

    def _line(self, kind: str, numbers: list[float], origin: complex) -> None:
        if kind == "L":
            self._here = origin + complex(*numbers)
        elif kind == "H":
            self._here = complex(origin.real + numbers[0], self._here.imag)
        else:
            self._here = complex(self._here.real, origin.imag + numbers[0])
        self.drawn.line(self._here)

    def _curve(self, kind: str, numbers: list[float], origin: complex) -> None:
        points = [origin + complex(*pair) for pair in zip(numbers[::2], numbers[1::2], strict=True)]
        if kind in "ST":
            mirrored = 2 * self._here - self._control if self._smooth == kind else self._here
            points.insert(0, mirrored)
        if kind in "QT":
            self.drawn.quadratic(self._here, *points)
        else:
            self.drawn.cubic(self._here, *points)
        self._control, self._here = points[-2:]
        self._smooth = "T" if kind in "QT" else "S"

    def _arc(self, numbers: list[float], origin: complex) -> None:
        wide, high, rotation, large, positive, x, y = numbers
        start, self._here = self._here, origin + complex(x, y)
        if start != self._here and wide and high:
            flags = bool(large), bool(positive)
            number = len(self.drawn.ends)
            self.drawn.chords.append(
                (number, start, self._here, abs(wide), abs(high), rotation, *flags)
            )
        self.drawn.line(self._here)


def shape_segments(shape: Any) -> Segments:
    """Return the segments of a shape object of svgelements."""
    elements = import_optional("svgelements", "svgelements")
    if isinstance(shape, (elements.Circle, elements.Ellipse)):
        return _round_segments(shape)
    found = Segments()
    for one in elements.Path(shape):
        if one.end is None:
            continue
        end = _complex(one.end)
        if isinstance(one, elements.Move):
            found.move(end)
            continue
        if not found.closed or found.closed[-1]:
            found.move(end if one.start is None else _complex(one.start))
        if isinstance(one, elements.Close):
            found.line(end)
            found.closed[-1] = True
        elif isinstance(one, elements.CubicBezier):
            found.cubic(*_points(one.start, one.control1, one.control2, one.end))
        elif isinstance(one, elements.QuadraticBezier):
            found.quadratic(*_points(one.start, one.control, one.end))
        else:
            if isinstance(one, elements.Arc) and one.sweep:
                _turn(found, one)
            found.line(end)
    return found


def _round_segments(shape: Any) -> Segments:
    """Return a circle or an ellipse of svgelements as four arcs, faster than svgelements itself."""
    found = Segments()
    center, wide, high = complex(shape.cx, shape.cy), complex(shape.rx), complex(0, shape.ry)
    if wide and high:
        found.move(center + wide)
        for quarter, end in enumerate((high, -wide, -high, wide)):
            begin = quarter * math.pi / 2
            found.turns.append((len(found.ends), center, wide, high, begin, math.pi / 2))
            found.line(center + end)
        found.close()
    return found


def _turn(found: Segments, arc: Any) -> None:
    """Add an arc of svgelements to `found`, unless its ellipse has no width or height."""
    start, center, across, along = _points(arc.start, arc.center, arc.prx, arc.pry)
    wide, height = across - center, abs(along - center)
    if wide and height:
        width = abs(wide)
        from_wide = (start - center) / wide
        begin = math.atan2(from_wide.imag * width / height, from_wide.real)
        high = 1j * height * wide / width
        found.turns.append((len(found.ends), center, wide, high, begin, float(arc.sweep)))


def _points(*points: Any) -> Iterator[complex]:
    return map(_complex, points)


def _complex(point: Any) -> complex:
    return complex(float(point.x), float(point.y))
