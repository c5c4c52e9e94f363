"""Numbers and verdicts as text for a page."""

import math
from collections.abc import Sequence

#: The concern that a verdict is to cause, which gives its colour and its sign.
_TONES = {
    "agree": "good",
    "same set, other topology": "good",
    "within rounding": "near",
    "oracle refused": "warn",
    "oracle failed": "warn",
    "refused": "mute",
}

#: The meaning of each verdict, for whoever sees one for the first time.
_MEANINGS = {
    "agree": "the same set and the same topology",
    "same set, other topology": "the same set; surfaces that touch are joined in another way",
    "within rounding": "the sets differ by a film as thin as rounding explains",
    "oracle refused": "the oracle takes an operand for no solid",
    "oracle failed": "the oracle's result is proven wrong by exact counts of crossings",
    "refused": "an operand is no solid, so there is nothing to compare",
    "DISAGREE": "a failure: the sets differ by more than rounding explains",
    "subject failed": "a failure: our result is not sound by itself",
    "timeout": "a failure: the case took longer than it was given",
    "crash": "a failure: the process of the case ended before its time",
}

#: The sign that stands for no number.
NOTHING = "–"

#: The space between thousands.
_THIN = "\N{NARROW NO-BREAK SPACE}"

#: Powers of ten from and below which numbers are written out.
_PLAIN = (-4, 9)


def tone(verdict: str) -> str:
    """Return the tone of a verdict: good, near, warn, mute or bad; bad if it is unknown."""
    return _TONES.get(verdict, "bad")


def meaning(verdict: str) -> str:
    """Return the meaning of a verdict; nothing for an unknown one."""
    return _MEANINGS.get(verdict, "")


def number(value: float | None, digits: int = 6) -> str:
    """Return a number with so many significant digits, with powers of ten only where they help."""
    if value is None:
        return NOTHING
    power = math.floor(math.log10(abs(value))) if value and math.isfinite(value) else 0
    if not _PLAIN[0] <= power < max(_PLAIN[1], digits) or not math.isfinite(value):
        return f"{value:.{digits}g}"
    places = max(digits - 1 - power, 0)
    text = f"{value:,.{places}f}".replace(",", _THIN)
    return text.rstrip("0").rstrip(".") if places else text


def whole(value: int | None) -> str:
    """Return a whole number with separated thousands."""
    return NOTHING if value is None else f"{value:,}".replace(",", _THIN)


def milliseconds(seconds: float | None) -> str:
    """Return a time in milliseconds."""
    return (
        NOTHING
        if seconds is None
        else f"{seconds * 1e3:.3g}"
        if seconds < 1
        else whole(round(seconds * 1e3))
    )


def vector(values: Sequence[float] | None) -> str:
    """Return the coordinates of a point as text."""
    return NOTHING if values is None else ", ".join(f"{value:.6g}" for value in values)
