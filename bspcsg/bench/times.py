"""Times in words."""


def seconds_text(seconds: float) -> str:
    """Return a time with three digits and a unit that suits it."""
    if seconds < 1e-3:
        return f"{seconds * 1e6:.3g} µs"
    return f"{seconds * 1e3:.3g} ms" if seconds < 1 else f"{seconds:.3g} s"
