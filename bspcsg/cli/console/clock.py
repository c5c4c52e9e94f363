"""The time that the command has been running, from its first line on."""

import time

_began = time.perf_counter()


def start(began: float | None = None) -> None:
    """Count from now, or from a moment that is past."""
    global _began  # noqa: PLW0603  one command runs at a time
    _began = time.perf_counter() if began is None else began


def elapsed() -> float:
    """Return the seconds since the command began."""
    return time.perf_counter() - _began
