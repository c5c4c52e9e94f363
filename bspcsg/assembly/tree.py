"""`Assembly`: an immutable tree of named and coloured solids with transforms."""

import os
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np

from .._types import FloatArray, Scalar
from ..attributes.colours import AnyColor, color_of
from ..errors import Finding, invalid_parameter, warn_of_losses
from ..geometry.transform import Factors
from ..method_ownership import with_own_methods
from ..operations.setops import union
from ..parameters import instance_of, not_negative, shown
from ..solid.ledger import uncounted
from ..solid.movable import Movable
from ..solid.solid import Solid
from .bill import Bill, bill_of
from .clashes import Clash, are_apart, clashes_of

#: The largest nesting depth of assemblies, the same as in files.
_MAX_DEPTH = 64

#: The content of an assembly: a solid, or several solids and assemblies.
Content: TypeAlias = Solid | Iterable[Any]


@dataclass(frozen=True, eq=False)
class Part:
    """A solid of an assembly, with its transform, colour and density.

    Parameters
    ----------
    path : str
        The names of the enclosing assemblies and of the part, separated by ``/``; unique among the
        parts.
    name : str
        The name of the part.
    shape : Solid
        The solid before it is transformed; instances share one object.
    factors : tuple of Factor
        The affine maps that transform the solid, outermost first.
    color : (4,) tuple of float or None
        The part's own colour, or the colour of an enclosing assembly.
    density : float or None
        The mass of a cubic model unit.
    """

    path: str
    name: str
    shape: Solid
    factors: Factors
    color: tuple[float, ...] | None
    density: float | None

    @cached_property
    def solid(self) -> Solid:
        """The solid, transformed to its position in the assembly."""
        return transformed_solid(self.shape, self.factors)


