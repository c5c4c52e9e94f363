"""Exact casting of rays at points, segments and triangles."""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, Self

import numpy as np

from ..._core import RayScene
from ..._types import FloatArray, IndexArray, SideArray, WindingRule
from ...errors import InvalidMeshError, core_errors, invalid_parameter
from ...geometry.arrays import doubles
from ...parameters import pitch_exponent, thread_count, truth_value, winding_rule
from .targets import RayTargets, facets_from, ray_arrays

#: Values of `Hits.kind`.
MISS, INTERIOR, EDGE, VERTEX = -1, 0, 1, 2


@dataclass(frozen=True, eq=False)
class Hits:
    """The hits of rays with facets: one row for each ray, or for each hit of `RayCaster.all_hits`.

    Parameters
    ----------
    facet : (n,) int64
        The index of the facet that the ray meets, -1 if it meets none.
    t : (n,) float64
        The hit point is ``origin + t * direction``; the exact t rounded correctly; inf without a
        hit.
    kind : (n,) int8
        0 for a hit in the facet's interior, 1 on an edge, 2 in a vertex (in 2D an end), -1 without
        a hit. Exact.
    weights : (n, d) float64
        The hit point's barycentric coordinates in the facet, rounded correctly; exact zeros are
        0.0.
    point : (n, d) float64
        The hit point in model units, from the weights: within a few units in the last place of the
        facet's corners.
    normal : (n, d) float64
        The facet's unit normal: by the right-hand rule in 3D, to the right of a segment in 2D.
    source : (n, 2) int64 or None
        The input mesh and face of the facet, if the caster was made from a `Solid`.
    """

    facet: IndexArray
    t: FloatArray
    kind: SideArray
    weights: FloatArray
    point: FloatArray
    normal: FloatArray
    source: IndexArray | None = None

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.facet)

    @property
    def hit(self) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """Whether each ray meets a facet, (n,) bool."""
        return self.facet >= 0

    def __getitem__(self, rows: Any) -> "Hits":
        """Return the rows that a slice, a mask or an index array selects."""
        columns = {field.name: getattr(self, field.name) for field in fields(self)}
        taken: dict[str, Any] = {
            name: None if c is None else c[rows] for name, c in columns.items()
        }
        return Hits(**taken)


@dataclass(frozen=True, eq=False)
class HitLists:
    """All hits of each ray, ordered by t.

    Parameters
    ----------
    offsets : (n + 1,) int64
        The hits of ray i are ``hits[offsets[i]:offsets[i + 1]]``.
    hits : Hits
    """

    offsets: IndexArray
    hits: Hits

    def __len__(self) -> int:
        """Return the number of rays."""
        return len(self.offsets) - 1

    def __getitem__(self, ray: int) -> Hits:
        """Return the hits of one ray."""
        start = range(len(self))[ray]
        return self.hits[self.offsets[start] : self.offsets[start + 1]]

    def __iter__(self) -> Iterator[Hits]:
        """Yield the hits of each ray in turn."""
        return (self[i] for i in range(len(self)))


@dataclass(frozen=True, eq=False)
class InsideSpans:
    """The intervals of rays that lie inside a closed boundary.

    Parameters
    ----------
    offsets : (n + 1,) int64
        The intervals of ray i are the rows ``offsets[i]:offsets[i + 1]``.
    t : (k, 2) float64
        The start and end t of each interval, rounded correctly; the start is 0 if the ray starts
        inside, the end is inf if it stays inside.
    facets : (k, 2) int64
        The facets at the start and end, the first of the input if there are several; -1 if the ray
        starts inside or stays inside.
    """

    offsets: IndexArray
    t: FloatArray
    facets: IndexArray

    def __len__(self) -> int:
        """Return the number of rays."""
        return len(self.offsets) - 1

    def __getitem__(self, ray: int) -> FloatArray:
        """Return the intervals of one ray as rows (start t, end t), (k, 2) float64."""
        start = range(len(self))[ray]
        return self.t[self.offsets[start] : self.offsets[start + 1]]

    def __iter__(self) -> Iterator[FloatArray]:
        """Yield the intervals of each ray in turn, (k, 2) float64."""
        return (self[i] for i in range(len(self)))

    def lengths(self) -> FloatArray:
        """Return the total length of each ray inside, in lengths of its direction vector, (n,)."""
        rays = np.repeat(np.arange(len(self)), np.diff(self.offsets))
        lengths = np.zeros(len(self))
        np.add.at(lengths, rays, self.t[:, 1] - self.t[:, 0])
        return lengths


