"""Trees as geometry."""

import os
from collections.abc import Hashable, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path

from ..bsp import Region
from ..counting import counted
from ..errors import BspcsgError, FormatError
from ..solid import Solid
from . import (
    nodes_file,
    nodes_hull,
    nodes_move,
    nodes_plane,
    nodes_project,
    nodes_set,
    nodes_solid,
    nodes_sweep,
)
from .polish import polished_pitch
from .registry import RECIPES, Evaluation, Geometry, OnInvalid
from .scope import Scope, inherited, with_scope
from .source import error_at
from .tree import CsgTree, Node

#: The modules that register nodes when they are imported.
MAKERS = (
    nodes_file, nodes_hull, nodes_move, nodes_plane,
    nodes_project, nodes_set, nodes_solid, nodes_sweep,
)  # fmt: skip


def node_names() -> tuple[str, ...]:
    """Return the names of the nodes that can be evaluated, sorted."""
    return tuple(sorted(RECIPES))


@counted
def evaluate(
    tree: CsgTree,
    *,
    polish: bool = False,
    on_invalid: OnInvalid = "error",
    allow_paths: Iterable[str | os.PathLike[str]] = (),
) -> Geometry:
    """Return what a tree stands for: a solid, a region of the plane, or None if it is nothing.

    Parameters
    ----------
    tree : CsgTree
    polish : bool
        Undo what six digits did: matrices within 1e-5 of a rotation become that rotation, and
        coordinates are snapped to a lattice whose step is a unit of the sixth digit of the model's
        largest coordinate, so that faces meet again that nearly did; faces of turned bodies may
        break where their corners move by as much. The model is evaluated once more to know its
        size.
    on_invalid : {"error", "warn", "repair"}
        Whether polyhedra and imported meshes that are not closed are errors, or are left out with a
        warning, as OpenSCAD does, or closed by `bspcsg.repair` with one.
    allow_paths : iterable of path
        Folders that ``import`` and ``surface`` may read beside the script's own. Links are
        followed before it is decided where a file lies.

    Raises
    ------
    FormatError
        For a node that is not supported (code "unsupported"), an argument of a wrong kind
        ("bad_argument"), a file that is not there ("missing_file") or lies elsewhere
        ("forbidden_path"); the message names the script, line and column, which `where` holds.
    InvalidMeshError, LimitError
        If a node makes no solid; the message names the place as well.

    Warns
    -----
    CsgWarning
        For what is left out as OpenSCAD leaves it out.
    """
    allowed = tuple(Path(path).resolve() for path in allow_paths)
    run = Evaluation(tree.name, tree.folder, allowed, polish, on_invalid=on_invalid)
    result = _run(tree, run)
    if not polish or result is None or result.is_empty:
        return result
    return _run(tree, replace(run, pitch=polished_pitch(_largest(result))))


def _largest(body: Solid | Region) -> float:
    bounds = body.bounds
    return 0.0 if bounds is None else float(abs(bounds).max())


def _run(tree: CsgTree, run: Evaluation) -> Geometry:
    cache = _Cache(run)
    whole = Node("union", (), tree.roots())
    return cache.geometry(whole)


@dataclass
class _Cache:
    """The geometry of each node, made once for nodes that say the same.

    Two nodes say the same if their names, arguments and children do; so repeated parts share one
    solid, which is evaluated once.
    """

    run: Evaluation
    numbers: dict[Hashable, int] = field(default_factory=dict)
    made: list[Geometry] = field(default_factory=list)

    def geometry(self, root: Node) -> Geometry:
        """Return what a node stands for; nodes may nest to any depth."""
        waiting: list[tuple[Node, Scope | None]] = [(root, ())]
        done: list[int] = []
        while waiting:
            node, scope = waiting.pop()
            children = [child for child in node.children if not child.is_ignored]
            if scope is not None:
                inner = inherited(scope, node)
                waiting.append((with_scope(node, scope), None))
                waiting.extend((child, inner) for child in reversed(children))
                continue
            first = len(done) - len(children)
            numbers = tuple(done[first:])
            del done[first:]
            done.append(self._number(node, numbers))
        return self.made[done[0]]

    def _number(self, node: Node, children: tuple[int, ...]) -> int:
        """Return the number of the node's geometry, made if it is new."""
        key = (node.name, node.arguments, children)
        if key not in self.numbers:
            self.made.append(self._make(node, [self.made[child] for child in children]))
            self.numbers[key] = len(self.made) - 1
        return self.numbers[key]

    def _make(self, node: Node, children: list[Geometry]) -> Geometry:
        recipe = RECIPES.get(node.name)
        if recipe is None:
            raise unsupported(node, self.run.script)
        try:
            made = recipe.maker(node, children, self.run)
            polished = self.run.pitch is not None
            return self._built(made) if recipe.makes_corners or polished else made
        except BspcsgError as error:
            raise _placed(error, node, self.run.script) from error

    def _built(self, body: Geometry) -> Geometry:
        """Return a body on the lattice asked for; what is wrong with it is this node's error."""
        pitch = self.run.pitch
        if isinstance(body, Solid):
            body.tree  # noqa: B018  builds it
        if body is None or pitch is None or body.is_empty:
            return body
        if isinstance(body, Region):
            return body if body.pitch == pitch else Region(body.to_polygons(), pitch=pitch)
        if body.tree.pitch == pitch:
            return body
        mesh = body.normalized().to_mesh()
        return Solid(mesh.vertices, mesh.faces, pitch=pitch)


def unsupported(node: Node, script: str) -> FormatError:
    """Return the error for a node that cannot be evaluated."""
    if node.name == "text":
        message = (
            "text() needs fonts, which bspcsg does not read. Export it from OpenSCAD as SVG and"
            " import() that file, or leave it out."
        )
    else:
        message = f"{node.name}() is not supported. Supported: {' '.join(node_names())}."
    return error_at(script, node.place, message, "unsupported")


def _placed(error: BspcsgError, node: Node, script: str) -> BspcsgError:
    """Return the error with the node's place, if it does not name one of this script already."""
    if error.message.startswith(f"{script}:{node.place.line}:"):
        return error
    message = f"{script}:{node.place.line}:{node.place.column}: {node.name}(): {error.message}"
    return type(error)(message, error.code, error.where)
