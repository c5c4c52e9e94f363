"""Write the generated parts of the manual: options of the verbs, the API, outputs of examples.

Pages under docs/ are written by hand except docs/api, which is not in the repository, and the text
between two marks: options on the pages of verbs, scripts on the page "side by side", results of
other engines on the page "trust". With --examples, the commands on the pages are run, their output
is written below them and their pictures beside the page; check the difference before a commit.
"""

import argparse
import re
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click
import griffe

from bspcsg.cli.main import commands
from peers import with_answers
from support.documents import DOCS, ROOT, page_files, rewritten, with_generated

# What is written


def generated() -> dict[Path, str]:
    """Return the new text of each page that has a generated part, by path."""
    pages = {}
    for path in sorted((DOCS / "verbs").glob("*.md")):
        page = path.read_text("utf-8")
        pages[path] = with_generated(path.stem, page, _described(path.stem))
    side = DOCS / "side_by_side.md"
    pages[side] = with_parts(side.read_text("utf-8"))
    trust = DOCS / "trust.md"
    pages[trust] = with_answers(trust.read_text("utf-8"))
    return pages


def write_api() -> None:
    """Write the pages of the API, and remove all other pages from their folder."""
    API.mkdir(exist_ok=True)
    for path in API.glob("*.md"):
        path.unlink()
    for name, text in api_pages().items():
        API.joinpath(f"{name}.md").write_text(text, encoding="utf-8")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing; fail if outdated")
    parser.add_argument("--api", action="store_true", help="write the pages of the API only")
    parser.add_argument("--examples", nargs="*", metavar="PAGE", help="run examples, all or some")
    given = parser.parse_args()
    if given.check:
        wrong = [path for path, text in generated().items() if path.read_text("utf-8") != text]
        for path in wrong:
            print(f"{path.relative_to(ROOT)} is not up to date; run scripts/manual")
        return 1 if wrong else 0
    write_api()
    if given.api:
        return 0
    for path, text in generated().items():
        path.write_text(text, encoding="utf-8")
    if given.examples is not None:
        for path in page_files():
            if not given.examples or path.stem in given.examples:
                path.write_text(rewritten(path), encoding="utf-8")
    return 0


# Verbs

#: click's mark of paragraphs that keep their lines.
_AS_IS = "\b"


def _described(verb: str) -> str:
    with click.Context(commands, info_name="bspcsg") as parent:
        command = commands.get_command(parent, verb)
        if command is None:
            raise SystemExit(f"manual: there is a page, but no verb {verb}")
        context = click.Context(command, parent=parent, info_name=verb)
        synopsis = " ".join([context.command_path, *command.collect_usage_pieces(context)])
        options = [p for p in command.get_params(context) if isinstance(p, click.Option)]
        records = [record for option in options if (record := option.get_help_record(context))]
    rows = [f"| `{_cell(names)}` | {_cell(said)} |" for names, said in records if names != "--help"]
    table = "\n".join(["| option | meaning |", "| --- | --- |", *rows])
    return f"```text\n{synopsis}\n```\n\n{_paragraphs(command.help or '')}\n\n{table}\n"


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def _paragraphs(text: str) -> str:
    """Return a help text as Markdown; paragraphs whose lines click keeps become preformatted."""
    blocks = re.split(r"\n\s*\n", text.strip())
    return "\n\n".join(
        f"```text\n{block.strip().removeprefix(_AS_IS).strip()}\n```"
        if block.strip(" \n").startswith(_AS_IS)
        else "\n".join(line.strip() for line in block.splitlines())
        for block in blocks
    )


# Parts side by side

FOLDER = ROOT / "examples" / "side_by_side"

#: For each tool's folder: its name, the suffix of its scripts, and their language.
TOOLS = {
    "bspcsg": ("bspcsg", ".py", "py"),
    "manifold3d": ("manifold3d", ".py", "py"),
    "trimesh": ("trimesh", ".py", "py"),
    "openscad": ("OpenSCAD", ".scad", "openscad"),
    "build123d": ("build123d", ".py", "py"),
}


@dataclass(frozen=True)
class Part:
    """A part of the page "side by side": its title, and a remark on missing or shorter scripts."""

    title: str
    remark: str


