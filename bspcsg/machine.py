"""Facts about this machine, and about the memory of this process, from the operating system."""

import os
import platform
import sys
from pathlib import Path
from typing import TypedDict

_STATUS = Path("/proc/self/status")
_CLEAR = Path("/proc/self/clear_refs")

#: The text that, written to `_CLEAR`, resets the peak memory to the current memory
#: (proc_pid_clear_refs(5)).
_FORGET_PEAK = "5"


class Machine(TypedDict):
    """The machine on which something was measured: processor, cores, memory and system.

    The memory is in 10^9 bytes.
    """

    processor: str
    cores: int
    memory_gb: float
    system: str


def machine() -> Machine:
    """Return the processor, number of cores, memory and operating system of this machine."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count() or 1,
        "memory_gb": _installed_gb(),
        "system": system(),
    }


def system() -> str:
    """Return the name and release of the operating system, and the processor architecture."""
    return f"{platform.system()} {platform.release()} {platform.machine()}"


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    names = (line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    return next(names, platform.processor())


def _installed_gb() -> float:
    """Return the installed memory of this machine in 10^9 bytes; 0 if unknown."""
    try:
        return round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9, 1)
    except (ValueError, OSError, AttributeError):
        return 0.0


def memory_mb() -> float:
    """Return the current memory of this process in 10^6 bytes; if unknown, the peak memory."""
    return _status("VmRSS") or peak_mb()


def peak_mb() -> float:
    """Return the peak memory of this process in 10^6 bytes, since its start or `reset_peak`.

    It is 0 if unknown.
    """
    return _status("VmHWM") or _used_mb()


def _status(name: str) -> float | None:
    try:
        lines = _STATUS.read_text(encoding="utf-8").splitlines()
    except OSError:
        return None
    found = [line.split()[1] for line in lines if line.startswith(f"{name}:")]
    return int(found[0]) * 1024 / 1e6 if found else None


def _used_mb() -> float:
    if sys.platform == "win32":
        return 0.0
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6


def reset_peak() -> bool:
    """Reset the peak memory to the current memory; return False if the system cannot do that."""
    try:
        _CLEAR.write_text(_FORGET_PEAK, encoding="utf-8")
    except OSError:
        return False
    return True


def limit_memory(size: int | None) -> None:
    """Limit the address space of this process to `size` bytes; None means no limit.

    On Windows nothing is done.
    """
    if size is None or sys.platform == "win32":
        return
    import resource

    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    least = size if hard == resource.RLIM_INFINITY else min(size, hard)
    resource.setrlimit(resource.RLIMIT_AS, (least, hard))
