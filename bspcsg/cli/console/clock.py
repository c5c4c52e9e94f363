"""The running time of the command, measured from the start of the process."""

import time

_began = time.perf_counter()


def start(began: float | None = None) -> None:
    """Start measuring the running time now, or from `began`, a time of `time.perf_counter`."""
    global _began  # noqa: PLW0603  one command runs at a time
    _began = time.perf_counter() if began is None else began


def elapsed() -> float:
    """Return the seconds since the command began."""
    return time.perf_counter() - _began
