"""Opening of pages in a browser on this machine."""

import os
import sys
import tempfile
from pathlib import Path


def has_screen() -> bool:
    """Return True if a browser started by this process would have a screen."""
    if os.environ.get("SSH_CONNECTION") or os.environ.get("SSH_TTY"):
        return False
    if sys.platform in ("win32", "darwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def open_page(address: str) -> str:
    """Open a page in a browser; return an empty text, or the reason why that failed."""
    if not has_screen():
        return (
            "no browser was opened, because this machine has no display; open the page in a"
            " browser yourself."
        )
    import webbrowser

    if webbrowser.open(address):
        return ""
    return "no browser could be started; open the page in a browser yourself."


def temporary_page(stem: str) -> Path:
    """Return the path of a new HTML page in a new temporary folder, which is not removed."""
    return Path(tempfile.mkdtemp(prefix="bspcsg-")) / f"{stem}.html"
