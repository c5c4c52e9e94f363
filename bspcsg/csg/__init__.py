"""OpenSCAD's `.csg` scripts: reading, evaluating and writing.

A script is a tree of primitives, transforms and operations, which `parse` reads and `dumps`
writes. `evaluate` turns the tree into a solid or a region with the same corners as in OpenSCAD;
`load` and `loads` read and evaluate. `to_json` and `from_json` convert a tree to and from JSON.

Examples
--------
>>> from bspcsg import csg as scripts
>>> scripts.loads("difference() { cube(size = 2); sphere(r = 1, $fn = 8); }").volume > 7
True
"""

from .evaluator import evaluate, node_names
from .from_solid import tree_of
from .loading import dump, dumps, load, loads, read_tree
from .making.polish import Polish
from .nodes.registry import CsgWarning
from .openscad import read_scad
from .syntax.json_form import from_json, to_json
from .syntax.parser import parse, value_of
from .syntax.simplification import simplified
from .syntax.tree import Argument, CsgTree, Node, Place
from .syntax.tree_display import graph, outline
from .syntax.writer import written

__all__ = [
    "Argument",
    "CsgTree",
    "CsgWarning",
    "Node",
    "Place",
    "Polish",
    "dump",
    "dumps",
    "evaluate",
    "from_json",
    "graph",
    "load",
    "loads",
    "node_names",
    "outline",
    "parse",
    "read_scad",
    "read_tree",
    "simplified",
    "to_json",
    "tree_of",
    "value_of",
    "written",
]
