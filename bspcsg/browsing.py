"""Shows pages in the browser of the user of this machine."""

import os
import sys
import tempfile
from pathlib import Path


def has_screen() -> bool:
    """Say whether a browser that starts here would be visible."""
    if os.environ.get("SSH_CONNECTION") or os.environ.get("SSH_TTY"):
        return False
    if sys.platform in ("win32", "darwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def opened(address: str) -> str:
    """Open a page in a browser; return nothing, or a sentence that says why that failed."""
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
    """Return a name for a page in a folder of its own, which is not removed."""
    return Path(tempfile.mkdtemp(prefix="bspcsg-")) / f"{stem}.html"