@dataclass(frozen=True, eq=False)
class CasterNodes:
    """The nodes of a `RayCaster`'s hierarchy of boxes that rays have reached.

    Parameters
    ----------
    low, high : (n, d) float64
        The minimum and maximum corner of each node's box, in model units. Boxes of neighbours may
        overlap.
    parent : (n,) int64
        The parent node, -1 for the root; a node has up to eight children.
    deferred : (n,) bool
        True if the node is to be divided when a ray reaches it.
    offsets : (n + 1,) int64
        Leaf v lists ``facets[offsets[v]:offsets[v + 1]]``.
    facets : (k,) int64
        The facets of all leaves; each facet is listed in one leaf, whose box contains it.
    """

    low: FloatArray
    high: FloatArray
    parent: IndexArray
    deferred: np.ndarray[Any, np.dtype[np.bool_]]
    offsets: IndexArray
    facets: IndexArray

    def __len__(self) -> int:
        """Return the number of nodes."""
        return len(self.parent)

    def held(self, node: int) -> IndexArray:
        """Return the facets that a leaf lists; empty for an inner node."""
        at = range(len(self))[node]
        return self.facets[self.offsets[at] : self.offsets[at + 1]]


class RayCaster:
    """A set of points, segments or triangles at which rays can be cast, with exact hits.

    Facets are snapped to a lattice, as those of a solid are; facets without extent on the lattice
    are never hit. A ray's origin is snapped to the same lattice; its direction is taken as it is,
    bit by bit (but components more than 2**60 times smaller than the largest are rounded to 2**-113
    of it). After that every hit is exact: facets are closed sets, a ray never slips through an edge
    or a vertex of a closed mesh, and of several facets at one point the first of the input is
    reported. A ray in the plane of a facet hits it at their first common point.

    The hierarchy of boxes over the facets grows where rays go. Neither its shape nor the order of
    rays affects a hit. Similar rays are traced in bundles that share their path down the hierarchy.
    Threads can share an object, and hits are bitwise equal for any number of threads.

    Parameters
    ----------
    facets : array_like, Solid, or mesh
        ``(n,)`` for points of the line, ``(n, 2, 2)`` for segments of the plane, ``(n, 3, 3)`` for
        triangles; a `Solid` (its reduced boundary, which must be finite, as it is for a bounded
        solid and for its complement); a *tuple* ``(vertices, faces)``; or what `Solid.from_mesh`
        takes. Only `intervals` needs a closed mesh.
    pitch : int, optional
        The lattice step is ``10**pitch`` units; by default the solid's, or one that suits the
        coordinates.
    deferred : bool
        True to divide a box when a ray first reaches it, False to divide all boxes in the
        constructor.

    Raises
    ------
    InvalidMeshError
        For arrays of another shape, or coordinates that are not finite (`where` lists the facet).
    LimitError
        If coordinates do not fit the lattice.
    UnboundedError
        For a solid whose boundary reaches to infinity.

    Notes
    -----
    Two levels, bundles and deferral after Cadet, Lécussan 2007; boxes by the surface area heuristic
    in bins (Wald 2007), eight to a node and of single precision, with an error bound; the filter in
    doubles after Woop, Benthin, Wald 2013, with an error bound and exact integers behind it.

    Examples
    --------
    >>> import bspcsg as csg
    >>> from bspcsg import bsp
    >>> caster = bsp.RayCaster(csg.cube(2))
    >>> hits = caster.first_hit([[0.5, 0.5, 5.0], [3.0, 3.0, 5.0]], [0, 0, -2])
    >>> hits.t
    array([1.5, inf])
    >>> caster.intervals([0.5, 0.5, 5.0], [0, 0, -2]).t
    array([[1.5, 2.5]])
    """

    def __init__(self, facets: Any, *, pitch: int | None = None, deferred: bool = True) -> None:
        found = facets_from(facets)
        step = found.pitch if pitch is None else pitch_exponent(pitch)
        self._set(found, step, truth_value(deferred, "deferred"))

    def _set(self, facets: RayTargets, pitch: int | None, deferred: bool) -> None:
        self._facets = facets
        with core_errors():
            self._scene = RayScene(facets.dimension, facets.corners.ravel(), pitch)
            if not deferred:
                self._scene.complete()

    def refitted(self, facets: Any) -> Self:
        """Return a caster over the same facets after they have moved.

        The new caster has the same lattice and the same hierarchy with refitted boxes, which is
        much faster than a new hierarchy. Hits equal those of `RayCaster(facets)`, but take longer
        the farther neighbours have moved apart. This caster does not change.

        Parameters
        ----------
        facets : array_like, Solid, or mesh
            The same number of facets, in the same order.

        Raises
        ------
        InvalidMeshError, LimitError
            As for a new caster, and for another number or another dimension of facets.
        """
        found = facets_from(facets)
        if found.corners.shape != self._facets.corners.shape:
            shapes = f"{found.corners.shape}, not {self._facets.corners.shape}"
            raise InvalidMeshError(
                f"The moved facets must have the same array shape as the facets before: {shapes}.",
                "shape",
            )
        moved = type(self).__new__(type(self))
        moved._facets = found
        with core_errors():
            moved._scene = self._scene.refitted(found.corners.ravel())
        return moved

    @property
    def nodes(self) -> CasterNodes:
        """The nodes of the hierarchy of boxes that rays have reached, in preorder."""
        with core_errors():
            arrays = self._scene.nodes()
        shape = (-1, self._facets.dimension)
        low, high = arrays["low"].reshape(shape), arrays["high"].reshape(shape)
        return CasterNodes(
            low,
            high,
            arrays["parent"],
            arrays["deferred"],
            arrays["offsets"],
            arrays["facets"],
        )

    def __copy__(self) -> Self:
        """Return the caster itself, whose hits never change."""
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """Return the caster itself, whose hits never change."""
        return self

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        """Return facets and lattice for pickling; the hierarchy of boxes grows again in a copy."""
        return _restored, (type(self), self._facets, self.pitch)

    @property
    def dimension(self) -> int:
        """The dimension of the facets: 1, 2 or 3."""
        return self._facets.dimension

    @property
    def pitch(self) -> int:
        """The exponent of the lattice step, which is ``10**pitch`` model units."""
        return self._scene.pitch

    def __len__(self) -> int:
        """Return the number of facets given."""
        return len(self._facets.corners)

    def __repr__(self) -> str:
        """Return a text with the number and the kind of the facets."""
        name = ("points", "segments", "triangles")[self.dimension - 1]
        return f"RayCaster({len(self)} {name})"

    def first_hit(self, origins: Any, directions: Any, *, threads: int = 0) -> Hits:
        """Return the hit of each ray (t ≥ 0) with the facet that it meets first.

        Parameters
        ----------
        origins, directions : (n, d) or (d,) array_like of float
            In model units; a single origin or direction serves all rays. Directions may have any
            length.
        threads : int
            The number of threads; 0 for the number of processors.

        Raises
        ------
        InvalidMeshError
            For a direction of length zero, or numbers that are not finite (`where` lists the ray).
        LimitError
            If a coordinate of an origin is more than 2**53 lattice steps.
        """
        first, second = ray_arrays(origins, directions, self.dimension)
        with core_errors():
            columns = self._scene.first(first.ravel(), second.ravel(), thread_count(threads))
        return self._hits(*columns)

    def first_facet(self, origins: Any, directions: Any, *, threads: int = 0) -> IndexArray:
        """Return the index of the facet that each ray meets first, (n,) int64, -1 for none.

        This is `first_hit` without the hit points.

        Parameters
        ----------
        origins, directions, threads
            As for `first_hit`, as are the errors.
        """
        first, second = ray_arrays(origins, directions, self.dimension)
        with core_errors():
            return self._scene.first_facets(first.ravel(), second.ravel(), thread_count(threads))

    def all_hits(
        self, origins: Any, directions: Any, *, merge: bool = False, threads: int = 0
    ) -> HitLists:
        """Return all facets that each ray meets, each at its first point on the ray, nearest first.

        Parameters
        ----------
        origins, directions, threads
            As for `first_hit`, as are the errors.
        merge : bool
            True to merge hits of several facets at one point, as on a common edge, into one hit
            with the first facet of the input. By default there is a hit for each facet, in input
            order. Points are compared exactly. Points where a ray only touches a boundary are
            included; `intervals` returns crossings.
        """
        first, second = ray_arrays(origins, directions, self.dimension)
        count, merges = thread_count(threads), truth_value(merge, "merge")
        with core_errors():
            found = self._scene.all(first.ravel(), second.ravel(), merges, count)
        offsets, columns = found
        return HitLists(offsets, self._hits(*columns))

    def intervals(
        self,
        origins: Any,
        directions: Any,
        *,
        winding: WindingRule = "positive",
        threads: int = 0,
    ) -> InsideSpans:
        """Return the intervals of each ray (t ≥ 0) inside the boundary that the facets make.

        The facets must be a closed mesh, closed outlines with their inside to the left, or an even
        number of points, between which inside and outside alternate. This is checked exactly, on
        the lattice, in the first call. Winding numbers are counted from the far end of the ray,
        where they are 0, or 1 for a solid whose complement is bounded. Every ray is shifted by an
        infinitesimal vector (ε, ε², ε³), so that it meets no edge or vertex; a ray within a facet
        is inside if the shifted ray is. Intervals of length zero are omitted, and intervals that
        touch are joined.

        Parameters
        ----------
        origins, directions, threads
            As for `first_hit`, as are the errors.
        winding : {"positive", "nonzero", "even-odd"}
            The rule that says which winding numbers are inside; 1D casters always use even-odd.

        Raises
        ------
        InvalidMeshError
            If the facets do not close ("not_closed"; `where` lists facets at the border).
        """
        rule, count = winding_rule(winding), thread_count(threads)
        first, second = ray_arrays(origins, directions, self.dimension)
        if self.dimension == 1:
            rule = "even-odd"
        far = self._facets.unbounded
        with core_errors():
            found = self._scene.intervals(first.ravel(), second.ravel(), rule, far, count)
        offsets, t, facets = found
        return InsideSpans(offsets, t.reshape(-1, 2), facets.reshape(-1, 2))

    def occluded(
        self,
        origins: Any,
        targets: Any = None,
        *,
        directions: Any = None,
        max_t: Any = np.inf,
        threads: int = 0,
    ) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """Return whether a facet lies strictly between each origin and its target, (n,) bool.

        The ends do not count, so facets at two vertices do not block the segment between them.
        Facets that contain a part of the segment do block it. Facets block from both sides and need
        not be closed.

        Parameters
        ----------
        origins : (n, d) or (d,) array_like of float
        targets : (n, d) or (d,) array_like of float
            Snapped to the lattice, as origins are.
        directions : (n, d) or (d,) array_like of float
            Instead of targets.
        max_t : float or (n,) array_like of float
            Only with directions: facets with ``0 < t < max_t`` count, with `t` rounded as in
            `first_hit`.
        threads : int

        Raises
        ------
        InvalidMeshError
            As for `first_hit`; also if a target equals its origin, if not exactly one of targets
            and directions is given, or if `max_t` is given with targets.
        """
        if (targets is None) == (directions is None):
            raise invalid_parameter("Give exactly one of targets and directions.")
        if targets is not None:
            first, second = ray_arrays(origins, targets, self.dimension, ("Origins", "Targets"))
            if not np.isposinf(_limits(max_t, len(first))).all():
                raise invalid_parameter(
                    "max_t can only be given together with directions, because with targets"
                    " each ray ends at its target; leave max_t out."
                )
            with core_errors():
                return self._scene.hidden(first.ravel(), second.ravel(), thread_count(threads))
        first, second = ray_arrays(origins, directions, self.dimension)
        limits = _limits(max_t, len(first))
        with core_errors():
            return self._scene.blocked(first.ravel(), second.ravel(), limits, thread_count(threads))

    @cached_property
    def _normals(self) -> FloatArray:
        return self._facets.normals()

    def _hits(self, *columns: Any) -> Hits:
        # For fewer hits than facets, compute only the normals of the facets hit.
        many = len(columns[0]) >= len(self._facets.corners)
        return hits_of(self._facets, columns, self._normals if many else None)


