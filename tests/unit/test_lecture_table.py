"""The table of the lecture names functions, tests and pictures that exist."""

import re
from functools import reduce
from pathlib import Path

from bspcsg import bsp

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "lecture.md").read_text(encoding="utf-8")
TEMPLATES = ROOT / "bspcsg" / "report" / "templates" / "lecture"
ROWS = re.findall(r"^\|.*\| `([\w.]+)` \| `([\w./:]+)` \| `([\w./-]+)` \|$", PAGE, re.MULTILINE)
FIGURES = {
    name
    for path in TEMPLATES.glob("*.html")
    for name in re.findall(r'figure\("(fig-\w+)"', path.read_text(encoding="utf-8"))
}


def is_there(test: str) -> bool:
    path, *names = test.split("::")
    text = (ROOT / path).read_text(encoding="utf-8")
    return all(re.search(rf"^ *(?:class|def|fn) {name}\b", text, re.M) for name in names)


def test_names_are_there() -> None:
    assert len(ROWS) > 40
    for function, test, picture in ROWS:
        assert reduce(getattr, function.split("."), bsp) is not None
        assert is_there(test), test
        assert picture in FIGURES or (ROOT / "examples" / picture).is_file(), picture