PARTS = {
    "plate": Part(
        "A plate with twelve holes",
        "build123d needs one line less: a list of positions times a shape places copies of it. In "
        "bspcsg the function `grid` takes the shape and the positions, so the call is longer.",
    ),
    "knob": Part(
        "A block with round edges and a bore",
        "manifold3d, trimesh and OpenSCAD have no boxes with round edges, so their scripts make "
        "the hull of eight balls.",
    ),
    "flange": Part(
        "A flange with six counterbored holes",
        "build123d needs one line less: it has a shape for counterbored holes. The OpenSCAD script "
        "makes the subtracted cylinders longer than the holes, because OpenSCAD's preview flickers "
        "where two faces coincide.",
    ),
    "case": Part(
        "A case with a rim for its lid",
        "manifold3d, trimesh and OpenSCAD have no fillets in the plane; offsetting a smaller "
        "rectangle outwards makes round corners. build123d has rectangles with round corners.",
    ),
    "nut": Part(
        "A nut without its thread",
        "All scripts revolve one profile, which has the bore and all chamfers, about the axis. "
        "bspcsg and build123d make a hexagon from its width across flats; the other scripts "
        "compute the radius of the circle through its corners.",
    ),
    "bracket": Part(
        "A bracket with a rib and four holes",
        "In bspcsg, `hole` drills from points of a face right through the part. The other scripts "
        "subtract cylinders, whose lengths and directions they must give.",
    ),
    "label": Part(
        "A label",
        "manifold3d and trimesh have no text. build123d takes the em size of the font, which is "
        "1.39 times the height of capitals; bspcsg and OpenSCAD take that height.",
    ),
    "vase": Part(
        "A twisted hexagon",
        "build123d has no twisted extrusion, so its script makes a loft through 61 hexagons.",
    ),
    "link": Part(
        "The hull of two balls, with a bore",
        "build123d has hulls in the plane only; its script revolves one, because this hull is a "
        "solid of revolution.",
    ),
    "bend": Part(
        "A pipe around two corners",
        "manifold3d and OpenSCAD have no sweeps. trimesh's sweep does not mitre corners: its pipe "
        "is too thin between the corners, with two thirds of the right volume.",
    ),
}


def script(part: str, tool: str) -> Path:
    """Return the path of a tool's script for a part, whether it exists or not."""
    return FOLDER / tool / f"{part}{TOOLS[tool][1]}"


def lines(path: Path) -> int:
    """Return the number of lines of a script that make the part."""
    left_out = ("import ", "from ", "print(", "//", "#")
    texts = [line.strip() for line in path.read_text(encoding="utf-8").splitlines()]
    return sum(bool(text) and not text.startswith(left_out) for text in texts)


def with_parts(page: str) -> str:
    """Return the page "side by side" with its table and the scripts as they are."""
    sections = "".join(_section(part) for part in PARTS)
    return with_generated("side_by_side", page, _table() + sections)


def _table() -> str:
    names = [name for name, _, _ in TOOLS.values()]
    rows = [f"| part | {' | '.join(names)} |", "| --- |" + " --- |" * len(names)]
    for part, said in PARTS.items():
        counts = [str(lines(path)) if path.exists() else "–" for path in _scripts(part)]
        rows.append(f"| {said.title.lower()} | {' | '.join(counts)} |")
    return "\n".join(rows) + "\n"


def _scripts(part: str) -> list[Path]:
    return [script(part, tool) for tool in TOOLS]


def _section(part: str) -> str:
    tabs = [
        f":::{{tab-item}} {TOOLS[tool][0]}\n:sync: {tool}\n\n"
        f"```{TOOLS[tool][2]}\n{script(part, tool).read_text(encoding='utf-8')}```\n:::\n"
        for tool in TOOLS
        if script(part, tool).exists()
    ]
    joined = "\n".join(tabs)
    said = PARTS[part]
    return f"\n## {said.title}\n\n::::{{tab-set}}\n\n{joined}\n::::\n\n{said.remark}\n"


# The API: signatures and docstrings, which griffe reads without importing

API = DOCS / "api"

#: The public packages, and the first lines of their pages.
_PACKAGES = (
    "bspcsg",
    "bspcsg.bsp",
    "bspcsg.bsp.analysis",
    "bspcsg.csg",
    "bspcsg.io",
    "bspcsg.parts",
    "bspcsg.block",
    "bspcsg.trimesh_engine",
)

