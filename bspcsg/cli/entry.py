"""The start of the command line: it installs handlers of Ctrl-C before the slow imports begin."""

import os

#: The exit code `output.INTERRUPTED`, which is not imported yet.
_INTERRUPTED = 130

#: A file name and a function name in whose frames an interrupt would be lost: Python's own code for
#: imports, and a test in numpy that takes every exception for “no”.
_BAD_MOMENTS = ("<frozen importlib._bootstrap>", "npy_ctypes_check")

#: The number of seconds after which an interrupt is repeated that would have been lost.
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
    """Handle Ctrl-C while no files are open: end the process at once, without a traceback."""
    os._exit(_INTERRUPTED)


def _end_in_order(number: int, frame: FrameType | None) -> None:
    """Handle Ctrl-C during the work: raise `KeyboardInterrupt`, so that files are closed.

    During imports the interrupt is postponed: an exception would be lost in the callback of a lock,
    and would end the process while a compiled module is initialized.
    """
    if _is_bad_moment(frame) and hasattr(signal, "setitimer"):
        _repeat_interrupt()
    else:
        signal.default_int_handler(number, frame)


def _is_bad_moment(frame: FrameType | None) -> bool:
    while frame is not None:
        if frame.f_code.co_filename in _BAD_MOMENTS or frame.f_code.co_name in _BAD_MOMENTS:
            return True
        frame = frame.f_back
    return False


def _repeat_interrupt() -> None:
    signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
    signal.setitimer(signal.ITIMER_REAL, _REPEAT_DELAY)


def _end_for_good() -> None:
    """Obey a postponed interrupt before Python shuts down, and ignore all later ones."""
    _replace(_end_quietly, signal.SIG_IGN)
    if hasattr(signal, "setitimer") and any(signal.setitimer(signal.ITIMER_REAL, 0)):
        # An interrupt was still postponed.
        _end_quietly()


def _catch_lost(lost: "sys.UnraisableHookArgs") -> None:
    """Repeat an interrupt that a finaliser swallowed; report other exceptions as usual."""
    if isinstance(lost.exc_value, KeyboardInterrupt) and hasattr(signal, "setitimer"):
        _repeat_interrupt()
    else:
        sys.__unraisablehook__(lost)


def _replace(old: object, new: object) -> None:
    """Replace the Ctrl-C handler `old` with `new`; do nothing if another handler is installed."""
    if signal.getsignal(signal.SIGINT) is old:
        signal.signal(signal.SIGINT, new)  # type: ignore[arg-type]


class Quietly:
    """A context in which Ctrl-C ends the process quietly, if `sys.argv` names the command line.

    It surrounds the imports of the package.
    """

    def __enter__(self) -> None:
        # While `python -m` imports a package, `sys.argv[0]` is "-m".
        program = os.path.basename((getattr(sys, "argv", None) or [""])[0])
        if program == "-m" or program.removesuffix(".exe") == "bspcsg":
            _replace_in_main_thread(signal.default_int_handler, _end_quietly)

    def __exit__(self, *_: object) -> None:
        _replace_in_main_thread(_end_quietly, signal.default_int_handler)


def _replace_in_main_thread(old: object, new: object) -> None:
    """Call `_replace`; do nothing outside the main thread, where handlers cannot be set."""
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
    # The function that is registered first is called last.
    atexit.register(_end_for_good)
    _replace(signal.default_int_handler, _end_quietly)
    from . import main as command_line

    try:
        # During the work files may be open; an exception closes them and removes incomplete ones.
        sys.unraisablehook = _catch_lost
        _replace(_end_quietly, _end_in_order)
        command_line.main(began=began)
    finally:
        _replace(_end_in_order, _end_quietly)
