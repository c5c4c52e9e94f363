"""Makes the links of README.md absolute, so that a package index shows its pictures.

`python scripts/readme_for_index.py` changes README.md in place: in a copy that a package is built
from, never in the repository. Needs nothing but Python.
"""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

#: A link or picture that is neither absolute nor within the page.
_LINK = re.compile(r"(!?)(\[[^\]]*\])\((?!https?:|mailto:|#)([^)\s]+)\)")


def absolute(text: str, home: str) -> str:
    """Return a page whose links lead to a repository's main branch, pictures to their bytes."""

    def link(found: re.Match[str]) -> str:
        mark, words, target = found.groups()
        return f"{mark}{words}({home}/{'raw' if mark else 'blob'}/main/{target})"

    return _LINK.sub(link, text)


def home() -> str:
    """Return the address of the repository."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return str(project["urls"]["Source"])


def main() -> None:
    page = Path("README.md")
    page.write_text(absolute(page.read_text(encoding="utf-8"), home()), encoding="utf-8")


if __name__ == "__main__":
    main()
