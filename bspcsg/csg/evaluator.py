"""The evaluation of script trees to solids and regions."""

import os
from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, get_args

from ..bsp import Region
from ..errors import BspcsgError, FormatError, invalid_parameter
from ..parameters import file_path, function_of, instance_of, one_of, shown, truth_value
from ..solid.ledger import counted
from ..solid.solid import Solid
from .making.polish import Polish, corners_and_levels, pitch_of, polished_pitch, snapped
from .making.transform_distribution import COMBINING, with_transforms_distributed
from .nodes import files as nodes_file
from .nodes import hulls as nodes_hull
from .nodes import plane_figures as nodes_plane
from .nodes import projection as nodes_project
from .nodes import set_operations as nodes_set
from .nodes import solids as nodes_solid
from .nodes import sweeps as nodes_sweep
from .nodes import text as nodes_letters
from .nodes import transforms as nodes_move
from .nodes.left_out import empty_geometry_of, is_left_out
from .nodes.registry import NODE_KINDS, Evaluation, Geometry, OnInvalid
from .scope import Scope, inherited, with_scope
from .syntax.source import error_at
from .syntax.tree import CsgTree, Node

#: The modules that register the functions for nodes when they are imported.
NODE_MODULES = (
    nodes_file, nodes_hull, nodes_letters, nodes_move, nodes_plane,
    nodes_project, nodes_set, nodes_solid, nodes_sweep,
)  # fmt: skip


def node_names() -> tuple[str, ...]:
    """Return the sorted names of the script nodes that can be evaluated."""
    return tuple(sorted(NODE_KINDS))


@counted
def evaluate(
    tree: CsgTree,
    *,
    polish: bool = False,
    on_polish: Callable[[Polish], object] | None = None,
    on_invalid: OnInvalid = "error",
    allow_paths: Iterable[str | os.PathLike[str]] = (),
    lenient: bool = False,
) -> Geometry:
    """Evaluate a script tree to a solid, a region of the plane, or None if it has no geometry.

    Parameters
    ----------
    tree : CsgTree
    polish : bool
        True to undo OpenSCAD's rounding to six digits. Matrices within 1e-5 of a rotation become
        that rotation. The parts that the outermost unions, differences and intersections combine
        are snapped to the finest lattice on which the most corners and axis-aligned faces of
        different parts coincide. Its step is at most a unit of the sixth digit of the largest
        coordinate. Each corner moves once, by at most half a step along each axis. Nothing moves if
        no lattice makes more of them coincide, and a part is unchanged if one of its pieces would
        lose more than half its volume or area. Faces of rotated solids may break where their
        corners move.
    on_polish : callable, optional
        Called with a `Polish`: the lattice, and the largest distance that a corner moved.
    on_invalid : {"error", "warn", "repair"}
        The treatment of polyhedra and imported meshes that are not closed: raise an error, omit
        them with a warning, as OpenSCAD does, or close them by `bspcsg.repair` with a warning.
        Direct children of ``hull`` need not be closed, since only their corners matter.
    allow_paths : iterable of path
        Folders that ``import`` and ``surface`` may read in addition to the script's own folder.
        Links are resolved first.
    lenient : bool
        True to omit nodes that cannot be evaluated, with a warning that names line and column; also
        meshes that are not closed, unless `on_invalid` is "repair".

    Raises
    ------
    FormatError
        For a node that is not supported (code "unsupported"), an argument of a wrong type
        ("bad_argument"), or a file outside the allowed folders ("forbidden_path"). The message
        names script, line and column; `where` contains line and column.
    InvalidMeshError, LimitError
        If no solid can be made for a node; the message names script, line and column.

    Warns
    -----
    CsgWarning
        For everything that is omitted, as by OpenSCAD: missing files, numbers that are not finite,
        missing points, children of the other dimension, parts of drawings that are not outlines,
        and arguments that a node does not have or that other arguments override.
    """
    one_of(get_args(OnInvalid), on_invalid, "on_invalid")
    polishes, skips = truth_value(polish, "polish"), truth_value(lenient, "lenient")
    if on_polish is not None:
        function_of(on_polish, "on_polish")
    allowed = _folders(allow_paths)
    instance_of(CsgTree, tree, "tree")
    name = tree.name if tree.intermediate is None else tree.intermediate.name
    invalid: OnInvalid = "warn" if skips and on_invalid == "error" else on_invalid
    run = Evaluation(
        name,
        tree.folder,
        allowed,
        polishes,
        on_invalid=invalid,
        lenient=skips,
        explained=lambda message: tree.explained(FormatError(message)).message,
    )
    try:
        result, done = _polished(tree, run)
    except BspcsgError as error:
        explained = tree.explained(error)
        if explained is error:
            raise
        raise explained from error
    if polishes and on_polish is not None:
        on_polish(done)
    return result


def _folders(given: Any) -> tuple[Path, ...]:
    if not isinstance(given, (str, bytes)) and isinstance(given, Iterable):
        return tuple(Path(file_path(path, "allow_paths")).resolve() for path in given)
    raise invalid_parameter(f"allow_paths must be a list of folders, not {shown(given)}.")


