"""Numbers and verdicts as a page shows them."""

from collections.abc import Sequence

#: How much a verdict is to worry about, which gives its colour and its sign.
_TONES = {
    "agree": "good",
    "same set, other topology": "good",
    "within rounding": "near",
    "oracle refused": "warn",
    "oracle failed": "warn",
    "refused": "mute",
}

#: What stands where there is no number.
NOTHING = "–"


def tone(verdict: str) -> str:
    """Return good, near, warn, mute or bad; an unknown verdict is bad."""
    return _TONES.get(verdict, "bad")


def number(value: float | None, digits: int = 6) -> str:
    """Return a number with so many digits that count."""
    return NOTHING if value is None else f"{value:.{digits}g}"


def whole(value: int | None) -> str:
    """Return a whole number with its thousands apart."""
    return NOTHING if value is None else f"{value:,}".replace(",", "\N{NARROW NO-BREAK SPACE}")


def milliseconds(seconds: float | None) -> str:
    """Return a time in milliseconds."""
    return NOTHING if seconds is None else f"{seconds * 1e3:.3g}" if seconds < 1 else whole(
        round(seconds * 1e3)
    )


def vector(values: Sequence[float] | None) -> str:
    """Return a point."""
    return NOTHING if values is None else ", ".join(f"{value:.6g}" for value in values)