@with_own_methods
class Assembly(Movable):
    """A tree of named and coloured solids, each with a transform.

    Solids and assemblies may appear several times: instances share their geometry, also in files.
    Iterating yields the parts, each with its transformed solid.

    Parameters
    ----------
    name : str
        The name of the assembly.
    content : Solid or sequence of Solid and Assembly
        The parts; any object that `Solid.from_mesh` takes counts as a solid.
    color : optional
        The colour of all parts that have no colour of their own: ``"orange"``, ``"#ff8800"``, or
        red, green, blue and optionally opacity, as floats from 0 to 1 or whole numbers from 0 to
        255. Whole numbers are from 0 to 1 if none exceeds 1. It is stored as four floats.
    density : float, optional
        The mass of a cubic model unit, for all parts that have no density of their own.

    Raises
    ------
    InvalidParameterError
        If assemblies are nested more than 64 deep, the density is negative, or the colour is
        invalid.

    Examples
    --------
    >>> import bspcsg as csg
    >>> wheel = csg.Assembly("wheel", csg.cylinder(h=2, r=5, segments=4), color=(0.2, 0.2, 0.2))
    >>> car = csg.Assembly("car", [wheel, wheel.translate(20, 0, 0)], density=0.5)
    >>> [part.path for part in car]
    ['car/wheel', 'car/wheel (2)']
    >>> car.bill().mass
    100.0
    >>> car.clashes()
    []
    """

    def __init__(
        self,
        name: str = "",
        content: Content = (),
        *,
        color: AnyColor | None = None,
        density: Scalar | None = None,
    ) -> None:
        self.name = instance_of(str, name, "name")
        self.color = None if color is None else color_of(color)
        self.density = None if density is None else not_negative(density, "density")
        self.shape = content if isinstance(content, Solid) else None
        children = () if isinstance(content, Solid) else _children(content)
        self.children: tuple[Assembly, ...] = children
        self.factors: Factors = ()
        self._depth: int = 1 + max((child._depth for child in children), default=0)
        if self._depth > _MAX_DEPTH:
            raise invalid_parameter(
                f"The assembly is nested {self._depth} levels deep, and at most {_MAX_DEPTH} are"
                " allowed; use fewer levels."
            )

    def _with(self, **changes: Any) -> "Assembly":
        other = object.__new__(Assembly)
        kept = {name: value for name, value in vars(self).items() if name != "parts"}
        other.__dict__.update(kept | changes)
        return other

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """All solids of the tree with their transforms, in order."""
        found: list[Part] = []
        taken: dict[str, int] = {}
        waiting: list[tuple[Assembly, str, Part | None]] = [(self, "", None)]
        while waiting:
            node, above, around = waiting.pop()
            name = node.name or ("part" if node.shape is not None else "")
            path = "/".join(filter(None, (above, name)))
            path = path if node.shape is None else _unused_path(path, taken)
            inherited = node._inherited(path, around)
            if node.shape is not None:
                found.append(inherited)
            waiting.extend((child, path, inherited) for child in reversed(node.children))
        return tuple(found)

    def _inherited(self, path: str, around: Part | None) -> Part:
        """Return this node as a part that inherits transform, colour and density from `around`."""
        outer = () if around is None else around.factors
        color = self.color if self.color is not None or around is None else around.color
        density = self.density if self.density is not None or around is None else around.density
        shape = Solid.empty() if self.shape is None else self.shape
        return Part(path, self.name, shape, outer + self.factors, color, density)

    def __iter__(self) -> Iterator[Part]:
        """Yield the parts of the assembly."""
        return iter(self.parts)

    def __len__(self) -> int:
        """Return the number of parts of the assembly."""
        return len(self.parts)

    def __getitem__(self, path: str) -> Part:
        """Return the part with the given path, or with the given name if it is unique.

        Raises
        ------
        KeyError
            If there is no such part, or several parts have that name.
        """
        found = [part for part in self.parts if part.path == path]
        found = found or [part for part in self.parts if part.name == path]
        if len(found) != 1:
            known = ", ".join(part.path for part in self.parts)
            raise KeyError(
                f"{len(found)} parts have the path or name “{path}”, but exactly one must; the"
                f" known paths are {known}"
            )
        return found[0]

    def __repr__(self) -> str:
        """Return a text with the name of the assembly and the number of its parts."""
        count = len(self.parts)
        return f"Assembly({self.name!r}, {count} part{'' if count == 1 else 's'})"

    def show(self) -> None:
        """Show the parts in a notebook or in a browser (see `bspcsg.show`)."""
        from ..script.run import show

        show(self)

    def _repr_html_(self) -> str | None:
        """Return HTML for a notebook: an interactive view of the union of all parts."""
        from ..report.viewer.notebook import solid_html

        return solid_html(self.to_solid())

    # Transforms

    def _moved(self, factors: Factors) -> "Assembly":
        kept = tuple(factor for factor in factors if not factor.is_identity)
        return self._with(factors=kept + self.factors) if kept else self

    # Operations, part by part

    def __sub__(self, tool: Any) -> "Assembly":
        """Subtract a solid or an assembly from every part.

        Parts whose bounding box does not meet the tool's bounding box are unchanged.
        """
        other = _as_solid(tool)
        return self._each((), lambda part: part if are_apart(part, other) else part - other)

    def __and__(self, tool: Any) -> "Assembly":
        """Intersect every part with a solid or another assembly."""
        other = _as_solid(tool)
        return self._each((), lambda part: part & other)

    def _each(self, outer: Factors, change: Callable[[Solid], Solid]) -> "Assembly":
        """Return the tree with a change applied to each part's transformed solid.

        `outer` are the affine maps of the enclosing assemblies.
        """
        factors = outer + self.factors
        if self.shape is None:
            children = tuple(child._each(factors, change) for child in self.children)
            return self._with(children=children, factors=())
        placed = transformed_solid(self.shape, factors)
        made = change(placed)
        if made is placed:
            return self._with(factors=factors)
        return self._with(shape=made, factors=())

    # Results

    @uncounted
    def to_solid(self) -> Solid:
        """Return the union of all parts.

        The face attribute ``"part"`` is the path of the part that a face comes from, and
        ``"color"`` the part's colour in bytes, unless the part's mesh has colours itself.
        """
        return (
            union([_with_part_attributes(part) for part in self.parts])
            if self.parts
            else Solid.empty()
        )

    def clashes(self, clearance: Scalar = 0.0) -> list[Clash]:
        """Return the pairs of parts that share volume or are too close to each other.

        Parameters
        ----------
        clearance : float
            The least allowed distance of parts, in model units. By default parts may touch.

        Returns
        -------
        list of Clash
            The clashes, in the order of the parts.
        """
        return clashes_of(self.parts, not_negative(clearance, "clearance"))

    def bill(self) -> Bill:
        """Return the bill of materials: the count, volume and mass of each kind of part."""
        return bill_of(self.parts)

    @property
    def bounds(self) -> FloatArray | None:
        """The least and the greatest coordinates, (2, 3) float64, or None without points."""
        boxes = [box for part in self.parts if (box := part.solid.bounds) is not None]
        if not boxes:
            return None
        lows, highs = zip(*boxes, strict=True)
        return np.array([np.min(lows, axis=0), np.max(highs, axis=0)])

    # Files

    def save(self, path: str | os.PathLike[str]) -> tuple[Finding, ...]:
        """Write the assembly; the suffix names the format.

        3MF and GLB store the tree, names, colours, the shared geometry of instances, and attributes
        of faces as far as `bspcsg.save` does. OBJ stores each transformed part as an object,
        ``.csg`` each part with its colour.

        Returns
        -------
        tuple of Finding
            Findings about all data that the format cannot store; no format stores densities.

        Raises
        ------
        FormatError
            If the suffix is unknown (code "unknown_format"), or as for `bspcsg.save`.

        Warns
        -----
        LossWarning
            As for `bspcsg.save`.
        """
        from .files import save

        findings = save(self, path)
        warn_of_losses(findings)
        return findings

    @classmethod
    def load(cls, path: str | os.PathLike[str], **options: Any) -> "Assembly":
        """Read an assembly; the suffix names the format.

        The tree consists of the components of 3MF, the nodes of GLB, or the uniting nodes of
        scripts; the objects of OBJ are parts. Any other mesh file is an assembly of one part.
        Support and surface objects of 3MF, lines of GLB, and objects scaled by 0 are ignored, as by
        `bspcsg.load`.

        Parameters
        ----------
        path : str or path
        **options
            The options of `Solid` for each solid; for scripts, the options of
            `bspcsg.csg.evaluate`.

        Raises
        ------
        FormatError, InvalidMeshError
            As for `bspcsg.load`.
        """
        from .files import load

        return load(path, **options)


