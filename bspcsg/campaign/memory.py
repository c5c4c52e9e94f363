"""How much memory this process has held at most, and how much it may hold."""

import os
import sys
from pathlib import Path

_STATUS = Path("/proc/self/status")
_CLEAR = Path("/proc/self/clear_refs")

#: Written there, it sets the peak back to what is held now (proc_pid_clear_refs(5)).
_FORGET_PEAK = "5"


def forget_peak() -> None:
    """Let the peak begin anew, where the system can do that."""
    try:
        _CLEAR.write_text(_FORGET_PEAK)
    except OSError:
        return


def peak_mb() -> float | None:
    """Return the peak of resident memory in 10^6 bytes, or None where nobody says."""
    try:
        lines = _STATUS.read_text().splitlines()
    except OSError:
        return None
    found = [line.split() for line in lines if line.startswith("VmHWM:")]
    return round(int(found[0][1]) * 1024 / 1e6, 1) if found else None


def limit_memory(size: int | None) -> None:
    """Let this process ask for no more than so many bytes of addresses."""
    if size is None or sys.platform == "win32":
        return
    import resource

    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    least = size if hard == resource.RLIM_INFINITY else min(size, hard)
    resource.setrlimit(resource.RLIMIT_AS, (least, hard))


def installed_gb() -> float:
    """Return the memory of this machine in 10^9 bytes; 0 where nobody says."""
    try:
        return round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9, 1)
    except (ValueError, OSError, AttributeError):
        return 0.0
