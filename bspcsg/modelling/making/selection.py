"""`Selection`: a subset of a solid's edges or faces, and methods to choose it."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from typing import Any, ClassVar, Self, TypeAlias

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray, Scalar, Vector
from ...errors import invalid_parameter
from ...geometry.arrays import axes_of, doubles_or_none
from ...geometry.transform import axis_vector
from ...parameters import number, shown
from .plane_faces import FaceGraph, extent, flatness

#: The least cosine between lines that count as parallel, for an angle of 0.001 radians: snapping to
#: the lattice may rotate an edge of a thousand steps so much.
_PARALLEL = 1 - 1e-3**2 / 2

#: Sorted values belong to one group if neighbours differ by less than this share of the largest.
_SAME = 1e-6

#: A sort key: an axis, the name of a property, or a function of a selection.
Key: TypeAlias = "str | Vector | Callable[[Any], Any]"


class Selection(ABC):
    """An ordered subset of a solid's edges or faces, the items.

    Each property is an array with one entry per item, for use in conditions. An index gives a
    selection of one item, a slice a selection of several.
    """

    #: The name of the items in messages, "edges" or "faces", and the properties that may be sort
    #: keys; `__repr__` shows the range of the first property.
    _things: ClassVar[str]
    _sizes: ClassVar[tuple[str, ...]]

    def __init__(self, graph: FaceGraph, numbers: IndexArray) -> None:
        self._graph = graph
        self._numbers = numbers

    @property
    @abstractmethod
    def middle(self) -> FloatArray:
        """The middle of each item, (n, 3) float64, in model units."""

    @property
    @abstractmethod
    def direction(self) -> FloatArray:
        """The direction of each edge or normal of each flat face, (n, 3); zero for round faces."""

    @abstractmethod
    def _flat_faces(self) -> tuple[IndexArray, IndexArray]:
        """Return pairs of a plane face of the solid and an item that is or touches it.

        Two (k,) arrays: numbers of plane faces, and positions of items in this selection.
        """

    @abstractmethod
    def _between(self, heights: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the least and greatest value at the corners of each item, (n,) each.

        `heights` has a value for each vertex of the solid.
        """

    @abstractmethod
    def _total(self) -> int:
        """Return the number of all edges, or all faces, of the solid."""

    def _with(self, numbers: IndexArray) -> Self:
        return type(self)(self._graph, numbers)

    def filter(self, condition: "Callable[[Self], Any] | Any") -> Self:
        """Return the selection of the items for which a condition is true.

        Parameters
        ----------
        condition : function or (n,) bool
            A truth value for each item, or a function that takes this selection and returns them.

        Raises
        ------
        InvalidParameterError
            If the number of truth values is wrong.
        """
        found = condition(self) if callable(condition) else condition
        given = np.asarray(None if axes_of(found) is None else found)
        if given.dtype != np.bool_ or given.shape != (len(self),):
            raise invalid_parameter(
                f"A condition must give one bool for each of the {len(self)} {self._things},"
                f" not {given.dtype} of shape {given.shape}."
            )
        return self._with(self._numbers[given])

    def where(self, condition: "Callable[[Self], Any] | Any") -> Self:
        """Return the selection of the items for which a condition is true; same as `filter`."""
        return self.filter(condition)

    def parallel(self, axis: str | Vector) -> Self:
        """Return the edges parallel to an axis, or the flat faces whose normals are parallel to it.

        Parameters
        ----------
        axis : {"x", "y", "z"} or (3,) float
        """
        return self.filter(np.abs(self.direction @ axis_vector(axis)) >= _PARALLEL)

    def on(self, place: "str | Vector | Selection", offset: Scalar | None = None) -> Self:
        """Return the items that lie in a plane, or are adjacent to another selection.

        Parameters
        ----------
        place : {"x", "y", "z"}, (3,) float or Selection
            The plane's normal, which need not have unit length. Or a selection of the same solid:
            edges lie on the faces that they bound, faces on the edges that bound them.
        offset : float, optional
            The plane consists of the points p with ``normal . p == offset``.

        Examples
        --------
        >>> import bspcsg as csg
        >>> part = csg.box(4, 3, 2)
        >>> len(part.edges().on("z", 2)), len(part.edges().on(part.faces().parallel("x")))
        (4, 8)
        """
        if isinstance(place, Selection):
            return self._with_faces_of(place, offset)
        if offset is None:
            raise invalid_parameter(
                "offset is missing: a plane needs a normal and an offset, as in on('z', 5)."
            )
        normal = axis_vector(place)
        size = 1.0 if isinstance(place, str) else float(np.linalg.norm(np.asarray(place, float)))
        away = self._graph.vertices @ normal - number(offset, "offset") / size
        low, high = self._between(away)
        return self.filter(np.maximum(-low, high) <= flatness(self._graph.vertices))

    def _with_faces_of(self, other: "Selection", offset: Scalar | None) -> Self:
        if offset is not None:
            raise invalid_parameter(
                "offset can only be given with a normal, not with a selection; leave it out."
            )
        self._refuse_another_solid(other)
        faces, owners = self._flat_faces()
        found = np.zeros(len(self), dtype=np.bool_)
        found[owners[np.isin(faces, other._flat_faces()[0])]] = True
        return self.filter(found)

    def sort_by(self, key: Key) -> Self:
        """Return the items in ascending order, so that ``[-1]`` has the largest value.

        Parameters
        ----------
        key : str, (3,) float or function
            "x", "y", "z" or a vector sorts by the position of each item's middle along that axis.
            Otherwise the name of a property, such as "length" or "area"; or a function that takes
            this selection and returns a number for each item.

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.box(4, 3, 2).faces().sort_by("z")[-1].middle.tolist()
        [[2.0, 1.5, 2.0]]
        """
        return self._with(self._numbers[np.argsort(self._values(key)[0], kind="stable")])

    def group_by(self, key: Key) -> list[Self]:
        """Return one selection for each group of items with equal key values, in ascending order.

        Parameters
        ----------
        key : str, (3,) float or function
            As for `sort_by`. Consecutive values are equal if they differ by less than a millionth
            of the largest value, or for positions along an axis, of the solid's longest extent.

        Examples
        --------
        >>> import bspcsg as csg
        >>> [len(edges) for edges in csg.box(4, 3, 2).edges().group_by("z")]
        [4, 4, 4]
        """
        values, scale = self._values(key)
        order = np.argsort(values, kind="stable")
        starts = np.flatnonzero(np.diff(values[order]) > _SAME * scale) + 1
        return [self._with(self._numbers[part]) for part in np.split(order, starts) if len(part)]

    def _values(self, key: Key) -> tuple[FloatArray, float]:
        """Return the key value of each item, (n,), and the scale for their relative tolerance."""
        if isinstance(key, str) and key in self._sizes:
            values = getattr(self, key)
        elif callable(key):
            values = doubles_or_none(key(self))
        else:
            if isinstance(key, str) and key.lower() not in ("x", "y", "z"):
                names = ", ".join(("x", "y", "z", *self._sizes))
                raise invalid_parameter(
                    f"Unknown key {shown(key)}; known are {names}, a vector or a function."
                )
            values = self.middle @ axis_vector(key)
            return values, extent(self._graph.vertices)
        if values is None or values.shape != (len(self),) or not np.isfinite(values).all():
            raise invalid_parameter(
                f"A key must give one finite number for each of the {len(self)} {self._things}."
            )
        return values, float(np.abs(values).max(initial=0))

    def _refuse_another_solid(self, other: "Selection") -> None:
        mine, theirs = self._graph.vertices, other._graph.vertices
        if mine is not theirs and not np.array_equal(mine, theirs):
            raise invalid_parameter(
                "The two selections belong to different solids, so they cannot be combined;"
                " select from one solid."
            )

    def _is_alike(self, other: object) -> bool:
        """Return True if another selection has items of the same kind: edges, or faces."""
        return type(other) is type(self)

    def __or__(self, other: object) -> Self:
        """Return the items that are in at least one of two selections of the same solid."""
        return self._joined(other, lambda theirs: np.union1d(self._numbers, theirs))

    def __and__(self, other: object) -> Self:
        """Return the items of this selection that are also in another selection of the solid."""
        return self._joined(other, lambda theirs: self._numbers[np.isin(self._numbers, theirs)])

    def __sub__(self, other: object) -> Self:
        """Return the items of this selection that are not in another selection of the solid."""
        return self._joined(other, lambda theirs: self._numbers[~np.isin(self._numbers, theirs)])

    def _joined(self, other: object, join: "Callable[[IndexArray], IndexArray]") -> Self:
        if not isinstance(other, Selection) or not self._is_alike(other):
            unlike: Self = NotImplemented
            return unlike
        self._refuse_another_solid(other)
        return self._with(join(other._numbers))

    def __getitem__(self, index: int | slice) -> Self:
        """Return one item, or a slice of items, as a selection."""
        return self._with(np.atleast_1d(self._numbers[index]))

    def __iter__(self) -> Iterator[Self]:
        """Yield a selection of one item for each item."""
        return (self[k] for k in range(len(self)))

    def __len__(self) -> int:
        """Return the number of items."""
        return len(self._numbers)

    def __repr__(self) -> str:
        """Return a text: the counts of items here and in the solid, and their range of sizes."""
        name = self._sizes[0]
        sizes = getattr(self, name)
        told = f", {name} {sizes.min():g} to {sizes.max():g}" if len(self) else ""
        return f"{type(self).__name__}({len(self)} of {self._total()}{told})"


def as_bend(angle: Scalar, every: bool) -> float:
    """Return the angle, in degrees, above which two plane faces have an edge between them.

    If `every` is true, return minus infinity: then all adjacent plane faces have an edge between
    them. Raise `InvalidParameterError` for an angle outside 0 to 180.
    """
    bend = number(angle, "angle")
    if not 0 <= bend < 180:
        raise invalid_parameter(f"angle must be at least 0 and below 180 degrees, not {bend:g}.")
    return -np.inf if every else bend


def bends(graph: FaceGraph, least: float) -> BoolArray:
    """Return a mask, (e,), of edges whose face normals differ by more than `least` degrees."""
    # Add a tolerance: a 12-gon bends by the common limit of 30 degrees, up to rounding.
    return np.asarray(np.abs(180 - graph.angles) > least + _SAME)
