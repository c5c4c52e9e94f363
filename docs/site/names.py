"""Names of the API as links wherever they are written, and words of others in the search.

The generated pages describe each object to Sphinx, which keeps their names in `objects.inv` and
links types in signatures. Here a name in running text leads to its object, too. Words that people
use elsewhere stand in a table of the glossary; the search leads from each to the page in its row.
"""

import re
from collections.abc import Iterator

from docutils import nodes
from sphinx.addnodes import desc, index, pending_xref
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util.nodes import make_refnode

#: Where the names of the API may lie, in the order in which they are tried.
_HOMES = ("", "bspcsg.", "bspcsg.bsp.", "bspcsg.csg.", "bspcsg.io.")

#: A name as it is written: as in the examples, and with what it is called with.
_WRITTEN = re.compile(r"(?:csg\.)?([A-Za-z]\w*(?:\.\w+)*)(?:\(.*\))?")

#: Nodes inside of which names stay as they are.
_KEPT = (nodes.reference, nodes.title, pending_xref)

#: The page with the words of others, and the head of their table.
_GLOSSARY, _WORDS = "docs/glossary", "Words used elsewhere"


def _full_name(env: BuildEnvironment, written: str, owners: list[str]) -> str | None:
    """Return the whole name of an object, first among the members of owners; None if not there."""
    objects = env.domains.python_domain.objects
    homes = [*(f"{owner}." for owner in owners), *_HOMES]
    return next((home + written for home in homes if home + written in objects), None)


def _owners(node: nodes.Node) -> list[str]:
    """Return the whole names of the classes that a text describes, or members of which."""
    described = [above[0] for above in _above(node) if isinstance(above, desc)]
    return [id_ for signature in described for id_ in signature["ids"]]


def _link(app: Sphinx, docname: str, name: str, shown: nodes.Node) -> nodes.reference:
    entry = app.env.domains.python_domain.objects[name]
    return make_refnode(app.builder, docname, entry.docname, entry.node_id, [shown], name)


def _linked(app: Sphinx, tree: nodes.document, docname: str) -> None:
    """Make links of the names in running text.

    Verbs and modules of OpenSCAD have names of functions; on pages about those, only names with a
    capital or a dot are ours for sure.
    """
    in_api = docname.startswith("docs/api/")
    for literal in list(tree.findall(nodes.literal)):
        if any(isinstance(above, _KEPT) for above in _above(literal)):
            continue
        written = literal.astext()
        match = _WRITTEN.fullmatch(written)
        if match and (in_api or re.match(r"[A-Z]|\w+\.", written)):
            name = _full_name(app.env, match[1], _owners(literal))
            if name is not None:
                literal.replace_self(_link(app, docname, name, literal.deepcopy()))


def _above(node: nodes.Node) -> Iterator[nodes.Node]:
    while node.parent is not None:
        node = node.parent
        yield node


def _words_read(app: Sphinx, env: BuildEnvironment) -> list[str]:
    """Read the words of others, with the pages that their rows lead to."""
    for words, page in _rows(env.get_doctree(_GLOSSARY)):
        app.config.words_of_others.setdefault(page, []).extend(words)
    return []


def _with_words(app: Sphinx, tree: nodes.document, docname: str) -> None:
    """Enter the words of others that lead to a page into the index, which the search reads."""
    words = app.config.words_of_others.get(docname, [])
    tree.insert(0, index(entries=[("single", word, "", "main", None) for word in words]))


def _rows(tree: nodes.document) -> Iterator[tuple[list[str], str]]:
    """Yield the words and the page of each row."""
    for section in tree.findall(nodes.section):
        if section[0].astext() == _WORDS:
            for row in section.findall(nodes.row):
                for link in row.findall(pending_xref):
                    words = [word.strip() for word in row[0].astext().split(",")]
                    yield words, link["reftarget"]


def setup(app: Sphinx) -> None:
    """Connect what stands above."""
    app.add_config_value("words_of_others", {}, "")
    app.connect("doctree-resolved", _linked)
    app.connect("env-updated", _words_read)
    app.connect("doctree-resolved", _with_words)
