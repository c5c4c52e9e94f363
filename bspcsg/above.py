"""The requests of methods to the floors above them.

Files, scripts, sections, checks and pictures are made of solids and regions, and are methods of
them, too. So that imports go one way all the same, such a method asks here, and
`bspcsg.conveniences` says once, when the package is imported, which function answers.
"""

from collections.abc import Callable
from typing import Any, Literal, TypeAlias

#: The names of the functions that are asked for.
Convenience: TypeAlias = Literal[
    "align",
    "closest_points",
    "curvature",
    "decompose",
    "chamfer",
    "chamfer_region",
    "counterbore",
    "countersink",
    "edges",
    "faces",
    "fillet",
    "difference",
    "fillet_region",
    "hole",
    "dumps",
    "hull_of_region",
    "intersection",
    "intersects",
    "leaning",
    "load",
    "load_assembly",
    "load_dxf",
    "load_svg",
    "loads",
    "min_gap",
    "normals",
    "offset",
    "offset_region",
    "ray_cast",
    "refine",
    "rounded",
    "save",
    "save_assembly",
    "save_dxf",
    "save_svg",
    "shadow",
    "simplify_region",
    "show",
    "show_here",
    "slice_solid",
    "smooth",
    "region_png",
    "region_svg",
    "solid_html",
    "solid_png",
    "solid_svg",
    "split",
    "symmetric_difference",
    "trim",
    "union",
    "validate",
    "warp",
]

_answers: dict[Convenience, Callable[..., Any]] = {}


def answer(name: Convenience, function: Callable[..., Any]) -> None:
    """Let a function of an upper floor answer."""
    _answers[name] = function


def above(name: Convenience) -> Callable[..., Any]:
    """Return the function that answers."""
    return _answers[name]
