"""Memory of this process, as the kernel counts it."""

import resource
from pathlib import Path

_STATUS = Path("/proc/self/status")
_RESET = Path("/proc/self/clear_refs")


def held_mb() -> float:
    """Return what the process holds now, in 10⁶ bytes."""
    return _status("VmRSS") or peak_mb()


def peak_mb() -> float:
    """Return the most it held since it began, or since the peak was forgotten, in 10⁶ bytes."""
    return _status("VmHWM") or resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6


def forget_peak() -> bool:
    """Begin the peak anew; false where the kernel does not offer that."""
    try:
        _RESET.write_text("5")
    except OSError:
        return False
    return True


def _status(name: str) -> float | None:
    try:
        lines = _STATUS.read_text().splitlines()
    except OSError:
        return None
    found = [line.split()[1] for line in lines if line.startswith(f"{name}:")]
    return int(found[0]) * 1024 / 1e6 if found else None
