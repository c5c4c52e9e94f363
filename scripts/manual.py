"""Writes what can be generated of the manual: options of the verbs, the API, the shown examples.

Pages under docs/ are written by hand but for docs/api, and what stands between two marks: options
on the pages of verbs, scripts on that of parts side by side, what other engines answered on that
of trust. With --examples, the commands on the
pages are run, what they print is written below them and the pictures they make beside the page;
look at the difference before you commit it.
"""

import argparse
import sys
from pathlib import Path

from manual_api import api_pages
from manual_options import with_options
from manual_side import with_parts
from peers import with_answers
from support.documents import DOCS, page_files, rewritten

#: Pages that grow beyond this are split by hand, in bytes.
LARGEST = 100_000


def generated() -> dict[Path, str]:
    """Return each page that is generated or has a generated part, with its text."""
    pages = {path: with_options(path.stem, path.read_text("utf-8")) for path in verb_files()}
    for name, text in api_pages().items():
        pages[DOCS / "api" / f"{name}.md"] = text
    side = DOCS / "side_by_side.md"
    pages[side] = with_parts(side.read_text("utf-8"))
    trust = DOCS / "trust.md"
    pages[trust] = with_answers(trust.read_text("utf-8"))
    return pages


def verb_files() -> list[Path]:
    """Return the pages of the verbs."""
    return sorted((DOCS / "verbs").glob("*.md"))


def outdated(pages: dict[Path, str]) -> list[str]:
    """Return what is wrong with the pages as they are."""
    found = [
        f"{path.relative_to(DOCS.parent)} is not up to date; run scripts/manual"
        for path, text in pages.items()
        if not path.exists() or path.read_text("utf-8") != text
    ]
    found += [
        f"{path.relative_to(DOCS.parent)} is generated no more; delete it"
        for path in (DOCS / "api").glob("*.md")
        if path not in pages
    ]
    sizes = {path: path.stat().st_size for path in DOCS.rglob("*.md")}
    found += [f"{path} has {size} bytes" for path, size in sizes.items() if size > LARGEST]
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing; fail if outdated")
    parser.add_argument("--examples", nargs="*", metavar="PAGE", help="run examples, all or some")
    given = parser.parse_args()
    if given.check:
        wrong = outdated(generated())
        print("\n".join(wrong) or "the manual is up to date")
        return 1 if wrong else 0
    for path, text in generated().items():
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    if given.examples is not None:
        for path in page_files():
            if not given.examples or path.stem in given.examples:
                path.write_text(rewritten(path))
    return 0


if __name__ == "__main__":
    sys.exit(main())