def _polished(tree: CsgTree, run: Evaluation) -> tuple[Geometry, Polish]:
    """Evaluate a tree; if polishing needs a coarser lattice, evaluate it again on that lattice.

    Return the geometry, and what polishing changed.
    """
    root = Node("union", (), tree.roots())
    if not run.polish:
        return _Cache(run).geometry(root), Polish()
    root, rough = with_transforms_distributed(root), _Cache(run)
    result = rough.geometry(root)
    pitch = _wanted_pitch(rough.parts)
    if pitch is None:
        return result, Polish()
    fine = _Cache(run, pitch)
    return fine.geometry(root), Polish(pitch, fine.moved)


def _wanted_pitch(parts: list[Solid | Region]) -> int | None:
    """Return the pitch of the lattice on which nearly coincident parts meet; None if none helps."""
    there = [part for part in parts if not part.is_empty]
    finest = min((pitch_of(part) for part in there), default=0)
    return polished_pitch(corners_and_levels(there), finest)


@dataclass
class _Cache:
    """The geometry of each node of a tree, computed once for equal nodes.

    Nodes are equal if their names, arguments and children are equal. So repeated parts share one
    solid, which is evaluated once.

    Parameters
    ----------
    run : Evaluation
    pitch : int, optional
        The pitch of the lattice to which the corners of parts are snapped, if any.
    parts : list of Solid or Region
        The operands of the outermost operations.
    moved : float
        The largest distance that a corner of a part moved.
    """

    run: Evaluation
    pitch: int | None = None
    numbers: dict[Hashable, int] = field(default_factory=dict)
    made: list[Geometry] = field(default_factory=list)
    parts: list[Solid | Region] = field(default_factory=list)
    moved: float = 0.0

    def geometry(self, root: Node) -> Geometry:
        """Return the geometry of a node, whose children may be nested to any depth."""
        waiting: list[tuple[Node, Scope | None, bool, bool]] = [(root, (), True, False)]
        done: list[int] = []
        while waiting:
            node, scope, outer, in_hull = waiting.pop()
            combines = outer and node.name in COMBINING
            children = [child for child in node.children if not child.is_ignored]
            if scope is not None:
                inner = inherited(scope, node)
                waiting.append((with_scope(node, scope), None, outer, in_hull))
                is_hull = node.name == "hull"
                waiting.extend((child, inner, combines, is_hull) for child in reversed(children))
                continue
            first = len(done) - len(children)
            numbers = tuple(done[first:])
            del done[first:]
            self.run.in_hull = in_hull
            done.append(self._number(node, numbers, outer and not combines))
        return self.made[done[0]]

    def _number(self, node: Node, children: tuple[int, ...], is_part: bool) -> int:
        """Return the position in `made` of a node's geometry, which is computed if it is new."""
        # Warn at each of several equal nodes, since the warning names line and column.
        self.run.warn_of_arguments(node)
        key = (node.name, node.arguments, children, is_part, self.run.in_hull)
        if key in self.numbers:
            return self.numbers[key]
        number = len(self.made)
        try:
            self.made.append(self._make(node, [self.made[child] for child in children], is_part))
            self.numbers[key] = number
        except BspcsgError as error:
            # Do not cache it: an equal node must warn with its own line and column.
            self.made.append(self._nothing_for(node, error))
        return number

    def _make(self, node: Node, children: list[Geometry], is_part: bool) -> Geometry:
        recipe = NODE_KINDS.get(node.name)
        if recipe is None:
            raise unsupported(node, self.run.script)
        made = recipe.maker(node, children, self.run)
        if isinstance(made, Solid) and (recipe.makes_corners or (is_part and self.run.polish)):
            made.tree  # noqa: B018  builds it, so that errors name this node
        return self._part(made) if is_part and self.run.polish else made

    def _nothing_for(self, node: Node, error: BspcsgError) -> Geometry:
        """Return the empty set for a node that fails, with a warning.

        If the error is not one for which nodes are omitted, raise it.
        """
        placed = _located(error, node, self.run.script)
        if not is_left_out(error, lenient=self.run.lenient):
            raise placed from error
        self.run.warn_once(f"{placed.message} This node is left out.")
        return empty_geometry_of(node)

    def _part(self, body: Geometry) -> Geometry:
        """Record a part of the model; snap it to the lattice of `self.pitch` if that is coarser."""
        if body is None or body.is_empty:
            return body
        if self.pitch is not None and self.pitch > pitch_of(body):
            body, moved = snapped(body, self.pitch)
            self.moved = max(self.moved, moved)
        self.parts.append(body)
        return body


def unsupported(node: Node, script: str) -> FormatError:
    """Return the error for a node whose name is not supported."""
    message = f"{node.name}() is not supported. Supported: {' '.join(node_names())}."
    return error_at(script, node.place, message, "unsupported")


def _located(error: BspcsgError, node: Node, script: str) -> BspcsgError:
    """Return the error with script, line and column of a node at the front of its message.

    It is unchanged if the message already begins with that line.
    """
    if error.message.startswith(f"{script}:{node.place.line}:"):
        return error
    message = f"{script}:{node.place.line}:{node.place.column}: {node.name}(): {error.message}"
    return type(error)(message, error.code, error.where)
