"""Which errors omit a node of a script, and the empty set that replaces it."""

from pathlib import PurePath

from ...bsp import Region
from ...errors import BspcsgError, FormatError, InvalidMeshError, LimitError, UnboundedError
from ...solid.solid import Solid
from ..syntax.arguments import Arguments
from ..syntax.tree import Node
from .registry import Geometry

#: The names of nodes that make solids, and of nodes that make plane figures.
_SOLIDS = frozenset(
    {
        "cube", "sphere", "cylinder", "polyhedron", "surface", "linear_extrude", "rotate_extrude",
        "roof",
    }
)  # fmt: skip
_FIGURES = frozenset({"square", "circle", "polygon", "text", "offset", "projection", "fill"})
_DRAWINGS = (".dxf", ".svg")

#: The codes of errors after which OpenSCAD continues without the node.
_OPENSCADS = frozenset({"missing_file", "missing_argument", "not_finite"})


def is_left_out(error: BspcsgError, *, lenient: bool) -> bool:
    """Return True if a node that fails with this error is omitted with a warning.

    OpenSCAD omits nodes for errors such as a missing file. A lenient evaluation omits every node
    that is itself at fault, but never hides defects of this package or missing dependencies.
    """
    if error.code in _OPENSCADS:
        return True
    own_faults = (FormatError, InvalidMeshError, LimitError, UnboundedError)
    return lenient and isinstance(error, own_faults)


def empty_geometry_of(node: Node) -> Geometry:
    """Return the empty solid or region that replaces a node; None if its dimension is unknown."""
    if node.name in _SOLIDS:
        return Solid.empty()
    if node.name in _FIGURES:
        return Region.empty()
    if node.name != "import":
        return None
    name = Arguments(node, "", ("file",)).value("file")
    is_drawing = isinstance(name, str) and PurePath(name).suffix.lower() in _DRAWINGS
    return Region.empty() if is_drawing else Solid.empty()
