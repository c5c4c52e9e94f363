"""The site: the Markdown of this repository as pages, in one navigation, searched without a server.

Pages are written for the repository and read there, too. So they hold no directives for their
navigation, which stands here, and their links are paths between files. `scripts/site` builds it.

Sphinx, because it is kept (Material for MkDocs is not extended any more), finds broken links and
lost pages by itself, and its search works in pages that are opened as files; Furo, because it is
light and dark, readable on a phone, and loads neither fonts nor scripts from elsewhere.

What `static/site.js` says to screen readers was missing when axe-core 4.14 looked at eleven pages
in Chromium, light and dark, 1280 and 390 wide. With it, axe finds no violation on them but that the
page of results has no heading before something is searched for.
`tests/pipeline/test_site.py` lets axe look at some of them.
"""

import shutil
import sys
from pathlib import Path

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform

from bspcsg.report.lecture.page import lecture_page

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(Path(__file__).parent))

project = "bspcsg"
copyright = "bspcsg contributors"  # noqa: A001 (Sphinx calls it so)
extensions = ["myst_parser", "sphinx_copybutton", "sphinx_design", "names"]
root_doc = "docs/index"
include_patterns = [
    "docs/**.md",
    "examples/GALLERY.md",
    "examples/meshes/README.md",
    "tests/corpus/README.md",
    "core/ARCHITECTURE.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
]
exclude_patterns = [
    ".*",
    "out",
    "dist",
    "target",
    "**/target",
    "bspcsg",
    "fuzz",
    "lecture",
    "scripts",
    "core/src",
]

#: Pages of these names or patterns, under these heads. What is named first keeps its place; a
#: pattern adds what is there and was not named, so that a new page is found without a change here.
NAVIGATION = {
    "First steps": ["docs/install", "docs/tasks/first", "docs/tasks/plate"],
    "Tutorials": [
        "docs/tutorials/first_part",
        "docs/tutorials/openscad",
        "docs/tutorials/trimesh",
        "docs/tutorials/manifold3d",
        "docs/tutorials/printing",
        "docs/tutorials/campaigns",
        "docs/tutorials/clusters",
        "docs/tutorials/*",
    ],
    "Tasks": [
        "docs/tasks/making",
        "docs/tasks/assemblies",
        "docs/tasks/folder",
        "docs/tasks/scans",
        "docs/tasks/openscad",
        "docs/tasks/validate",
        "docs/tasks/pictures",
        "docs/tasks/libraries",
        "docs/tasks/plugins",
        "docs/tasks/trees",
        "docs/tasks/precision",
        "docs/tasks/errors",
        "docs/tasks/formats",
        "docs/tasks/performance",
        "docs/tasks/*",
    ],
    "Compare": ["docs/side_by_side", "docs/compare", "docs/measured"],
    "Command line": ["docs/verbs/*"],
    "Python": ["docs/api/index", "docs/api/*"],
    "Theory": ["docs/theory", "docs/lecture", "examples/GALLERY"],
    "Trust": ["docs/trust", "docs/stability", "CHANGELOG", "SECURITY"],
    "Inside": [
        "core/ARCHITECTURE",
        "docs/design/*",
        "CONTRIBUTING",
        "docs/glossary",
        "docs/*",
        "tests/corpus/README",
        "examples/meshes/README",
    ],
}

myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 4
myst_html_meta = {
    "description": "Exact set operations on solids, from Python and from the command line."
}
smartquotes = False  # two hyphens begin an option
# Signatures that are longer have a line for each parameter.
python_maximum_signature_line_length = 88
toc_object_entries_show_parents = "hide"

