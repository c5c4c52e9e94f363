"""Formatting of numbers, and meanings and tones of verdicts, for a page."""

import math
from collections.abc import Sequence

#: The tone of each verdict, which gives its colour and its sign on a page.
_TONES = {
    "agree": "good",
    "same set, other topology": "good",
    "within rounding": "near",
    "oracle refused": "warn",
    "oracle failed": "warn",
    "refused": "mute",
}

#: The meaning of each verdict of a campaign's case, as shown on a page.
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

#: The text of a cell without a number.
NO_NUMBER = "–"

#: The space between thousands.
_THIN = "\N{NARROW NO-BREAK SPACE}"

#: Numbers from 10**-4 to below 10**9 are written without a power of ten.
_PLAIN = (-4, 9)


def tone(verdict: str) -> str:
    """Return the tone of a verdict, which gives its colour: good, near, warn, mute or bad.

    An unknown verdict has the tone “bad”.
    """
    return _TONES.get(verdict, "bad")


def meaning(verdict: str) -> str:
    """Return the meaning of a verdict; an empty string for an unknown one."""
    return _MEANINGS.get(verdict, "")


def number(value: float | None, digits: int = 6) -> str:
    """Return a number as text with `digits` significant digits.

    Very large and very small numbers have a power of ten; None becomes a dash.
    """
    if value is None:
        return NO_NUMBER
    power = math.floor(math.log10(abs(value))) if value and math.isfinite(value) else 0
    if not _PLAIN[0] <= power < max(_PLAIN[1], digits) or not math.isfinite(value):
        return f"{value:.{digits}g}"
    places = max(digits - 1 - power, 0)
    text = f"{value:,.{places}f}".replace(",", _THIN)
    return text.rstrip("0").rstrip(".") if places else text


def whole(value: int | None) -> str:
    """Return an integer as text with separated thousands; None becomes a dash."""
    return NO_NUMBER if value is None else f"{value:,}".replace(",", _THIN)


def milliseconds(seconds: float | None) -> str:
    """Return a time, given in seconds, as text in milliseconds; None becomes a dash."""
    return (
        NO_NUMBER
        if seconds is None
        else f"{seconds * 1e3:.3g}"
        if seconds < 1
        else whole(round(seconds * 1e3))
    )


def vector(values: Sequence[float] | None) -> str:
    """Return the coordinates of a point as text, separated by commas; None becomes a dash."""
    return NO_NUMBER if values is None else ", ".join(f"{value:.6g}" for value in values)