def _restored(kind: type[RayCaster], facets: RayTargets, pitch: int) -> RayCaster:
    caster = kind.__new__(kind)
    caster._set(facets, pitch, deferred=True)
    return caster


def hits_of(facets: RayTargets, columns: Any, normals: FloatArray | None = None) -> Hits:
    """Return `Hits` made of the arrays that the core returns for rays; for this package only."""
    facet, t, kind, weights, point = columns
    d, missed = facets.dimension, facet < 0
    if normals is None:
        normal = facets.normals(facet) if len(facets.corners) else np.zeros((len(facet), d))
    else:
        normal = _rows_at(normals, facet)
    normal[missed] = np.nan
    source = facets.source
    if source is not None:
        source = _rows_at(source, facet)
        source[missed] = -1
    return Hits(facet, t, kind, weights.reshape(-1, d), point.reshape(-1, d), normal, source)


def _rows_at(rows: Any, index: IndexArray) -> Any:
    """Return the rows of an array at the indices; index -1, for no hit, gives an arbitrary row."""
    return rows[index] if len(rows) else np.zeros((len(index), *rows.shape[1:]), rows.dtype)


def _limits(given: Any, count: int) -> FloatArray:
    limits = doubles(
        given,
        invalid_parameter("max_t must be one number, or an array with one number for each ray."),
    )
    if limits.ndim > 1 or np.isnan(limits).any():
        raise invalid_parameter(
            "max_t must be one number, or an array with one number for each ray, and must not"
            " contain NaN."
        )
    if limits.shape not in ((), (1,), (count,)):
        raise invalid_parameter(
            f"max_t has {len(limits)} values, but there are {count} rays; give one value, or one"
            " for each ray."
        )
    return np.ascontiguousarray(np.broadcast_to(limits, count))