html_theme = "furo"
html_title = "bspcsg"
html_favicon = "static/icon.svg"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_js_files = ["site.js"]
html_copy_source = False
html_show_sphinx = False
# Excerpts are fetched, which browsers allow of servers only; titles and places are found without.
html_show_search_summary = False
html_theme_options = {
    "top_of_page_buttons": [],
    "light_css_variables": {
        "color-brand-primary": "#8a3b12",
        "color-brand-content": "#8a3b12",
    },
    "dark_css_variables": {
        "color-brand-primary": "#f0a36b",
        "color-brand-content": "#f0a36b",
    },
}
pygments_style = "a11y-high-contrast-light"
pygments_dark_style = "a11y-high-contrast-dark"
copybutton_exclude = ".linenos, .gp, .go"


def _pages(patterns: list[str], taken: set[str]) -> list[str]:
    """Return the pages of some patterns, without those that other heads have."""
    found: list[str] = []
    for pattern in patterns:
        for path in sorted(ROOT.glob(f"{pattern}.md")):
            name = str(path.relative_to(ROOT).with_suffix(""))
            if name not in {*taken, *found}:
                found.append(name)
    return found


def navigation() -> dict[str, list[str]]:
    """Return the pages under each head; a page that several name stands under the first."""
    named = {name for patterns in NAVIGATION.values() for name in patterns if "*" not in name}
    heads = {}
    for head, patterns in NAVIGATION.items():
        own = {name for name in patterns if "*" not in name}
        heads[head] = _pages(patterns, {root_doc, *(named - own)})
    return {head: pages for head, pages in heads.items() if pages}


def _with_navigation(_: Sphinx, name: str, source: list[str]) -> None:
    if name == root_doc:
        for head, pages in navigation().items():
            names = "\n".join(f"/{page}" for page in pages)
            source[0] += (
                f"\n```{{toctree}}\n:hidden:\n:titlesonly:\n:caption: {head}\n\n{names}\n```\n"
            )
    if name in ("docs/lecture", "docs/verbs/lecture"):
        up = "../" * name.count("/")
        source[0] += f'\n<p><a href="{up}lecture.html">The lecture that it writes.</a></p>\n'


class PathsOfTheRepository(SphinxTransform):
    """Let links to other HTML files open these, and name folders, which are no pages.

    The HTML files are copied to where the links lead.
    """

    default_priority = 10

    def apply(self, **_: object) -> None:
        """Put links in the place of downloads, and text in that of links to folders."""
        here = Path(self.env.doc2path(self.env.docname)).parent
        for download in list(self.document.findall(addnodes.download_reference)):
            path = (here / download["reftarget"]).resolve()
            if path.suffix == ".html" and path.exists():
                target = str(Path(download["reftarget"]).with_name(_beside(path).name))
                download.replace_self(nodes.reference("", "", *download.children, refuri=target))
                self.config.html_files_beside.add(str(path.relative_to(ROOT)))
        for link in list(self.document.findall(addnodes.pending_xref)):
            if (here / link["reftarget"]).is_dir():
                link.replace_self(link.children)


def _beside(path: Path) -> Path:
    """Return where an HTML file goes, which is not where a page of its name goes."""
    return path.with_suffix(".page.html") if path.with_suffix(".md").exists() else path


def _add_pages(app: Sphinx, failed: Exception | None) -> None:
    """Add the pages that Sphinx does not make: what links name, the lecture, and the entrance."""
    if failed is not None or app.builder.format != "html":
        return
    out = Path(app.outdir)
    for name in app.config.html_files_beside:
        copy = out / _beside(ROOT / name).relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, copy)
    (out / "lecture.html").write_text(lecture_page(), encoding="utf-8")
    (out / "index.html").write_text(
        '<!doctype html><html lang="en"><meta charset="utf-8"><title>bspcsg</title>'
        f'<meta http-equiv="refresh" content="0; url={root_doc}.html">'
        f'<p><a href="{root_doc}.html">bspcsg</a></p></html>\n'
    )


def setup(app: Sphinx) -> None:
    """Connect what stands above."""
    app.add_config_value("html_files_beside", set(), "")
    app.add_transform(PathsOfTheRepository)
    app.connect("source-read", _with_navigation)
    app.connect("build-finished", _add_pages)
