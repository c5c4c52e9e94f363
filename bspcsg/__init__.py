"""Exact set operations on solids by merging binary space partition trees.

Meshes become inside/outside partition trees on a decimal lattice; unions, intersections and
differences merge those trees in exact arithmetic; the result is returned as a closed mesh.

Examples
--------
>>> import bspcsg as csg
>>> part = csg.cube(10, center=True) - csg.cylinder(h=20, r=3, segments=4, center=True)
>>> part.volume
820.0
"""

from .cli.entry import Quietly as _Quietly

with _Quietly():
    from importlib import import_module
    from typing import TYPE_CHECKING, Any

    try:
        import_module("._core", __name__)
    except ModuleNotFoundError:
        raise ImportError(
            f"{__path__[0]} contains the source code of bspcsg without its compiled core. Run"
            " Python in another folder to use the installed package, or run scripts/setup to"
            " compile the core here."
        ) from None

    import sys as _sys

    from .suggestions import attribute_error as _no_attribute

if TYPE_CHECKING:
    from ._core import __version__
    from .assembly.tree import Assembly
    from .attributes.material import Material
    from .bsp.sets.region import Region
    from .errors import (
        BspcsgError,
        Finding,
        FormatError,
        InternalError,
        InvalidMeshError,
        InvalidParameterError,
        LimitError,
        LossWarning,
        MissingPartError,
        UnboundedError,
    )
    from .io import load, save
    from .mesh.mesh import Mesh
    from .modelling.bodies.hulls import hull
    from .modelling.bodies.level_sets import level_set
    from .modelling.bodies.sums import minkowski
    from .modelling.making.edges import EdgeSelection
    from .modelling.making.faces import FaceSelection
    from .modelling.making.height_maps import surface
    from .modelling.making.lofting import loft
    from .modelling.making.paths import helix, spline
    from .modelling.making.patterns import grid, linear_pattern, polar_pattern
    from .modelling.making.round_boxes import rounded_box
    from .modelling.making.sweeping import pipe, sweep
    from .modelling.planar.curves import arc, bezier
    from .modelling.planar.lettering.text import text
    from .operations.setops import boolean, difference, intersection, union, xor
    from .parameters import set_threads
    from .progress_display import progress
    from .script.run import run_script, show
    from .shapes.primitives import (
        box,
        cone,
        cube,
        cylinder,
        extrude,
        half_space,
        prism,
        revolve,
        sphere,
        torus,
    )
    from .solid.solid import Solid
    from .verify.check import CheckReport, Verdict, validate

__all__ = [
    "Assembly",
    "BspcsgError",
    "CheckReport",
    "EdgeSelection",
    "FaceSelection",
    "Finding",
    "FormatError",
    "InternalError",
    "InvalidMeshError",
    "InvalidParameterError",
    "LimitError",
    "LossWarning",
    "Material",
    "Mesh",
    "MissingPartError",
    "Region",
    "Solid",
    "UnboundedError",
    "Verdict",
    "__version__",
    "arc",
    "bezier",
    "boolean",
    "box",
    "cone",
    "cube",
    "cylinder",
    "difference",
    "extrude",
    "grid",
    "half_space",
    "helix",
    "hull",
    "intersection",
    "level_set",
    "linear_pattern",
    "load",
    "loft",
    "minkowski",
    "pipe",
    "polar_pattern",
    "prism",
    "progress",
    "revolve",
    "rounded_box",
    "run_script",
    "save",
    "set_threads",
    "show",
    "sphere",
    "spline",
    "surface",
    "sweep",
    "text",
    "torus",
    "union",
    "validate",
    "xor",
]

#: The public names by the module that defines them. A module is imported when one of its names is
#: first used, so that the command line starts without numpy.
_MODULES = {
    "_core": "__version__",
    "bsp.sets.region": "Region",
    "modelling.making.edges": "EdgeSelection",
    "modelling.making.faces": "FaceSelection",
    "modelling.making.height_maps": "surface",
    "modelling.making.lofting": "loft",
    "modelling.making.paths": "helix spline",
    "modelling.making.patterns": "grid linear_pattern polar_pattern",
    "modelling.making.round_boxes": "rounded_box",
    "modelling.making.sweeping": "pipe sweep",
    "assembly.tree": "Assembly",
    "attributes.material": "Material",
    "verify.check": "CheckReport Verdict validate",
    "errors": "BspcsgError Finding FormatError InternalError InvalidMeshError"
    " InvalidParameterError LimitError LossWarning MissingPartError UnboundedError",
    "io": "load save",
    "mesh.mesh": "Mesh",
    "modelling.bodies.hulls": "hull",
    "modelling.bodies.level_sets": "level_set",
    "modelling.bodies.sums": "minkowski",
    "modelling.planar.curves": "arc bezier",
    "modelling.planar.lettering.text": "text",
    "parameters": "set_threads",
    "progress_display": "progress",
    "shapes.primitives": "box cone cube cylinder extrude half_space prism revolve sphere torus",
    "script.run": "run_script show",
    "operations.setops": "boolean difference intersection union xor",
    "solid.solid": "Solid",
}
#: Submodules that are imported on first use, without an import statement.
_PARTS = frozenset({"bsp", "csg", "errors", "io", "parts", "trimesh_engine"})
_HOMES = {name: module for module, names in _MODULES.items() for name in names.split()}


def __getattr__(name: str) -> "Any":
    """Return a public name of the package, importing its module on first use."""
    if name in _PARTS:
        return import_module(f".{name}", __name__)
    if name not in _HOMES:
        raise _no_attribute(_sys.modules[__name__], name, f"module {__name__!r}")
    module = import_module(f".{_HOMES[name]}", __name__)
    value = getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the public names of the package, whether imported or not."""
    return sorted({*__all__, *_PARTS})