#: The page on which the names of a module or package are described.
_PAGES = {
    "bspcsg.solid": "solid",
    "bspcsg.mesh": "solid",
    "bspcsg.attributes": "solid",
    "bspcsg.assembly": "assemblies",
    "bspcsg.shapes": "shapes",
    "bspcsg.operations": "operations",
    "bspcsg.modelling": "modelling",
    "bspcsg.parts": "parts",
    "bspcsg.trimesh_engine": "trimesh",
    "bspcsg.errors": "errors",
    "bspcsg.verify": "check",
    "bspcsg.script": "scripts",
    "bspcsg.bsp.sets.region": "regions",
    "bspcsg.bsp.sets.interval": "regions",
    "bspcsg.bsp.sets.loops": "regions",
    "bspcsg.bsp.sets.slicing": "regions",
    "bspcsg.bsp.drawings": "regions",
    "bspcsg.modelling.planar": "regions",
    "bspcsg.modelling.making": "shapes",
    "bspcsg.bsp.rays": "rays",
    "bspcsg.bsp.painting": "pictures",
    "bspcsg.bsp": "trees",
    "bspcsg.csg": "scripts",
    "bspcsg.io": "files",
    "bspcsg.formats": "files",
    "bspcsg": "others",
}

#: The methods that need no description.
_UNTOLD = (
    "__init__",
    "__repr__",
    "__str__",
    "__copy__",
    "__deepcopy__",
    "__reduce__",
    "__hash__",
    "__post_init__",
)

#: The words in docstrings of methods and parameters that only modules of the package use.
_INSIDE = "for the modules of this package"

#: The pages of the API, without the index, with their titles.
TITLES = {
    "solid": "Solids and meshes",
    "assemblies": "Assemblies",
    "shapes": "Shapes",
    "operations": "Operations",
    "modelling": "Modelling",
    "parts": "Standard parts",
    "errors": "Errors and findings",
    "check": "Checks against manifold3d",
    "regions": "Regions of the plane, intervals, drawings",
    "rays": "Rays",
    "pictures": "Pictures",
    "trees": "Partition trees",
    "scripts": "Scripts",
    "files": "Files",
    "trimesh": "The engine for trimesh",
    "others": "Other functions",
}


def api_pages() -> dict[str, str]:
    """Return the text of each page of the API, by name."""
    loader = griffe.GriffeLoader(
        search_paths=[ROOT], docstring_parser="numpy", allow_inspection=False
    )
    loader.load("bspcsg")
    loader.resolve_aliases()
    placed: dict[str, list[tuple[str, Any]]] = {name: [] for name in TITLES}
    seen: set[str] = set()
    for package in _PACKAGES:
        module = _module(loader.modules_collection[package])
        for name in _public(module):
            entity = None if name.startswith("_") else _target(module[name])
            if entity is not None and entity.path not in seen:
                seen.add(entity.path)
                placed[_page(entity)].append((f"{package}.{name}", entity))
    pages = {name: _page_text(TITLES[name], held) for name, held in placed.items() if held}
    return {"index": _index(placed), **pages}


def _module(found: Any) -> Any:
    """Return the module itself if a found object is an alias of it, else the object."""
    return found.final_target if found.is_alias else found


def _public(module: Any) -> list[str]:
    """Return a module's exported names; without ``__all__``, its own functions and classes."""
    if module.exports is not None:
        return sorted(map(str, module.exports), key=str.lower)
    own = [name for name, member in module.members.items() if not member.is_alias]
    kinds = ("function", "class")
    return [n for n in own if n[0] != "_" and module[n].kind.value in kinds]


def _target(member: Any) -> Any | None:
    """Return the object that a public name refers to; None for modules and objects of the core."""
    try:
        found = member.final_target if member.is_alias else member
    except griffe.AliasResolutionError:
        return None
    if found.is_module:
        # A function and its module have one name.
        return _target(found[found.name]) if found.name in found.members else None
    return found


def _page(entity: Any) -> str:
    home = entity.module.path
    while home not in _PAGES:
        home = home.rpartition(".")[0]
    return _PAGES[home]


def _index(placed: dict[str, list[tuple[str, Any]]]) -> str:
    lines = ["# The Python API", "", "Generated from the docstrings.", ""]
    for name, held in placed.items():
        if held:
            names = ", ".join(f"`{path.removeprefix('bspcsg.')}`" for path, _ in held)
            lines.append(f"- [{TITLES[name]}]({name}.md): {names}")
    return "\n".join(lines) + "\n"


def _page_text(title: str, held: list[tuple[str, Any]]) -> str:
    blocks = [f"# {title}", "[All pages of the API](index.md)"]
    for path, entity in held:
        blocks += _entity(entity, path)
    return "\n\n".join(blocks) + "\n"


