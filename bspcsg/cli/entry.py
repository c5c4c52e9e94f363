"""Where the command line begins: before what takes time is imported, Ctrl-C is made quiet."""

import os

#: As `output.INTERRUPTED`, which is not imported yet.
_INTERRUPTED = 130

try:
    import signal
except KeyboardInterrupt:
    os._exit(_INTERRUPTED)


def _end_quietly(*_: object) -> None:
    """End the process at once; nothing has been begun, or all is done."""
    os._exit(_INTERRUPTED)


def _replace(old: object, new: object) -> None:
    """Put one way to heed Ctrl-C in place of another; who started the process may have chosen."""
    if signal.getsignal(signal.SIGINT) is old:
        signal.signal(signal.SIGINT, new)  # type: ignore[arg-type]


def main() -> None:
    """Run the command line and end the process with its exit code."""
    _replace(signal.default_int_handler, _end_quietly)
    from . import main as command_line

    try:
        # From here on files may be open, which an exception closes and takes away.
        _replace(_end_quietly, signal.default_int_handler)
        command_line.main()
    except KeyboardInterrupt:
        _end_quietly()
    finally:
        _replace(signal.default_int_handler, _end_quietly)
