"""The start of the command line, which handles Ctrl-C before the slow imports begin."""

import os

#: As `output.INTERRUPTED`, which is not imported yet.
_INTERRUPTED = 130

#: The file that Python's own code for imports says it is from, and numpy's for a question whose
#: every exception numpy takes for a no.
_BAD_MOMENTS = ("<frozen importlib._bootstrap>", "npy_ctypes_check")

#: An interrupt that came at a bad moment is repeated after this many seconds.
_REPEAT_DELAY = 0.01

try:
    import atexit
    import contextlib
    import signal
    import sys
    import time
    from types import FrameType
except KeyboardInterrupt:
    os._exit(_INTERRUPTED)


def _end_quietly(*_: object) -> None:
    """End the process at once, before the work has begun or after it is done."""
    os._exit(_INTERRUPTED)


def _end_in_order(number: int, frame: FrameType | None) -> None:
    """Raise `KeyboardInterrupt`, so that files are closed; postpone it where it would be lost.

    During imports, an exception is lost in a lock's callback, and it ends the process while a
    compiled module starts.
    """
    if _is_bad_moment(frame) and hasattr(signal, "setitimer"):
        _come_again()
    else:
        signal.default_int_handler(number, frame)


def _is_bad_moment(frame: FrameType | None) -> bool:
    while frame is not None:
        if frame.f_code.co_filename in _BAD_MOMENTS or frame.f_code.co_name in _BAD_MOMENTS:
            return True
        frame = frame.f_back
    return False


def _come_again() -> None:
    signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
    signal.setitimer(signal.ITIMER_REAL, _REPEAT_DELAY)


def _end_for_good() -> None:
    """Act on a postponed interrupt before Python shuts down, and ignore later ones."""
    _replace(_end_quietly, signal.SIG_IGN)
    if hasattr(signal, "setitimer") and any(signal.setitimer(signal.ITIMER_REAL, 0)):
        # It would have come again.
        _end_quietly()


def _catch_lost(lost: "sys.UnraisableHookArgs") -> None:
    """Repeat an interrupt that a finaliser swallowed; report other exceptions as usual."""
    if isinstance(lost.exc_value, KeyboardInterrupt) and hasattr(signal, "setitimer"):
        _come_again()
    else:
        sys.__unraisablehook__(lost)


def _replace(old: object, new: object) -> None:
    """Replace one Ctrl-C handler with another; keep one that the parent process chose."""
    if signal.getsignal(signal.SIGINT) is old:
        signal.signal(signal.SIGINT, new)  # type: ignore[arg-type]


class Quietly:
    """Lets Ctrl-C end the process quietly while the package is imported for the command line."""

    def __enter__(self) -> None:
        # While a package is imported for `-m`, this stands for the name of the program.
        program = os.path.basename((getattr(sys, "argv", None) or [""])[0])
        if program == "-m" or program.removesuffix(".exe") == "bspcsg":
            _replace_in_main_thread(signal.default_int_handler, _end_quietly)

    def __exit__(self, *_: object) -> None:
        _replace_in_main_thread(_end_quietly, signal.default_int_handler)


def _replace_in_main_thread(old: object, new: object) -> None:
    """Call `_replace` in the main thread; do nothing in others, which may not set handlers."""
    with contextlib.suppress(ValueError):
        _replace(old, new)


def main() -> None:
    """Run the command line and end the process with its exit code."""
    try:
        _run()
    except KeyboardInterrupt:
        _end_quietly()


def _run() -> None:
    began = time.perf_counter()
    # What is registered first is called last.
    atexit.register(_end_for_good)
    _replace(signal.default_int_handler, _end_quietly)
    from . import main as command_line

    try:
        # From here on files may be open; an exception closes and removes them.
        sys.unraisablehook = _catch_lost
        _replace(_end_quietly, _end_in_order)
        command_line.main(began=began)
    finally:
        _replace(_end_in_order, _end_quietly)
