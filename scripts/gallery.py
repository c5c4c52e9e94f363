"""Run the code blocks of the gallery page, which write its pictures.

    scripts/gallery [FOLDER]

Each block runs alone, with `examples/drawing.py` importable, and writes to `gallery/` in FOLDER, by
default `examples`.
"""

import os
import re
import sys
from contextlib import chdir
from importlib import import_module
from pathlib import Path

os.environ.setdefault("MPLBACKEND", "agg")

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"

#: The largest number of lines of a code block, without imports and empty lines.
MAX_BLOCK_LINES = 10


def blocks() -> list[str]:
    """Return the code blocks of the gallery page."""
    page = (EXAMPLES / "GALLERY.md").read_text(encoding="utf-8")
    return re.findall(r"```python\n(.*?)```", page, re.DOTALL)


def pictures(block: str) -> list[str]:
    """Return the names of the picture files that a code block writes."""
    return re.findall(r'"gallery/([\w.]+)"', block)


def run(block: str, folder: Path) -> None:
    """Run a code block in a folder."""
    folder.joinpath("gallery").mkdir(parents=True, exist_ok=True)
    sys.path.insert(0, str(EXAMPLES))
    try:
        # `drawing` sets the style of all plots.
        import_module("drawing")
        with chdir(folder):
            exec(compile(block, "GALLERY.md", "exec"), {"__name__": "gallery"})
        from matplotlib import pyplot

        pyplot.close("all")
    finally:
        sys.path.remove(str(EXAMPLES))


def main() -> int:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else EXAMPLES
    for block in blocks():
        run(block, folder)
        print(*pictures(block))
    return 0


if __name__ == "__main__":
    sys.exit(main())
