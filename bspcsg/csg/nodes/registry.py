"""The table of functions by the nodes that they make."""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np

from ..._types import FloatArray
from ...bsp import Region
from ...errors import InvalidMeshError, harmless
from ...formats.raw import RawMesh
from ...repair.repair import repair
from ...solid.solid import Solid
from ..syntax.arguments import Arguments
from ..syntax.tree import Node
from .signature import Signature

#: The geometry of a node; None is nothing at all, which has no dimension.
Geometry: TypeAlias = Solid | Region | None


OnInvalid: TypeAlias = Literal["error", "warn", "repair"]


#: Codes of meshes without an inside.
_BOUND_NOTHING = frozenset({"not_closed", "empty_mesh"})


class CsgWarning(UserWarning):
    """Something in a script was left out, as OpenSCAD does."""


@dataclass
class Evaluation:
    """The state that nodes share while one tree is evaluated.

    Parameters
    ----------
    script : str
        Its name, for errors.
    folder : Path
        The folder in which imported files are looked for.
    allowed : tuple of Path
        Other folders from which files may be imported, with links resolved.
    polish : bool
        True to turn matrices that are nearly rotations into exact ones.
    on_invalid : {"error", "warn", "repair"}
        The treatment of polyhedra and imported meshes that are not closed: error, left out, or
        closed.
    lenient : bool
        True if nodes that cannot be made are left out.
    explained : callable
        Takes a message that begins with a place, and adds what is known about the place.
    united : dict
        Unions of plane figures by their `id`, each with the figures that it is made of.
    in_hull : bool
        True while a child of a hull is made, of which only the corners count.
    loose : dict
        Empty solids that stand for meshes in hulls that bound nothing, by `id`, each with the
        corners of its mesh.
    told : set of str
        The warnings that were issued already.
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
    loose: dict[int, tuple[Solid, FloatArray]] = field(default_factory=dict)
    told: set[str] = field(default_factory=set)

    def arguments(self, node: Node) -> Arguments:
        """Return the arguments of a node."""
        return Arguments(node, self.script, RECIPES[node.name].takes.order)

    def tell_of_arguments(self, node: Node) -> None:
        """Warn of the arguments of a node that are ignored."""
        if node.name in RECIPES:
            for complaint in RECIPES[node.name].takes.complaints(node):
                self.warn(node, complaint)

    def figures(self, owner: Node, children: list[Geometry]) -> list[Geometry]:
        """Return the children of a node that takes plane figures; warn of solids among them."""
        figures: list[Geometry] = [child for child in children if not isinstance(child, Solid)]
        if len(figures) < len(children):
            self.warn(owner, "its 3D children are ignored, because it takes 2D children only")
        return figures

    def solids(self, owner: Node, children: list[Geometry]) -> list[Geometry]:
        """Return the children of a node that takes solids; warn of plane figures among them."""
        solids: list[Geometry] = [child for child in children if not isinstance(child, Region)]
        if len(solids) < len(children):
            self.warn(owner, "its 2D children are ignored, because it takes 3D children only")
        return solids

    def parts_of(self, figure: Region) -> list[Region]:
        """Return the figures that a union was made of; any other figure alone."""
        return self.united[id(figure)][1] if id(figure) in self.united else [figure]

    def corners_or(self, solid: Solid) -> Solid | FloatArray:
        """Return the corners of a mesh in a hull that bounds nothing; any other solid itself."""
        return self.loose[id(solid)][1] if id(solid) in self.loose else solid

    def warn(self, node: Node, message: str) -> None:
        """Warn that something at a node was left out."""
        place = node.place
        self.tell(f"{self.script}:{place.line}:{place.column}: {node.name}(): {message}")

    def tell(self, message: str) -> None:
        """Issue a warning that names its place, each message once."""
        # A polished model is evaluated twice.
        if message in self.told:
            return
        self.told.add(message)
        warnings.warn(harmless(self.explained(message)), CsgWarning, stacklevel=2)

    def closed_solid(self, node: Node, vertices: Any, faces: Any) -> Solid | None:
        """Return the solid of a mesh that the user gave, oriented either way.

        A mesh that is not closed is an error, or is left out or repaired with a warning; in a hull
        its corners are kept.
        """
        try:
            solid = Solid(vertices, faces, winding="nonzero")
            return self._loose(vertices, faces) if self.in_hull and solid.is_empty else solid
        except InvalidMeshError as error:
            if self.in_hull and error.code in _BOUND_NOTHING:
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
        self.loose[id(stand_in)] = stand_in, np.asarray(vertices)[np.unique(faces)]
        return stand_in

    def same_kind(
        self, node: Node, children: Sequence[Geometry]
    ) -> tuple[list[Solid], list[Region]]:
        """Return the solids or regions among the children, whichever the first one is.

        The others are ignored with a warning, as in OpenSCAD.
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
class Recipe:
    """The evaluation of one kind of node.

    Parameters
    ----------
    maker : callable
        Takes the node, its children's geometries and the evaluation.
    takes : Signature
        The arguments that it knows.
    makes_corners : bool
        True if its result has corners that its children do not have.
    """

    maker: NodeMaker
    takes: Signature
    makes_corners: bool


RECIPES: dict[str, Recipe] = {}


_NO_ARGUMENTS = Signature()


def node(
    *names: str, takes: Signature = _NO_ARGUMENTS, makes_corners: bool = True
) -> Callable[[NodeMaker], NodeMaker]:
    """Register a function as the maker of the nodes with these names."""

    def register(maker: NodeMaker) -> NodeMaker:
        for name in names:
            RECIPES[name] = Recipe(maker, takes, makes_corners)
        return maker

    return register
