"""The API as Markdown, from signatures and docstrings; griffe reads them without importing."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import griffe

_ROOT = Path(__file__).resolve().parent.parent

#: Packages with names of their own for users, and how their pages begin.
_PACKAGES = (
    "bspcsg",
    "bspcsg.bsp",
    "bspcsg.bsp.analysis",
    "bspcsg.csg",
    "bspcsg.io",
    "bspcsg.block",
    "bspcsg.trimesh_engine",
)

#: On which page the names of a module or package stand.
_PAGES = {
    "bspcsg.solid": "solid",
    "bspcsg.mesh": "solid",
    "bspcsg.attributes": "solid",
    "bspcsg.assembly": "assemblies",
    "bspcsg.shapes": "shapes",
    "bspcsg.operations": "operations",
    "bspcsg.modelling": "modelling",
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

#: Methods that are as everybody expects them.
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

#: The words in docstrings of methods that are public for neighbours only.
_INSIDE = "for the modules of this package"

_TITLES = {
    "solid": "Solids and meshes",
    "assemblies": "Assemblies",
    "shapes": "Shapes",
    "operations": "Operations",
    "modelling": "Modelling",
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
    """Return each page's name and text."""
    loader = griffe.GriffeLoader(
        search_paths=[_ROOT], docstring_parser="numpy", allow_inspection=False
    )
    loader.load("bspcsg")
    loader.resolve_aliases()
    placed: dict[str, list[tuple[str, Any]]] = {name: [] for name in _TITLES}
    seen: set[str] = set()
    for package in _PACKAGES:
        module = _module(loader.modules_collection[package])
        for name in _public(module):
            entity = None if name.startswith("_") else _target(module[name])
            if entity is not None and entity.path not in seen:
                seen.add(entity.path)
                placed[_page(entity)].append((f"{package}.{name}", entity))
    pages = {name: _page_text(_TITLES[name], held) for name, held in placed.items() if held}
    return {"index": _index(placed), **pages}


def _module(found: Any) -> Any:
    """Return a module itself, if what was found is another name for it."""
    return found.final_target if found.is_alias else found


def _public(module: Any) -> list[str]:
    """Return what a module exports; without ``__all__``, the functions and classes it defines."""
    if module.exports is not None:
        return sorted(map(str, module.exports), key=str.lower)
    own = [name for name, member in module.members.items() if not member.is_alias]
    kinds = ("function", "class")
    return [n for n in own if n[0] != "_" and module[n].kind.value in kinds]


def _target(member: Any) -> Any | None:
    """Return what a public name stands for; modules, and what only the core has, have no page."""
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
            lines.append(f"- [{_TITLES[name]}]({name}.md): {names}")
    return "\n".join(lines) + "\n"


def _page_text(title: str, held: list[tuple[str, Any]]) -> str:
    blocks = [f"# {title}", "[All pages of the API](index.md)"]
    for path, entity in held:
        blocks += _entity(entity, path, 2)
    return "\n\n".join(blocks) + "\n"


def _entity(entity: Any, path: str, level: int) -> Iterator[str]:
    yield f"{'#' * level} `{path}`"
    if entity.is_function or entity.is_class:
        yield f"```text\n{_signature(entity, path)}\n```"
    elif entity.value is not None and len(str(entity.value)) < 200:
        yield f"```text\n{path.rpartition('.')[2]} = {entity.value}\n```"
    if entity.docstring is not None:
        # Apart from its owner, so that types stay the words they are.
        text = griffe.Docstring(entity.docstring.value)
        yield from _sections(text.parse("numpy", warnings=False))
    if entity.is_class:
        for member in _members(entity):
            yield from _entity(member, member.name, level + 1)


def _members(cls: Any) -> list[Any]:
    """Return what a class offers and documents: methods and properties, operators at the end."""
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


def _signature(entity: Any, path: str) -> str:
    name = path.rpartition(".")[2]
    if entity.is_class:
        return f"class {name}({', '.join(_parameters(entity.parameters))})"
    text = f"{name}({', '.join(_parameters(entity.parameters))})"
    return f"{text} -> {entity.returns}" if entity.returns is not None else text


def _parameters(parameters: Any) -> Iterator[str]:
    """Yield the parameters as they are declared, without the first of methods."""
    starred = False
    for parameter in parameters:
        kind = parameter.kind.value
        if parameter.name in ("self", "cls"):
            continue
        if kind == "keyword-only" and not starred:
            yield "*"
        starred = starred or kind in ("keyword-only", "variadic positional")
        prefix = {"variadic positional": "*", "variadic keyword": "**"}.get(kind, "")
        annotation = f": {parameter.annotation}" if parameter.annotation is not None else ""
        shown = parameter.default is not None and not prefix
        default = f" = {parameter.default}" if shown else ""
        yield f"{prefix}{parameter.name}{annotation}{default}"


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
            yield "\n".join(_item(entry) for entry in section.value)


def _item(entry: Any) -> str:
    name = getattr(entry, "name", "")
    annotation = str(entry.annotation) if entry.annotation is not None else ""
    head = f"`{name}`" if name else ""
    if annotation:
        head = f"{head} ({annotation})" if head else f"`{annotation}`"
    said = entry.description.strip().replace("\n\n", "\n\n  ")
    lines = "\n".join(f"  {line}".rstrip() for line in said.splitlines()).strip()
    return f"- {head}: {lines}" if lines else f"- {head}"
