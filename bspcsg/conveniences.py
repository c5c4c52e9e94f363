"""The one place that ties methods of solids and regions to the floors above them.

Each function imports what it needs when it is called, so that the package starts without it.
"""

import os
from typing import TYPE_CHECKING, Any

from .above import answer

if TYPE_CHECKING:
    from .bsp import Region
    from .solid.solid import Solid


def attach() -> None:
    """Let the functions of this module answer."""
    answer("save", _save)
    answer("load", _load)
    answer("loads", _loads)
    answer("dumps", _dumps)
    answer("validate", _validate)
    answer("slice_solid", _slice_solid)
    answer("solid_html", _solid_html)
    answer("solid_svg", _solid_svg)
    answer("load_svg", _load_svg)
    answer("save_svg", _save_svg)
    answer("load_dxf", _load_dxf)
    answer("save_dxf", _save_dxf)
    answer("offset_region", _offset_region)
    answer("hull_of_region", _hull_of_region)
    answer("simplify_region", _simplify_region)
    answer("shadow", _shadow)


def _save(solid: "Solid", path: str | os.PathLike[str], **options: Any) -> None:
    from .io import save

    save(solid, path, **options)


def _load(path: str | os.PathLike[str], **options: Any) -> "Solid":
    from .io import load

    return load(path, **options)


def _loads(data: Any, suffix: str | None, **options: Any) -> "Solid":
    from .io import loads

    return loads(data, suffix, **options)


def _dumps(solid: "Solid", *, flat: bool) -> str:
    from .csg import dumps

    return dumps(solid, flat=flat)


def _slice_solid(solid: "Solid", offset: Any, normal: Any, origin: Any) -> "Region":
    from .bsp import slice_solid

    return slice_solid(solid, offset, normal, origin=origin)


def _validate(solid: "Solid", **options: Any) -> Any:
    from .verify.check import check_result

    return check_result(solid, **options)


def _solid_html(solid: "Solid") -> str | None:
    from .report.viewer.notebook import solid_html

    return solid_html(solid)


def _solid_svg(solid: "Solid") -> str:
    from .report.viewer.notebook import solid_svg

    return solid_svg(solid)


def _load_svg(path: str | os.PathLike[str], **options: Any) -> "Region":
    from .bsp import load_svg

    return load_svg(path, **options)


def _save_svg(region: "Region", path: str | os.PathLike[str], **options: Any) -> None:
    from .bsp import save_svg

    save_svg(region, path, **options)


def _load_dxf(path: str | os.PathLike[str], **options: Any) -> "Region":
    from .bsp import load_dxf

    return load_dxf(path, **options)


def _save_dxf(region: "Region", path: str | os.PathLike[str]) -> None:
    from .bsp import save_dxf

    save_dxf(region, path)


def _offset_region(region: "Region", delta: Any, join: Any, **options: Any) -> "Region":
    from .modelling.planar.offsetting import offset_region

    return offset_region(region, delta, join, **options)


def _hull_of_region(region: "Region") -> "Region":
    from .modelling.planar.hulls import hull_of_region

    return hull_of_region(region)


def _simplify_region(region: "Region", tolerance: Any) -> "Region":
    from .modelling.planar.simplifying import simplify_region

    return simplify_region(region, tolerance)


def _shadow(solid: "Solid") -> "Region":
    from .modelling.planar.shadows import shadow

    return shadow(solid)
