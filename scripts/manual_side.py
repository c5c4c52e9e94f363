"""The page of the manual that shows the same parts in several tools, from examples/side_by_side."""

from dataclasses import dataclass
from pathlib import Path

from manual_options import with_generated
from support.documents import ROOT

FOLDER = ROOT / "examples" / "side_by_side"

#: The tools by their folders: how they are called, the ending of their scripts, and its language.
TOOLS = {
    "bspcsg": ("bspcsg", ".py", "py"),
    "manifold3d": ("manifold3d", ".py", "py"),
    "trimesh": ("trimesh", ".py", "py"),
    "openscad": ("OpenSCAD", ".scad", "openscad"),
    "build123d": ("build123d", ".py", "py"),
}


@dataclass(frozen=True)
class Part:
    """A part: what it is, why a tool is shorter or missing, and nothing where none is."""

    title: str
    remark: str


PARTS = {
    "plate": Part(
        "A plate with twelve holes",
        "build123d is a line shorter: places are values there, which multiply a shape. Here a "
        "pattern is a function of the shape, and both do not fit one line.",
    ),
    "knob": Part(
        "A block with round edges and a bore",
        "Manifold, trimesh and OpenSCAD have no round boxes; the hull of eight balls is one.",
    ),
    "label": Part(
        "A label",
        "manifold3d and trimesh have no text. build123d's sizes are those of the em, which is 1.39 "
        "times the height of capitals.",
    ),
    "vase": Part(
        "A twisted hexagon",
        "build123d lofts sixty-one hexagons, for its extrusions do not twist.",
    ),
    "link": Part(
        "The hull of two balls, with a bore",
        "build123d has hulls in the plane only; this one is a solid of revolution, by luck.",
    ),
    "bend": Part(
        "A pipe around two corners",
        "manifold3d and OpenSCAD have no sweeps. trimesh's does not mitre: the pipe gets thinner "
        "between the corners, and has two thirds of the volume.",
    ),
}


def script(part: str, tool: str) -> Path:
    """Return where a script lies, or would."""
    return FOLDER / tool / f"{part}{TOOLS[tool][1]}"


def lines(path: Path) -> int:
    """Return how many lines make the part."""
    left_out = ("import ", "from ", "print(", "//", "#")
    texts = [line.strip() for line in path.read_text(encoding="utf-8").splitlines()]
    return sum(bool(text) and not text.startswith(left_out) for text in texts)


def with_parts(page: str) -> str:
    """Return the page with its table and its parts as the scripts have them."""
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
