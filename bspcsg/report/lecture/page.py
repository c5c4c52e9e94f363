"""The lecture as one page: text, figures, and the WebAssembly core that the figures call."""

import base64
import re
from importlib.resources import files

from ..._core import __version__
from ..assets import rendered

TITLE = "Binary space partition trees"

#: The chapters of the lecture in order: the name of the template, and the title.
CHAPTERS = (
    ("hyperplanes", "Hyperplanes and regions"),
    ("autopartitions", "Autopartitions"),
    ("painter", "The painter"),
    ("rays", "Rays"),
    ("costs", "Costs, and trees that learn"),
    ("merging", "Sets and their merging"),
    ("space", "In space"),
)

#: The page's scripts, each after the scripts that it uses.
SCRIPTS = (
    "kit/draw.js",
    "kit/tree.js",
    "kit/controls.js",
    "kit/order.js",
    "kit/scenes.js",
    "kit/core.js",
    "chapters/line.js",
    "chapters/autopartition.js",
    "chapters/painter.js",
    "chapters/ray.js",
    "chapters/cost.js",
    "chapters/merge.js",
    "chapters/space.js",
    "main.js",
)


def lecture_page(title: str = TITLE) -> str:
    """Return the page of the lecture as HTML; it is the same for the same version of bspcsg.

    Parameters
    ----------
    title : str

    Raises
    ------
    MissingPartError
        If Jinja2 is not installed.
    """
    page = rendered(
        "lecture.html",
        title=title,
        chapters=CHAPTERS,
        scripts=SCRIPTS,
        module=_module(),
        version=__version__,
    )
    return re.sub(r"\n\s*\n+", "\n", page)


def _module() -> str:
    """Return the core of bspcsg, compiled to WebAssembly, as base64 text."""
    data = files("bspcsg.report") / "assets" / "lecture" / "core.wasm"
    return base64.b64encode(data.read_bytes()).decode("ascii")