def transformed_solid(solid: Solid, factors: Factors) -> Solid:
    """Return a solid transformed by affine maps, of which the last is applied first."""
    return solid._moved(factors)


def _children(content: Any) -> tuple[Assembly, ...]:
    if not isinstance(content, Iterable):
        raise invalid_parameter(
            "The content of an assembly must be a Solid, an Assembly or a list of these, not"
            f" {shown(content)}."
        )
    return tuple(map(_as_assembly, content))


def _as_assembly(content: Any) -> Assembly:
    if isinstance(content, Assembly):
        return content
    return Assembly("", Solid.from_mesh(content))


def _as_solid(tool: Any) -> Solid:
    return tool.to_solid() if isinstance(tool, Assembly) else Solid.from_mesh(tool)


def _unused_path(path: str, taken: dict[str, int]) -> str:
    """Return a path, with a number appended if it is already used, and mark it as used.

    `taken` has the last number for each path. Counting continues from it, so the time for n parts
    of one name is proportional to n.
    """
    number, free = taken.get(path, 1), path
    while free in taken:
        number += 1
        free = f"{path} ({number})"
    taken[path] = number
    taken.setdefault(free, 1)
    return free


def _with_part_attributes(part: Part) -> Solid:
    said = part.solid.to_mesh().attributes.without_empty_material().names
    values: dict[str, Any] = {"part": part.path}
    if part.color is not None and not {"color", "material"}.intersection(said):
        values["color"] = np.rint(np.array(part.color) * 255).astype(np.uint8)
    return part.solid.tagged(**values)
