"""Exact set operations on solids by merging binary space partition trees.

Meshes become inside/outside partition trees on a decimal lattice; unions, intersections and
differences merge those trees in exact arithmetic; the result leaves as a closed mesh.

Examples
--------
>>> import bspcsg as b
>>> part = b.cube(10, center=True) - b.cylinder(h=20, r=3, segments=4, center=True)
>>> part.volume
820.0
"""

from ._core import __version__, set_threads
from .check import CheckReport, Verdict, validate
from .errors import (
    BspcsgError,
    Finding,
    FormatError,
    InternalError,
    InvalidMeshError,
    LimitError,
    UnboundedError,
)
from .io import load, save
from .mesh import Mesh
from .primitives import (
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
from .script import run_script, show
from .setops import boolean, difference, intersection, union, xor
from .solid import Solid

__all__ = [
    "BspcsgError",
    "CheckReport",
    "Finding",
    "FormatError",
    "InternalError",
    "InvalidMeshError",
    "LimitError",
    "Mesh",
    "Solid",
    "UnboundedError",
    "Verdict",
    "__version__",
    "boolean",
    "box",
    "cone",
    "cube",
    "cylinder",
    "difference",
    "extrude",
    "half_space",
    "intersection",
    "load",
    "prism",
    "revolve",
    "run_script",
    "save",
    "set_threads",
    "show",
    "sphere",
    "torus",
    "union",
    "validate",
    "xor",
]
