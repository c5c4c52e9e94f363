"""The one place that ties methods of solids and regions to the floors above them.

What answers is imported when it is first asked for, so that the package starts without it.
"""

from collections.abc import Callable
from importlib import import_module
from typing import Any, get_args

from .above import Convenience, answer

#: The function that answers, after its module.
_HOMES: dict[Convenience, str] = {
    "align": "modelling.bodies.placing:align",
    "chamfer": "modelling.making.blends:chamfer",
    "counterbore": "modelling.making.drilling:counterbore",
    "countersink": "modelling.making.drilling:countersink",
    "hole": "modelling.making.drilling:hole",
    "chamfer_region": "modelling.planar.corners:chamfer_region",
    "fillet_region": "modelling.planar.corners:fillet_region",
    "edges": "modelling.making.edges:edges_of",
    "faces": "modelling.making.faces:faces_of",
    "fillet": "modelling.making.blends:fillet",
    "closest_points": "modelling.bodies.gaps:closest_points",
    "curvature": "modelling.bodies.shading:curvature",
    "decompose": "modelling.bodies.parts:decompose",
    "difference": "operations.setops:difference",
    "dumps": "csg:dumps",
    "hull_of_region": "modelling.planar.hulls:hull_of_region",
    "intersection": "operations.setops:intersection",
    "intersects": "modelling.bodies.gaps:intersects",
    "leaning": "modelling.making.leaning:leaning",
    "load": "io:load",
    "load_assembly": "assembly.files:load",
    "load_dxf": "bsp:load_dxf",
    "load_svg": "bsp:load_svg",
    "loads": "io:loads",
    "min_gap": "modelling.bodies.gaps:min_gap",
    "normals": "modelling.bodies.shading:normals",
    "offset": "modelling.bodies.offsetting:offset",
    "offset_region": "modelling.planar.offsetting:offset_region",
    "ray_cast": "modelling.bodies.casting:ray_cast",
    "refine": "modelling.bodies.refining:refine",
    "rounded": "modelling.bodies.offsetting:rounded",
    "save": "io:save",
    "save_assembly": "assembly.files:save",
    "save_dxf": "bsp:save_dxf",
    "save_svg": "bsp:save_svg",
    "shadow": "modelling.planar.shadows:shadow",
    "simplify_region": "modelling.planar.simplifying:simplify_region",
    "show": "script.run:show",
    "show_here": "report.viewer.showing:show",
    "slice_solid": "bsp:slice_solid",
    "smooth": "modelling.bodies.smoothing:smooth",
    "region_png": "report.viewer.notebook:region_png",
    "region_svg": "report.viewer.notebook:region_svg",
    "solid_html": "report.viewer.notebook:solid_html",
    "solid_png": "report.viewer.notebook:solid_png",
    "solid_svg": "report.viewer.notebook:solid_svg",
    "split": "modelling.bodies.parts:split",
    "symmetric_difference": "operations.setops:xor",
    "trim": "modelling.bodies.parts:trim",
    "union": "operations.setops:union",
    "validate": "verify.check:check_result",
    "warp": "modelling.bodies.warping:warp",
}


def attach() -> None:
    """Let these functions answer."""
    for name in get_args(Convenience):
        answer(name, _asked_at(_HOMES[name]))


def _asked_at(home: str) -> Callable[..., Any]:
    """Return a function that asks the one of this home."""
    module, _, name = home.partition(":")

    def ask(*args: Any, **options: Any) -> Any:
        return getattr(import_module(f".{module}", __package__), name)(*args, **options)

    return ask
