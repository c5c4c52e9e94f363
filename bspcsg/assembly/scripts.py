"""Assemblies in `.csg` scripts: nodes that unite their children become the tree."""

import os
from collections.abc import Iterable
from typing import Any

from .. import csg
from ..attributes.colours import color_of
from ..csg import CsgTree, Node
from ..csg.from_solid import lost_attributes, tree_of
from ..csg.scope import Scope, inherited
from ..csg.syntax.tree import Argument
from ..errors import Finding
from ..solid.solid import Solid
from .tree import Assembly

#: The names of nodes that unite their children.
_UNITING = frozenset({"group", "union", "render", "color"})


#: The largest nesting depth of the tree; a node at a greater depth becomes one part.
_MAX_PART_DEPTH = 60


def load(path: str | os.PathLike[str], name: str, **options: Any) -> Assembly:
    """Read an assembly from a script; each node that does not unite, colour or move is a part."""
    reading = _AssemblyReader(csg.read_tree(path), options)
    return Assembly(name, reading.assemblies(reading.tree.roots(), None, (), 0))


class _AssemblyReader:
    """A script that is read as an assembly, and the options with which its nodes are evaluated."""

    def __init__(self, tree: CsgTree, options: dict[str, Any]) -> None:
        self.tree = tree
        self._options = options

    def assemblies(
        self, nodes: Iterable[Node], color: tuple[float, ...] | None, scope: Scope, depth: int
    ) -> list[Assembly]:
        """Return the assemblies of the given nodes, omitting nodes that are not solids."""
        there = (node for node in nodes if not node.is_ignored)
        found = (self._assembly(node, color, scope, depth) for node in there)
        return [made for made in found if made is not None]

    def _assembly(
        self, node: Node, color: tuple[float, ...] | None, scope: Scope, depth: int
    ) -> Assembly | None:
        """Return the assembly of a node, or None if it is not a solid.

        Of nested colours, the outermost one, `color`, applies.
        """
        is_moving = node.name == "multmatrix" and len(node.arguments) > 0
        if depth > _MAX_PART_DEPTH or not (node.name in _UNITING or is_moving):
            one = CsgTree((Node("group", scope, (node,)),), self.tree.name, self.tree.folder)
            body = csg.evaluate(one, **self._options)
            return Assembly(node.name, body, color=color) if isinstance(body, Solid) else None
        own = _color(node) if node.name == "color" and color is None else color
        found = self.assemblies(node.children, own, inherited(scope, node), depth + 1)
        made = found[0] if len(found) == 1 else Assembly("", found)
        return made.transform(node.arguments[0].value) if is_moving else made


def _color(node: Node) -> tuple[float, ...] | None:
    """Return the colour of a `color` node, or None if it is invalid.

    The second argument of the node is the opacity.
    """
    named = {
        argument.name or str(place): argument.value for place, argument in enumerate(node.arguments)
    }
    given: Any = named.get("c", named.get("0"))
    alpha: Any = named.get("alpha", named.get("1"))
    try:
        # In scripts, colours are from 0 to 1, also if they are written as whole numbers.
        found = color_of(given if isinstance(given, str) else [float(value) for value in given])
        return found if alpha is None else color_of([*found[:3], float(alpha)])
    except (TypeError, ValueError):
        return None


def save(assembly: Assembly, path: str | os.PathLike[str]) -> tuple[Finding, ...]:
    """Write each part, transformed and with its colour, as a node of a script.

    Return the findings about losses: scripts store no names and no attributes.
    """
    nodes: list[Node] = []
    for part in assembly.parts:
        inner = tree_of(part.solid).nodes
        if part.color is None:
            nodes.append(Node("group", (), inner))
        else:
            nodes.append(Node("color", (Argument(None, part.color),), inner))
    csg.dump(CsgTree(tuple(nodes)), path)
    lost = lost_attributes(part.shape for part in assembly.parts)
    count = sum(bool(part.name) for part in assembly.parts)
    if not count:
        return lost
    message = f".csg scripts cannot store part names; the names of {count} parts were left out."
    return (*lost, Finding("names_left_out", "warning", message, (), count))
