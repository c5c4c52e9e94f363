"""The table of the functions that evaluate script nodes, by the names of the nodes."""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np

from ..._types import FloatArray
from ...bsp import Region
from ...errors import InvalidMeshError, without_control_characters
from ...formats.raw import RawMesh
from ...repair.repair import repair
from ...solid.solid import Solid
from ..syntax.arguments import Arguments
from ..syntax.tree import Node
from .signature import Signature

#: The geometry of a node; None if it has none, and so no dimension.
Geometry: TypeAlias = Solid | Region | None


OnInvalid: TypeAlias = Literal["error", "warn", "repair"]


#: The error codes of meshes that do not bound a solid.
_NO_SOLID_CODES = frozenset({"not_closed", "empty_mesh"})


class CsgWarning(UserWarning):
    """A warning that a part of a script was omitted, as OpenSCAD would."""


@dataclass
class Evaluation:
    """The state that nodes share while one tree is evaluated.

    Parameters
    ----------
    script : str
        The name of the script in errors.
    folder : Path
        The folder to which names of imported files are relative.
    allowed : tuple of Path
        Other folders from which files may be imported, with links resolved.
    polish : bool
        True to replace matrices that are nearly rotations by exact rotations.
    on_invalid : {"error", "warn", "repair"}
        The treatment of polyhedra and imported meshes that are not closed: raise an error, omit
        them, or close them.
    lenient : bool
        True if nodes that cannot be evaluated are omitted.
    explained : callable
        Takes a message that begins with script, line and column, and adds an explanation of them.
    united : dict
        Unions of plane figures by their `id`, each with the figures that it is made of.
    in_hull : bool
        True while a child of a hull is evaluated, of which only the corners matter.
    open_meshes : dict
        The empty solids that represent open meshes in hulls, by `id`, each with the corners of its
        mesh.
    issued_warnings : set of str
        The warnings that were already issued.
    """

    script: str = "<csg>"
    folder: Path = field(default_factory=Path)
    allowed: tuple[Path, ...] = ()
    polish: bool = False
    on_invalid: OnInvalid = "error"
    lenient: bool = False
    explained: Callable[[str], str] = str
    united: dict[int, tuple[Region, list[Region]]] = field(default_factory=dict)
    in_hull: bool = False
    open_meshes: dict[int, tuple[Solid, FloatArray]] = field(default_factory=dict)
    issued_warnings: set[str] = field(default_factory=set)

    def arguments(self, node: Node) -> Arguments:
        """Return the arguments of a node, with names for positional arguments."""
        return Arguments(node, self.script, NODE_KINDS[node.name].takes.order)

    def warn_of_arguments(self, node: Node) -> None:
        """Warn of each argument of a node that is ignored."""
        if node.name in NODE_KINDS:
            for complaint in NODE_KINDS[node.name].takes.complaints(node):
                self.warn(node, complaint)

    def figures(self, owner: Node, children: list[Geometry]) -> list[Geometry]:
        """Return the children that are not solids; warn if a solid is ignored."""
        figures: list[Geometry] = [child for child in children if not isinstance(child, Solid)]
        if len(figures) < len(children):
            self.warn(owner, "its 3D children are ignored, because it takes 2D children only")
        return figures

    def solids(self, owner: Node, children: list[Geometry]) -> list[Geometry]:
        """Return the children that are not plane figures; warn if a plane figure is ignored."""
        solids: list[Geometry] = [child for child in children if not isinstance(child, Region)]
        if len(solids) < len(children):
            self.warn(owner, "its 2D children are ignored, because it takes 3D children only")
        return solids

    def parts_of(self, figure: Region) -> list[Region]:
        """Return the figures whose union is the given one; the figure itself if it is no union."""
        return self.united[id(figure)][1] if id(figure) in self.united else [figure]

    def corners_or(self, solid: Solid) -> Solid | FloatArray:
        """Return the solid, or if it is a placeholder for an open mesh, the mesh's corners."""
        return self.open_meshes[id(solid)][1] if id(solid) in self.open_meshes else solid

    def warn(self, node: Node, message: str) -> None:
        """Issue a warning with the script, line, column and name of a node."""
        place = node.place
        self.warn_once(f"{self.script}:{place.line}:{place.column}: {node.name}(): {message}")

    def warn_once(self, message: str) -> None:
        """Issue a warning, unless the same message was issued before."""
        # A polished model may be evaluated twice.
        if message in self.issued_warnings:
            return
        self.issued_warnings.add(message)
        warnings.warn(without_control_characters(self.explained(message)), CsgWarning, stacklevel=2)

    def closed_solid(self, node: Node, vertices: Any, faces: Any) -> Solid | None:
        """Return the solid of a mesh from the script, whatever its orientation.

        If the mesh is not closed, raise an error, or repair it or return None with a warning, as
        `on_invalid` says. In a hull, return an empty solid as a placeholder for the mesh.
        """
        try:
            solid = Solid(vertices, faces, winding="nonzero")
            return self._loose(vertices, faces) if self.in_hull and solid.is_empty else solid
        except InvalidMeshError as error:
            if self.in_hull and error.code in _NO_SOLID_CODES:
                return self._loose(vertices, faces)
            if self.on_invalid == "error" or error.code != "not_closed":
                raise
            if self.on_invalid == "repair":
                made = repair(RawMesh(vertices, faces)).mesh
                self.warn(node, f"{error.message} This mesh is repaired.")
                return Solid(made.vertices, made.faces, winding="nonzero")
            self.warn(node, f"{error.message} This mesh is left out.")
            return None

    def _loose(self, vertices: Any, faces: Any) -> Solid:
        stand_in = Solid.empty()
        self.open_meshes[id(stand_in)] = stand_in, np.asarray(vertices)[np.unique(faces)]
        return stand_in

    def same_kind(
        self, node: Node, children: Sequence[Geometry]
    ) -> tuple[list[Solid], list[Region]]:
        """Return the solids and the regions among the children; one of the lists is empty.

        If there are both, only the dimension of the first child counts, as in OpenSCAD, and a
        warning is issued.
        """
        there = [child for child in children if child is not None]
        solids = [child for child in there if isinstance(child, Solid)]
        regions = [child for child in there if isinstance(child, Region)]
        if not solids or not regions:
            return solids, regions
        flat = isinstance(there[0], Region)
        left_out = "3D" if flat else "2D"
        self.warn(
            node, f"its children are partly 2D and partly 3D; the {left_out} children are ignored"
        )
        return ([], regions) if flat else (solids, [])


NodeMaker: TypeAlias = Callable[[Node, list[Geometry], Evaluation], Geometry]


@dataclass(frozen=True)
class NodeKind:
    """The function that evaluates the nodes of one name, and their arguments.

    Parameters
    ----------
    maker : callable
        Takes the node, the geometries of its children and the evaluation; returns its geometry.
    takes : Signature
        The arguments that such nodes have.
    makes_corners : bool
        True if the result has corners that the children do not have.
    """

    maker: NodeMaker
    takes: Signature
    makes_corners: bool


NODE_KINDS: dict[str, NodeKind] = {}


_NO_ARGUMENTS = Signature()


def node(
    *names: str, takes: Signature = _NO_ARGUMENTS, makes_corners: bool = True
) -> Callable[[NodeMaker], NodeMaker]:
    """Return a decorator that registers a function to evaluate the nodes of the given names."""

    def register(maker: NodeMaker) -> NodeMaker:
        for name in names:
            NODE_KINDS[name] = NodeKind(maker, takes, makes_corners)
        return maker

    return register