def _entity(entity: Any, path: str, member: bool = False) -> Iterator[str]:
    """Yield the description of an object for Sphinx, with its members nested."""
    fence = ":::" if member else "::::"
    module, _, name = path.rpartition(".")
    if not member:
        yield f"{fence}{{py:currentmodule}} {module}\n{fence}"
    head = f"{fence}{{py:{_role(entity, member)}}} {_signature(entity, name)}"
    yield "\n".join([head, *_options(entity)])
    if entity.docstring is not None:
        # A docstring without its object, so that griffe does not parse types.
        text = griffe.Docstring(entity.docstring.value)
        yield from _sections(text.parse("numpy", warnings=False))
    if entity.is_class:
        for one in _members(entity):
            yield from _entity(one, one.name, member=True)
    yield fence


def _role(entity: Any, member: bool) -> str:
    """Return Sphinx's name of the kind of an object."""
    if entity.is_class:
        return "exception" if entity.name.endswith(("Error", "Warning")) else "class"
    if entity.is_function:
        return "method" if member else "function"
    if "property" in entity.labels:
        return "property"
    return "attribute" if member else "data"


def _options(entity: Any) -> Iterator[str]:
    """Yield the options of an object's directive besides its signature."""
    yield from (f":{label}:" for label in ("classmethod", "staticmethod") if label in entity.labels)
    if entity.is_attribute:
        if entity.annotation is not None:
            yield f":type: {entity.annotation}"
        if entity.value is not None and len(str(entity.value)) < 200:
            yield f":value: {entity.value}"


def _members(cls: Any) -> list[Any]:
    """Return the documented public members of a class, operators last."""
    found = []
    for name, member in cls.all_members.items():
        target = _target(member)
        hidden = name.startswith("_") and not (name.startswith("__") and name.endswith("__"))
        if target is None or hidden or name in _UNTOLD or target.docstring is None:
            continue
        if _INSIDE in target.docstring.value:
            continue
        found.append(target)
    return sorted(found, key=lambda member: (member.name.startswith("__"), member.name))


def _signature(entity: Any, name: str) -> str:
    if entity.is_attribute:
        return name
    told = f"{name}({', '.join(_parameters(entity))})"
    if entity.is_class or entity.returns is None:
        return told
    return f"{told} -> {entity.returns}"


def _parameters(entity: Any) -> Iterator[str]:
    """Yield the parameters of a function as they are declared, without `self` and `cls`."""
    starred = False
    untold = {"self", "cls", *_parameters_inside(entity)}
    for parameter in entity.parameters:
        kind = parameter.kind.value
        if parameter.name in untold:
            continue
        if kind == "keyword-only" and not starred:
            yield "*"
        starred = starred or kind in ("keyword-only", "variadic positional")
        prefix = {"variadic positional": "*", "variadic keyword": "**"}.get(kind, "")
        annotation = f": {parameter.annotation}" if parameter.annotation is not None else ""
        shown = parameter.default is not None and not prefix
        default = f" = {parameter.default}" if shown else ""
        yield f"{prefix}{parameter.name}{annotation}{default}"


def _parameters_inside(entity: Any) -> Iterator[str]:
    """Yield the names of parameters that are only for modules of the package."""
    if entity.docstring is not None:
        for section in griffe.Docstring(entity.docstring.value).parse("numpy", warnings=False):
            if section.kind.value == "parameters":
                yield from (one.name for one in section.value if _INSIDE in one.description)


def _sections(sections: Iterable[Any]) -> Iterator[str]:
    for section in sections:
        kind = section.kind.value
        if kind == "text":
            yield section.value
        elif kind == "examples":
            code = "\n".join(text for _, text in section.value)
            yield f"```pycon\n{code}\n```"
        elif kind == "admonition":
            yield f"**{section.title}**"
            yield section.value.description
        else:
            yield f"**{kind.capitalize()}**"
            told = (entry for entry in section.value if _INSIDE not in entry.description)
            yield "\n".join(map(_item, told))


def _item(entry: Any) -> str:
    name = getattr(entry, "name", "")
    annotation = str(entry.annotation) if entry.annotation is not None else ""
    head = f"`{name}`" if name else ""
    if annotation:
        # Names of classes become links; the other words of a type are prose.
        typed = re.sub(r"(?<![\w`.])(?!None\b)[A-Z][a-z]\w+", r"`\g<0>`", annotation)
        head = f"{head} ({typed})" if head else typed
    said = entry.description.strip().replace("\n\n", "\n\n  ")
    lines = "\n".join(f"  {line}".rstrip() for line in said.splitlines()).strip()
    return f"- {head}: {lines}" if lines else f"- {head}"


if __name__ == "__main__":
    sys.exit(main())
