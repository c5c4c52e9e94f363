"""Format times as text."""


def seconds_text(seconds: float) -> str:
    """Return a time with three significant digits, in µs, ms or s."""
    if seconds < 1e-3:
        return f"{seconds * 1e6:.3g} µs"
    return f"{seconds * 1e3:.3g} ms" if seconds < 1 else f"{seconds:.3g} s"
